// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cmath>
#include <concepts>
#include <plica/kernels/materials/material.hpp>
#include <plica/kernels/patch_kernel.hpp>

namespace plica::bench {

/// A number that counts the operations done on it. Pointwise physics is templated on its number
/// type: run once on this, it says what it costs. Each of + - * / sqrt, exp and log counts as one,
/// comparisons as none.
struct Counted {
  double value = 0;
  static inline long operations = 0;

  Counted() = default;
  template <class T>
  requires std::is_arithmetic_v<T> Counted(T v) : value(static_cast<double>(v)) {}
  operator double() const { return value; }
  static Counted done(double v) {
    ++operations;
    return Counted(v);
  }
};

template <class A, class C>
concept CountedWith =
    (std::same_as<A, Counted> ||
     std::same_as<C, Counted>)&&std::convertible_to<A, double>&& std::convertible_to<C, double>;

template <class A, class C>
requires CountedWith<A, C> Counted operator+(A a, C b) {
  return Counted::done(double(a) + double(b));
}
template <class A, class C>
requires CountedWith<A, C> Counted operator-(A a, C b) {
  return Counted::done(double(a) - double(b));
}
template <class A, class C>
requires CountedWith<A, C> Counted operator*(A a, C b) {
  return Counted::done(double(a) * double(b));
}
template <class A, class C>
requires CountedWith<A, C> Counted operator/(A a, C b) {
  return Counted::done(double(a) / double(b));
}
inline Counted operator-(Counted a) { return Counted::done(-a.value); }
inline Counted& operator+=(Counted& a, Counted b) { return a = a + b; }
inline Counted& operator-=(Counted& a, Counted b) { return a = a - b; }
inline Counted& operator*=(Counted& a, Counted b) { return a = a * b; }
template <class A, class C>
requires CountedWith<A, C>
bool operator<(A a, C b) { return double(a) < double(b); }
template <class A, class C>
requires CountedWith<A, C>
bool operator<=(A a, C b) { return double(a) <= double(b); }
template <class A, class C>
requires CountedWith<A, C>
bool operator>(A a, C b) { return double(a) > double(b); }

// found by their argument where physics calls them
inline Counted sqrt(Counted a) { return Counted::done(std::sqrt(a.value)); }
inline Counted exp(Counted a) { return Counted::done(std::exp(a.value)); }
inline Counted where_positive(Counted a, Counted b) { return a.value > 0 ? b : Counted(0); }
inline Counted log(Counted a) { return Counted::done(std::log(a.value)); }
inline Counted max(Counted a, Counted b) { return a.value < b.value ? b : a; }
inline void set_lane(Counted& a, int, double value) { a = Counted(value); }

/// Operations of one tetrahedron's corner forces (fields = 1) or of their change in a direction
/// (2): gradients of the fields, stress, corner vectors, and the sums at the vertices.
template <class Material>
double flops_per_tet(int fields) {
  ElementShape<Counted> shape;
  for (int c = 0; c < 3; ++c)
    for (int k = 0; k < 3; ++k) shape.gradient[c][k] = c == k ? 10.0 : 1.0 + c;
  shape.volume = 1e-3;
  const auto c = load_constants<Material, Counted>([](int) { return 1.0; }, 0);
  Mat3<Counted> F = Mat3<Counted>::identity(), dF;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) F[i][k] = F[i][k] + 0.05 * (i - 0.4 * k), dF[i][k] = 0.01 * (k - i);
  Vec3<Counted> corner[4];
  Counted::operations = 0;
  stress_to_corners(fields == 1 ? Material::stress(F, c) : Material::stress_change(F, dF, c), shape,
                    corner);
  constexpr double differences = 9, products = 45, identity = 3, sums = 12;
  return static_cast<double>(Counted::operations) + fields * (differences + products) + identity +
         sums;
}

}  // namespace plica::bench

template <>
struct plica::LaneOf<plica::bench::Counted> {
  using type = double;
  static constexpr int count = 1;
};
