// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <plica/core/mesh.hpp>
#include <plica/meshes/memory_file.hpp>
#include <string>
#include <vector>

namespace plica {

/// What a writer makes of a mesh.
struct WrittenMesh {
  std::vector<MemoryFile> files;      ///< names and bytes
  std::vector<std::string> left_out;  ///< what the format cannot hold, a sentence each
};

/// Text in the making. Numbers are as short as they can be while they keep every bit.
class TextOut {
 public:
  /// As it is.
  TextOut& operator<<(std::string_view text) { return text_ += text, *this; }
  TextOut& operator<<(double number);        ///< in the fewest digits
  TextOut& operator<<(std::int64_t number);  ///< in decimal
  /// In decimal.
  TextOut& operator<<(int number) { return *this << std::int64_t{number}; }
  /// In decimal.
  TextOut& operator<<(std::size_t number) { return *this << static_cast<std::int64_t>(number); }
  /// Three numbers with a blank before each
  TextOut& operator<<(const Point& point) { return *this << " " << point.x() << " " << point.y() << " " << point.z(); }
  /// The text, once.
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

/// Positive numbers for names: those at their ends where all have one and none twice ("region_5"), so that a file written
/// from what was read has the same; else from 1.
std::vector<std::int64_t> numbers_of(const std::vector<std::string>& names);

/// Per tetrahedron the number of its region; empty without regions.
std::vector<std::int64_t> region_numbers(const TetMesh& mesh);

/// Notes which names of regions a format cannot hold that will read their numbers as "PREFIXnumber".
void leave_out_region_names(const TetMesh& mesh, const std::string& prefix, WrittenMesh& written);
/// Notes all vertex sets.
void leave_out_vertex_sets(const TetMesh& mesh, WrittenMesh& written);

}  // namespace plica
