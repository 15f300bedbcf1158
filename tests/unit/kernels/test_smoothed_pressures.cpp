// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <plica/drivers/elastic/materials.hpp>
#include <plica/drivers/study/level_probe.hpp>
#include <plica/kernels/elastic/nodal_elements.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/gradients.hpp"
#include "support/tolerance.hpp"

// Smoothed pressures of nodal elements: they keep the chosen law of volume.
namespace {

using namespace plica;
using namespace plica::test;

/// test(problem) for each law that can be smoothed and each law of volume that it can have. The
/// cube has two regions.
template <class Test>
void for_each_law(const Test& test) {
  for_each_material_name([&](const std::string& material) {
    const MaterialInfo& info = *find_material(material);
    if (!info.smooths_dilatation) return;
    for (const std::string& volume : names(volumes())) {
      if (!info.of_tissue && volume != names(volumes()).front()) continue;
      SCOPED_TRACE(volume);
      Problem p = small_cube(material, 2);
      p.body.levels[0] = with_regions(p.body.levels[0], 0.05, "left", "right");
      p.body.element = {"nodal"}, p.body.pressure = "smoothed";
      if (info.of_tissue) p.body.material.volume = volume;
      p.body.material.poisson_ratio = 0.49;
      test(p);
    }
  });
}

/// Of a displacement field, stretched in every direction and turned besides.
std::vector<Point> stretched(const TetMesh& mesh, const Point& stretches, double disorder = 0) {
  std::mt19937 random(5);
  const Eigen::Matrix3d F =
      random_rotation(random) * stretches.asDiagonal() * random_rotation(random);
  return along(affine_field(mesh, F, {0.01, -0.02, 0.03}), 1,
               random_field(mesh.vertices.size(), disorder, 1));
}

TEST(SmoothedPressures, ChangeNoHomogeneousState) {
  for_each_law([](Problem p) {
    LevelProbe<Host> smoothed(p);
    ASSERT_GT(smoothed.at(0).model.rows.bulk_excess.extent(0), 0u);
    p.body.pressure = "plain";
    LevelProbe<Host> plain(p);
    for (const Point& stretches :
         {Point(1.3, 0.9, 0.95), Point(1.1, 1.05, 1.15), Point(0.8, 1, 1)}) {
      const auto u = stretched(p.body.levels[0], stretches);
      const auto want = plain.force(u);
      EXPECT_GT(largest(want), 1e-3);
      EXPECT_LE(largest_difference(smoothed.force(u), want), 1e-11 * largest(want));
      const double energy = plain.elastic_energy(u);
      EXPECT_NEAR(smoothed.elastic_energy(u), energy, 1e-11 * energy);
    }
  });
}

TEST(SmoothedPressures, ForceAndTangentAreDerivativesFarFromRest) {
  for_each_law([](const Problem& problem) {
    LevelProbe<Host> probe(problem);
    const auto u = stretched(problem.body.levels[0], {1.15, 1.05, 0.95}, 0.002),
               p = random_field(probe.vertices(), 0.003, 2);
    const double h = 1e-3;
    const auto slope = [&](double t) {
      return (probe.elastic_energy(along(u, t, p)) - probe.elastic_energy(along(u, -t, p))) /
             (2 * t);
    };
    const double work = -dot(probe.force(u), p);
    EXPECT_NEAR(work, (4 * slope(h / 2) - slope(h)) / 3, 1e-6 * std::abs(work));
    const auto change = [&](double t) {
      auto d = minus(probe.force(along(u, -t, p)), probe.force(along(u, t, p)));
      for (Point& x : d) x /= 2 * t;
      return d;
    };
    auto want = change(h);
    const auto half = change(h / 2), Kp = probe.stiffness(u, p);
    for (std::size_t a = 0; a < want.size(); ++a) want[a] = (4 * half[a] - want[a]) / 3;
    EXPECT_LE(largest_difference(Kp, want), 1e-6 * largest(Kp));
    const Eigen::MatrixXd K = probe.stiffness_matrix(u);
    EXPECT_LE((K - K.transpose()).cwiseAbs().maxCoeff(),
              round_off<double>(1e3, K.cwiseAbs().maxCoeff()));
  });
}

/// Gives a level the place for mixed dilatations, which stages of implicit steps have. Returns
/// them.
Scalars<Host> make_mixed(Level<Host>& level) {
  const auto slots = static_cast<std::size_t>(level.model.rows.slots());
  level.nodal.pressure = zeros<Scalars<Host>>("test.pressure", 3 * slots);
  return carried_dilatations<Host>(level.model.rows, level.nodal);
}

// Where the mixed dilatations are those of the state, the tangent is Newton's, and the augmented
// potential has the energy's slope.
TEST(SmoothedPressures, MixedDilatationsOfTheStateChangeNothing) {
  for_each_law([](const Problem& problem) {
    LevelProbe<Host> probe(problem);
    Level<Host>& level = probe.at(0);
    const auto u = stretched(problem.body.levels[0], {1.15, 1.05, 0.95}, 0.002),
               p = random_field(probe.vertices(), 0.003, 2);
    const auto force = probe.force(u), Kp = probe.stiffness(u, p);
    make_mixed(level);
    level.elasticity().carry_dilatations(level.exec(), level, device_field<Host>(u),
                                         device_field<Host>(probe.zero()));
    EXPECT_LE(largest_difference(probe.stiffness(u, p), Kp), 1e-11 * largest(Kp));
    const double h = 1e-3;
    const auto slope = [&](double t) {
      return (probe.elastic_energy(along(u, t, p)) - probe.elastic_energy(along(u, -t, p))) /
             (2 * t);
    };
    const double work = -dot(force, p);
    EXPECT_NEAR(work, (4 * slope(h / 2) - slope(h)) / 3, 1e-6 * std::abs(work));
  });
}

// A solve foresees the dilatations of its end up to the square of the change.
TEST(SmoothedPressures, ForeseenDilatationsAreOfFirstOrder) {
  for_each_law([](const Problem& problem) {
    LevelProbe<Host> probe(problem);
    Level<Host>& level = probe.at(0);
    const Scalars<Host> mixed = make_mixed(level);
    const auto start = stretched(problem.body.levels[0], {1.1, 0.95, 1}, 0.002),
               way = random_field(probe.vertices(), 0.003, 2);
    const auto miss = [&](double t) {
      const auto u = device_field<Host>(along(start, t, way)),
                 du = device_field<Host>(along(probe.zero(), t, way));
      level.elasticity().carry_dilatations(level.exec(), level, u, du);
      const std::vector<double> foreseen = host_values(Host::Exec(), mixed);
      level.elasticity().carry_dilatations(level.exec(), level, u,
                                           device_field<Host>(probe.zero()));
      const std::vector<double> found = host_values(Host::Exec(), mixed);
      double most = 0;
      for (std::size_t i = 0; i < found.size(); ++i)
        most = std::max(most, std::abs(found[i] - foreseen[i]));
      return most;
    };
    EXPECT_GT(miss(1), 1e-6);
    EXPECT_NEAR(miss(0.1) / miss(0.05), 4, 0.3);
  });
}

// Tetrahedra that are held give their vertices no part of the strain of free ones: nodal elements
// on a held block are those on the free part alone, clamped where the two meet.
TEST(NodalElements, AreNoSofterWhereWholeTetrahedraAreHeld) {
  const Box whole{{0, 0, -0.1}, {0.1, 0.1, 0.1}};
  const TetMesh mesh = box_mesh(whole, {2, 2, 4});
  TetMesh part;
  std::vector<int> number(mesh.vertices.size(), -1);
  std::vector<std::size_t> from;
  for (std::size_t a = 0; a < mesh.vertices.size(); ++a)
    if (mesh.vertices[a][2] > -1e-9) {
      number[a] = static_cast<int>(from.size());
      from.push_back(a), part.vertices.push_back(mesh.vertices[a]);
    }
  for (const auto& t : mesh.tets)
    if (std::ranges::all_of(t, [&](int v) { return number[static_cast<std::size_t>(v)] >= 0; })) {
      auto& own = part.tets.emplace_back();
      for (std::size_t k = 0; k < 4; ++k) own[k] = number[static_cast<std::size_t>(t[k])];
    }
  const auto body = [&](const TetMesh& of) {
    Problem p = body_of({of}, "neo_hookean");
    p.body.element = {"nodal"};
    p.body.fixed = {Box{{-1, -1, -1}, {1, 1, 1e-9}}};
    return p;
  };
  LevelProbe<Host> held(body(mesh)), free(body(part));
  auto u_free = random_field(from.size(), 0.004, 1);
  auto u = held.zero();
  for (std::size_t i = 0; i < from.size(); ++i) {
    if (part.vertices[i][2] < 1e-9) u_free[i] = Point::Zero();
    u[from[i]] = u_free[i];
  }
  const auto got = held.force(u), want = free.force(u_free);
  EXPECT_GT(largest(want), 0.01);
  for (std::size_t i = 0; i < from.size(); ++i)
    EXPECT_LE((got[from[i]] - want[i]).norm(), 1e-11 * largest(want)) << i;
  EXPECT_NEAR(held.elastic_energy(u), free.elastic_energy(u_free),
              1e-11 * free.elastic_energy(u_free));
}

}  // namespace
