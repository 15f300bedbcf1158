// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/meshes/files/format_by_content.hpp>
#include <plica/meshes/files/reading.hpp>

namespace plica {

namespace {

// First bytes of a format, in lower case and after blanks
struct Start {
  std::string_view bytes;
  const char *extension, *description, *advice;
};
constexpr Start starts[] = {
    {"# vtk datafile version", "vtk", "VTK's legacy format", ""},
    {"$meshformat", "msh", "Gmsh's MSH", ""},
    {"$nod\n", "msh", "Gmsh's MSH 1", ""},
    {"meshversionformatted", "mesh", "Medit", ""},
    {"ply\n", "ply", "PLY", ""},
    {"ply\r", "ply", "PLY", ""},
    {"solid ", "stl", "STL", ""},
    {"solid\n", "stl", "STL", ""},
    {"solid\r", "stl", "STL", ""},
    {"off\n", "off", "OFF", ""},
    {"off\r", "off", "OFF", ""},
    {"*heading", "inp", "an Abaqus input file", ""},
    {"*node", "inp", "an Abaqus input file", ""},
    {"**", "inp", "an Abaqus input file", ""},
    {"\x1f\x8b", "", "compressed by gzip", "unpack it by gunzip"},
    {"pk\x03\x04", "", "a zip archive", "unpack it by unzip"},
    {"\x89hdf", "", "HDF5, as XDMF, MED or CGNS have it", "convert it to .vtu or .msh"},
    {"glb", "", "binary glTF", "convert it to .ply or .stl"},
    {"iso-10303-21", "", "STEP, a CAD model", "mesh it to .msh by Gmsh"},
};

// Roots of XML files
constexpr Start roots[] = {
    {"<vtkfile", "vtu", "VTK's XML format", ""},
    {"<febio_spec", "feb", "FEBio", ""},
    {"<xdmf", "", "XDMF", "convert it to .vtu"},
};

constexpr std::string_view blanks = " \t\r\n";

KnownContent content_of(const Start& start) {
  return {start.extension, start.description, start.advice};
}

}  // namespace

bool KnownContent::names(const std::string& file_extension) const {
  return file_extension == extension || (extension == "vtu" && file_extension == "vtp");
}

std::optional<KnownContent> known_content(std::string_view bytes) {
  constexpr std::size_t longest = 4096;
  const std::string head = lower_case(bytes.substr(0, longest));
  const std::size_t begin = head.find_first_not_of(blanks);
  if (begin == std::string::npos) return {};
  const std::string_view text = std::string_view(head).substr(begin);
  for (const Start& start : starts)
    if (text.starts_with(start.bytes)) return content_of(start);
  if (text.front() != '<' && !text.starts_with("\xef\xbb\xbf<")) return {};
  for (const Start& root : roots)
    if (text.find(root.bytes) != std::string_view::npos) return content_of(root);
  return {};
}

}  // namespace plica
