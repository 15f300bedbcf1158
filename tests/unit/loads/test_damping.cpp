// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <plica/drivers/study/level_probe.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/gradients.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Damping by mass and by stiffness: its forces, what it does to motion, and what it takes from the
// explicit limits.
namespace {

using namespace plica;
using namespace plica::test;

Problem two_halves(const std::string& material) {
  Problem p =
      body_of({with_regions(jittered_box(decimetre, {3, 3, 3}), 0.05, "left", "right")}, material);
  p.body.regions["left"] = {}, p.body.regions["right"] = {};
  return p;
}

/// test(problem) for each kind of elements: linear, nodal, and nodal with smoothed pressures.
template <class Test>
void for_each_element(Problem p, const Test& test) {
  p.body.damping.stiffness = 2e-3;
  for (const char* pressure : {"", "plain", "smoothed"}) {
    // refused
    if (p.body.material.model == "linear" && std::string(pressure) == "smoothed") continue;
    SCOPED_TRACE(p.body.material.model + " " + pressure);
    Problem one = p;
    one.body.element = {*pressure ? "nodal" : "linear"};
    if (*pressure) one.body.pressure = pressure, one.body.material.poisson_ratio = 0.45;
    test(one);
  }
}

/// Turned, stretched by up to a half, and each vertex moved at random besides.
std::vector<Point> deformed(const TetMesh& mesh) {
  std::mt19937 random(4);
  const Eigen::Matrix3d F = random_rotation(random) * Eigen::Vector3d(1.5, 0.8, 0.9).asDiagonal() *
                            random_rotation(random);
  return along(affine_field(mesh, F, {0.01, -0.02, 0.03}), 1,
               random_field(mesh.vertices.size(), 0.004, 1));
}

/// The velocity w x (X + u) + v.
std::vector<Point> turning(const TetMesh& mesh, const std::vector<Point>& u, const Point& w,
                           const Point& v) {
  std::vector<Point> velocity;
  for (std::size_t a = 0; a < u.size(); ++a)
    velocity.emplace_back(w.cross(mesh.vertices[a] + u[a]) + v);
  return velocity;
}

template <class B>
class Damping : public testing::Test {};
TYPED_TEST_SUITE(Damping, EachBackend);

TYPED_TEST(Damping, ByStiffnessIsItsPartOfTheStiffnessAtRest) {
  for (const std::string& material : names(materials())) {
    if (material == "holzapfel_gasser_ogden") continue;  // whose fibres have one in tension only
    Problem p = two_halves(material);
    p.body.damping.stiffness = 2e-3;
    LevelProbe<TypeParam> probe(p);
    const auto v = random_field(probe.vertices(), 1, 2), zero = probe.zero();
    const auto Kv = probe.stiffness(zero, v), Dv = probe.damping(zero, v);
    for (std::size_t a = 0; a < v.size(); ++a)
      EXPECT_LE((Dv[a] - 2e-3 * Kv[a]).norm(),
                round_off<typename TypeParam::Real>(100, largest(Dv)))
          << material;
  }
}

TYPED_TEST(Damping, LeavesABodyThatTurnsAlone) {
  for_each_material_name([](const std::string& material) {
    for_each_element(small_cube(material), [](const Problem& p) {
      LevelProbe<TypeParam> probe(p);
      const TetMesh& mesh = p.body.levels[0];
      const auto u = deformed(mesh);
      const auto elastic = probe.force(u),
                 turned = probe.force(u, turning(mesh, u, {20, -30, 40}, {1, 2, -3}));
      const double strained = largest(probe.damping(u, random_field(u.size(), 5, 2)));
      EXPECT_GT(strained, 1);
      EXPECT_LE(largest_difference(turned, elastic),
                round_off<typename TypeParam::Real>(300, strained + largest(elastic)));
    });
  });
}

// Also inside out. What it leaves alone of linear elements is rigid.
TEST(StiffnessDamping, TakesEnergyInEveryState) {
  for_each_material_name([](const std::string& material) {
    for_each_element(small_cube(material, 2), [](Problem p) {
      p.body.damping.stiffness = 1e12;  // not lost beside the elastic forces of any law
      LevelProbe<Host> probe(p);
      const auto u = deformed(p.body.levels[0]);
      for (const double size : {0.0, 0.03}) {
        const Eigen::MatrixXd D =
            probe.damping_matrix(along(u, 1, random_field(u.size(), size, 3)));
        const double most = D.cwiseAbs().maxCoeff();
        EXPECT_LE((D - D.transpose()).cwiseAbs().maxCoeff(), round_off<double>(1e4, most));
        const Eigen::VectorXd powers = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(
                                           0.5 * (D + D.transpose()), Eigen::EigenvaluesOnly)
                                           .eigenvalues();
        EXPECT_GE(powers[0], -round_off<double>(1e4, most));
        EXPECT_TRUE(p.body.element[0] == "nodal" || powers[6] > 1e-4 * most) << powers[6] / most;
      }
    });
  });
}

// Its product, the vertices' own blocks, and both where the tangents are projected
TEST(StiffnessDamping, IsInTheSystemsOfImplicitSteps) {
  for_each_material_name([](const std::string& material) {
    for_each_element(small_cube(material, 2), [](const Problem& p) {
      Problem without = p;
      without.body.damping.stiffness = 0;
      LevelProbe<Host> damped(p), undamped(without);
      const auto u = deformed(p.body.levels[0]), x = random_field(u.size(), 1, 2);
      const State<Host> at(device_field<Host>(u), device_field<Host>(damped.zero()));
      const ImplicitWeights weights{1e-4, 1e-2};
      const auto product = [&](LevelProbe<Host>& of, bool positive) {
        const Vectors<Host> q("test.q", u.size());
        of.at(0).product(at, device_field<Host>(x), weights, positive, q);
        return to_host<Host>({}, q);
      };
      const auto Dx = damped.damping(u, x);
      for (const bool positive : {false, true}) {
        const auto q = product(damped, positive);
        EXPECT_LE(largest_difference(q, along(product(undamped, positive), weights.b, Dx)),
                  1e-11 * largest(q));
      }
      const Eigen::MatrixXd D = damped.damping_matrix(u);
      const Blocks<Host> with("test.with", u.size()), alone("test.alone", u.size());
      damped.at(0).diagonal(at, weights, false, with),
          undamped.at(0).diagonal(at, weights, false, alone);
      if (p.body.pressure == "smoothed") return;  // these have no blocks of pressures
      for (std::size_t a = 0; a < u.size(); ++a)
        for (std::size_t k = 0; k < 6; ++k) {
          constexpr int row[6] = {0, 1, 2, 0, 0, 1}, column[6] = {0, 1, 2, 1, 2, 2};
          const auto at_a = static_cast<Eigen::Index>(3 * a);
          EXPECT_NEAR(with(a, k) - alone(a, k), weights.b * D(at_a + row[k], at_a + column[k]),
                      1e-10 * (std::abs(with(a, 0)) + weights.b * D.cwiseAbs().maxCoeff()));
        }
    });
  });
}

/// Of all vertices about the origin [kg m^2/s].
Point angular_momentum(const Simulation<Host>& simulation, const std::vector<double>& mass) {
  const auto x = simulation.positions(), v = simulation.velocities();
  Point sum = Point::Zero();
  for (std::size_t a = 0; a < mass.size(); ++a) sum += mass[a] * x[a].cross(v[a]);
  return sum;
}

// Of a free body that turns, and swings or is under pressure from all sides
TEST(StiffnessDamping, KeepsTheAngularMomentum) {
  for (const char* integrator : {"symplectic_euler", "central_difference"})
    for_each_element(small_cube("neo_hookean"), [&](Problem p) {
      p.integration.integrator = {integrator}, p.integration.macro_step = 2e-4;
      p.body.initial.angular_velocity = {3, -2, 5}, p.body.initial.stretch = {1.3, 0.9, 0.9};
      const std::vector<double> mass = LevelProbe<Host>(p).mass();
      for (const double pressure : {0.0, 3e3}) {
        if (pressure > 0) p.body.loads = {{decimetre, FollowerPressure{pressure}, {}}};
        Simulation<Host> simulation(p);
        const Point before = angular_momentum(simulation, mass);
        double energy = simulation.energies().total();
        for (int n = 0; n < 10; ++n) {
          advance(simulation, 50);
          const double now = simulation.energies().total();
          EXPECT_TRUE(pressure > 0 || now < energy) << n << ' ' << energy << ' ' << now;
          energy = now;
        }
        EXPECT_LE((angular_momentum(simulation, mass) - before).norm(),
                  round_off<double>(5000, before.norm()));
      }
    });
}

TEST(RegionDamping, IsOfItsElements) {
  Problem p = two_halves("linear");
  p.body.damping = {4, 0};
  p.body.regions["right"].damping = {10, 1e-3};
  LevelProbe<Host> probe(p);
  const auto& model = probe.at(0).model;
  const auto& x = p.body.levels[0].vertices;
  for (std::size_t a = 0; a < x.size(); ++a) {
    const double c = model.damping(static_cast<int>(a));
    if (x[a][0] < 1e-9) {
      EXPECT_NEAR(c, 4, 1e-12);
    }
    if (x[a][0] > 0.1 - 1e-9) {
      EXPECT_NEAR(c, 10, 1e-12);
    }
    EXPECT_GE(c, 4 - 1e-12);
    EXPECT_LE(c, 10 + 1e-12);
  }
  const auto v = random_field(x.size(), 1, 3), zero = probe.zero();
  const auto f = probe.force(zero, v);  // nothing but the damping of the right half
  for (std::size_t a = 0; a < x.size(); ++a)
    if (x[a][0] < 1e-9) {
      EXPECT_EQ(f[a].norm(), 0);
    }
  EXPECT_GT(largest(f), 0);
}

// The largest h with lambda_max(h^2 K + h r D) <= r^2, D the stiffness of each region times its own
// damping.
TEST(StiffnessDamping, LowersTheLimitAsPredicted) {
  for (const char* integrator : {"symplectic_euler", "central_difference", "rk4"})
    for (const char* element : {"linear", "nodal"}) {
      Problem p = two_halves("linear");
      p.integration.integrator = {integrator}, p.body.element = {element};
      const double radius = std::string(integrator) == "rk4" ? 2.78 : 2;
      const double undamped = Simulation<Host>(p).levels()[0].critical_step;
      p.body.regions["right"].damping.stiffness = 0.5 * undamped;
      LevelProbe<Host> probe(p);
      const double predicted = probe.built.reports[0].critical_step;
      const Eigen::MatrixXd S =
          probe.scaled_by_mass(predicted * predicted * probe.stiffness_matrix(probe.zero()) +
                               predicted * radius * probe.damping_matrix(probe.zero()));
      const double top = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(S, Eigen::EigenvaluesOnly)
                             .eigenvalues()
                             .maxCoeff();
      EXPECT_LE(top, 1.001 * radius * radius) << integrator;
      EXPECT_GE(top, 0.95 * radius * radius) << integrator;
      EXPECT_LT(predicted, 0.9 * undamped) << integrator;
    }
}

// What stabilises nodal elements is not damped, so that its modes grow
TEST(StiffnessDamping, HoldsNoNodalElementsThatGrow) {
  for (const char* element : {"linear", "nodal"}) {
    Problem p = small_cube("linear");
    p.body.element = {element}, p.body.damping.stiffness = 1e-3;
    p.integration.integrator = {"euler"}, p.integration.allow_unstable = true,
    p.integration.macro_step = 1e-4;
    EXPECT_EQ(Simulation<Host>(p).levels()[0].critical_step > 0, p.body.element[0] == "linear");
  }
}

// Integrators that grow undamped are stable with damping just below the predicted limit, and not
// well above it.
TEST(Damping, HoldsWhatGrows) {
  for (const char* integrator : {"euler", "rk2"}) {
    Problem p = small_cube("linear");
    p.body.damping.mass = 40, p.integration.substeps = {1};
    p.integration.integrator = {integrator}, p.integration.allow_unstable = true;
    const double limit = Simulation<Host>(p).levels()[0].critical_step;
    ASSERT_GT(limit, 0);
    for (const double part : {0.97, 1.5}) {
      p.integration.macro_step = part * limit;
      Simulation<Host> simulation(p);
      simulation.set_state(random_field(p.body.levels[0].vertices.size(), 1e-6, 5),
                           std::vector<Point>(p.body.levels[0].vertices.size(), Point::Zero()));
      const double before = simulation.energies().total();
      for (int n = 0; n < static_cast<int>(20 / (part * limit * 40)); ++n) simulation.step();
      EXPECT_EQ(simulation.energies().total() < before, part < 1) << integrator << " " << part;
    }
  }
}

// A mode's amplitude decays like exp(-(c + b w^2) t / 2).
TEST(Damping, DecaysAsRayleighSays) {
  for (const std::string& integrator : names(integrators())) {
    Problem p = small_cube("linear", 2);
    LevelProbe<Host> probe(p);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(
        probe.scaled_by_mass(probe.stiffness_matrix(probe.zero())));
    const double w = std::sqrt(modes.eigenvalues()[8]);  // beyond the six rigid ones
    const auto mass = probe.mass();
    std::vector<Point> shape = probe.zero();
    for (std::size_t a = 0; a < shape.size(); ++a)
      for (int k = 0; k < 3; ++k)
        shape[a][k] = 1e-4 * modes.eigenvectors()(static_cast<Eigen::Index>(3 * a) + k, 8) /
                      std::sqrt(mass[a]);
    p.body.damping = {0.02 * w, 0.02 / w};
    p.integration.integrator = {integrator}, p.integration.allow_unstable = true;
    const double h = 5e-4 * 2 * M_PI / w;
    p.integration.macro_step = h, p.integration.implicit.relative_residual = 1e-10;
    Simulation<Host> simulation(p);
    simulation.set_state(shape, probe.zero());
    const double before = simulation.energies().total();
    for (int n = 0; n < 2000; ++n) simulation.step();  // one period
    const double decay = -std::log(simulation.energies().total() / before);
    EXPECT_NEAR(decay, 0.04 * 2 * M_PI, 0.1 * 0.04 * 2 * M_PI) << integrator;
  }
}

}  // namespace
