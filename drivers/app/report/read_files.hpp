// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <plica/core/mesh.hpp>
#include <string>
#include <vector>

namespace plica::app {

/// Frame of an animation, as its collection (.pvd) lists it.
struct FilmEntry {
  double time = 0;  ///< simulated time [s]
  std::filesystem::path file;
};

/// Returns the entries of a collection. Throws InputError with file and line if it is none.
std::vector<FilmEntry> read_collection(const std::filesystem::path& pvd);

/// Array of values in a frame.
struct FrameArray {
  std::string name;
  bool of_cells = false;  ///< true: values of the cells; false: of the points
  int components = 1;
  std::vector<double> values;  ///< [points or cells][components]
};

/// Frame of an animation, from a .vtu file that a run has written.
struct FrameFile {
  std::vector<Point> points;                  ///< positions [m]
  std::vector<std::array<int, 3>> triangles;  ///< cells of a surface; empty: a volume
  std::vector<std::array<int, 4>> tets;       ///< cells of a volume; empty: a surface
  std::vector<FrameArray> arrays;

  /// Returns the array of that name; null: there is none.
  const FrameArray* find(const std::string& name) const;
};

/// Reads a frame. Throws InputError with file and location if the file is malformed, cut short, or
/// has a number that is not finite.
FrameFile read_frame(const std::filesystem::path& vtu);

/// Returns a table of numbers (.csv with a head) as {column: [values]}. Of a table with more than
/// `rows` rows it takes that many, evenly, the first and the last among them. Throws InputError
/// with file and line if the file is no such table.
nlohmann::ordered_json read_columns(const std::filesystem::path& csv, std::size_t rows);

/// Reads a JSON file. Throws InputError if it is damaged or lacks one of the members `keys`.
nlohmann::ordered_json read_json(const std::filesystem::path& file,
                                 const std::vector<std::string>& keys);

}  // namespace plica::app
