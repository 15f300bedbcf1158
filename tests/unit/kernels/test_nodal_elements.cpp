// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <numbers>
#include <plica/drivers/elastic/build_nodal_rows.hpp>
#include <plica/drivers/elastic/materials.hpp>
#include <plica/drivers/study/level_probe.hpp>
#include <plica/kernels/elastic/gather_forces.hpp>
#include <plica/kernels/elastic/nodal_elements.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/gradients.hpp"
#include "support/tolerance.hpp"

// Nodal elements: an independent sum over tetrahedra, derivatives, what must vanish, regions,
// smoothed pressures.
namespace {

using namespace plica;
using namespace plica::test;

Problem nodal(Problem p, const std::string& pressure = "auto") {
  p.body.element = {"nodal"}, p.body.pressure = pressure;
  return p;
}

/// An irregular cube of two regions, the second ten times as stiff.
Problem layered_cube(const std::string& material, int cells = 3) {
  Problem p = nodal(small_cube(material, cells));
  p.body.levels[0] = with_regions(p.body.levels[0], 0.05, "soft", "stiff");
  p.body.regions["stiff"].young_modulus = 200e3;
  return p;
}

/// Psi = mu/2 (J^(-2/3) I1 - 3) + kappa/2 (J - 1)^2
struct QuadraticNeoHookean : TwoConstants {
  static constexpr const char* name = "quadratic_neo_hookean";
  template <class T>
  static KOKKOS_INLINE_FUNCTION T energy(const Mat3<T>& F, const Lame<T>& c) {
    const T J = determinant(F), r = inverse_cube_root(J), kappa = c.lambda + T(2.0 / 3) * c.mu;
    return T(0.5) * (c.mu * (r * r * inner(F, F) - T(3)) + kappa * (J - T(1)) * (J - T(1)));
  }
  template <class T>
  static KOKKOS_INLINE_FUNCTION Mat3<T> stress(const Mat3<T>& F, const Lame<T>& c) {
    const Mat3<T> H = cofactor(F);
    const T J = dot(F[0], H[0]), r = inverse_cube_root(J), kappa = c.lambda + T(2.0 / 3) * c.mu;
    return (c.mu * r * r) * F +
           (kappa * (J - T(1)) - T(1.0 / 3) * c.mu * r * r / J * inner(F, F)) * H;
  }
  template <class T>
  static KOKKOS_INLINE_FUNCTION Mat3<T> stress_change(const Mat3<T>& F, const Mat3<T>&,
                                                      const Lame<T>&) {
    return F;  // not asked for
  }
};

// Numbers of an independent program: a unit cube of six tetrahedra, one corner moved.
TEST(NodalElements, HaveTheEnergyAndForceOfOneCell) {
  const TetMesh mesh = box_mesh(unit_box, {1, 1, 1});
  const double beta = 0.4;
  LevelData<Host> level;
  level.model.vertices = 8,
  level.model.rows = build_nodal_rows<Host>(mesh, {{{10 - 2.0 / 3, 1}}, {beta * 1}, {}, {}});
  level.model.shares = level.model.rows.shares;
  level.model.mass = Scalars<Host>("test.mass", 8);
  level.nodal = make_nodal_work<Host>(level.model.rows);
  level.partial = Vectors<Host>("test.partial", static_cast<std::size_t>(level.model.shares.rows));
  std::vector<Point> u(8, Point::Zero());
  const std::size_t corner = vertex_at(mesh, {1, 1, 1});
  u[corner] = {0.1, 0.2, 0.3};
  const Vectors<Host> at = device_field<Host>(u), f("test.f", 8);
  nodal_energy<Host, QuadraticNeoHookean>({}, level, at);
  double energy = 0;
  for (std::size_t i = 0; i < level.partial.extent(0); ++i) energy += level.partial(i, 0);
  EXPECT_NEAR(energy, 0.2624915127, 1e-10);
  nodal_force<Host, QuadraticNeoHookean>({}, level, {at, {}}, 1);
  gather_forces<Host>({}, level.model, level.partial, {}, f);
  const Point force(f(corner, 0), f(corner, 1), f(corner, 2));
  EXPECT_LE((force - Point(-0.636416, -0.809517, -0.982141)).norm(), 2e-6);
}

/// The energy by its definition, over tetrahedra: domain means of F, Psi of these, the spread about
/// them.
double energy_by_tets(const Problem& p, const std::vector<Point>& u) {
  const TetMesh& mesh = p.body.levels[0];
  const MaterialInfo& info = *find_material(p.body.material.model);
  std::map<std::pair<int, int>, std::pair<double, Eigen::Matrix3d>> domains;
  std::vector<Eigen::Matrix3d> F;
  std::vector<double> V;
  for (const auto& t : mesh.tets) {
    Eigen::Matrix3d X, x;
    for (int c = 0; c < 3; ++c) {
      const auto v = static_cast<std::size_t>(t[static_cast<std::size_t>(c + 1)]),
                 o = static_cast<std::size_t>(t[0]);
      X.col(c) = mesh.vertices[v] - mesh.vertices[o], x.col(c) = X.col(c) + u[v] - u[o];
    }
    F.push_back(x * X.inverse()), V.push_back(X.determinant() / 6);
  }
  const auto region = [&](std::size_t e) { return mesh.region.empty() ? 0 : mesh.region[e]; };
  for (std::size_t e = 0; e < F.size(); ++e)
    for (int v : mesh.tets[e]) {
      auto& [volume, mean] =
          domains.try_emplace({v, region(e)}, 0, Eigen::Matrix3d::Zero()).first->second;
      volume += V[e] / 4, mean += V[e] / 4 * F[e];
    }
  const auto values = [&](int r) {
    const auto own =
        p.body.regions.find(mesh.region_names.empty() ? "" : mesh.region_names[std::size_t(r)]);
    return parameter_values(info, p.body.material,
                            own == p.body.regions.end() ? RegionOptions{} : own->second);
  };
  double energy = 0;
  for (auto& [key, domain] : domains) {
    domain.second /= domain.first;
    Materials::visit(info.name, [&](auto m) {
      using M = decltype(m);
      energy += domain.first * M::energy(mat3<double>(domain.second),
                                         M::kernel_constants(values(key.second).data()));
    });
  }
  for (std::size_t e = 0; e < F.size(); ++e)
    for (int v : mesh.tets[e])
      energy += 0.5 * p.body.stabilisation * info.small_strains(values(region(e))).mu * V[e] / 4 *
                (F[e] - domains.at({v, region(e)}).second).squaredNorm();
  return energy;
}

TEST(NodalElements, EnergyIsThatOfItsDefinition) {
  for_each_material_name([](const std::string& material) {
    for (const Problem& problem : {nodal(small_cube(material)), layered_cube(material)}) {
      LevelProbe<Host> probe(problem);
      const auto u = random_field(probe.vertices(), 0.003, 1);
      const double want = energy_by_tets(problem, u);
      EXPECT_NEAR(probe.elastic_energy(u), want, 1e-11 * want);
    }
  });
}

TEST(NodalElements, ForceIsMinusTheGradientOfTheEnergy) {
  for_each_material_name([](const std::string& material) {
    for (const char* pressure : {"plain", "smoothed"}) {
      if (material == "linear" && std::string(pressure) == "smoothed") continue;  // refused
      SCOPED_TRACE(pressure);
      Problem problem = layered_cube(material);
      problem.body.pressure = pressure, problem.body.material.poisson_ratio = 0.45;
      LevelProbe<Host> probe(problem);
      const auto u = random_field(probe.vertices(), 0.003, 1),
                 p = random_field(probe.vertices(), 0.003, 2);
      const double h = 1e-3;
      const auto slope = [&](double t) {
        return (probe.elastic_energy(along(u, t, p)) - probe.elastic_energy(along(u, -t, p))) /
               (2 * t);
      };
      const double work = -dot(probe.force(u), p);
      EXPECT_NEAR(work, (4 * slope(h / 2) - slope(h)) / 3, 1e-6 * std::abs(work));
    }
  });
}

TEST(NodalElements, TangentIsMinusTheDerivativeOfTheForceAndSymmetric) {
  for_each_material_name([](const std::string& material) {
    for (const char* pressure : {"plain", "smoothed"}) {
      if (material == "linear" && std::string(pressure) == "smoothed") continue;
      SCOPED_TRACE(pressure);
      Problem problem = layered_cube(material, 2);
      problem.body.pressure = pressure, problem.body.material.poisson_ratio = 0.45;
      LevelProbe<Host> probe(problem);
      const auto u = random_field(probe.vertices(), 0.003, 1),
                 p = random_field(probe.vertices(), 0.003, 2);
      const auto slope = [&](double h) {
        auto d = minus(probe.force(along(u, -h, p)), probe.force(along(u, h, p)));
        for (Point& x : d) x /= 2 * h;
        return d;
      };
      auto want = slope(1e-3);
      const auto half = slope(5e-4), Kp = probe.stiffness(u, p);
      for (std::size_t a = 0; a < want.size(); ++a) want[a] = (4 * half[a] - want[a]) / 3;
      EXPECT_LE(largest_difference(Kp, want), 1e-6 * largest(Kp));
      const Eigen::MatrixXd K = probe.stiffness_matrix(u);
      EXPECT_LE((K - K.transpose()).cwiseAbs().maxCoeff(),
                round_off<double>(1e3, K.cwiseAbs().maxCoeff()));
    }
  });
}

TEST(NodalElements, OwnBlocksAreThoseOfTheTangent) {
  for_each_material_name([](const std::string& material) {
    Problem problem = nodal(layered_cube(material, 2), "plain");
    problem.body.damping.stiffness = 2e-3;
    LevelProbe<Host> probe(problem);
    Level<Host>& level = probe.at(0);
    const State<Host> state(device_field<Host>(random_field(probe.vertices(), 0.006, 1)),
                            device_field<Host>(probe.zero()));
    const ImplicitWeights weights{1e-4, 1e-2};
    const Blocks<Host> blocks("test.blocks", probe.vertices());
    Vectors<Host> q("test.q", probe.vertices());
    for (const bool projected : {false, true}) {
      SCOPED_TRACE(projected);
      level.diagonal(state, weights, projected, blocks);
      for (std::size_t a = 0; a < probe.vertices(); ++a)
        for (int k = 0; k < 3; ++k) {
          auto p = probe.zero();
          p[a][k] = 1;
          level.product(state, device_field<Host>(p), weights, projected, q);
          for (int i = 0; i < 3; ++i) {
            const int number = i == k ? i : i + k + 2;
            EXPECT_NEAR(blocks(a, static_cast<std::size_t>(number)),
                        q(a, static_cast<std::size_t>(i)),
                        1e-11 * std::abs(q(a, static_cast<std::size_t>(k))))
                << a << ' ' << i << ' ' << k;
          }
        }
    }
  });
}

// Kept for a state, projected tangents are those that every product projects anew, and no direction
// has less than no stiffness in them but for what stabilises; squeezed elements have less.
TEST(NodalElements, KeepProjectedTangents) {
  for_each_material_name([](const std::string& material) {
    Problem problem = nodal(layered_cube(material, 2), "plain");
    problem.integration.integrator = {"implicit_euler"}, problem.integration.macro_step = 1e-3;
    LevelProbe<Host> probe(problem);
    Level<Host>& level = probe.at(0);
    auto squeezed = random_field(probe.vertices(), 0.004, 1);
    for (std::size_t a = 0; a < probe.vertices(); ++a)
      squeezed[a][2] -= 0.3 * problem.body.levels[0].vertices[a][2];
    const State<Host> state(device_field<Host>(squeezed), device_field<Host>(probe.zero()));
    const auto tangent = [&](unsigned seed) {
      level.tangent(state, device_field<Host>(random_field(probe.vertices(), 0.003, seed)), 0,
                    true);
      return to_host<Host>({}, level.partial);
    };
    const auto own_blocks = [&] {
      const Blocks<Host> blocks("test.blocks", probe.vertices());
      level.diagonal(state, {1e-4, 1e-2}, true, blocks);
      return host_values(Host::Exec(), blocks);
    };
    level.linearise(state, 0, {1e-4, 1e-2}, 0, level.f);
    const auto anew = tangent(3), other = tangent(4);
    const auto blocks = own_blocks();
    level.keep_tangents(state);
    ASSERT_GT(level.nodal.tangent.extent(0), 0);
    EXPECT_LE(largest_difference(tangent(3), anew), 1e-11 * largest(anew));
    EXPECT_LE(largest_difference(tangent(4), other), 1e-11 * largest(other));
    const auto kept = own_blocks();
    for (std::size_t i = 0; i < blocks.size(); ++i)
      EXPECT_NEAR(kept[i], blocks[i], 1e-11 * std::abs(blocks[0]));
  });
}

TEST(NodalElements, TangentsTakeTheGradientsThatAreKeptOfTheirStateAlone) {
  for_each_material_name([](const std::string& material) {
    Problem problem = nodal(layered_cube(material, 2), "plain");
    problem.integration.integrator = {"implicit_euler"}, problem.integration.macro_step = 1e-3;
    LevelProbe<Host> probe(problem);
    Level<Host>& level = probe.at(0);
    ASSERT_GT(level.nodal.gradient.extent(0), 0);
    const auto state = [&](unsigned seed) {
      return State<Host>(device_field<Host>(random_field(probe.vertices(), 0.006, seed)),
                         device_field<Host>(probe.zero()));
    };
    const State<Host> here = state(1), same = state(1), elsewhere = state(2);
    const Vectors<Host> p = device_field<Host>(random_field(probe.vertices(), 0.003, 3));
    const auto tangent = [&](const State<Host>& at) {
      level.tangent(at, p);
      return to_host<Host>({}, level.partial);
    };
    const auto own_blocks = [&](const State<Host>& at) {
      const Blocks<Host> blocks("test.blocks", probe.vertices());
      level.diagonal(at, {1e-4, 1e-2}, false, blocks);
      return host_values(Host::Exec(), blocks);
    };
    const auto want = tangent(here);  // nothing is kept yet
    const std::vector<double> blocks = own_blocks(here);
    const auto agree = [&](const State<Host>& at) {
      EXPECT_LE(largest_difference(tangent(at), want), round_off<double>(100, largest(want)));
      const std::vector<double> now = own_blocks(at);
      for (std::size_t k = 0; k < blocks.size(); ++k)
        EXPECT_NEAR(now[k], blocks[k], round_off<double>(100, std::abs(blocks[0]))) << k;
    };
    level.linearise(here, 0, {1e-4, 1e-2}, 0, level.f);
    agree(here), agree(same);
    level.linearise(elsewhere, 0, {1e-4, 1e-2}, 0, level.f);
    agree(here);
    const double away = largest_difference(tangent(elsewhere), want);
    EXPECT_TRUE(material == "linear" || away > 1e-3 * largest(want)) << away;
  });
}

/// Forces and moments on a body that is turned and strained.
template <class B>
class NodalElementsOn : public testing::Test {};
TYPED_TEST_SUITE(NodalElementsOn, EachBackend);

TYPED_TEST(NodalElementsOn, PatchTest) {
  using Real = typename TypeParam::Real;
  std::mt19937 random(9);
  const Eigen::Matrix3d F = random_rotation(random) * Eigen::Vector3d(1.2, 0.9, 1.05).asDiagonal() *
                            random_rotation(random);
  Materials::for_each([&](auto material) {
    using M = decltype(material);
    SCOPED_TRACE(M::name);
    const Problem problem = nodal(small_cube(M::name, 4));
    const TetMesh& mesh = problem.body.levels[0];
    LevelProbe<TypeParam> probe(problem);
    const auto f = probe.force(affine_field(mesh, F, {0.01, 0.02, -0.03}));
    const auto c = M::kernel_constants(
        parameter_values(*find_material(M::name), problem.body.material, {}).data());
    const Eigen::Matrix3d P = eigen(M::stress(mat3<double>(F), c));
    for (std::size_t a = 0; a < f.size(); ++a) {
      if (on_boundary(decimetre, mesh.vertices[a])) continue;
      EXPECT_LE(f[a].norm(), round_off<Real>(400, P.norm() * 0.025 * 0.025)) << a;
    }
    EXPECT_LE((virial(f, mesh) - 1e-3 * P).norm(), round_off<Real>(1000, 1e-3 * P.norm()));
  });
}

TYPED_TEST(NodalElementsOn, RigidMotionHasNoForce) {
  using Real = typename TypeParam::Real;
  std::mt19937 random(11);
  for_each_material_name([&](const std::string& material) {
    const Problem problem = layered_cube(material);
    LevelProbe<TypeParam> probe(problem);
    const bool turns = find_material(material)->rotation_invariant;
    const Eigen::Matrix3d R = turns ? random_rotation(random) : Eigen::Matrix3d::Identity();
    const auto u = affine_field(problem.body.levels[0], R, {0.05, -0.02, 0.01});
    EXPECT_LE(largest(probe.force(u)), round_off<Real>(400, 200e3 * 0.03 * 0.03));
    EXPECT_NEAR(probe.elastic_energy(u), 0, round_off<Real>(400, 200e3 * 1e-3));
  });
}

TYPED_TEST(NodalElementsOn, ForcesAndMomentsBalance) {
  using Real = typename TypeParam::Real;
  for (const char* pressure : {"plain", "smoothed"}) {
    Problem problem = layered_cube("neo_hookean");
    problem.body.pressure = pressure, problem.body.material.poisson_ratio = 0.49;
    LevelProbe<TypeParam> probe(problem);
    const auto u = random_field(probe.vertices(), 0.004, 1);
    const auto f = probe.force(u);
    Point force = Point::Zero(), moment = Point::Zero();
    for (std::size_t a = 0; a < f.size(); ++a)
      force += f[a], moment += (problem.body.levels[0].vertices[a] + u[a]).cross(f[a]);
    EXPECT_LE(force.norm(), round_off<Real>(100, largest(f)));
    EXPECT_LE(moment.norm(), round_off<Real>(100, 0.1 * largest(f)));
  }
}

TYPED_TEST(NodalElementsOn, AgreesWithDouble) {
  using Real = typename TypeParam::Real;
  for_each_material_name([](const std::string& material) {
    const Problem problem = nodal(small_cube(material, 5));
    LevelProbe<TypeParam> probe(problem);
    LevelProbe<Host> reference(problem);
    const auto u = random_field(probe.vertices(), 0.001, 1),
               p = random_field(probe.vertices(), 0.001, 2);
    const auto f = reference.force(u), q = reference.stiffness(u, p);
    EXPECT_LE(largest_difference(probe.force(u), f), round_off<Real>(100, largest(f)));
    EXPECT_LE(largest_difference(probe.stiffness(u, p), q), round_off<Real>(100, largest(q)));
  });
}

// At rest, of a region its own part of what is stiff but for the stabiliser, which a uniform strain
// rate does not know
TEST(NodalElements, DampingByStiffnessOfUniformRatesIsItsPartOfTheStiffness) {
  for (const char* pressure : {"plain", "smoothed"}) {
    Problem problem = layered_cube("neo_hookean");
    problem.body.pressure = pressure, problem.body.material.poisson_ratio = 0.45;
    problem.body.damping.stiffness = 0.01;
    LevelProbe<Host> probe(problem);
    Eigen::Matrix3d A;
    A << 1.1, 0.2, -0.3, 0.5, 0.9, 0.1, 0.4, -0.2, 1.3;
    const auto v = affine_field(problem.body.levels[0], A, Point::Zero()), zero = probe.zero();
    const auto Kv = probe.stiffness(zero, v), Dv = probe.damping(zero, v);
    for (std::size_t a = 0; a < v.size(); ++a)
      EXPECT_LE((Dv[a] - 0.01 * Kv[a]).norm(), 1e-10 * largest(Dv));
  }
}

// Layers of very different stiffness: each region has its own strain at the vertices between them.
TEST(NodalElements, RegionsShareNoStrain) {
  const Problem problem = layered_cube("linear");
  LevelProbe<Host> probe(problem);
  std::size_t between = 0;
  const auto first = on_host(probe.at(0).model.rows.shares.first);
  for (std::size_t a = 0; a < probe.vertices(); ++a)
    between += first(a + 1) - first(a) == 2 ? 1 : 0;
  EXPECT_GT(between, 0u);
  EXPECT_EQ(static_cast<std::size_t>(probe.at(0).model.rows.domains), probe.vertices() + between);
}

// The stress and volume ratio per vertex are those of an affine motion, also between regions of one
// material.
TEST(NodalElements, StressOfAnAffineMotionIsTheSameEverywhere) {
  Problem problem = nodal(small_cube("neo_hookean"));
  problem.body.levels[0] = with_regions(problem.body.levels[0], 0.05, "one", "other");
  LevelProbe<Host> probe(problem);
  const Eigen::Matrix3d F = Eigen::Vector3d(1.2, 0.95, 1).asDiagonal();
  const Level<Host>& level = probe.at(0);
  const Scalars<Host> stress("test.stress", probe.vertices()), J("test.J", probe.vertices());
  level.elasticity().stress(
      level.exec(), level,
      device_field<Host>(affine_field(problem.body.levels[0], F, Point::Zero())), {stress, J});
  const auto c = lame_constants(20e3, 0.35);
  const double want = von_mises(cauchy_stress<NeoHookean>(mat3<double>(F), c));
  for (std::size_t a = 0; a < probe.vertices(); ++a) {
    EXPECT_NEAR(stress(a), want, 1e-10 * want);
    EXPECT_NEAR(J(a), F.determinant(), 1e-12);
  }
}

}  // namespace
