// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <plica/drivers/solver/set_up/build_patches.hpp>
#include <plica/drivers/solver/set_up/build_surface.hpp>
#include <plica/drivers/solver/set_up/to_device.hpp>
#include <plica/kernels/elastic/elastic_force.hpp>
#include <plica/kernels/elastic/elastic_tangent.hpp>
#include <plica/kernels/elastic/gather_forces.hpp>
#include <plica/kernels/transfer.hpp>
#include <plica/meshes/generators.hpp>

#include "support/backends.hpp"
#include "support/gradients.hpp"
#include "support/three_constants.hpp"
#include "support/tolerance.hpp"

// The patch kernel and the transfers against sums written out element by element in double: with few parts of the library, so
// that they can be compiled for any width of vectors.
namespace {

using namespace plica;
using namespace plica::test;

using Field = std::vector<Point>;

Field disorder(std::size_t n, double size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> within(-size, size);
  Field field;
  for (std::size_t i = 0; i < n; ++i) field.emplace_back(within(random), within(random), within(random));
  return field;
}

/// An irregular box of several patches, the last pack of which is not full.
TetMesh irregular_box() {
  TetMesh mesh = box_mesh({Point::Zero(), Point(0.1, 0.1, 0.1)}, {5, 4, 3});
  const Field shift = disorder(mesh.vertices.size(), 0.004, 3);
  for (std::size_t a = 0; a < shift.size(); ++a) mesh.vertices[a] += shift[a];
  return mesh;
}

/// f_a = -sum V P(F) grad N_a; with a direction p, its change dP/dF : grad p instead of P.
template <class Material>
Field plain_force(const TetMesh& mesh, const Field& u, const Field* p) {
  const auto constants = sample_constants<Material>();
  Field f(mesh.vertices.size(), Point::Zero());
  for (const auto& t : mesh.tets) {
    const auto edges = [&](const Field& x) {
      Eigen::Matrix3d E;
      for (int c = 0; c < 3; ++c)
        E.col(c) = x[static_cast<std::size_t>(t[static_cast<std::size_t>(c + 1)])] - x[static_cast<std::size_t>(t[0])];
      return E;
    };
    const Eigen::Matrix3d D = edges(mesh.vertices), inverse = D.inverse();
    const Eigen::Matrix3d F = Eigen::Matrix3d::Identity() + edges(u) * inverse;
    const Eigen::Matrix3d P =
        p == nullptr ? eigen(Material::stress(mat3<double>(F), constants))
                     : eigen(Material::stress_change(mat3<double>(F), mat3<double>(edges(*p) * inverse), constants));
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
  const Vectors<B> partial("test.partial", patches.vertex.extent(0)), f("test.f", mesh.vertices.size());
  Model<B> model;
  model.vertices = static_cast<int>(mesh.vertices.size());
  model.patches = patches, model.shares = patches.shares;
  model.mass = Scalars<B>("test.mass", mesh.vertices.size());
  launch_patches<B>(exec, "test", patches, integrand, partial);
  gather_forces<B>(exec, model, partial, {}, f);
  return host<B>(f);
}

template <class B>
class PatchKernelOn : public testing::Test {};
TYPED_TEST_SUITE(PatchKernelOn, EachBackend);

template <class B, class M>
void expect_the_sum() {
  SCOPED_TRACE(M::name);
  const TetMesh mesh = irregular_box();
  const Patches<B> patches = build_patches<B>(mesh, {as_list(sample_constants<M>())});
  ASSERT_GT(patches.count, 1);
  const Field u = disorder(mesh.vertices.size(), 0.001, 1), p = disorder(mesh.vertices.size(), 0.001, 2);
  const Vectors<B> u_here = device<B>(u), p_here = device<B>(p);
  const Field f = plain_force<M>(mesh, u, nullptr), df = plain_force<M>(mesh, u, &p);
  const ElasticForce<B, M, false> force{{u_here}, patches.constants, {}, 0};
  const ElasticTangent<B, M> tangent{{u_here, p_here}, patches.constants, {}};
  EXPECT_LE(largest_difference(through_patches(mesh, patches, force), f), round_off<typename B::Real>(100, largest(f)));
  EXPECT_LE(largest_difference(through_patches(mesh, patches, tangent), df),
            round_off<typename B::Real>(100, largest(df)));
}

TYPED_TEST(PatchKernelOn, IsTheSumOverTheElements) {
  Materials::for_each([](auto material) { expect_the_sum<TypeParam, decltype(material)>(); });
}

TYPED_TEST(PatchKernelOn, TakesAMaterialOfThreeConstants) { expect_the_sum<TypeParam, ThreeConstants>(); }

// Each region's patches have its constants
TYPED_TEST(PatchKernelOn, KnowsTheConstantsOfEveryRegion) {
  using B = TypeParam;
  TetMesh mesh = irregular_box();
  mesh.region_names = {"left", "right"};
  for (std::size_t e = 0; e < mesh.tets.size(); ++e) mesh.region.push_back(e % 3 == 0 ? 1 : 0);
  const Patches<B> patches = build_patches<B>(mesh, {{1, 2, 3, 4}, {5, 6, 7, 8}});
  const auto host_of = [](const auto& view) { return Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), view); };
  const auto constants = host_of(patches.constants);
  const auto element = host_of(patches.element), first = host_of(patches.first_pack);
  ASSERT_EQ(constants.extent(0), static_cast<std::size_t>(4 * patches.count));
  for (int p = 0; p < patches.count; ++p) {
    const auto c = load_constants<ThreeConstants, double>(constants, p);
    const int region = mesh.region[static_cast<std::size_t>(element(first(p) * B::lanes))];
    EXPECT_EQ(c.c1, 1 + 4 * region);
    EXPECT_EQ(c.c2, 2 + 4 * region);
    EXPECT_EQ(c.bulk, 3 + 4 * region);
    EXPECT_EQ(c.rest, 4 + 4 * region);
  }
}

