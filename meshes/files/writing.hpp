// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <bit>
#include <cstdint>
#include <plica/core/mesh.hpp>
#include <plica/meshes/files/memory_file.hpp>
#include <plica/meshes/files/raw_mesh.hpp>
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
  TextOut& operator<<(const Point& point) {
    return *this << " " << point.x() << " " << point.y() << " " << point.z();
  }
  /// The text, once.
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

/// Positive numbers for names: those at their ends where all have one and none twice ("region_5"),
/// so that a file written from what was read has the same; else from 1.
std::vector<std::int64_t> numbers_of(const std::vector<std::string>& names);

/// The numbers of the regions: their file's, where it has them, else those at the ends of their
/// names or from 1.
std::vector<std::int64_t> region_tags(const TetMesh& mesh, const MeshGroups& groups);

/// Per tetrahedron the number of its region; empty without regions.
std::vector<std::int64_t> region_numbers(const TetMesh& mesh, const MeshGroups& groups);

/// The groups to write: those of the file, and each other vertex set as a group of points. Tags are
/// unique within a dimension.
std::vector<ElementGroup> groups_of(const TetMesh& mesh, const MeshGroups& groups);

/// Notes which names of regions a format cannot hold that will read their numbers as
/// "PREFIXnumber".
void leave_out_region_names(const TetMesh& mesh, const MeshGroups& groups,
                            const std::string& prefix, WrittenMesh& written);
/// Notes all vertex sets.
void leave_out_vertex_sets(const TetMesh& mesh, WrittenMesh& written);

/// Numbers one after the other, as text or in binary: a format that has both forms is written once.
class NumbersOut {
 public:
  explicit NumbersOut(bool binary, std::endian order = std::endian::native)
      : binary_(binary), order_(order) {}

  bool binary() const { return binary_; }
  NumbersOut& text(std::string_view text);  ///< as it is in both forms
  NumbersOut& int32(std::int64_t number);   ///< which must fit
  NumbersOut& int64(std::int64_t number);   ///< where the format has a size, too
  NumbersOut& real32(double number);        ///< rounded in binary
  NumbersOut& real32(const Point& point) {
    return real32(point.x()).real32(point.y()).real32(point.z());
  }
  NumbersOut& real64(double number);
  NumbersOut& real64(const Point& point) {
    return real64(point.x()).real64(point.y()).real64(point.z());
  }
  NumbersOut& end();  ///< of a record: of its line, in text
  std::string take() { return std::move(bytes_); }

 private:
  template <typename Number>
  NumbersOut& add(Number number);

  std::string bytes_;
  bool binary_;
  bool line_begun_ = false;
  std::endian order_;
};

}  // namespace plica
