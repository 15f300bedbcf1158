// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/meshes/numbers.hpp>
#include <plica/meshes/vtk/vtk_grid.hpp>
#include <string>

namespace plica {

/// The type of numbers that a word of the line names, in any case of letters; else an InputError with the choices.
NumberType legacy_vtk_type(std::size_t word, const TextLines& lines);

/// Goes past a block of METADATA, which ends with a blank line.
void skip_vtk_metadata(TextLines& lines);

/// The arrays of points and cells in VTK's legacy format: those of cells go to the grid, the others are passed over.
class LegacyArrays {
 public:
  explicit LegacyArrays(VtkGrid& grid) : grid_(grid) {}

  NumberForm form = {false, std::endian::big, true};  ///< binary data are big-endian on every machine

  /// The following arrays are of points or cells, with so many tuples.
  void begin(std::int64_t tuples, bool of_cells) { tuples_ = tuples, of_cells_ = of_cells, begun_ = true; }
  /// FIELD: arrays, each with a heading "name components tuples type".
  void field(TextLines& lines);
  /// SCALARS and its like: false if the line is the heading of none.
  bool attribute(const std::string& keyword, TextLines& lines);

 private:
  void values(const std::string& name, std::int64_t tuples, std::int64_t components, NumberType type, TextLines& lines);

  VtkGrid& grid_;
  std::int64_t tuples_ = 0;
  bool of_cells_ = false, begun_ = false;
};

}  // namespace plica