TYPED_TEST(PatchKernelOn, WatchesEveryLaneForInversion) {
  using B = TypeParam;
  const TetMesh mesh = irregular_box();
  const Patches<B> patches = build_patches<B>(mesh, {as_list(soft)});
  const auto element = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), patches.element);
  for (const int turned : {0, 7, 100, static_cast<int>(mesh.tets.size()) - 1}) {
    Field u(mesh.vertices.size(), Point::Zero());
    const auto& t = mesh.tets[static_cast<std::size_t>(turned)];
    const auto x = [&](std::size_t c) { return mesh.vertices[static_cast<std::size_t>(t[c])]; };
    u[static_cast<std::size_t>(t[0])] = 2.2 * ((x(1) + x(2) + x(3)) / 3 - x(0));  // through the opposite face
    const auto flags = make_element_flags<B>(patches.count);
    through_patches(mesh, patches, ElasticForce<B, NeoHookean, true>{{device<B>(u)}, patches.constants, flags, 1});
    const auto found = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), flags.evaluation);
    const auto slot = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), flags.element);
    const auto J = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), flags.J);
    std::vector<int> inverted;
    for (int p = 0; p < patches.count; ++p)
      if (found(p) == 1) {
        EXPECT_LE(static_cast<double>(J(p)), 0);
        inverted.push_back(element(slot(p)));
      }
    EXPECT_FALSE(inverted.empty()) << turned;
    for (const int e : inverted) {  // it, or another one of the vertex that moved
      const auto& other = mesh.tets[static_cast<std::size_t>(e)];
      EXPECT_NE(std::find(other.begin(), other.end(), t[0]), other.end()) << e;
    }
  }
}

TYPED_TEST(PatchKernelOn, TransfersAreWeightedSums) {
  using B = TypeParam;
  Embedding embedding;
  embedding.vertices = {{0, 1, 2, 3}, {4, 2, 1, 0}, {3, 3, 4, 1}};
  embedding.weights = {{0.1, 0.2, 0.3, 0.4}, {1, 0, 0, 0}, {0.25, 0.25, 0.75, -0.25}};
  const auto transfer = build_transfer<B>("test", embedding, {});
  const Field u = disorder(5, 1, 1), v = disorder(5, 1, 2);
  const State<B> from(device<B>(u), device<B>(v)), to("test.to", 3);
  map_fields<B, MapState>({}, "test", transfer, from, {}, {}, to, {});
  const auto sums = [&](const Field& x) {
    Field y(3, Point::Zero());
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t c = 0; c < 4; ++c)
        y[i] += embedding.weights[i][c] * x[static_cast<std::size_t>(embedding.vertices[i][c])];
    return y;
  };
  EXPECT_LE(largest_difference(host<B>(to.u), sums(u)), round_off<typename B::Real>(8));
  EXPECT_LE(largest_difference(host<B>(to.v), sums(v)), round_off<typename B::Real>(8));
}

// The lanes of a pack are independent and compute what a plain number does.

template <class Real, int N>
void expect_lanes() {
  using T = Pack<Real, N>;
  Materials::for_each([](auto material) {
    using M = decltype(material);
    SCOPED_TRACE(M::name);
    const auto list = gradients(M::survives_inversion);
    const auto c = sample_constants_as<M, Real>();
    const auto cs = sample_constants_as<M, T>();
    Mat3<T> Fs;
    for (int l = 0; l < N; ++l) {
      const auto F = mat3<Real>(list[static_cast<std::size_t>(l) % list.size()].F);
      for (int r = 0; r < 3; ++r)
        for (int k = 0; k < 3; ++k) Fs[r][k].set(l, F[r][k]);
    }
    const Mat3<Real> D = mat3<Real>(list[1].F);
    const Mat3<T> Ds = mat3<T>(list[1].F), P = M::stress(Fs, cs), dP = M::stress_change(Fs, Ds, cs);
    const T E = M::energy(Fs, cs);
    for (int l = 0; l < N; ++l) {
      const Gradient& g = list[static_cast<std::size_t>(l) % list.size()];
      const Mat3<Real> F = mat3<Real>(g.F), p = M::stress(F, c), dp = M::stress_change(F, D, c);
      const double much = round_off<Real>(500, 1 / g.smallest);
      const double e = static_cast<double>(M::energy(F, c)), size = std::sqrt(static_cast<double>(inner(p, p)));
      const double change = std::sqrt(static_cast<double>(inner(dp, dp)));
      EXPECT_NEAR(static_cast<double>(E[l]), e, much * std::abs(e) + round_off<Real>(100, soft.lambda));
      for (int r = 0; r < 3; ++r)
        for (int k = 0; k < 3; ++k) {
          EXPECT_NEAR(static_cast<double>(P[r][k][l]), static_cast<double>(p[r][k]), much * size) << l;
          EXPECT_NEAR(static_cast<double>(dP[r][k][l]), static_cast<double>(dp[r][k]), much * change) << l;
        }
    }
  });
}

TEST(MaterialPacks, AgreeWithNumbersInDouble) { expect_lanes<double, 8>(); }
TEST(MaterialPacks, AgreeWithNumbersInFloat) { expect_lanes<float, 16>(); }

}  // namespace
