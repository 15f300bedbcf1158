// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <complex>
#include <map>
#include <numbers>
#include <plica/drivers/run/simulation.hpp>
#include <plica/drivers/study/direct_solves.hpp>
#include <plica/drivers/study/stability.hpp>
#include <plica/drivers/study/verify.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/generators.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Every problem of `plica verify`, on coarse meshes; and largest stable steps of bodies that are
// not among them.
namespace {

using namespace plica;
using namespace plica::test;

class KnownAnswer : public testing::TestWithParam<std::string> {};

TEST_P(KnownAnswer, IsFound) {
  const VerifyResult result = verify({{GetParam()}, true});
  EXPECT_FALSE(result.rows.empty());
  for (const VerifyRow& row : result.rows) {
    EXPECT_NE(row.outcome, "not ok")
        << row.quantity << " " << (row.ours.empty() ? 0 : row.ours.back().value) << " " << row.note;
    EXPECT_FALSE(row.source.empty()) << row.quantity;
    for (const VerifyValue& v : row.ours)
      EXPECT_TRUE(std::isfinite(v.value)) << row.quantity << " " << v.mesh;
  }
}

INSTANTIATE_TEST_SUITE_P(Of, KnownAnswer, testing::ValuesIn(names(verify_problems())),
                         [](const auto& test) { return test.param; });

double finest(const std::string& problem, std::size_t row) {
  return verify({{problem}, true}).rows.at(row).ours.back().value;
}

// Values that no tolerance of the table stands between
TEST(KnownAnswers, AreTheseNumbers) {
  EXPECT_NEAR(finest("axial_bar", 0), 6.25, 0.002);
  EXPECT_NEAR(finest("tapered_membrane", 0), 44.623, 0.5);
  EXPECT_GT(finest("tapered_membrane", 0), 44.623);
  const double cube = finest("free_cube", 0);
  EXPECT_GT(cube, 0.2626);
  EXPECT_LT(cube, 0.28);
  EXPECT_NEAR(*verify({{"cook_membrane"}, true}).rows.at(0).limit, 14.74, 0.15);
  EXPECT_LT(finest("cook_membrane", 0), 14.74);
}

// A note is about its own row.
TEST(KnownAnswers, NotesOfTheCantileverAreTheirOwn) {
  for (const VerifyRow& row : verify({{"cantilever"}, true}).rows) {
    const bool extrapolated = row.judged == Judged::limit;
    const std::string percent =
        std::to_string(std::lround(100 * std::abs(row.ours.back().value / *row.accepted - 1)));
    EXPECT_EQ(row.note.find("lock") != std::string::npos, extrapolated)
        << row.quantity << ": " << row.note;
    EXPECT_EQ(row.note.find(" " + percent + " % off") != std::string::npos, extrapolated)
        << row.note;
    EXPECT_EQ(row.note.find("shear") != std::string::npos,
              row.quantity.starts_with("first bending frequency"))
        << row.quantity << ": " << row.note;
  }
}

TEST(LargestStableStep, OfAStiffInclusion) {
  Problem p = small_cube("linear", 4);
  p.body.levels[0] = with_regions(p.body.levels[0], 0.05, "stiff", "soft");
  p.body.regions["stiff"].young_modulus = 2e6;
  StudyOptions asked;
  asked.methods = {"single/symplectic_euler"};
  const StabilityRow row = stability(p, asked).rows.at(0);
  ASSERT_EQ(row.status, "limited") << row.reason;
  EXPECT_NEAR(*row.ratio, 1, 0.02);
}

// Deep in a plane, pressed on by every point: the limit is still that of the elements, and no lower
// one shows.
TEST(LargestStableStep, IsNotBoundByContact) {
  Problem p = small_cube("linear");
  p.body.surface = sphere_surface({0.05, 0.05, 0.05}, 0.049, 2);
  p.contact.obstacles.push_back({PlaneOptions{{0, 0, 0.097}, {0, 0, 1}}, {}, {}});
  p.contact.stiffness_scale = 100, p.contact.damping_scale = 0;
  p.body.fixed = {left_face()};
  p.integration.macro_step = 1e-7;
  const double predicted = Simulation<Host>(p).levels()[0].critical_step;
  p.integration.macro_step = 0.999 * predicted;
  Simulation<Host> simulation(p);
  for (int i = 0; i < 800; ++i) simulation.step();
  EXPECT_LT(largest(simulation.velocities()),
            1e4);  // so fast it leaves the plane; what grows is beyond that in 20 steps
}

// Integrators on bars and beams: against direct solves on the same mesh, beam theory and waves.
// `plica verify` has the direct solves themselves, refined.

Problem beam(const std::string& material) {
  Problem p = body_of({jittered_box(beam_box, {12, 3, 3})}, material);
  p.body.material.young_modulus = 1e5, p.body.material.poisson_ratio = 0.3;
  p.body.fixed = {left_face()};
  return p;
}

std::vector<Point> weight(const LevelProbe<Host>&, const std::vector<double>& mass,
                          const Point& g) {
  std::vector<Point> f;
  for (double m : mass) f.push_back(m * g);
  return f;
}

double relative(const std::vector<Point>& a, const std::vector<Point>& b) {
  return largest_difference(a, b) / largest(b);
}

std::vector<Point> settled(Problem p, const std::string& integrator, double step, double damping,
                           double time) {
  p.integration.integrator = {integrator};
  p.integration.macro_step = step;
  p.body.damping.mass = damping;
  p.integration.implicit.relative_residual = 1e-6;
  Simulation<Host> simulation(p);
  advance(simulation, static_cast<int>(time / step));
  EXPECT_LT(largest(simulation.velocities()), 1e-6);
  return displacements(simulation, p.body.levels[0]);
}

TEST(Cantilever, LinearSagIsTheDirectSolution) {
  Problem p = beam("linear");
  p.gravity = {0, 0, -2};
  LevelProbe<Host> probe(p);
  const auto sag = SparseStiffness(probe).equilibrium(weight(probe, probe.mass(), p.gravity));
  EXPECT_LE(relative(settled(p, "implicit_euler", 2.0, 0, 60), sag), 1e-5);
  EXPECT_LE(relative(settled(p, "symplectic_euler", 1e-3, 15, 4), sag), 1e-4);
}

TEST(Cantilever, NonlinearSagBalancesEveryVertex) {
  for (const char* material : {"st_venant_kirchhoff", "corotational", "neo_hookean"}) {
    Problem p = beam(material);
    p.gravity = {0, 0, -9.81};
    const auto u = settled(p, "implicit_euler", 0.05, 12, 5);
    EXPECT_GT(largest(u), 0.05) << material;
    LevelProbe<Host> probe(p);
    const auto f = probe.force(u);
    const auto inverse = probe.inverse_mass();
    for (std::size_t a = 0; a < f.size(); ++a)
      if (inverse[a] > 0) {
        EXPECT_LE(f[a].norm(), 1e-4 * 4 * 9.81) << material;  // of the whole weight
      }
  }
}

// Coarse levels pull to their own sag; a fine level alone must not.
TEST(Cantilever, SingleCycleOfALevelHierarchyIsTheFineSag) {
  Problem p = beam("linear");
  p.body.levels.push_back(jittered_box(beam_box, {6, 2, 2}));
  p.gravity = {0, 0, -2};
  LevelProbe<Host> probe(p);
  const auto sag = SparseStiffness(probe).equilibrium(weight(probe, probe.mass(), p.gravity));
  EXPECT_LE(relative(settled(p, "implicit_euler", 2.0, 0, 60), sag), 1e-5);
}

// Mean sag [m] under its own weight and lowest frequency [Hz], by direct solves.
std::array<double, 2> sag_and_frequency(TetMesh mesh) {
  Problem p = beam("linear");
  p.body.levels = {std::move(mesh)};
  LevelProbe<Host> probe(p);
  const SparseStiffness K(probe);
  const auto mass = probe.mass();
  const auto u = K.equilibrium(weight(probe, mass, {0, 0, -2}));
  double sag = 0, whole = 0;
  for (std::size_t a = 0; a < u.size(); ++a) sag -= mass[a] * u[a][2], whole += mass[a];
  return {sag / whole, K.frequencies(1).at(0)};
}

// What linear tetrahedra give on a mesh of this resolution follows from coarser and finer ones: a
// stiffness that falls with a power of the cells' size, to that of beam theory.
TEST(Cantilever, SagAndFrequencyOnThisMeshAreThoseOfItsResolution) {
  VerifyRow sag, frequency;
  sag.power = -1, frequency.power = 2;
  for (const int n : {2, 4, 8}) {
    const auto found = sag_and_frequency(box_mesh(beam_box, {4 * n, n, n}));
    sag.add("", 1.0 / n, found[0]), frequency.add("", 1.0 / n, found[1]);
  }
  judge(sag), judge(frequency);
  ASSERT_TRUE(sag.limit && frequency.limit);
  // Timoshenko: bending and shear; of the frequency Dunkerley's sum of both
  const double L = 0.4, EI = 1e5 * 1e-4 / 12, rho_A = 10, kGA = 5.0 / 6 * 1e5 / 2.6 * 0.01,
               q = 2 * rho_A;
  const double bending = 1.8751 * 1.8751 / (2 * M_PI * L * L) * std::sqrt(EI / rho_A);
  const double shear = std::sqrt(kGA / rho_A) / (4 * L);
  const double mean = q * std::pow(L, 4) / (20 * EI) + q * L * L / (3 * kGA);
  EXPECT_NEAR(*sag.limit, mean, 0.03 * mean);
  const double both = bending * shear / std::hypot(bending, shear);
  EXPECT_NEAR(*frequency.limit, both, 0.03 * both);
  const auto expected = [](const VerifyRow& row) {
    const double limit = std::pow(*row.limit, row.power),
                 coarse = std::pow(row.ours[0].value, row.power);
    return std::pow(limit + (coarse - limit) * std::pow(2.0 / 3, *row.order), 1 / row.power);
  };
  const auto even = sag_and_frequency(box_mesh(beam_box, {12, 3, 3})),
             irregular = sag_and_frequency(jittered_box(beam_box, {12, 3, 3}));
  EXPECT_NEAR(even[0], expected(sag), 0.01 * even[0]);
  EXPECT_NEAR(even[1], expected(frequency), 0.01 * even[1]);
  EXPECT_NEAR(irregular[0], even[0], 0.01 * even[0]);
  EXPECT_NEAR(irregular[1], even[1], 0.01 * even[1]);
}

// Under its own weight, hung at one end: u = rho g x (L - x/2) / E with nu = 0. The mesh shares
// mass out unevenly within a cross-section, so that the mean over each is what is exact.
TEST(Bar, StretchUnderItsOwnWeight) {
  Problem p = body_of({box_mesh(beam_box, {16, 2, 2})}, "linear");
  p.body.material.young_modulus = 1e5, p.body.material.poisson_ratio = 0;
  p.body.fixed = {left_face()};
  p.gravity = {9.81, 0, 0};
  const auto u = settled(p, "implicit_euler", 1.0, 0, 30);
  LevelProbe<Host> probe(p);
  const auto m = probe.mass();
  const double longest = 1000 * 9.81 * 0.4 * 0.2 / 1e5;
  std::map<long, std::array<double, 2>> sections;
  for (std::size_t a = 0; a < u.size(); ++a) {
    auto& section = sections[std::lround(p.body.levels[0].vertices[a][0] / 0.025)];
    section[0] += m[a] * u[a][0], section[1] += m[a];
  }
  EXPECT_EQ(sections.size(), 17u);
  for (const auto& [i, section] : sections) {
    const double x = 0.025 * static_cast<double>(i);
    EXPECT_NEAR(section[0] / section[1], 1000 * 9.81 * x * (0.4 - x / 2) / 1e5, 0.01 * longest)
        << x;
  }
}

/// A bar of linear material, pulled at both ends with the same traction until it is at rest: strain
/// p/E along, -nu p/E across, which linear tetrahedra take exactly.
TEST(UniaxialTension, StrainIsTractionOverYoungsModulus) {
  const double E = 20e3, nu = 0.3, p_over_E = 1e-3;
  for (const char* integrator : {"symplectic_euler", "implicit_euler"}) {
    SCOPED_TRACE(integrator);
    Problem p = body_of({jittered_box(beam_box, {6, 2, 2})}, "linear");
    p.body.material.poisson_ratio = nu;
    p.body.loads = {{HalfSpaceSelection{{0, 0, 0}, {1, 0, 0}}, Traction{{-p_over_E * E, 0, 0}},
                     RampCourse{0.5}},
                    {HalfSpaceSelection{{0.4, 0, 0}, {-1, 0, 0}}, Traction{{p_over_E * E, 0, 0}},
                     RampCourse{0.5}}};
    p.body.damping.mass = 20;
    p.integration.integrator = {integrator};
    if (std::string(integrator) == "implicit_euler") p.integration.macro_step = 5e-3;
    p.integration.implicit.relative_residual = 1e-9;
    Simulation<Host> simulation(p);
    while (simulation.time() < 2) advance(simulation, 1);
    const auto u = displacements(simulation, p.body.levels[0]);
    const Eigen::Matrix3d want =
        p_over_E * Eigen::Vector3d(1, -nu, -nu).asDiagonal().toDenseMatrix();
    for (const auto& t : p.body.levels[0].tets) {
      Eigen::Matrix3d rest, change;
      for (int k = 0; k < 3; ++k) {
        const auto a = static_cast<std::size_t>(t[static_cast<std::size_t>(k) + 1]),
                   o = static_cast<std::size_t>(t[0]);
        rest.col(k) = p.body.levels[0].vertices[a] - p.body.levels[0].vertices[o];
        change.col(k) = u[a] - u[o];
      }
      const Eigen::Matrix3d slope = change * rest.inverse();
      EXPECT_LE(((slope + slope.transpose()) / 2 - want).norm(), 1e-4 * p_over_E);
    }
  }
}

/// A bar whose one end shakes along its axis. With mass damping c its steady answer at the free end
/// is 1 / cos(k L), k^2 = (w^2 - i w c) rho / E (one-dimensional: nu = 0).
TEST(ShakenBar, FreeEndAnswersAsTheWaveEquationSays) {
  const double L = 0.4, speed = std::sqrt(20e3 / 1000), c = 5, f = 1.4,
               w = 2 * std::numbers::pi * f;
  Problem p = body_of({box_mesh(beam_box, {16, 2, 2})}, "linear");
  p.body.material.poisson_ratio = 0;
  p.body.damping.mass = c;
  p.body.prescribed = {{left_face(), SineMotion{{1e-4, 0, 0}, f, 0}}};
  Simulation<Host> simulation(p);
  while (simulation.time() < 4) advance(simulation, 1);
  double largest_motion = 0;
  while (simulation.time() < 4 + 2 / f) {
    advance(simulation, 1);
    const auto u = displacements(simulation, p.body.levels[0]);
    for (std::size_t a = 0; a < u.size(); ++a)
      if (p.body.levels[0].vertices[a][0] > L - 1e-9)
        largest_motion = std::max(largest_motion, std::abs(u[a][0]));
  }
  const double want =
      1e-4 / std::abs(std::cos(std::sqrt(std::complex<double>(w * w, -w * c)) / speed * L));
  EXPECT_GT(want, 1.3e-4);
  EXPECT_NEAR(largest_motion, want, 0.01 * want);
}

}  // namespace
