// SPDX-License-Identifier: BSD-3-Clause
#include <bit>
#include <plica/meshes/files/list.hpp>
#include <plica/meshes/files/writing.hpp>

namespace plica {

namespace {

constexpr int vtk_tet = 10;

WrittenMesh noted(const TetMesh& mesh, const MeshGroups& groups) {
  WrittenMesh written;
  leave_out_region_names(mesh, groups, "region_", written);
  leave_out_vertex_sets(mesh, written);
  return written;
}

// Returns a name that both formats can hold, with '_' for blanks and XML's special characters
std::string written_name(std::string name) {
  for (char& c : name)
    if (c <= ' ' || std::string_view("\"'<>&\x7f").find(c) != std::string_view::npos) c = '_';
  return name;
}

// Appended data of the XML format: each array after its length in bytes
class Appended {
 public:
  template <typename Number>
  std::string array(const char* type, const char* name, int components,
                    const std::vector<Number>& values) {
    TextOut tag;
    tag << "<DataArray type=\"" << type << "\" Name=\"" << name << "\" NumberOfComponents=\""
        << components << "\" format=\"appended\" offset=\"" << bytes_.size() << "\"/>\n";
    const std::uint64_t size = values.size() * sizeof(Number);
    bytes_.append(reinterpret_cast<const char*>(&size), sizeof(size));
    bytes_.append(reinterpret_cast<const char*>(values.data()), size);
    return tag.take();
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

// Writes the legacy format; each array ends its line, in binary too
WrittenMesh write_legacy(const std::filesystem::path& path, const TetMesh& mesh,
                         const MeshGroups& groups, bool binary) {
  WrittenMesh written = noted(mesh, groups);
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
  for (const auto& [name, vectors] : mesh.tet_vectors) {
    out.text("VECTORS " + written_name(name) + " double\n");
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
  std::vector<double> points;
  for (const Point& p : mesh.vertices) points.insert(points.end(), {p.x(), p.y(), p.z()});
  std::vector<std::int64_t> corners, ends;
  for (const auto& tet : mesh.tets) {
    corners.insert(corners.end(), tet.begin(), tet.end());
    ends.push_back(static_cast<std::int64_t>(corners.size()));
  }
  const std::vector<std::uint8_t> types(mesh.tets.size(), vtk_tet);
  Appended appended;
  TextOut out;
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\""
      << (std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian")
      << "\" header_type=\"UInt64\">\n<UnstructuredGrid>\n<Piece NumberOfPoints=\""
      << mesh.vertices.size() << "\" NumberOfCells=\"" << mesh.tets.size() << "\">\n<Points>\n"
      << appended.array("Float64", "Points", 3, points) << "</Points>\n<Cells>\n"
      << appended.array("Int64", "connectivity", 1, corners)
      << appended.array("Int64", "offsets", 1, ends) << appended.array("UInt8", "types", 1, types)
      << "</Cells>\n";
  const bool has_data = !mesh.region.empty() || !mesh.tet_vectors.empty();
  if (has_data) out << "<CellData>\n";
  if (!mesh.region.empty())
    out << appended.array("Int64", "region", 1, region_numbers(mesh, groups));
  for (const auto& [name, vectors] : mesh.tet_vectors) {
    std::vector<double> numbers;
    for (const Point& p : vectors) numbers.insert(numbers.end(), {p.x(), p.y(), p.z()});
    out << appended.array("Float64", written_name(name).c_str(), 3, numbers);
  }
  if (has_data) out << "</CellData>\n";
  out << "</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_" << appended.bytes()
      << "\n</AppendedData>\n</VTKFile>\n";
  written.files = {{path.string(), out.take()}};
  return written;
}

}  // namespace plica
