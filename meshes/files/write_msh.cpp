// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/meshes/files/list.hpp>
#include <plica/meshes/files/writing.hpp>

namespace plica {

namespace {

constexpr int point_type = 15, tet_type = 4;

void check_name(const std::filesystem::path& path, const std::string& name) {
  if (name.empty() || name.find_first_of("\r\n") != std::string::npos)
    throw InputError("the name " + shown(name) + " of a region or set cannot be written", {path.string()});
}

// Tags are from 1: of regions, of the vertex sets in their order, of vertices and elements
void write_heading(const char* version, const std::filesystem::path& path, const TetMesh& mesh, WrittenMesh& written,
                   NumbersOut& out) {
  out.text("$MeshFormat\n").text(version).text(out.binary() ? " 1 8\n" : " 0 8\n");
  if (out.binary()) out.int32(1).text("\n");  // tells the order of bytes
  out.text("$EndMeshFormat\n");
  const std::size_t names = mesh.region_names.size() + mesh.vertex_sets.size();
  if (names == 0) return;
  out.text("$PhysicalNames\n" + std::to_string(names) + "\n");
  int tag = 0;
  for (const auto& [name, vertices] : mesh.vertex_sets) {
    check_name(path, name);
    out.text("0 " + std::to_string(++tag) + " \"" + name + "\"\n");
    if (vertices.empty()) written.left_out.push_back("the vertex set '" + name + "' is left out: it is empty");
  }
  tag = 0;
  for (const std::string& name : mesh.region_names) {
    check_name(path, name);
    out.text("3 " + std::to_string(++tag) + " \"" + name + "\"\n");
  }
  out.text("$EndPhysicalNames\n");
}

// In binary the end of a section is on a line of its own
void end_section(const char* name, NumbersOut& out) {
  out.text(out.binary() ? "\n$End" : "$End").text(name).text("\n");
}

std::int64_t count_elements(const TetMesh& mesh) {
  std::size_t count = mesh.tets.size();
  for (const auto& [name, vertices] : mesh.vertex_sets) count += vertices.size();
  return static_cast<std::int64_t>(count);
}

// 0: none
int region_tag(const TetMesh& mesh, std::size_t tet) { return mesh.region.empty() ? 0 : mesh.region[tet] + 1; }

std::int64_t size_of(const auto& container) { return static_cast<std::int64_t>(container.size()); }

void write_entities(const TetMesh& mesh, NumbersOut& out) {
  const std::int64_t regions = std::max<std::int64_t>(size_of(mesh.region_names), 1);
  out.text("$Entities\n").int64(size_of(mesh.vertex_sets)).int64(0).int64(0).int64(regions).end();
  int tag = 0;
  for (const auto& [name, vertices] : mesh.vertex_sets) {
    const Point at = vertices.empty() ? Point::Zero().eval() : mesh.vertices[static_cast<std::size_t>(vertices[0])];
    ++tag;
    out.int32(tag).real64(at).int64(1).int32(tag).end();
  }
  const Box box = bounding_box(mesh.vertices);
  for (std::int64_t r = 1; r <= regions; ++r) {
    out.int32(r).real64(box.min).real64(box.max);
    if (mesh.region_names.empty())
      out.int64(0);
    else
      out.int64(1).int32(r);
    out.int64(0).end();
  }
  end_section("Entities", out);
}

// A block per set and per run of tetrahedra of one region, to keep their order
void write_blocks(const TetMesh& mesh, NumbersOut& out) {
  std::int64_t blocks = mesh.tets.empty() ? 0 : 1;
  for (const auto& [name, vertices] : mesh.vertex_sets) blocks += vertices.empty() ? 0 : 1;
  for (std::size_t t = 1; t < mesh.region.size(); ++t) blocks += mesh.region[t] != mesh.region[t - 1] ? 1 : 0;
  const std::int64_t count = count_elements(mesh);
  out.text("$Elements\n").int64(blocks).int64(count).int64(1).int64(count).end();
  int set = 0;
  std::int64_t tag = 0;
  for (const auto& [name, vertices] : mesh.vertex_sets) {
    ++set;
    if (!vertices.empty()) out.int32(0).int32(set).int32(point_type).int64(size_of(vertices)).end();
    for (const int v : vertices) out.int64(++tag).int64(v + 1).end();
  }
  for (std::size_t begin = 0, end = 0; begin < mesh.tets.size(); begin = end) {
    while (end < mesh.tets.size() && region_tag(mesh, end) == region_tag(mesh, begin)) ++end;
    const int entity = std::max(region_tag(mesh, begin), 1);
    out.int32(3).int32(entity).int32(tet_type).int64(static_cast<std::int64_t>(end - begin)).end();
    for (std::size_t t = begin; t < end; ++t) {
      out.int64(++tag);
      for (const int v : mesh.tets[t]) out.int64(v + 1);
      out.end();
    }
  }
  end_section("Elements", out);
}

// Version 2.2 gives an element its type and number of tags in text, a whole run of elements in binary
template <std::size_t corners>
void write_element22(std::int64_t tag, int type, int group, const std::array<int, corners>& vertices, NumbersOut& out) {
  out.int32(tag);
  if (!out.binary()) out.int32(type).int32(2);
  out.int32(group).int32(std::max(group, 1));
  for (const int v : vertices) out.int32(v + 1);
  out.end();
}

void write_elements22(const TetMesh& mesh, NumbersOut& out) {
  const auto begin_run = [&](int type, std::int64_t count) {
    if (out.binary() && count > 0) out.int32(type).int32(count).int32(2);
  };
  out.text("$Elements\n" + std::to_string(count_elements(mesh)) + "\n");
  std::int64_t tag = 0;
  int set = 0;
  for (const auto& [name, vertices] : mesh.vertex_sets) {
    ++set;
    begin_run(point_type, size_of(vertices));
    for (const int v : vertices) write_element22<1>(++tag, point_type, set, {v}, out);
  }
  begin_run(tet_type, size_of(mesh.tets));
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    write_element22(++tag, tet_type, region_tag(mesh, t), mesh.tets[t], out);
  end_section("Elements", out);
}

WrittenMesh write22(const std::filesystem::path& path, const TetMesh& mesh, bool binary) {
  WrittenMesh written;
  NumbersOut out(binary);
  write_heading("2.2", path, mesh, written, out);
  out.text("$Nodes\n" + std::to_string(mesh.vertices.size()) + "\n");
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    out.int32(static_cast<std::int64_t>(v + 1)).real64(mesh.vertices[v]).end();
  end_section("Nodes", out);
  write_elements22(mesh, out);
  written.files = {{path.string(), out.take()}};
  return written;
}

WrittenMesh write41(const std::filesystem::path& path, const TetMesh& mesh, bool binary) {
  WrittenMesh written;
  NumbersOut out(binary);
  write_heading("4.1", path, mesh, written, out);
  write_entities(mesh, out);
  const std::int64_t count = size_of(mesh.vertices);
  out.text("$Nodes\n").int64(1).int64(count).int64(1).int64(count).end();
  out.int32(3).int32(1).int32(0).int64(count).end();
  for (std::int64_t v = 1; v <= count; ++v) out.int64(v).end();
  for (const Point& p : mesh.vertices) out.real64(p).end();
  end_section("Nodes", out);
  write_blocks(mesh, out);
  written.files = {{path.string(), out.take()}};
  return written;
}

}  // namespace

WrittenMesh write_msh22(const std::filesystem::path& path, const TetMesh& mesh) { return write22(path, mesh, false); }
WrittenMesh write_msh41(const std::filesystem::path& path, const TetMesh& mesh) { return write41(path, mesh, false); }
WrittenMesh write_msh22_binary(const std::filesystem::path& path, const TetMesh& mesh) {
  return write22(path, mesh, true);
}
WrittenMesh write_msh41_binary(const std::filesystem::path& path, const TetMesh& mesh) {
  return write41(path, mesh, true);
}

}  // namespace plica
