// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <functional>
#include <plica/core/to_device.hpp>
#include <plica/drivers/elastic/build_patches.hpp>
#include <plica/kernels/elastic/gather_forces.hpp>
#include <plica/meshes/generators.hpp>
#include <random>

#include "support/gradients.hpp"
#include "support/tolerance.hpp"

// Sums over elements written out one by one in double, and the same through the patch kernel: with
// few parts of the library, so that they can be compiled for any width of vectors.
namespace plica::test {

using Field = std::vector<Point>;

inline Field disorder(std::size_t n, double size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> within(-size, size);
  Field field;
  for (std::size_t i = 0; i < n; ++i)
    field.emplace_back(within(random), within(random), within(random));
  return field;
}

/// An irregular box of several patches, the last pack of which is not full.
inline TetMesh irregular_box() {
  TetMesh mesh = box_mesh({Point::Zero(), Point(0.1, 0.1, 0.1)}, {5, 3, 3});
  const Field shift = disorder(mesh.vertices.size(), 0.004, 3);
  for (std::size_t a = 0; a < shift.size(); ++a) mesh.vertices[a] += shift[a];
  return mesh;
}

/// P(F), or with dF its change dP/dF : dF.
using Stress = std::function<Eigen::Matrix3d(const Eigen::Matrix3d& F, const Eigen::Matrix3d* dF)>;

template <class Material>
Eigen::Matrix3d stress_of(const Eigen::Matrix3d& F, const Eigen::Matrix3d* dF) {
  const auto constants = sample_constants<Material>();
  return dF == nullptr
             ? eigen(Material::stress(mat3<double>(F), constants))
             : eigen(Material::stress_change(mat3<double>(F), mat3<double>(*dF), constants));
}

/// f_a = -sum V P(F) grad N_a; with a direction p, its change dP/dF : grad p instead of P.
inline Field plain_force(const Stress& stress, const TetMesh& mesh, const Field& u,
                         const Field* p) {
  Field f(mesh.vertices.size(), Point::Zero());
  for (const auto& t : mesh.tets) {
    const auto edges = [&](const Field& x) {
      Eigen::Matrix3d E;
      for (int c = 0; c < 3; ++c)
        E.col(c) = x[static_cast<std::size_t>(t[static_cast<std::size_t>(c + 1)])] -
                   x[static_cast<std::size_t>(t[0])];
      return E;
    };
    const Eigen::Matrix3d D = edges(mesh.vertices), inverse = D.inverse();
    const Eigen::Matrix3d F = Eigen::Matrix3d::Identity() + edges(u) * inverse;
    const Eigen::Matrix3d dF =
        p == nullptr ? Eigen::Matrix3d::Zero() : Eigen::Matrix3d(edges(*p) * inverse);
    const Eigen::Matrix3d P = stress(F, p == nullptr ? nullptr : &dF);
    const Eigen::Matrix3d H = -D.determinant() / 6 * P * inverse.transpose();
    for (int c = 0; c < 3; ++c) {
      f[static_cast<std::size_t>(t[static_cast<std::size_t>(c + 1)])] += H.col(c);
      f[static_cast<std::size_t>(t[0])] -= H.col(c);
    }
  }
  return f;
}

template <class B>
Field host(const Vectors<B>& values) {
  const auto copy = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), values);
  Field field;
  for (std::size_t a = 0; a < copy.extent(0); ++a)
    field.emplace_back(static_cast<double>(copy(a, 0)), static_cast<double>(copy(a, 1)),
                       static_cast<double>(copy(a, 2)));
  return field;
}

template <class B>
Vectors<B> device(const Field& field) {
  return to_device<Vectors<B>>("test", rows<typename B::Real>(field));
}

template <class B, class Integrand>
Field through_patches(const TetMesh& mesh, const Patches<B>& patches, const Integrand& integrand) {
  const typename B::Exec exec;
  const Vectors<B> partial("test.partial", patches.vertex.extent(0)),
      f("test.f", mesh.vertices.size());
  Model<B> model;
  model.vertices = static_cast<int>(mesh.vertices.size());
  model.patches = patches, model.shares = patches.shares;
  model.mass = Scalars<B>("test.mass", mesh.vertices.size());
  launch_patches<B>(exec, "test", patches, integrand, partial);
  gather_forces<B>(exec, model, partial, {}, f);
  return host<B>(f);
}

/// A mesh with fields on it, for every material.
template <class B>
struct Disordered {
  TetMesh mesh = irregular_box();
  Field u = disorder(mesh.vertices.size(), 0.001, 1), p = disorder(mesh.vertices.size(), 0.001, 2);
  Vectors<B> u_here = device<B>(u), p_here = device<B>(p);
};

/// What integrand(patches) adds up to, against plain_force() of this material.
template <class B, class Material, class Integrand>
void expect_the_sum(const Disordered<B>& on, const Field* p, const Integrand& integrand) {
  SCOPED_TRACE(Material::name);
  const Patches<B> patches = build_patches<B>(on.mesh, {as_list(sample_constants<Material>())});
  ASSERT_GT(patches.count, 1);
  const Field want = plain_force(stress_of<Material>, on.mesh, on.u, p);
  EXPECT_LE(largest_difference(through_patches(on.mesh, patches, integrand(patches)), want),
            round_off<typename B::Real>(100, largest(want)));
}

}  // namespace plica::test
