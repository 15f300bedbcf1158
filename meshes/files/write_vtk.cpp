// SPDX-License-Identifier: BSD-3-Clause
#include <plica/meshes/files/list.hpp>
#include <plica/meshes/files/vtu_out.hpp>
#include <plica/meshes/files/writing.hpp>
#include <set>

namespace plica {

namespace {

constexpr int vtk_tet = 10;

WrittenMesh noted(const TetMesh& mesh, const MeshGroups& groups) {
  WrittenMesh written;
  leave_out_region_names(mesh, groups, "region_", written);
  leave_out_filled(mesh, written);
  leave_out_vertex_sets(mesh, written);
  return written;
}

// Returns a name that both formats can hold, with '_' for blanks, XML's special characters
// and all beyond ASCII
std::string written_name(std::string name) {
  for (char& c : name)
    if (c <= ' ' || c > '~' || std::string_view("\"'<>&").find(c) != std::string_view::npos)
      c = '_';
  return name;
}

// Returns the names of the arrays of vectors, in the order of the mesh: no two arrays of a file
// have one name. Names that the formats can hold stay; the others give way, with a number at their
// end.
std::vector<std::string> array_names(const TetMesh& mesh, WrittenMesh& written) {
  std::map<std::string, std::string> names;
  std::set<std::string> taken;
  if (!mesh.region.empty()) taken.insert("region");
  for (const bool stays : {true, false})
    for (const auto& [name, vectors] : mesh.tet_vectors) {
      const std::string wanted = written_name(name);
      if ((wanted == name) != stays) continue;
      std::string& own = names[name] = wanted;
      for (int n = 2; !taken.insert(own).second; ++n) own = wanted + "_" + std::to_string(n);
      if (own != wanted)
        written.left_out.push_back("the vectors '" + name + "' are now '" + own +
                                   "': another array has the name '" + wanted + "'");
    }
  std::vector<std::string> all;
  for (const auto& [name, own] : names) all.push_back(own);
  return all;
}

// Writes the legacy format; each array ends its line, in binary too
WrittenMesh write_legacy(const std::filesystem::path& path, const TetMesh& mesh,
                         const MeshGroups& groups, bool binary) {
  WrittenMesh written = noted(mesh, groups);
  const std::vector<std::string> names = array_names(mesh, written);
  const std::string cells = std::to_string(mesh.tets.size()), end = binary ? "\n" : "";
  NumbersOut out(binary, std::endian::big);
  out.text("# vtk DataFile Version 3.0\nmesh\n").text(binary ? "BINARY" : "ASCII");
  out.text("\nDATASET UNSTRUCTURED_GRID\nPOINTS " + std::to_string(mesh.vertices.size()) +
           " double\n");
  for (const Point& p : mesh.vertices) out.real64(p).end();
  out.text(end + "CELLS " + cells + " " + std::to_string(5 * mesh.tets.size()) + "\n");
  for (const auto& [a, b, c, d] : mesh.tets) out.int32(4).int32(a).int32(b).int32(c).int32(d).end();
  out.text(end + "CELL_TYPES " + cells + "\n");
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) out.int32(vtk_tet).end();
  out.text(end);
  if (!mesh.region.empty() || !mesh.tet_vectors.empty()) out.text("CELL_DATA " + cells + "\n");
  if (!mesh.region.empty()) {
    out.text("SCALARS region int 1\nLOOKUP_TABLE default\n");
    for (const std::int64_t region : region_numbers(mesh, groups)) out.int32(region).end();
    out.text(end);
  }
  auto own = names.begin();
  for (const auto& [name, vectors] : mesh.tet_vectors) {
    out.text("VECTORS " + *own++ + " double\n");
    for (const Point& vector : vectors) out.real64(vector).end();
    out.text(end);
  }
  written.files = {{path.string(), out.take()}};
  return written;
}

}  // namespace

WrittenMesh write_vtk(const std::filesystem::path& path, const TetMesh& mesh,
                      const MeshGroups& groups) {
  return write_legacy(path, mesh, groups, false);
}
WrittenMesh write_vtk_binary(const std::filesystem::path& path, const TetMesh& mesh,
                             const MeshGroups& groups) {
  return write_legacy(path, mesh, groups, true);
}

WrittenMesh write_vtu(const std::filesystem::path& path, const TetMesh& mesh,
                      const MeshGroups& groups) {
  WrittenMesh written = noted(mesh, groups);
  const std::vector<std::string> names = array_names(mesh, written);
  std::vector<std::int64_t> corners, ends;
  for (const auto& tet : mesh.tets) {
    corners.insert(corners.end(), tet.begin(), tet.end());
    ends.push_back(static_cast<std::int64_t>(corners.size()));
  }
  const std::vector<std::uint8_t> types(mesh.tets.size(), vtk_tet);
  VtuOut out;
  TextOut grid;
  grid << "<Piece NumberOfPoints=\"" << mesh.vertices.size() << "\" NumberOfCells=\""
       << mesh.tets.size() << "\">\n<Points>\n"
       << out.add("Points", mesh.vertices) << "</Points>\n<Cells>\n"
       << out.add("connectivity", 1, corners) << out.add("offsets", 1, ends)
       << out.add("types", 1, types) << "</Cells>\n";
  const bool has_data = !mesh.region.empty() || !mesh.tet_vectors.empty();
  if (has_data) grid << "<CellData>\n";
  if (!mesh.region.empty()) grid << out.add("region", 1, region_numbers(mesh, groups));
  auto own = names.begin();
  for (const auto& [name, vectors] : mesh.tet_vectors) grid << out.add(*own++, vectors);
  if (has_data) grid << "</CellData>\n";
  grid << "</Piece>\n";
  written.files = {{path.string(), out.file(grid.take())}};
  return written;
}

}  // namespace plica
