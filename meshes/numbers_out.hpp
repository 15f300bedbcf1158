// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <bit>
#include <plica/meshes/written_mesh.hpp>

namespace plica {

/// Numbers one after the other, as text or in binary: a format that has both forms is written once.
class NumbersOut {
 public:
  explicit NumbersOut(bool binary, std::endian order = std::endian::native) : binary_(binary), order_(order) {}

  bool binary() const { return binary_; }
  NumbersOut& text(std::string_view text);  ///< as it is in both forms
  NumbersOut& int32(std::int64_t number);   ///< which must fit
  NumbersOut& int64(std::int64_t number);   ///< where the format has a size, too
  NumbersOut& real32(double number);        ///< rounded in binary
  NumbersOut& real32(const Point& point) { return real32(point.x()).real32(point.y()).real32(point.z()); }
  NumbersOut& real64(double number);
  NumbersOut& real64(const Point& point) { return real64(point.x()).real64(point.y()).real64(point.z()); }
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
