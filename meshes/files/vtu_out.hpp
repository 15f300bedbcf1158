// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <plica/core/mesh.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace plica {

/// VTK XML file of an unstructured grid (.vtu) that is being written. Its arrays stand at the end
/// in base64, so the file is strict XML. Source:
/// https://docs.vtk.org/en/latest/vtk_file_formats/vtkxml_file_format.html
class VtuOut {
 public:
  /// Adds an array and returns its tag <DataArray>, a line. Arrays stand in the order of the calls.
  /// @param name    name of the array, without characters that XML would need escaped
  /// @param values  [tuples][components] values
  template <class T>
  std::string add(std::string_view name, int components, const std::vector<T>& values) {
    return add(vtk_type(T()), name, components, values.data(), values.size() * sizeof(T));
  }
  /// Adds an array of points or vectors and returns its tag.
  std::string add(std::string_view name, const std::vector<Point>& values) {
    static_assert(sizeof(Point) == 3 * sizeof(double));
    return add("Float64", name, 3, values.data(), values.size() * sizeof(Point));
  }
  /// Returns the file and leaves this empty.
  /// @param grid  text between <UnstructuredGrid> and its end, with the tags of all arrays
  std::string file(std::string_view grid);

 private:
  static const char* vtk_type(double) { return "Float64"; }
  static const char* vtk_type(std::int32_t) { return "Int32"; }
  static const char* vtk_type(std::int64_t) { return "Int64"; }
  static const char* vtk_type(std::uint8_t) { return "UInt8"; }
  std::string add(const char* type, std::string_view name, int components, const void* data,
                  std::size_t size);

  std::string arrays_;  // in base64, one after the other
};

}  // namespace plica
