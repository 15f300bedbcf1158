// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/drivers/elastic/materials.hpp>
#include <plica/drivers/run/diagnose.hpp>
#include <plica/drivers/run/join_bodies.hpp>
#include <plica/drivers/run/registry.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/generators.hpp>
#include <regex>

#include "fuzz/replay.hpp"
#include "fuzz/run_target.hpp"
#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// A run that goes wrong stops before it shows, and says where, by how much and what to do.
namespace {

using namespace plica;
using namespace plica::test;

template <class B>
class Divergence : public testing::Test {};
TYPED_TEST_SUITE(Divergence, EachBackend);

Problem hanging(const std::string& material) {
  Problem p = small_cube(material);
  p.gravity = {0, 0, -9.81};
  p.body.fixed = {left_face()};
  return p;
}

bool all_finite(const std::vector<Point>& field) {
  for (const Point& p : field)
    if (!p.allFinite()) return false;
  return true;
}

TYPED_TEST(Divergence, AboveTheCriticalStepStopsBeforeItIsNotFinite) {
  for (const std::string& material : names(materials())) {
    SCOPED_TRACE(material);
    Problem p = hanging(material);
    const double limit = Simulation<TypeParam>(p).levels()[0].critical_step;
    p.integration.macro_step = 1.5 * limit;
    p.integration.substeps = {1};
    p.integration.allow_unstable = true;
    Simulation<TypeParam> simulation(p);
    std::optional<Diagnosis> bad;
    for (int n = 0; n < 2000 && !bad; ++n) {
      simulation.step();
      bad = simulation.check();
    }
    ASSERT_TRUE(bad);
    EXPECT_TRUE(all_finite(simulation.positions()) && all_finite(simulation.velocities()));
    EXPECT_TRUE(bad->kind == "energy" || (bad->kind == "inverted" && material == "neo_hookean"))
        << bad->kind;
    EXPECT_EQ(bad->level, 0);
    EXPECT_GE(bad->element, 0);
    EXPECT_LT(bad->J, 0.65);  // 0.50 to 0.62: the energy tells before an element is inside out
    EXPECT_NEAR(bad->substep_over_critical, 1.5, 1e-9);
    EXPECT_NE(bad->remedy.find("critical step"), std::string::npos);
    for (const char* part : {"level 0", "element ", "J = ", "1.5 times", "try "})
      EXPECT_NE(bad->text().find(part), std::string::npos) << part << " not in: " << bad->text();
  }
}

// Names of regions come from mesh files and may have any length.
TEST(Diagnosis, HoldsNamesOfAnyLength) {
  const std::string name(6000, 'r'), reason(2000, 's');
  const Diagnosis d{.kind = "inverted",
                    .level = 1,
                    .element = 3,
                    .region = name,
                    .J = -0.5,
                    .reason = reason,
                    .remedy = "a smaller macro_step"};
  EXPECT_EQ(d.text(), "an element is inside out: level 1, element 3 (region " + name +
                          ") with J = -0.5; " + reason + "; try a smaller macro_step");
}

TYPED_TEST(Divergence, NamesTheInvertedElementAndItsRegion) {
  Problem p = small_cube("neo_hookean", 5);
  p.body.levels[0] = with_regions(p.body.levels[0], 0.05, "left", "right");
  p.integration.macro_step = 1e-6;
  Simulation<TypeParam> simulation(p);
  const TetMesh& mesh = p.body.levels[0];
  // one vertex is pushed through the opposite face of one of its tetrahedra, which comes out the
  // most inverted of all
  std::size_t inner = 0;
  while (on_boundary(decimetre, mesh.vertices[inner]) || mesh.vertices[inner][0] < 0.065) ++inner;
  std::vector<Point> u(mesh.vertices.size(), Point::Zero()), v = u;
  u[inner] = {0.012, 0.016, 0.008};
  const WorstElement worst = worst_element(mesh, u);
  ASSERT_LT(worst.J, 0);
  simulation.set_state(u, v);
  simulation.step();
  const auto bad = simulation.check();
  ASSERT_TRUE(bad);
  EXPECT_EQ(bad->kind, "inverted");
  EXPECT_EQ(bad->region, "right");
  EXPECT_LT(bad->J, 0);
  EXPECT_NE(bad->remedy.find("allow_inversion"), std::string::npos);
  for (const Choice& material : materials())
    EXPECT_EQ(std::regex_search(bad->remedy, std::regex("[ (]" + material.name + "[,)]")),
              recovers(material.name))
        << bad->remedy;
  // it is one of the inverted elements
  const auto& t = mesh.tets[static_cast<std::size_t>(bad->element)];
  const auto at = [&](std::size_t k) {
    const auto a = static_cast<std::size_t>(t[k]);
    return Point(mesh.vertices[a] + u[a]);
  };
  EXPECT_LT(tet_volume(at(0), at(1), at(2), at(3)), 0);
  // a sound state set afterwards is sound
  simulation.set_state(v, v);
  simulation.step();
  EXPECT_FALSE(simulation.check());
}

TYPED_TEST(Divergence, NotFiniteIsFoundAtItsVertex) {
  Problem p = small_cube();
  p.integration.macro_step = 1e-5;
  Simulation<TypeParam> simulation(p);
  simulation.velocity()(17, 1) = std::numeric_limits<typename TypeParam::Real>::quiet_NaN();
  simulation.step();
  const auto bad = simulation.check();
  ASSERT_TRUE(bad);
  EXPECT_EQ(bad->kind, "non_finite");
  EXPECT_EQ(bad->vertex, 17);
  EXPECT_NE(bad->text().find("vertex 17"), std::string::npos);
}

// A search among places that are not finite must not end the program: the run says where it went
// wrong.
TYPED_TEST(Divergence, NotFiniteIsFoundWhereBodiesTouch) {
  using Real = typename TypeParam::Real;
  const auto block = [](double z) {
    Body body = body_of({box_mesh({{0, 0, z}, {0.1, 0.1, z + 0.1}}, {3, 3, 3})}).body;
    body.surface = boundary_surface(body.levels[0]).surface;
    return body;
  };
  for (const Real bad :
       {std::numeric_limits<Real>::quiet_NaN(), std::numeric_limits<Real>::infinity()})
    for (const char* integrator : {"symplectic_euler", "implicit_euler"}) {
      Problem p;
      p.body = join_bodies({{"under", block(0)}, {"over", block(0.1005)}});
      p.integration.integrator = {integrator};
      p.integration.macro_step = 1e-5;
      Simulation<TypeParam> simulation(p);
      simulation.velocity()(17, 1) = bad;
      simulation.step(), simulation.step();
      const auto found = simulation.check();
      ASSERT_TRUE(found) << integrator;
      EXPECT_EQ(found->kind, "non_finite") << integrator;
      if (integrator == std::string("symplectic_euler")) {
        EXPECT_GE(found->vertex, 0);
      }
      EXPECT_NE(found->text().find("level 0, "), std::string::npos) << found->text();
      simulation.return_to_last_good();
      EXPECT_TRUE(all_finite(simulation.positions()));
      advance(simulation, 3);
    }
}

// Where something from outside does work, energies cannot tell
TYPED_TEST(Divergence, FasterThanSoundIsFoundWhereEnergiesAreNotCompared) {
  Problem p = small_cube();
  p.body.prescribed = {{left_face(), SteadyMotion(Point(1e-6, 0, 0))}};
  const double limit = Simulation<TypeParam>(p).levels()[0].critical_step;
  p.integration.macro_step = 1.2 * limit;
  p.integration.substeps = {1};
  p.integration.allow_unstable = true;
  Simulation<TypeParam> simulation(p);
  std::optional<Diagnosis> bad;
  for (int n = 0; n < 5000 && !bad; ++n) {
    simulation.step();
    bad = simulation.check();
  }
  ASSERT_TRUE(bad);
  EXPECT_EQ(bad->kind, "speed");
  EXPECT_GT(bad->motion_over_edge, 1);
  EXPECT_TRUE(all_finite(simulation.positions()));
  EXPECT_NE(bad->text().find("edges moved in a sub-step"), std::string::npos) << bad->text();
}

// A program's own forces may be what throws a vertex out: only where there are some, they are
// named.
TYPED_TEST(Divergence, NamesForcesOfTheCallerAsACause) {
  Problem p = small_cube();
  p.integration.macro_step = 1e-5;
  const auto thrown = [&](bool by_caller) {
    Simulation<TypeParam> simulation(p);
    const auto last = simulation.velocity().extent(0) - 1;
    using Real = typename TypeParam::Real;
    if (by_caller)
      simulation.set_external_forces([last](const ForceRequest<TypeParam>& request) {
        request.exec.fence();
        request.force(last, 2) += Real(1e9);
      });
    else
      simulation.velocity()(last, 2) = Real(1e7);
    simulation.step();
    return simulation.check().value();
  };
  const Diagnosis own = thrown(true), other = thrown(false);
  EXPECT_NE(own.remedy.find("forces of your own (set_external_forces"), std::string::npos)
      << own.text();
  EXPECT_EQ(other.remedy.find("set_external_forces"), std::string::npos) << other.text();
}

// A plane holds at any depth, but a point that is further in than the body is large was not pushed
// there
TYPED_TEST(Divergence, APointFarInsideAnObstacleIsLost) {
  Problem p = small_cube();
  p.body.surface = sphere_surface({0.05, 0.05, 0.05}, 0.045, 1);
  p.contact.obstacles.push_back({PlaneOptions{{0, 0, -0.01}, {0, 0, 1}}, {}, {}});
  for (const char* integrator : {"symplectic_euler", "implicit_euler"}) {
    p.integration.integrator = {integrator};
    p.integration.macro_step = 1e-4;
    Simulation<TypeParam> simulation(p);
    std::vector<Point> u(p.body.levels[0].vertices.size(), Point(0, 0, -0.1)),
        v(u.size(), Point::Zero());
    simulation.set_state(u, v);
    simulation.step();
    EXPECT_FALSE(simulation.check());
    for (Point& at : u) at[2] = -1;
    simulation.set_state(u, v);
    simulation.step();
    const auto bad = simulation.check();
    ASSERT_TRUE(bad);
    EXPECT_EQ(bad->kind, "contact");
    EXPECT_NE(bad->text().find("surface point"), std::string::npos) << bad->text();
    simulation.set_state(v, v);
    simulation.step();
    EXPECT_FALSE(simulation.check());
  }
}

TYPED_TEST(Divergence, ImplicitStepsDoNotHideIt) {
  Problem p = small_cube("st_venant_kirchhoff");
  p.integration.integrator = {"implicit_euler"};
  p.integration.macro_step = 1e-3, p.integration.implicit.solver = "conjugate_gradients";
  Simulation<TypeParam> simulation(p);
  std::vector<Point> u(p.body.levels[0].vertices.size(), Point::Zero()), v = u;
  u[17] = {0, 1e30, 0};  // its stress is beyond the numbers there are
  if (std::is_same_v<typename TypeParam::Real, double>) u[17] = {0, 1e200, 0};
  simulation.set_state(u, v);
  simulation.step();
  const auto bad = simulation.check();
  ASSERT_TRUE(bad);
  EXPECT_EQ(bad->kind, "non_finite");
  EXPECT_GT(simulation.counters()["cg_misses"], 0);
}

TYPED_TEST(Divergence, ReturnsToTheLastGoodState) {
  Problem p = hanging("st_venant_kirchhoff");
  const double limit = Simulation<TypeParam>(p).levels()[0].critical_step;
  p.integration.macro_step = 1.5 * limit;
  p.integration.allow_unstable = true;
  p.integration.substeps = {1};
  Simulation<TypeParam> simulation(p);
  std::vector<std::vector<Point>> history = {simulation.positions()};
  while (history.size() < 2000) {
    simulation.step();
    history.push_back(simulation.positions());
    if (simulation.check()) break;
  }
  ASSERT_LT(history.size(), 2000u);
  simulation.return_to_last_good();
  const auto back = static_cast<std::size_t>(simulation.macro_steps());
  EXPECT_LT(back, history.size() - 1);
  EXPECT_GE(back + 21, history.size() - 1);
  EXPECT_DOUBLE_EQ(simulation.time(), static_cast<double>(back) * *p.integration.macro_step);
  EXPECT_TRUE(same_bits(simulation.positions(), history[back]));
}

// Sound runs pass their check at every macro step (advance() fails otherwise).

template <class B>
class NoFalseAlarm : public testing::Test {};
TYPED_TEST_SUITE(NoFalseAlarm, EachBackend);

Problem bouncing(const std::string& cycle) {
  Problem p = cube_levels(2, 4, cycle);
  p.body.material.model = "neo_hookean";
  p.body.surface = sphere_surface({0.05, 0.05, 0.05}, 0.05, 2);
  p.contact.obstacles.push_back({PlaneOptions{{0, 0, -0.02}, {0, 0, 1}}, 0.3, {}});
  p.gravity = {0, 0, -9.81};
  p.body.damping.mass = 5;
  return p;
}

TYPED_TEST(NoFalseAlarm, FallBounceAndRest) {
  Simulation<TypeParam> simulation(bouncing("single"));
  const Energies start = simulation.energies();
  advance(simulation, 1200);
  EXPECT_LT(simulation.energies().total(), start.total());
}

TYPED_TEST(NoFalseAlarm, ThrownUpwardSpinning) {
  Problem p = bouncing("single");
  p.contact.obstacles.clear();
  p.body.damping.mass = 0;
  p.body.initial.velocity = {0, 0, 3};
  p.body.initial.angular_velocity = {5, 2, 0};
  Simulation<TypeParam> simulation(p);
  advance(simulation, 400);
  EXPECT_LT(simulation.velocities()[0][2], 0);  // it came back down
}

TYPED_TEST(NoFalseAlarm, OfTheCyclesThatHold) {
  for (const char* cycle : {"rs", "rsv"}) {
    SCOPED_TRACE(cycle);
    Problem p = bouncing(cycle);
    p.body.levels = {box_mesh(decimetre, {9, 9, 9}), box_mesh(decimetre, {8, 8, 8})};
    p.body.material = {"neo_hookean", 50e3, 0.4, 1000};
    Simulation<TypeParam> simulation(p);
    advance(simulation, 150);
  }
}

// A thousand edges per macro step are nothing to a body as a whole
TYPED_TEST(NoFalseAlarm, OfAFastBodyInFlight) {
  Problem p = small_cube("corotational");
  p.body.initial.velocity = {0, 0, 1000};
  p.body.initial.angular_velocity = {0, 10, 0};
  p.gravity = {0, 0, -9.81};
  Simulation<TypeParam> simulation(p);
  advance(simulation, 100);
}

TYPED_TEST(NoFalseAlarm, OfARestingFreeBody) {
  Simulation<TypeParam> simulation(small_cube());
  advance(simulation, 300);
  EXPECT_LT(simulation.energies().kinetic, 1e-9);
}

TYPED_TEST(NoFalseAlarm, OfAStretchedBodyThatIsLetGo) {
  Problem p = small_cube("corotational");
  Simulation<TypeParam> simulation(p);
  std::vector<Point> u, v(p.body.levels[0].vertices.size(), Point::Zero());
  for (const Point& x : p.body.levels[0].vertices)
    u.push_back({0.3 * x[0], -0.1 * x[1], -0.1 * x[2]});
  simulation.set_state(u, v);
  advance(simulation, 300);
}

TYPED_TEST(NoFalseAlarm, OfAPushedBody) {
  Problem p = small_cube();
  p.body.prescribed = {{left_face(), Point(0.5, 0, 0)}};
  p.body.damping.mass = 5;
  Simulation<TypeParam> simulation(p);
  advance(simulation, 300);
}

TYPED_TEST(NoFalseAlarm, OfLargeImplicitSteps) {
  Problem p = bouncing("single");
  p.integration.integrator = {"implicit_euler"};
  p.integration.macro_step = 0.017;
  Simulation<TypeParam> simulation(p);
  advance(simulation, 60);
}

// Energy of an undamped body wavers but does not drift, and its parts add up.
TEST(Energies, AreKeptBySymplecticEuler) {
  Problem p = small_cube("st_venant_kirchhoff");
  p.body.fixed = {left_face()};
  Simulation<Host> simulation(p);
  std::vector<Point> u(p.body.levels[0].vertices.size(), Point::Zero()), v;
  for (const Point& x : p.body.levels[0].vertices) v.push_back(x[0] * Point(1, 3, -2));
  simulation.set_state(u, v);
  const double start = simulation.energies().total();
  double highest = 0, elastic = 0;
  for (int n = 0; n < 60; ++n) {
    advance(simulation, 10);
    highest = std::max(highest, std::abs(simulation.energies().total() / start - 1));
    elastic = std::max(elastic, simulation.energies().elastic / start);
  }
  EXPECT_LT(highest, 0.1);
  EXPECT_GT(elastic, 0.5);
}

// What the fuzzer of runs starts from, and what it once found, without libFuzzer

TEST(FuzzRun, IsRefusedOrDiagnosed) {
  for (const fuzz::Target& target : fuzz::run_targets) EXPECT_GE(fuzz::replay(target), 4);
}

// The seeds and findings are sound meshes, whose elements are found inverted
TEST(FuzzRun, SeedsAreStepped) {
  for (const char* kind : {"corpus", "findings"})
    for (const auto& entry : std::filesystem::directory_iterator(fuzz::folder / kind / "run")) {
      SCOPED_TRACE(entry.path().string());
      const std::string bytes = load_file(entry.path()).bytes;
      EXPECT_NO_THROW(
          fuzz::step(read_mesh(FileBytes{bytes.starts_with('#') ? "m.vtk" : "m.msh", bytes})));
    }
}

}  // namespace
