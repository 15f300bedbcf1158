// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/meshes/msh/write_msh.hpp>

namespace plica {

namespace {

constexpr int point_type = 15, tet_type = 4;

void check_name(const std::filesystem::path& path, const std::string& name) {
  if (name.empty() || name.find_first_of("\r\n") != std::string::npos)
    throw InputError("the name " + shown(name) + " of a region or set cannot be written", {path.string()});
}

// Tags are from 1: of regions, of the vertex sets in their order, of vertices and elements
TextOut heading(const char* version, const std::filesystem::path& path, const TetMesh& mesh, WrittenMesh& written) {
  TextOut out;
  out << "$MeshFormat\n" << version << " 0 8\n$EndMeshFormat\n";
  const std::size_t names = mesh.region_names.size() + mesh.vertex_sets.size();
  if (names == 0) return out;
  out << "$PhysicalNames\n" << names << "\n";
  int tag = 0;
  for (const auto& [name, vertices] : mesh.vertex_sets) {
    check_name(path, name);
    out << "0 " << ++tag << " \"" << name << "\"\n";
    if (vertices.empty()) written.left_out.push_back("the vertex set '" + name + "' is left out: it is empty");
  }
  tag = 0;
  for (const std::string& name : mesh.region_names) {
    check_name(path, name);
    out << "3 " << ++tag << " \"" << name << "\"\n";
  }
  out << "$EndPhysicalNames\n";
  return out;
}

std::size_t count_elements(const TetMesh& mesh) {
  std::size_t count = mesh.tets.size();
  for (const auto& [name, vertices] : mesh.vertex_sets) count += vertices.size();
  return count;
}

// 0: none
int region_tag(const TetMesh& mesh, std::size_t tet) { return mesh.region.empty() ? 0 : mesh.region[tet] + 1; }

void write_corners(const std::array<int, 4>& tet, TextOut& out) {
  for (const int v : tet) out << " " << v + 1;
  out << "\n";
}

void write_entities(const TetMesh& mesh, TextOut& out) {
  const std::size_t regions = std::max<std::size_t>(mesh.region_names.size(), 1);
  out << "$Entities\n" << mesh.vertex_sets.size() << " 0 0 " << regions << "\n";
  int tag = 0;
  for (const auto& [name, vertices] : mesh.vertex_sets) {
    const Point at = vertices.empty() ? Point::Zero().eval() : mesh.vertices[static_cast<std::size_t>(vertices[0])];
    ++tag;
    out << tag << at << " 1 " << tag << "\n";
  }
  const Box box = bounding_box(mesh.vertices);
  for (std::size_t r = 1; r <= regions; ++r) {
    out << r << box.min << box.max;
    if (mesh.region_names.empty())
      out << " 0 0\n";
    else
      out << " 1 " << r << " 0\n";
  }
  out << "$EndEntities\n";
}

// A block per set and per run of tetrahedra of one region, to keep their order
void write_blocks(const TetMesh& mesh, TextOut& out) {
  std::size_t blocks = mesh.tets.empty() ? 0 : 1;
  for (const auto& [name, vertices] : mesh.vertex_sets) blocks += vertices.empty() ? 0 : 1;
  for (std::size_t t = 1; t < mesh.region.size(); ++t) blocks += mesh.region[t] != mesh.region[t - 1] ? 1 : 0;
  const std::size_t count = count_elements(mesh);
  out << "$Elements\n" << blocks << " " << count << " 1 " << count << "\n";
  int set = 0;
  std::size_t tag = 0;
  for (const auto& [name, vertices] : mesh.vertex_sets) {
    ++set;
    if (!vertices.empty()) out << "0 " << set << " " << point_type << " " << vertices.size() << "\n";
    for (const int v : vertices) out << ++tag << " " << v + 1 << "\n";
  }
  for (std::size_t begin = 0, end = 0; begin < mesh.tets.size(); begin = end) {
    while (end < mesh.tets.size() && region_tag(mesh, end) == region_tag(mesh, begin)) ++end;
    out << "3 " << std::max(region_tag(mesh, begin), 1) << " " << tet_type << " " << end - begin << "\n";
    for (std::size_t t = begin; t < end; ++t) write_corners(mesh.tets[t], out << ++tag);
  }
  out << "$EndElements\n";
}

}  // namespace

WrittenMesh write_msh22(const std::filesystem::path& path, const TetMesh& mesh) {
  WrittenMesh written;
  TextOut out = heading("2.2", path, mesh, written);
  out << "$Nodes\n" << mesh.vertices.size() << "\n";
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) out << v + 1 << mesh.vertices[v] << "\n";
  out << "$EndNodes\n$Elements\n" << count_elements(mesh) << "\n";
  std::size_t tag = 0;
  int set = 0;
  for (const auto& [name, vertices] : mesh.vertex_sets) {
    ++set;
    for (const int v : vertices)
      out << ++tag << " " << point_type << " 2 " << set << " " << set << " " << v + 1 << "\n";
  }
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const int region = region_tag(mesh, t);
    out << ++tag << " " << tet_type << " 2 " << region << " " << std::max(region, 1);
    write_corners(mesh.tets[t], out);
  }
  out << "$EndElements\n";
  written.files = {{path.string(), out.take()}};
  return written;
}

WrittenMesh write_msh41(const std::filesystem::path& path, const TetMesh& mesh) {
  WrittenMesh written;
  TextOut out = heading("4.1", path, mesh, written);
  write_entities(mesh, out);
  const std::size_t count = mesh.vertices.size();
  out << "$Nodes\n1 " << count << " 1 " << count << "\n3 1 0 " << count << "\n";
  for (std::size_t v = 1; v <= count; ++v) out << v << "\n";
  for (const Point& p : mesh.vertices) out << p.x() << " " << p.y() << " " << p.z() << "\n";
  out << "$EndNodes\n";
  write_blocks(mesh, out);
  written.files = {{path.string(), out.take()}};
  return written;
}

}  // namespace plica
