// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <bit>
#include <cstdint>
#include <plica/core/mesh.hpp>
#include <plica/meshes/files/file_bytes.hpp>
#include <plica/meshes/files/parsed_mesh.hpp>
#include <string>
#include <vector>

namespace plica {

/// Result of a mesh writer.
struct WrittenMesh {
  std::vector<FileBytes> files;       ///< names and bytes of the files
  std::vector<std::string> left_out;  ///< sentences, one for each thing that the format cannot hold
};

/// Text that is being written. Numbers have the fewest digits that keep every bit.
class TextOut {
 public:
  /// Appends a text unchanged.
  TextOut& operator<<(std::string_view text) { return text_ += text, *this; }
  TextOut& operator<<(double number);        ///< appends a number in the fewest digits
  TextOut& operator<<(std::int64_t number);  ///< appends an integer in decimal
  /// Appends an integer in decimal.
  TextOut& operator<<(int number) { return *this << std::int64_t{number}; }
  /// Appends an integer in decimal.
  TextOut& operator<<(std::size_t number) { return *this << static_cast<std::int64_t>(number); }
  /// Appends three numbers with a blank before each.
  TextOut& operator<<(const Point& point) {
    return *this << " " << point.x() << " " << point.y() << " " << point.z();
  }
  /// Returns the text and leaves this empty.
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

/// Returns positive numbers for names. They are the numbers at the ends of the names ("region_5")
/// if all have one and none twice; else they count from 1. A file that is read and written again so
/// keeps its numbers.
std::vector<std::int64_t> numbers_of(const std::vector<std::string>& names);

/// Returns the numbers of the regions. They are those of the file if it has them; else those at the
/// ends of the names, or from 1.
std::vector<std::int64_t> region_tags(const TetMesh& mesh, const MeshGroups& groups);

/// Returns per tetrahedron the number of its region; empty without regions.
std::vector<std::int64_t> region_numbers(const TetMesh& mesh, const MeshGroups& groups);

/// Returns the groups to write: those of the file, and each other set as a group of its triangles
/// and one of its other vertices.
/// Tags are positive; 0 and other unusable tags get free numbers of their dimension.
std::vector<ElementGroup> groups_of(const TetMesh& mesh, const MeshGroups& groups);

/// Reports the names of regions that are lost in a format without names. A reader of the format
/// names a region "PREFIXnumber".
void leave_out_region_names(const TetMesh& mesh, const MeshGroups& groups,
                            const std::string& prefix, WrittenMesh& written);
/// Reports that the parts of the tetrahedra that are body are left out.
void leave_out_filled(const TetMesh& mesh, WrittenMesh& written);
/// Reports that all vertex sets are left out.
void leave_out_vertex_sets(const TetMesh& mesh, WrittenMesh& written);

/// Writer of numbers one after the other, as text or in binary. A format that has both forms needs
/// one writer only.
class NumbersOut {
 public:
  explicit NumbersOut(bool binary, std::endian order = std::endian::native)
      : binary_(binary), order_(order) {}

  bool binary() const { return binary_; }   ///< whether numbers are written in binary
  NumbersOut& text(std::string_view text);  ///< writes a text unchanged in both forms
  NumbersOut& int32(std::int64_t number);   ///< writes an integer, which must fit 32 bits
  NumbersOut& int64(std::int64_t number);   ///< writes an integer, also where a format has a size
  NumbersOut& real32(double number);        ///< writes a number, rounded to a float in binary
  /// Writes three numbers, rounded to floats in binary.
  NumbersOut& real32(const Point& point) {
    return real32(point.x()).real32(point.y()).real32(point.z());
  }
  NumbersOut& real64(double number);  ///< writes a number
  /// Writes three numbers.
  NumbersOut& real64(const Point& point) {
    return real64(point.x()).real64(point.y()).real64(point.z());
  }
  NumbersOut& end();  ///< ends a record, and its line in text
  /// Returns the bytes and leaves this empty.
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
