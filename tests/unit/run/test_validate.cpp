// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <plica/core/error.hpp>
#include <plica/drivers/body/selection.hpp>
#include <plica/drivers/run/validate.hpp>
#include <plica/drivers/study/level_probe.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/files/mesh_files.hpp>
#include <plica/meshes/generators.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/refusal.hpp"
#include "support/simulate.hpp"
#include "support/tolerance.hpp"

// Every option out of its range is refused by its name, with the value and what is expected.
namespace {

using namespace plica;
using namespace plica::test;

struct Bad {
  std::function<void(Problem&)> change;
  std::vector<std::string> says;
};

const double nan = std::numeric_limits<double>::quiet_NaN(),
             infinite = std::numeric_limits<double>::infinity();

const std::vector<Bad> bad_problems = {
    {[](Problem& p) { p.body.levels.clear(); }, {"body.levels", "at least one mesh"}},
    {[](Problem& p) { p.body.levels[0].tets.clear(); }, {"level 0 has no tetrahedron"}},
    {[](Problem& p) { p.body.material.model = "neohookean"; },
     {"neohookean", "did you mean 'neo_hookean'?"}},
    {[](Problem& p) { p.body.material.young_modulus = -1; },
     {"body.material.young_modulus is -1 Pa", "expected a pressure (Pa) in [1e-06, 1e+15] Pa"}},
    {[](Problem& p) { p.body.material.young_modulus = nan; }, {"body.material.young_modulus is"}},
    {[](Problem& p) { p.body.material.poisson_ratio = 0.5; },
     {"body.material.poisson_ratio is 0.5", "in [0, 0.5)"}},
    {[](Problem& p) { p.body.material.density = 0; }, {"body.material.density is 0"}},
    {[](Problem& p) { p.body.material.density = infinite; }, {"body.material.density is inf"}},
    {[](Problem& p) { p.body.regions["fat"]; }, {"unknown region 'fat'"}},
    {[](Problem& p) { p.body.damping.mass = -2; }, {"body.damping.mass is -2"}},
    {[](Problem& p) { p.gravity[1] = infinite; }, {"gravity is inf"}},
    {[](Problem& p) { p.body.initial.velocity[2] = nan; }, {"body.initial.velocity"}},
    {[](Problem& p) { p.body.initial.position = Point(nan, 0, 0); }, {"body.initial.position"}},
    {[](Problem& p) {
       p.body.initial.twist = TwistOptions{{1, 0, 0}, {1, 0, 0}, 3};
     },
     {"body.initial.twist.to, as a distance from .from, is 0"}},
    {[](Problem& p) {
       p.body.initial.twist = TwistOptions{{1, 0, 0}, {2, 0, 0}, nan};
     },
     {"body.initial.twist.angular_velocity is"}},
    {[](Problem& p) {
       p.body.initial.parts.push_back({BallSelection{{0, 0, 0}, -1}, {0, 0, 0}});
     },
     {"body.initial.parts.0.sphere.radius is -1"}},
    {[](Problem& p) {
       p.body.initial.parts.push_back({BallSelection{{0, 0, 0}, 1}, {0, nan, 0}});
     },
     {"body.initial.parts.0.velocity is"}},
    {[](Problem& p) { p.integration.cycle = "rsvv"; }, {"did you mean 'rsv'?"}},
    {[](Problem& p) { p.integration.distribution = "equl"; }, {"did you mean 'equal'?"}},
    {[](Problem& p) { p.integration.integrator = {"rk44"}; }, {"did you mean 'rk4'?"}},
    {[](Problem& p) { p.integration.integrator = {}; },
     {"integration.integrator: expected one for all or one for each level (1 in body.levels), got "
      "a list of 0"}},
    {[](Problem& p) {
       p.integration.substeps = {1, 2, 3};
     },
     {"integration.substeps: expected one for all or one for each level (1 in body.levels), got a "
      "list of 3"}},
    {[](Problem& p) { p.integration.substeps = {-1}; }, {"integration.substeps is -1"}},
    {[](Problem& p) { p.integration.macro_step = 0; }, {"integration.macro_step is 0"}},
    {[](Problem& p) { p.integration.shift_to_coarsest = 1; },
     {"integration.shift_to_coarsest is 1"}},
    {[](Problem& p) { p.integration.safety = 1.1; }, {"integration.safety is 1.1"}},
    {[](Problem& p) { p.integration.switch_threshold = 0; }, {"integration.switch_threshold is 0"}},
    {[](Problem& p) { p.integration.outside = "clip"; }, {"clip", "clamp"}},
    {[](Problem& p) { p.integration.implicit.relative_residual = 1; },
     {"integration.implicit.relative_residual is 1"}},
    {[](Problem& p) { p.integration.implicit.max_iterations = 0; },
     {"integration.implicit.max_iterations is 0"}},
    {[](Problem& p) { p.integration.implicit.newton_iterations = -1; },
     {"newton_iterations is -1"}},
    {[](Problem& p) {
       p.contact.obstacles.push_back({SphereOptions{}, {}, {}});
     },
     {"no surface"}},
    {[](Problem& p) { p.contact.stiffness_scale = 0; }, {"contact.stiffness_scale is 0"}},
    {[](Problem& p) { p.contact.damping_scale = -1; }, {"contact.damping_scale is -1"}},
};

std::string refusal_of(const Problem& p) {
  return refusal([&] { validate(p); });
}

TEST(Validate, AcceptsTheDefaults) { EXPECT_EQ(refusal_of(small_cube()), ""); }

TEST(Validate, NamesEveryBadOption) {
  for (const Bad& bad : bad_problems) {
    Problem p = small_cube();
    bad.change(p);
    const std::string text = refusal_of(p);
    for (const std::string& part : bad.says)
      EXPECT_NE(text.find(part), std::string::npos) << part << " not in: " << text;
  }
}

TEST(Validate, ChecksTheMeshesOfACaller) {
  const auto after = [](const std::function<void(TetMesh&)>& poison) {
    Problem p = small_cube();
    poison(p.body.levels[0]);
    return refusal_of(p);
  };
  EXPECT_EQ(after([](TetMesh& m) { m.tets[3][0] = 100000; }),
            "body.levels: level 0: tetrahedron 3 has vertex 100000 of 64");
  EXPECT_EQ(after([](TetMesh& m) { m.tets[3][0] = -1; }),
            "body.levels: level 0: tetrahedron 3 has vertex -1 of 64");
  EXPECT_EQ(after([](TetMesh& m) { m.vertices[5][1] = nan; }),
            "body.levels: level 0: vertex 5 is not at a finite place");
  EXPECT_EQ(
      after([](TetMesh& m) { std::swap(m.tets[7][0], m.tets[7][1]); }),
      "body.levels: level 0: tetrahedron 7 is flat or inside out; expected a positive volume");
  EXPECT_EQ(after([](TetMesh& m) { m.vertices.emplace_back(9, 9, 9); }),
            "body.levels: level 0: no tetrahedron has vertex 64");
  EXPECT_EQ(after([](TetMesh& m) { m.region = {0}; }),
            "body.levels: level 0 has regions for 1 of 162 tetrahedra; expected all or none");
  EXPECT_EQ(after([](TetMesh& m) {
              m.region.assign(m.tets.size(), 2), m.region_names = {"a", "b"};
            }),
            "body.levels: level 0: tetrahedron 0 is in region 2 of 2");
}

TEST(Validate, DoubtsLevelsThatDoNotCoarsen) {
  EXPECT_TRUE(other_doubts(cube_levels(3, 4, "rs")).empty());
  Problem p = cube_levels(3, 4, "rs");
  p.body.levels[1] = p.body.levels[0];
  ASSERT_EQ(other_doubts(p).size(), 1);
  EXPECT_EQ(other_doubts(p)[0],
            "body.levels: level 1 is not coarser than level 0: 384 tetrahedra after 384; expected "
            "the finest first");
  std::swap(p.body.levels[0], p.body.levels[2]);
  EXPECT_EQ(other_doubts(p).size(), 2);  // 2, 4 and 4 cells a side
}

TEST(Validate, DoubtsPathsThatStartElsewhere) {
  Problem p = small_cube();
  p.body.prescribed = {{left_face(), PathMotion{{{0.1, {0, 0, 1e-3}}}}}};
  ASSERT_EQ(other_doubts(p).size(), 1);
  EXPECT_EQ(
      other_doubts(p)[0],
      "body.prescribed.0.curve does not start at [0, 0, 0]: the vertices jump there at the start");
}

TEST(Validate, ChecksMotionsLoadsAndSelections) {
  const Box all{{0, 0, 0}, {1, 1, 1}};
  const auto motion = [&](const Motion& m) {
    Problem p = small_cube();
    p.body.prescribed = {{all, m}};
    return refusal_of(p);
  };
  EXPECT_EQ(motion(PathMotion{{{0, {0, 0, 0}}, {1, {0, 0, 1}}}}), "");
  EXPECT_EQ(motion(PathMotion{}), "body.prescribed.0.curve is empty; expected at least one time");
  EXPECT_EQ(motion(PathMotion{{{0.5, {0, 0, 0}}, {0.5, {0, 0, 1}}}}),
            "body.prescribed.0.curve.1.time is 0.5 s; expected a time after that of the entry "
            "before, 0.5 s");
  EXPECT_EQ(motion(PathMotion{{{-1, {0, 0, 0}}}}),
            "body.prescribed.0.curve.0.time is -1 s; expected a time (s) >= 0");
  EXPECT_EQ(motion(PathMotion{{{0, {nan, 0, 0}}}}).substr(0, 42),
            "body.prescribed.0.curve.0.displacement is ");
  EXPECT_EQ(motion(SineMotion{{1, 0, 0}, 0, 0}),
            "body.prescribed.0.sine.frequency is 0 1/s; expected a rate (1/s) > 0");
  const auto load = [&](const LoadOptions& o) {
    Problem p = small_cube();
    p.body.loads = {o};
    return refusal_of(p);
  };
  EXPECT_EQ(load({all, Traction{{1, 0, 0}}, {}}), "");
  EXPECT_EQ(load({all, Traction{{nan, 0, 0}}, {}}).substr(0, 25), "body.loads.0.traction is ");
  EXPECT_EQ(load({all, TotalForce{}, RampCourse{0}}),
            "body.loads.0.ramp is 0 s; expected a time (s) > 0");
  PolygonCourse backwards;
  backwards.knots.resize(2);
  backwards.knots[0].time = 1;
  EXPECT_EQ(
      load({all, TotalForce{}, backwards}),
      "body.loads.0.curve.1.time is 0 s; expected a time after that of the entry before, 1 s");
  EXPECT_NE(load({BallSelection{{0, 0, 0}, -1}, TotalForce{}, {}})
                .find("body.loads.0.sphere.radius is -1"),
            std::string::npos);
  EXPECT_NE(load({HalfSpaceSelection{{0, 0, 0}, {0, 0, 0}}, TotalForce{}, {}})
                .find("body.loads.0.half_space.normal is [0, 0, 0]; expected a direction"),
            std::string::npos);
  EXPECT_NE(load({Box{{0, 1, 0}, {1, 0, 1}}, TotalForce{}, {}})
                .find("body.loads.0.box.min is [0, 1, 0] m; expected at most max, [1, 0, 1] m"),
            std::string::npos);
}

TEST(Validate, ContactNeedsASurfaceWithAnArea) {
  Problem p = small_cube();
  p.body.surface = TriangleSurface{{{0, 0, 0}}, {}};
  EXPECT_EQ(refusal_of(p), "");
  p.contact.obstacles = {{PlaneOptions{}, {}, {}}};
  EXPECT_NE(refusal_of(p).find("no triangle"), std::string::npos);
}

TEST(Validate, ASurfaceObstacleIsClosedAndLooksOutwards) {
  const auto with = [](TriangleSurface surface, int cells = 0) {
    Problem p = small_cube();
    p.body.surface = TriangleSurface{{{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}}, {{0, 1, 2}}};
    p.contact.obstacles = {{SurfaceOptions{std::move(surface), cells}, {}, {}}};
    return refusal_of(p);
  };
  TriangleSurface ball = sphere_surface({0, 0, 0}, 1, 1);
  EXPECT_EQ(with(ball), "");
  EXPECT_NE(with(ball, 3).find("surface.cells is 3"), std::string::npos);
  EXPECT_NE(with({}).find("has no triangle"), std::string::npos);
  TriangleSurface open = ball, mixed = ball, inside_out = ball, wild = ball;
  open.triangles.pop_back();
  EXPECT_NE(with(open).find("of its edges 3 are open"), std::string::npos) << with(open);
  std::swap(mixed.triangles[0][0], mixed.triangles[0][1]);
  EXPECT_NE(with(mixed).find("3 between triangles that face different sides"), std::string::npos)
      << with(mixed);
  for (auto& t : inside_out.triangles) std::swap(t[0], t[1]);
  EXPECT_NE(with(inside_out).find("contact.obstacles.0.surface, as an enclosed volume, is -"),
            std::string::npos);
  wild.triangles[0][0] = 42;
  EXPECT_NE(with(wild).find("triangle's vertex is 42; expected a whole number in [0, 41]"),
            std::string::npos)
      << with(wild);
}

TEST(Validate, ObstaclesHaveNamesThatDiffer) {
  const auto with = [](const std::string& first, const std::string& second) {
    Problem p = small_cube();
    p.body.surface = sphere_surface({0.05, 0.05, 0.05}, 0.04, 1);
    p.contact.obstacles = {{PlaneOptions{}, {}, {}, first}, {PlaneOptions{}, {}, {}, second}};
    return refusal([&] { validate(p); });
  };
  EXPECT_EQ(with("", ""), "");
  EXPECT_EQ(with("tool", "floor"), "");
  EXPECT_NE(
      with("tool", "tool").find("contact.obstacles.1.name is 'tool', as is that of obstacle 0"),
      std::string::npos);
  EXPECT_NE(with("", "obstacle_0").find("expected names that differ"), std::string::npos);
  EXPECT_NE(with("a,b", "").find("expected no comma"), std::string::npos);
}

TEST(Validate, ChecksObstacles) {
  const auto with = [](ObstacleOptions o) {
    Problem p = small_cube();
    p.body.surface = TriangleSurface{{{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}}, {{0, 1, 2}}};
    p.contact.obstacles = {std::move(o)};
    return refusal_of(p);
  };
  EXPECT_EQ(with({PlaneOptions{}, 0.3, {}}), "");
  EXPECT_EQ(with({BowlOptions{{0, 0, 0}, 1, 0}, {}, {}}), "");
  EXPECT_NE(with({PlaneOptions{{0, 0, 0}, {0, 0, 0}}, {}, {}}).find("normal"), std::string::npos);
  EXPECT_NE(with({SphereOptions{{0, 0, 0}, -1}, {}, {}}).find("radius is -1"), std::string::npos);
  EXPECT_NE(with({BowlOptions{{0, 0, 0}, 1, 1.5}, {}, {}}).find("rim is 1.5"), std::string::npos);
  EXPECT_NE(with({PlaneOptions{}, -0.1, {}}).find("friction is -0.1"), std::string::npos);
  EXPECT_EQ(with({CapsuleOptions{{0, 0, 0}, {0, 0, 1}, 0.05}, {}, {}}), "");
  EXPECT_NE(with({CapsuleOptions{{0, 0, 1}, {0, 0, 1}, 1}, {}, {}})
                .find(".capsule.to, as a distance from .from, is 0"),
            std::string::npos);
  EXPECT_NE(with({CylinderOptions{{0, 0, 0}, {0, 0, 1}, 0}, {}, {}}).find("cylinder.radius is 0"),
            std::string::npos);
  EXPECT_NE(with({BlockOptions{{0, 0, 0}, {1, -1, 1}, {0, 0, 0}}, {}, {}}).find("box.size is -1"),
            std::string::npos);
  EXPECT_NE(with({PlaneOptions{}, {}, Point(nan, 0, 0)}).find("contact.obstacles.0.velocity"),
            std::string::npos);
}

TEST(Validate, DoubtsElementsThatAreTooStiff) {
  const auto said = [](const std::string& element, double poisson,
                       const std::array<int, 3>& cells) {
    Problem p = body_of({box_mesh({{0, 0, 0}, {1, 0.05, 0.05}}, cells)});
    p.body.element = {element}, p.body.material.poisson_ratio = poisson;
    const auto all = problem_warnings(p);
    return all.empty() ? std::string() : all.front();
  };
  EXPECT_EQ(said("linear", 0.45, {80, 4, 4}),
            "body.element: level 0 has linear elements, about 3.9 across its thickness, at nu "
            "0.45; a slender beam of these "
            "bends 0.61 of what it should, of nodal elements 0.97: expected body.element: nodal");
  EXPECT_NE(said("linear", 0.3, {40, 2, 2}).find("bends 0.4"), std::string::npos)
      << "for its few elements";
  EXPECT_EQ(said("linear", 0.3, {180, 9, 9}), "");
  EXPECT_EQ(said("nodal", 0.45, {40, 2, 2}), "");
  EXPECT_NE(said("nodal", 0.45, {20, 1, 1}).find("expected a finer mesh"), std::string::npos);
}

// Long steps let a vertex slip late off a tool that is narrower than an edge.
TEST(Validate, DoubtsNarrowToolsInLongSteps) {
  const auto said = [](const ShapeOptions& shape, const std::function<void(Problem&)>& change) {
    Problem p = body_of({box_mesh({{0, 0, 0}, {0.1, 0.1, 0.1}}, {8, 8, 8})});  // edges of 16 mm
    p.body.element = {"nodal"};
    p.contact.obstacles = {{shape, {}, SteadyMotion(Point(0.1, 0, 0))}};
    change(p);
    const auto all = problem_warnings(p);
    return all.empty() ? std::string() : all.front();
  };
  const auto implicit = [](Problem& p) { p.integration.integrator = {"implicit_euler"}; };
  const auto him = [](Problem& p) { p.integration.cycle = "him"; };
  const Point above(0.05, 0.05, 0.2), top(0.05, 0.05, 0.4);
  const ShapeOptions narrow = CapsuleOptions{above, top, 2e-3},
                     wide = CapsuleOptions{above, top, 0.03};
  EXPECT_EQ(said(narrow, implicit).find("contact.obstacles.0: its radius of 2 mm is below"), 0u);
  EXPECT_EQ(said(narrow, him).find("contact.obstacles.0: its radius of 2 mm is below"), 0u);
  EXPECT_NE(said(ConeOptions{above, top, 0.03, 1e-3}, him).find("radius of 1 mm"),
            std::string::npos);
  EXPECT_EQ(said(wide, him), "");
  EXPECT_EQ(said(narrow, [](Problem&) {}), "") << "explicit steps are short";
  EXPECT_EQ(said(narrow,
                 [&](Problem& p) {
                   him(p);
                   p.contact.obstacles.front().motion = SteadyMotion(Point::Zero());
                 }),
            "")
      << "nothing is drawn along";
}

// A strip of one cell, of which every vertex lies on the surface; not organs with thin borders.
TEST(Validate, DoubtsOneNodalElementAcross) {
  const auto said = [](const TetMesh& mesh) {
    Problem p = body_of({mesh});
    p.body.element = {"nodal"}, p.body.material.poisson_ratio = 0.45;
    const auto all = problem_warnings(p);
    return all.empty() ? std::string() : all.front();
  };
  const Box strip{{0, 0, 0}, {0.4, 0.08, 0.01}};
  EXPECT_EQ(said(jittered_box(strip, {40, 8, 1})),
            "body.element: level 0 has nodal elements, about 1 across its thickness, at nu 0.45; a "
            "slender beam of these bends 0.66 of what it should: expected a finer mesh");
  const TetMesh tall = jittered_box({strip.min, Point(0.4, 0.08, 0.03)}, {40, 8, 1});
  EXPECT_NE(said(tall).find("about 1 across"), std::string::npos);
  EXPECT_EQ(said(jittered_box(strip, {40, 8, 2})), "");
  EXPECT_EQ(said(jittered_box(decimetre, {2, 2, 2})), "");
  for (const char* organ : {"liver_coarse.msh", "organs/liver.vtk", "organs/branch.vtk"})
    EXPECT_EQ(said(read_mesh(std::string(PLICA_SOURCE_DIR "/meshes/data/") + organ)), "") << organ;
  // Of two regions, each of one cell, none averages across the other
  TetMesh layers = box_mesh({strip.min, Point(0.02, 0.08, 0.4)}, {2, 8, 40});
  EXPECT_EQ(said(layers), "");
  const TetMesh skin_and_fat = with_regions(layers, 0.01, "skin", "fat");
  EXPECT_NE(said(skin_and_fat).find("about 1 across"), std::string::npos);
}

// Nodal elements average within a region. A file whose numbers of cells were taken for regions
// gives each its own, and they are linear ones.
TEST(Validate, DoubtsMoreRegionsThanNodalElementsBear) {
  const auto said = [](const std::string& element, std::size_t regions) {
    TetMesh mesh = box_mesh(decimetre, {6, 6, 6});  // 1296 tetrahedra
    for (std::size_t r = 0; r < regions; ++r) mesh.region_names.push_back("r" + std::to_string(r));
    for (std::size_t e = 0; e < mesh.tets.size(); ++e)
      mesh.region.push_back(static_cast<int>(e % regions));
    Problem p = body_of({mesh});
    p.body.element = {element};
    const auto all = other_doubts(p);
    return all.empty() ? std::string() : all.front();
  };
  EXPECT_EQ(said("nodal", 13),
            "body.levels.0: 13 regions for 1296 tetrahedra; nodal elements average within a "
            "region, so these are as stiff as linear ones; expected a region for 100 tetrahedra or "
            "more");
  EXPECT_EQ(said("nodal", 12), "");
  EXPECT_EQ(said("linear", 13), "");
}

TEST(Validate, ElementsArePerLevelAndKnown) {
  Problem p = cube_levels(2, 3, "rs");
  p.body.element = {"linear", "nodal"};
  EXPECT_NO_THROW(validate(p));
  p.body.element = {"linear", "nodal", "nodal"};
  EXPECT_NE(refusal_of(p).find("expected one name, or one for each of 2 levels"),
            std::string::npos);
  p.body.element = {"nodl"};
  EXPECT_NE(refusal_of(p).find("did you mean 'nodal'"), std::string::npos);
  p.body.element = {"nodal"}, p.body.stabilisation = 0.1;
  EXPECT_NE(refusal_of(p).find("body.stabilisation"), std::string::npos);
  p.body.stabilisation = 0.4, p.body.pressure = "smoothed", p.body.material.model = "linear";
  EXPECT_NE(refusal_of(p).find("no stiffness for the volume alone"), std::string::npos);
}

}  // namespace
