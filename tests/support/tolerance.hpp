// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <limits>
#include <plica/core/mesh.hpp>
#include <vector>

// How close two results must be. Every test states its tolerance as a number of roundings of the
// precision under test.
namespace plica::test {

/// So many roundings of a number of this size.
template <class Real>
constexpr double round_off(double roundings, double size = 1) {
  return roundings * static_cast<double>(std::numeric_limits<Real>::epsilon()) * size;
}

/// The largest length among the points; NaN where one is.
inline double largest(const std::vector<Point>& field) {
  double most = 0;
  for (const Point& p : field) most = p.norm() <= most ? most : p.norm();
  return most;
}

/// The largest distance between points of the same index; infinite where the fields differ in
/// length.
inline double largest_difference(const std::vector<Point>& a, const std::vector<Point>& b) {
  if (a.size() != b.size()) return std::numeric_limits<double>::infinity();
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double d = (a[i] - b[i]).norm();
    most = d <= most ? most : d;
  }
  return most;
}

inline bool same_bits(const std::vector<Point>& a, const std::vector<Point>& b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin());
}

inline std::vector<Point> along(const std::vector<Point>& u, double t,
                                const std::vector<Point>& p) {
  std::vector<Point> moved = u;
  for (std::size_t a = 0; a < u.size(); ++a) moved[a] += t * p[a];
  return moved;
}

inline std::vector<Point> minus(std::vector<Point> a, const std::vector<Point>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] -= b[i];
  return a;
}

inline double dot(const std::vector<Point>& a, const std::vector<Point>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
  return sum;
}

}  // namespace plica::test
