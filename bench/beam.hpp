// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <cmath>
#include <plica/core/backend.hpp>
#include <plica/core/problem.hpp>
#include <plica/drivers/study/sample_bodies.hpp>
#include <plica/meshes/generators.hpp>
#include <string>
#include <vector>

// The body of nearly all benchmarks: a soft beam, clamped at its foot, of the size and stiffness
// that other simulators have been measured with.
namespace plica::bench {

using Cells = std::array<int, 3>;
inline constexpr Cells small_beam{9, 9, 22};     ///< 10 692 tetrahedra
inline constexpr Cells medium_beam{19, 19, 47};  ///< 101 802
inline constexpr Cells large_beam{41, 41, 101};  ///< 1 018 686

inline int beam_tets(const Cells& cells) { return 6 * cells[0] * cells[1] * cells[2]; }

inline TetMesh beam_mesh(const Cells& cells) {
  return box_mesh({Point::Zero(), Point(0.1, 0.1, 0.25)}, cells);
}

inline Problem beam_problem(const std::vector<Cells>& levels, const std::string& material,
                            const std::string& element = "linear") {
  Problem p;
  p.body.element = {element};
  for (const Cells& cells : levels) p.body.levels.push_back(beam_mesh(cells));
  p.body.material = complete({material, 1e5, 0.45, 1000});
  p.body.fixed.push_back(Box{Point::Zero(), Point(0.1, 0.1, 0)});
  p.gravity = Point(0, 0, -9.81);
  return p;
}

/// A bent and twisted state [m] with a disorder of a hundredth of an edge, in which no force
/// vanishes by symmetry.
inline std::vector<Point> bent(const TetMesh& mesh, double edge) {
  std::vector<Point> u;
  u.reserve(mesh.vertices.size());
  unsigned seed = 1;
  const auto disorder = [&] {
    return 0.01 * edge * ((seed = seed * 1664525U + 1013904223U) / 2147483648.0 - 1);
  };
  for (const Point& x : mesh.vertices)
    u.emplace_back(0.05 * std::sin(8 * x[2]) + disorder(), 0.3 * x[0] * x[2] + disorder(),
                   0.2 * x[1] * x[2] + disorder());
  return u;
}

template <class B>
Vectors<B> to_field(const std::vector<Point>& values) {
  const Vectors<B> field("bench::field", values.size());
  const auto host = Kokkos::create_mirror_view(field);
  for (std::size_t a = 0; a < values.size(); ++a)
    for (std::size_t k = 0; k < 3; ++k)
      host(a, k) = static_cast<typename B::Real>(values[a][static_cast<int>(k)]);
  Kokkos::deep_copy(field, host);
  return field;
}

template <class Real>
constexpr const char* precision_name() {
  return sizeof(Real) == sizeof(double) ? "double" : "float";
}

}  // namespace plica::bench
