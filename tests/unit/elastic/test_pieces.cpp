// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <plica/drivers/study/level_probe.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/composite_box.hpp"
#include "support/tolerance.hpp"

// Forces and products on a mesh of two pieces, where vertices of the finer one follow the coarser
// one.
namespace {

using namespace plica;
using namespace plica::test;

Problem problem_on(const TetMesh& mesh, const std::string& element,
                   const std::string& material = "neo_hookean", double poisson_ratio = 0.3) {
  Problem p = body_of({mesh}, material);
  p.body.element = {element}, p.body.material.poisson_ratio = poisson_ratio;
  p.integration.cycle = "single", p.integration.macro_step = 1e-9;
  return p;
}

std::vector<char> follows(const TetMesh& mesh) {
  std::vector<char> mark(mesh.vertices.size(), 0);
  for (const int v : mesh.followers.vertex) mark[static_cast<std::size_t>(v)] = 1;
  return mark;
}

template <class Check>
void for_composites(const Check& check) {
  for (const bool nested : {true, false})
    for (const char* element : {"linear", "nodal"}) {
      SCOPED_TRACE(std::string(element) + (nested ? ", nested" : ", not nested"));
      check(composite_beam(nested), element);
    }
}

TEST(Pieces, HaveTheVolumeOfTheBody) {
  for (const bool nested : {true, false}) {
    const TetMesh mesh = composite_beam(nested);
    ASSERT_GT(mesh.followers.vertex.size(), 20u);
    double volume = 0;
    for (std::size_t e = 0; e < mesh.tets.size(); ++e) {
      const auto x = [&](std::size_t c) {
        return mesh.vertices[static_cast<std::size_t>(mesh.tets[e][c])];
      };
      volume += mesh.part(e) * tet_volume(x(0), x(1), x(2), x(3));
    }
    EXPECT_NEAR(volume, 4e-3, 1e-15);
    std::vector<Point> place = mesh.vertices;
    follow(mesh, place);
    EXPECT_LT(largest_difference(place, mesh.vertices), 1e-11);
  }
}

TEST(Pieces, PushEachOtherWithoutNetForceOrMoment) {
  for_composites([](const TetMesh& mesh, const char* element) {
    // nodal elements smooth their pressures at this ratio
    LevelProbe<Host> probe(problem_on(mesh, element, "neo_hookean", 0.45));
    const std::vector<Point> u = followed_field(mesh, 2e-3, 5), f = probe.force(u);
    const std::vector<char> follower = follows(mesh);
    Point sum = Point::Zero(), moment = Point::Zero();
    for (std::size_t a = 0; a < f.size(); ++a) {
      if (follower[a]) {
        EXPECT_EQ(f[a], Point(Point::Zero())) << "vertex " << a;
      }
      sum += f[a], moment += (mesh.vertices[a] + u[a]).cross(f[a]);
    }
    EXPECT_LT(sum.norm(), 1e-12 * largest(f));
    EXPECT_LT(moment.norm(), 1e-11 * largest(f));
  });
}

// Of the energy that is a function of the free vertices alone, the followers' part included
TEST(Pieces, PushAgainstTheirEnergy) {
  for_composites([](const TetMesh& mesh, const char* element) {
    LevelProbe<Host> probe(problem_on(mesh, element));
    const std::vector<Point> u = followed_field(mesh, 1e-3, 5), f = probe.force(u);
    for (unsigned seed = 1; seed < 4; ++seed) {
      const std::vector<Point> p = followed_field(mesh, 1, seed);
      const double t = 2e-7, change = probe.elastic_energy(along(u, t, p)) -
                                      probe.elastic_energy(along(u, -t, p));
      double size = 0;
      for (std::size_t a = 0; a < f.size(); ++a) size += std::abs(f[a].dot(p[a]));
      EXPECT_NEAR(change / (2 * t), -dot(f, p), 1e-6 * size);
    }
  });
}

TEST(Pieces, HaveTheStiffnessOfTheirForces) {
  for_composites([](const TetMesh& mesh, const char* element) {
    LevelProbe<Host> probe(problem_on(mesh, element));
    const std::vector<Point> u = followed_field(mesh, 1e-3, 5), p = followed_field(mesh, 1, 6),
                             q = followed_field(mesh, 1, 7);
    std::vector<Point> loose = p;  // products put followers where their masters are
    for (const int v : mesh.followers.vertex) loose[static_cast<std::size_t>(v)] = {7, 8, 9};
    const std::vector<Point> Kp = probe.stiffness(u, loose), Kq = probe.stiffness(u, q);
    EXPECT_NEAR(dot(q, Kp), dot(p, Kq), 1e-11 * std::abs(dot(p, Kp)));
    const double t = 1e-6;
    std::vector<Point> change = minus(probe.force(along(u, -t, p)), probe.force(along(u, t, p)));
    for (Point& one : change) one /= 2 * t;
    EXPECT_LT(largest_difference(change, Kp), 1e-6 * largest(Kp));
  });
}

// Where the pieces meet in faces, a linear field is without force inside, as on one mesh
TEST(Pieces, StretchAlikeWhereTheyMeetInFaces) {
  for (const char* element : {"linear", "nodal"}) {
    const TetMesh mesh = composite_beam(true);
    LevelProbe<Host> probe(problem_on(mesh, element));
    Eigen::Matrix3d F;
    F << 1.10, 0.05, 0.00, -0.02, 0.95, 0.03, 0.01, 0.00, 1.05;
    const std::vector<Point> u = affine_field(mesh, F, Point(0.01, 0, 0)), f = probe.force(u);
    const Box beam{{0, 0, 0}, {0.4, 0.1, 0.1}};
    double inside = 0;
    for (std::size_t a = 0; a < f.size(); ++a)
      if (!on_boundary(beam, mesh.vertices[a])) inside = std::max(inside, f[a].norm());
    EXPECT_GT(largest(f), 0.1) << element;
    EXPECT_LT(inside, 1e-12 * largest(f)) << element;
  }
}

/// The largest squared frequency [1/s^2], from all eigenvalues.
double largest_of(const TetMesh& mesh, const std::string& element) {
  LevelProbe<Host> probe(problem_on(mesh, element, "linear"));
  const Eigen::MatrixXd S = probe.scaled_by_mass(probe.stiffness_matrix(probe.zero()));
  const double most = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(S, Eigen::EigenvaluesOnly)
                          .eigenvalues()
                          .maxCoeff();
  // and the bound that steps are planned by is of the same matrix
  EXPECT_NEAR(probe.built.reports[0].critical_step, 2 / std::sqrt(most), 2e-3 / std::sqrt(most));
  return most;
}

TEST(Pieces, DoNotShortenTheStep) {
  for (const bool nested : {true, false})
    for (const char* element : {"linear", "nodal"}) {
      const TetMesh mesh = composite_beam(nested, 1);
      TetMesh apart = mesh;  // two bodies in one room
      apart.followers = {};
      EXPECT_LE(largest_of(mesh, element), (1 + 1e-9) * largest_of(apart, element)) << element;
    }
}

TEST(Pieces, HaveAllTheMassOnFreeVertices) {
  for_composites([](const TetMesh& mesh, const char* element) {
    LevelProbe<Host> probe(problem_on(mesh, element));
    const std::vector<double> m = probe.mass(), inverse = probe.inverse_mass();
    const std::vector<char> follower = follows(mesh);
    double sum = 0;
    Point first = Point::Zero();  // first moment: the centre of mass stays where it is
    for (std::size_t a = 0; a < m.size(); ++a) {
      sum += m[a], first += m[a] * mesh.vertices[a];
      EXPECT_EQ(m[a] > 0, !follower[a]) << "vertex " << a;
      EXPECT_NEAR(m[a] * inverse[a], follower[a] ? 0 : 1, 1e-15);
    }
    EXPECT_NEAR(sum, 4, 1e-13);
    EXPECT_LT((first - sum * Point(0.2, 0.05, 0.05)).norm(), 2e-3 * sum);
  });
}

}  // namespace
