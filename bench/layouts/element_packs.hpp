// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/LU>
#include <array>
#include <cstdint>
#include <plica/core/mesh.hpp>
#include <plica/core/to_device.hpp>
#include <plica/kernels/materials/material.hpp>
#include <plica/kernels/patch_kernel.hpp>
#include <vector>

namespace plica::bench {

/// Tetrahedra in packs of a vector's lanes, in any order: corners as mesh vertices, shape as in
/// core/patches.hpp. Padding has volume 0 and sits on vertex 0.
template <class B>
struct ElementPacks {
  using Real = typename B::Real;
  static constexpr int lanes = B::lanes;
  using T = typename PackOf<Real, lanes>::type;
  template <class A>
  using Array = Kokkos::View<A, Kokkos::LayoutRight, typename B::Memory>;

  int packs = 0;
  Array<int* [4][lanes]> corner;
  Array<Real* [10][lanes]> shape;
  Scalars<B> constants;

  ElementPacks() = default;
  /// `order` lists the tetrahedra, -1: padding.
  ElementPacks(const TetMesh& mesh, const std::vector<double>& of_material,
               const std::vector<int>& order)
      : packs(static_cast<int>((order.size() + lanes - 1) / lanes)),
        constants(to_device<Scalars<B>>(
            "bench.constants", std::vector<Real>(of_material.begin(), of_material.end()))) {
    const std::size_t n = static_cast<std::size_t>(packs);
    std::vector<std::array<std::array<int, lanes>, 4>> corners(n);
    std::vector<std::array<std::array<Real, lanes>, 10>> shapes(n);
    for (std::size_t i = 0; i < order.size(); ++i) {
      if (order[i] < 0) continue;
      const auto& t = mesh.tets[static_cast<std::size_t>(order[i])];
      const auto x = [&](std::size_t c) -> const Point& {
        return mesh.vertices[static_cast<std::size_t>(t[c])];
      };
      Eigen::Matrix3d edges;
      for (std::size_t c = 0; c < 3; ++c) edges.col(static_cast<int>(c)) = x(c + 1) - x(0);
      const Eigen::Matrix3d inverse = edges.inverse();
      const std::size_t q = i / lanes, l = i % lanes;
      for (std::size_t c = 0; c < 4; ++c) corners[q][c][l] = t[c];
      for (int k = 0; k < 9; ++k)
        shapes[q][static_cast<std::size_t>(k)][l] = static_cast<Real>(inverse(k / 3, k % 3));
      shapes[q][9][l] = static_cast<Real>(edges.determinant() / 6);
    }
    corner = to_device<decltype(corner)>("bench.corner", corners);
    shape = to_device<decltype(shape)>("bench.shape", shapes);
  }

  KOKKOS_INLINE_FUNCTION ElementShape<T> load_shape(int q) const {
    ElementShape<T> s;
    for (int l = 0; l < lanes; ++l) {
      for (int c = 0; c < 3; ++c)
        for (int k = 0; k < 3; ++k) set_lane(s.gradient[c][k], l, shape(q, 3 * c + k, l));
      set_lane(s.volume, l, shape(q, 9, l));
    }
    return s;
  }

  /// The corner forces of pack q at displacements u [N].
  template <class Material>
  KOKKOS_INLINE_FUNCTION void forces(int q, const Vectors<B>& u, Vec3<T> (&f)[4]) const {
    Vec3<T> x[4];
    for (int l = 0; l < lanes; ++l)
      for (int c = 0; c < 4; ++c)
        for (int k = 0; k < 3; ++k) set_lane(x[c][k], l, u(corner(q, c, l), k));
    const ElementShape<T> s = load_shape(q);
    stress_to_corners(
        Material::stress(deformation(x, s), load_constants<Material, T>(constants, 0)), s, f);
  }

  static KOKKOS_INLINE_FUNCTION Mat3<T> deformation(const Vec3<T> (&u)[4],
                                                    const ElementShape<T>& s) {
    const Vec3<T> d[3] = {u[1] - u[0], u[2] - u[0], u[3] - u[0]};
    Mat3<T> F = Mat3<T>::identity();
    for (int r = 0; r < 3; ++r)
      F[r] += d[0][r] * s.gradient[0] + d[1][r] * s.gradient[1] + d[2][r] * s.gradient[2];
    return F;
  }
};

/// The elements at every vertex: entries [first(a), first(a+1)) of a list of 4 * element + corner,
/// ascending.
struct VertexElements {
  std::vector<int> first{0};
  std::vector<int> entry;

  explicit VertexElements(const TetMesh& mesh) {
    std::vector<std::vector<int>> of(mesh.vertices.size());
    for (std::size_t e = 0; e < mesh.tets.size(); ++e)
      for (std::size_t c = 0; c < 4; ++c)
        of[static_cast<std::size_t>(mesh.tets[e][c])].push_back(static_cast<int>(4 * e + c));
    for (const auto& list : of) {
      entry.insert(entry.end(), list.begin(), list.end());
      first.push_back(static_cast<int>(entry.size()));
    }
  }
};

inline std::vector<int> mesh_order(const TetMesh& mesh) {
  std::vector<int> order(mesh.tets.size());
  for (std::size_t e = 0; e < order.size(); ++e) order[e] = static_cast<int>(e);
  return order;
}

/// Runs a functor's operator()(int) for 0 ... n-1.
template <class B, class Functor>
void launch(const typename B::Exec& exec, const char* label, int n, const Functor& functor) {
  Kokkos::parallel_for(label, Kokkos::RangePolicy<typename B::Exec>(exec, 0, n), functor);
}

}  // namespace plica::bench
