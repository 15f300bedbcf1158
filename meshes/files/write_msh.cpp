// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/meshes/files/list.hpp>
#include <plica/meshes/files/writing.hpp>
#include <span>

namespace plica {

namespace {

constexpr int tet_type = 4;
constexpr int types[] = {15, 1, 2};  // MSH types of points, lines and triangles

void check_name(const std::filesystem::path& path, const std::string& name) {
  if (name.empty() || name.find_first_of("\r\n") != std::string::npos)
    throw InputError(
        "the name " + shown(name) + " of a region, set or field of vectors cannot be written",
        {path.string()});
}

std::int64_t size_of(const auto& container) { return static_cast<std::int64_t>(container.size()); }

// Mesh and its groups with the numbers for MSH
struct Parts {
  Parts(const TetMesh& mesh_, const MeshGroups& groups)
      : mesh(mesh_), sets(groups_of(mesh, groups)), tags(region_tags(mesh, groups)) {
    for (const ElementGroup& set : sets) elements += size_of(set.elements);
  }
  // Returns the tag of the region of a tetrahedron; 0 without regions
  std::int64_t region_tag(std::size_t tet) const {
    return mesh.region.empty() ? 0 : tags[static_cast<std::size_t>(mesh.region[tet])];
  }

  const TetMesh& mesh;
  std::vector<ElementGroup> sets;
  std::vector<std::int64_t> tags;  // tags of the regions
  std::int64_t elements = size_of(mesh.tets);
};

// Writes the format and the names of groups. Vertices and elements have tags from 1.
void write_heading(const char* version, const std::filesystem::path& path, const Parts& parts,
                   WrittenMesh& written, NumbersOut& out) {
  out.text("$MeshFormat\n").text(version).text(out.binary() ? " 1 8\n" : " 0 8\n");
  if (out.binary()) out.int32(1).text("\n");  // tells the byte order
  out.text("$EndMeshFormat\n");
  for (const auto& [name, vectors] : parts.mesh.tet_vectors) check_name(path, name);
  const std::size_t names = parts.tags.size() + parts.sets.size();
  if (names == 0) return;
  out.text("$PhysicalNames\n" + std::to_string(names) + "\n");
  const auto write = [&](int dimension, std::int64_t tag, const std::string& name) {
    check_name(path, name);
    out.text(std::to_string(dimension) + " " + std::to_string(tag) + " \"" + name + "\"\n");
  };
  for (const ElementGroup& set : parts.sets) {
    write(set.dimension, set.tag, set.name);
    if (set.elements.empty())
      written.left_out.push_back("the vertex set '" + set.name + "' is left out: it is empty");
  }
  for (std::size_t r = 0; r < parts.tags.size(); ++r)
    write(3, parts.tags[r], parts.mesh.region_names[r]);
  out.text("$EndPhysicalNames\n");
}

// Writes the end of a section; in binary it is on a line of its own
void end_section(const char* name, NumbersOut& out) {
  out.text(out.binary() ? "\n$End" : "$End").text(name).text("\n");
}

// Writes an entity for each group, with its tag, and one for a mesh without regions
void write_entities(const Parts& parts, NumbersOut& out) {
  std::int64_t counts[] = {0, 0, 0, std::max<std::int64_t>(size_of(parts.tags), 1)};
  for (const ElementGroup& set : parts.sets) ++counts[set.dimension];
  out.text("$Entities\n");
  for (const std::int64_t count : counts) out.int64(count);
  out.end();
  const Box box = bounding_box(parts.mesh.vertices);
  for (int dimension = 0; dimension < 3; ++dimension)
    for (const ElementGroup& set : parts.sets) {
      if (set.dimension != dimension) continue;
      out.int32(set.tag).real64(box.min);
      if (dimension > 0) out.real64(box.max);
      out.int64(1).int32(set.tag);
      if (dimension > 0) out.int64(0);
      out.end();
    }
  for (const std::int64_t tag : parts.tags)
    out.int32(tag).real64(box.min).real64(box.max).int64(1).int32(tag).int64(0).end();
  if (parts.tags.empty()) out.int32(1).real64(box.min).real64(box.max).int64(0).int64(0).end();
  end_section("Entities", out);
}

// Writes a block per group, and per run of tetrahedra of one region: their order is kept
void write_blocks(const Parts& parts, NumbersOut& out) {
  const TetMesh& mesh = parts.mesh;
  std::int64_t blocks = mesh.tets.empty() ? 0 : 1;
  for (const ElementGroup& set : parts.sets) blocks += set.elements.empty() ? 0 : 1;
  for (std::size_t t = 1; t < mesh.region.size(); ++t)
    blocks += mesh.region[t] != mesh.region[t - 1] ? 1 : 0;
  out.text("$Elements\n").int64(blocks).int64(parts.elements).int64(1).int64(parts.elements).end();
  std::int64_t tag = 0;
  for (const ElementGroup& set : parts.sets) {
    if (set.elements.empty()) continue;
    out.int32(set.dimension)
        .int32(set.tag)
        .int32(types[set.dimension])
        .int64(size_of(set.elements))
        .end();
    for (const auto& element : set.elements) {
      out.int64(++tag);
      for (std::size_t k = 0; k <= static_cast<std::size_t>(set.dimension); ++k)
        out.int64(element[k] + 1);
      out.end();
    }
  }
  for (std::size_t begin = 0, end = 0; begin < mesh.tets.size(); begin = end) {
    while (end < mesh.tets.size() && parts.region_tag(end) == parts.region_tag(begin)) ++end;
    const std::int64_t entity = std::max<std::int64_t>(parts.region_tag(begin), 1);
    out.int32(3).int32(entity).int32(tet_type).int64(static_cast<std::int64_t>(end - begin)).end();
    for (std::size_t t = begin; t < end; ++t) {
      out.int64(++tag);
      for (const int v : mesh.tets[t]) out.int64(v + 1);
      out.end();
    }
  }
  end_section("Elements", out);
}

// Writes the named vectors, in one form for all versions. The tetrahedra are the last elements.
void write_vectors(const Parts& parts, NumbersOut& out) {
  for (const auto& [name, vectors] : parts.mesh.tet_vectors) {
    out.text("$ElementData\n1\n\"" + name + "\"\n1\n0\n3\n0\n3\n" + std::to_string(vectors.size()) +
             "\n");
    std::int64_t tag = parts.elements - size_of(vectors);
    for (const Point& vector : vectors) out.int32(++tag).real64(vector).end();
    end_section("ElementData", out);
  }
}

// Writes the parts of the tetrahedra that are body
void write_filled(const Parts& parts, NumbersOut& out) {
  const std::vector<double>& filled = parts.mesh.filled;
  if (filled.empty()) return;
  out.text("$ElementData\n1\n\"" + std::string(filled_name) + "\"\n1\n0\n3\n0\n1\n" +
           std::to_string(filled.size()) + "\n");
  std::int64_t tag = parts.elements - size_of(filled);
  for (const double part : filled) out.int32(++tag).real64(part).end();
  end_section("ElementData", out);
}

// Writes an element of version 2.2. In text each element has its type and number of tags; in binary
// a run of elements has them.
void write_element22(std::int64_t tag, int type, std::int64_t group, std::span<const int> vertices,
                     NumbersOut& out) {
  out.int32(tag);
  if (!out.binary()) out.int32(type).int32(2);
  out.int32(group).int32(std::max<std::int64_t>(group, 1));
  for (const int v : vertices) out.int32(v + 1);
  out.end();
}

void write_elements22(const Parts& parts, NumbersOut& out) {
  const auto begin_run = [&](int type, std::int64_t count) {
    if (out.binary() && count > 0) out.int32(type).int32(count).int32(2);
  };
  out.text("$Elements\n" + std::to_string(parts.elements) + "\n");
  std::int64_t tag = 0;
  for (const ElementGroup& set : parts.sets) {
    const auto corners = static_cast<std::size_t>(set.dimension) + 1;
    begin_run(types[set.dimension], size_of(set.elements));
    for (const auto& element : set.elements)
      write_element22(++tag, types[set.dimension], set.tag, std::span(element).first(corners), out);
  }
  begin_run(tet_type, size_of(parts.mesh.tets));
  for (std::size_t t = 0; t < parts.mesh.tets.size(); ++t)
    write_element22(++tag, tet_type, parts.region_tag(t), parts.mesh.tets[t], out);
  end_section("Elements", out);
}

WrittenMesh write22(const std::filesystem::path& path, const TetMesh& mesh,
                    const MeshGroups& groups, bool binary) {
  WrittenMesh written;
  NumbersOut out(binary);
  const Parts parts(mesh, groups);
  write_heading("2.2", path, parts, written, out);
  out.text("$Nodes\n" + std::to_string(mesh.vertices.size()) + "\n");
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    out.int32(static_cast<std::int64_t>(v + 1)).real64(mesh.vertices[v]).end();
  end_section("Nodes", out);
  write_elements22(parts, out);
  write_vectors(parts, out);
  write_filled(parts, out);
  written.files = {{path.string(), out.take()}};
  return written;
}

WrittenMesh write41(const std::filesystem::path& path, const TetMesh& mesh,
                    const MeshGroups& groups, bool binary) {
  WrittenMesh written;
  NumbersOut out(binary);
  const Parts parts(mesh, groups);
  write_heading("4.1", path, parts, written, out);
  write_entities(parts, out);
  const std::int64_t count = size_of(mesh.vertices);
  out.text("$Nodes\n").int64(1).int64(count).int64(1).int64(count).end();
  out.int32(3).int32(parts.tags.empty() ? 1 : parts.tags.front()).int32(0).int64(count).end();
  for (std::int64_t v = 1; v <= count; ++v) out.int64(v).end();
  for (const Point& p : mesh.vertices) out.real64(p).end();
  end_section("Nodes", out);
  write_blocks(parts, out);
  write_vectors(parts, out);
  write_filled(parts, out);
  written.files = {{path.string(), out.take()}};
  return written;
}

}  // namespace

WrittenMesh write_msh22(const std::filesystem::path& path, const TetMesh& mesh,
                        const MeshGroups& groups) {
  return write22(path, mesh, groups, false);
}
WrittenMesh write_msh41(const std::filesystem::path& path, const TetMesh& mesh,
                        const MeshGroups& groups) {
  return write41(path, mesh, groups, false);
}
WrittenMesh write_msh22_binary(const std::filesystem::path& path, const TetMesh& mesh,
                               const MeshGroups& groups) {
  return write22(path, mesh, groups, true);
}
WrittenMesh write_msh41_binary(const std::filesystem::path& path, const TetMesh& mesh,
                               const MeshGroups& groups) {
  return write41(path, mesh, groups, true);
}

}  // namespace plica
