// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <plica/core/mesh.hpp>
#include <string>
#include <vector>

namespace plica::app {

/// A point in time of a film, as its collection (.pvd) lists it.
struct FilmEntry {
  double time = 0;  ///< [s]
  std::filesystem::path file;
};

/// The entries of a collection. InputError with file and line where it is none.
std::vector<FilmEntry> read_collection(const std::filesystem::path& pvd);

/// An array of a frame.
struct FrameArray {
  std::string name;
  bool of_cells = false;  ///< else of the points
  int components = 1;
  std::vector<double> values;  ///< one point or cell after the other
};

/// A frame of a film: what a run wrote into a .vtu file.
struct FrameFile {
  std::vector<Point> points;                  ///< [m]
  std::vector<std::array<int, 3>> triangles;  ///< of a surface
  std::vector<std::array<int, 4>> tets;       ///< of a volume
  std::vector<FrameArray> arrays;

  /// The array of that name; null: there is none.
  const FrameArray* find(const std::string& name) const;
};

/// Reads a frame. InputError with file and place where something is not sound: malformed, cut
/// short, not finite.
FrameFile read_frame(const std::filesystem::path& vtu);

/// A table of numbers (.csv with a head) as {column: [values]}, at most `rows` of them, evenly, the
/// last among them. InputError with file and line where it is none.
nlohmann::ordered_json read_columns(const std::filesystem::path& csv, std::size_t rows);

/// A JSON file with these members. InputError where it is none.
nlohmann::ordered_json read_json(const std::filesystem::path& file,
                                 const std::vector<std::string>& keys);

}  // namespace plica::app
