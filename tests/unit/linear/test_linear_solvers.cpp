// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <plica/core/error.hpp>
#include <plica/drivers/linear/list.hpp>
#include <plica/drivers/linear/make_linear_solver.hpp>
#include <plica/drivers/run/validate.hpp>
#include <plica/drivers/study/level_probe.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/kernels/materials/list.hpp>
#include <plica/meshes/generators.hpp>

#include "support/backends.hpp"
#include "support/bodies.hpp"
#include "support/refusal.hpp"
#include "support/tolerance.hpp"

// What solves the systems of implicit stages, against dense algebra.
namespace {

using namespace plica;
using namespace plica::test;

/// A deformed cube, clamped, in contact, on three meshes.
Problem pressed(const std::string& material, int cells = 4) {
  Problem p = cube_levels(3, cells, "single");
  p.body.material.model = material;
  p.body.material = complete(p.body.material);
  p.body.fixed = {left_face()};
  p.body.damping.mass = 3;
  p.body.surface = sphere_surface({0.05, 0.05, 0.05}, 0.045, 1);
  p.contact.obstacles.push_back({PlaneOptions{{0, 0, 0.02}, {0, 0, 1}}, 0.3, {}});
  p.integration.integrator = {"implicit_euler"};
  p.integration.macro_step = 0.01;
  p.integration.implicit.max_iterations = 1000;
  return p;
}

/// The system of a step of 10 ms of such a body at a random state.
template <class B>
struct StageCase {
  using Exec = typename B::Exec;
  Problem problem;
  LevelProbe<B> probe;
  State<B> state;
  ImplicitWeights weights{1e-4, 1e-2};

  explicit StageCase(const Problem& p) : problem(p), probe(p) {
    auto u = random_field(probe.vertices(), 0.0015, 1);
    const auto inverse = probe.inverse_mass();
    for (std::size_t a = 0; a < u.size(); ++a)
      if (inverse[a] == 0) u[a].setZero();
    state = State<B>(device_field<B>(u), device_field<B>(probe.zero()));
    level().linearise(state, 0, weights, 0, level().f);
  }
  Level<B>& level() { return probe.at(0); }
  const Exec& exec() { return probe.built.hierarchy->exec(); }

  std::vector<Point> random_right_side() {
    auto r = random_field(probe.vertices(), 1e-3, 5);
    const auto inverse = probe.inverse_mass();
    for (std::size_t a = 0; a < r.size(); ++a)
      if (inverse[a] == 0) r[a].setZero();
    return r;
  }
  std::vector<Point> product(const std::vector<Point>& p) {
    Vectors<B> q("test.q", p.size());
    level().product(state, device_field<B>(p), weights, false, q);
    return free_part(to_host<B>(exec(), q));
  }
  std::vector<Point> free_part(std::vector<Point> q) {
    const auto inverse = probe.inverse_mass();
    for (std::size_t a = 0; a < q.size(); ++a)
      if (inverse[a] == 0) q[a].setZero();
    return q;
  }
  LinearSolverParts parts(const std::string& solver, const std::string& preconditioner,
                          const std::string& matrix, double residual) {
    Problem p = problem;
    ImplicitOptions& o = p.integration.implicit;
    o.solver = solver, o.preconditioner = preconditioner, o.matrix = matrix,
    o.relative_residual = residual;
    validate(p);
    return linear_solver_parts(p, 0, B::on_host, solver);
  }
  SolveOutcome solve(const LinearSolverParts& chosen, const std::vector<Point>& r,
                     std::vector<Point>& x) {
    const auto solver = make_linear_solver<B>(chosen, level());
    solver->prepare(level(), state, weights, false);
    Vectors<B> answer("test.x", r.size());
    const SolveOutcome out =
        solver->solve(exec(), device_field<B>(r), answer, chosen.options.relative_residual);
    x = to_host<B>(exec(), answer);
    Archive<B> archive;
    solver->name_fields(archive);
    EXPECT_GT(archive.measured(), 0U);
    return out;
  }
};

struct Chosen {
  const char *solver, *preconditioner, *matrix;
};
constexpr Chosen all_chosen[] = {{"direct", "auto", "auto"},
                                 {"conjugate_gradients", "block_jacobi", "free"},
                                 {"conjugate_gradients", "block_jacobi", "assembled"},
                                 {"conjugate_gradients", "chebyshev", "free"},
                                 {"conjugate_gradients", "chebyshev", "assembled"},
                                 {"conjugate_gradients", "multigrid", "free"},
                                 {"conjugate_gradients", "multigrid", "assembled"}};

template <class B>
class LinearSolversOn : public testing::Test {};
TYPED_TEST_SUITE(LinearSolversOn, EachBackend);

TYPED_TEST(LinearSolversOn, FindWhatTheMatrixTakesToTheRightSide) {
  using Real = typename TypeParam::Real;
  const double residual = sizeof(Real) == sizeof(double) ? 1e-11 : 1e-5;
  Materials::for_each([&](auto material) {
    StageCase<TypeParam> stage(pressed(material.name));
    const auto r = stage.random_right_side();
    for (const Chosen& chosen : all_chosen) {
      if (!TypeParam::on_host && chosen.solver == std::string("direct")) continue;
      SCOPED_TRACE(std::string(material.name) + " " + chosen.solver + " " + chosen.preconditioner +
                   " " + chosen.matrix);
      std::vector<Point> x;
      const SolveOutcome out = stage.solve(
          stage.parts(chosen.solver, chosen.preconditioner, chosen.matrix, residual), r, x);
      EXPECT_TRUE(out.converged);
      EXPECT_FALSE(out.indefinite);
      EXPECT_LE(largest_difference(stage.product(x), r), 100 * residual * largest(r));
      EXPECT_TRUE(same_bits(x, stage.free_part(x))) << "moves what is fixed";
    }
  });
}

TYPED_TEST(LinearSolversOn, TheAssembledMatrixIsTheProductWithoutOne) {
  Materials::for_each([&](auto material) {
    for (const double damping : {0.0, 2e-3}) {
      SCOPED_TRACE(material.name);
      Problem problem = pressed(material.name);
      problem.body.damping.stiffness = damping;
      StageCase<TypeParam> stage(problem);
      StageSystem<TypeParam> system(stage.level(), true);
      system.prepare(stage.level(), stage.state, stage.weights, false);
      const auto p = stage.random_right_side();
      Vectors<TypeParam> q("test.q", p.size());
      system.product(stage.exec(), device_field<TypeParam>(p), q);
      const auto want = stage.product(p);
      EXPECT_LE(largest_difference(stage.free_part(to_host<TypeParam>(stage.exec(), q)), want),
                round_off<typename TypeParam::Real>(500, largest(want)));
    }
  });
}

// Contact, inertia and damping with it; in float, whatever the level's precision.
TYPED_TEST(LinearSolversOn, TheCyclesProductOfNodalElementsIsThatOfTheSystem) {
  for (const double damping : {0.0, 2e-3}) {
    Problem problem = pressed("neo_hookean");
    problem.body.element = {"nodal"}, problem.body.damping.stiffness = damping;
    StageCase<TypeParam> stage(problem);
    StageSystem<TypeParam> system(stage.level(), false);
    const CycleProduct<TypeParam>* const product = system.cycle_product("neo_hookean");
    system.prepare(stage.level(), stage.state, stage.weights, false);
    using F = Backend<float, typename TypeParam::Exec>;
    const auto p = stage.random_right_side();
    Vectors<F> q("test.q", p.size());
    product->apply(stage.exec(), device_field<F>(p), q);
    const auto want = stage.product(p);
    EXPECT_LE(largest_difference(stage.free_part(to_host<F>(stage.exec(), q)), want),
              round_off<float>(500, largest(want)));
  }
}

void expect_symmetric_and_positive(const Problem& problem, const char* name, const char* matrix) {
  SCOPED_TRACE(problem.body.element.front() + " " + name);
  StageCase<Host> stage(problem);
  const auto parts = stage.parts("conjugate_gradients", name, matrix, 1e-8);
  StageSystem<Host> system(stage.level(), matrix == std::string("assembled"));
  const auto preconditioner = make_preconditioner<Host>(parts, system);
  system.prepare(stage.level(), stage.state, stage.weights, false);
  system.fit(stage.exec(), *preconditioner);
  const auto free = stage.probe.free();
  const auto n = static_cast<Eigen::Index>(free.size());
  Eigen::MatrixXd C(n, n);
  auto r = stage.probe.zero();
  Vectors<Host> z("test.z", r.size());
  for (Eigen::Index j = 0; j < n; ++j) {
    const auto at = [&](Eigen::Index i) { return free[static_cast<std::size_t>(i)]; };
    r[static_cast<std::size_t>(at(j) / 3)][at(j) % 3] = 1;
    preconditioner->apply(stage.exec(), device_field<Host>(r), z);
    r[static_cast<std::size_t>(at(j) / 3)][at(j) % 3] = 0;
    stage.exec().fence();
    for (Eigen::Index i = 0; i < n; ++i)
      C(i, j) = z(static_cast<std::size_t>(at(i) / 3), static_cast<std::size_t>(at(i) % 3));
  }
  EXPECT_LE((C - C.transpose()).cwiseAbs().maxCoeff(),
            round_off<float>(500, C.cwiseAbs().maxCoeff()));
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(0.5 * (C + C.transpose()),
                                                             Eigen::EigenvaluesOnly);
  EXPECT_GT(eigen.eigenvalues().minCoeff(), 0);
}

TEST(LinearSolvers, PreconditionersAreSymmetricAndPositive) {
  for (const char* name : {"chebyshev", "multigrid"}) {
    expect_symmetric_and_positive(pressed("corotational"), name, "assembled");
    Problem nodal = pressed("neo_hookean");
    nodal.body.element = {"nodal"};
    expect_symmetric_and_positive(nodal, name, "free");
  }
}

int iterations(const std::string& preconditioner, int cells, const std::string& element = "linear",
               int coarsest = 2) {
  std::vector<TetMesh> meshes;
  for (int n = cells; n >= coarsest; n /= 2) meshes.push_back(box_mesh(decimetre, {n, n, n}));
  Problem p = body_of(std::move(meshes));
  p.body.material = {"st_venant_kirchhoff", 1e5, 0.45, 1000};
  p.body.fixed = {left_face()};
  p.body.element = {element};
  p.integration.integrator = {"implicit_euler"};
  p.integration.macro_step = 0.01;
  LevelProbe<Host> probe(p);
  const ImplicitWeights weights{1e-4, 1e-2};
  Level<Host>& part = probe.at(0);
  const auto& exec = probe.built.hierarchy->exec();
  p.integration.implicit.solver = "conjugate_gradients",
  p.integration.implicit.relative_residual = 1e-8;
  p.integration.implicit.preconditioner = preconditioner;
  const auto solver =
      make_linear_solver<Host>(linear_solver_parts(p, 0, true, "conjugate_gradients"), part);
  part.linearise(part.state, 0, weights, 0, part.f);
  solver->prepare(part, part.state, weights, false);
  std::vector<Point> r = probe.zero();
  const auto inverse = probe.inverse_mass();
  for (std::size_t a = 0; a < r.size(); ++a)
    if (inverse[a] > 0) r[a] = Point(0, 0, 1e-3 / inverse[a]);
  Vectors<Host> x("test.x", r.size());
  const SolveOutcome out = solver->solve(exec, device_field<Host>(r), x, 1e-8);
  EXPECT_TRUE(out.converged);
  return out.iterations;
}

TEST(LinearSolvers, UnknownNamesAreRefusedWithTheNearest) {
  Problem p = body_of({jittered_box(decimetre, {2, 2, 2})});
  p.integration.integrator = {"implicit_euler"}, p.integration.macro_step = 0.01;
  LevelProbe<Host> probe(p);
  const auto refused = [&](const std::string& solver, const std::string& preconditioner) {
    LinearSolverParts parts = linear_solver_parts(p, 0, true, "conjugate_gradients");
    parts.options.solver = solver, parts.options.preconditioner = preconditioner;
    return refusal([&] { make_linear_solver<Host>(parts, probe.at(0)); });
  };
  EXPECT_EQ(refused("conjugate_gradients", "block_jacobi"), "");
  EXPECT_EQ(refused("conjugate_gradient", "block_jacobi"),
            "unknown linear solver 'conjugate_gradient'; did you mean 'conjugate_gradients'? "
            "(choices: conjugate_gradients, direct, v_cycle)");
  EXPECT_EQ(refused("conjugate_gradients", "block_jakobi"),
            "unknown preconditioner 'block_jakobi'; did you mean 'block_jacobi'? (choices: "
            "block_jacobi, chebyshev, multigrid)");
}

TEST(LinearSolvers, MultigridIterationsHardlyGrow) {
  const int coarse = iterations("multigrid", 4), fine = iterations("multigrid", 16);
  EXPECT_LE(fine, 1.5 * coarse) << coarse;
  EXPECT_GE(iterations("block_jacobi", 16), 2.5 * iterations("block_jacobi", 4));
  EXPECT_LE(fine, iterations("block_jacobi", 16) / 5);
  EXPECT_LE(iterations("multigrid", 16, "nodal"), 1.3 * fine);
  EXPECT_LE(iterations("multigrid", 16, "linear", 8), 1.3 * fine)
      << "below a coarsest mesh of 729 vertices: spaces";
}

std::string refusal_of(const Problem& p) {
  return refusal([&] { validate(p); });
}

TEST(LinearSolvers, CombinationsWithoutSenseAreRefused) {
  const Problem good = pressed("linear");
  EXPECT_EQ(refusal_of(good), "");
  Problem p = good;
  p.integration.implicit.solver = "direkt";
  EXPECT_NE(refusal_of(p).find("unknown solver 'direkt'; did you mean 'direct'?"),
            std::string::npos)
      << refusal_of(p);
  p = good;
  p.integration.implicit.preconditioner = "multigrid",
  p.body.levels = {box_mesh(decimetre, {2, 2, 2})};
  EXPECT_NE(refusal_of(p).find("needs a coarser mesh"), std::string::npos) << refusal_of(p);
  p = good;
  p.integration.implicit.solver = "direct", p.integration.implicit.preconditioner = "chebyshev";
  EXPECT_NE(refusal_of(p).find("no iterations to precondition"), std::string::npos)
      << refusal_of(p);
  p.integration.implicit.preconditioner = "auto", p.integration.implicit.matrix = "free";
  EXPECT_NE(refusal_of(p).find("factorises the assembled matrix"), std::string::npos)
      << refusal_of(p);
  p.integration.implicit.matrix = "auto", p.integration.implicit.iterations = 5;
  EXPECT_NE(refusal_of(p).find("does not iterate"), std::string::npos) << refusal_of(p);
  p = good;
  p.integration.implicit.polynomial_degree = 1;
  EXPECT_NE(refusal_of(p).find("expected a whole number in [2, 16]"), std::string::npos)
      << refusal_of(p);
}

// Without a matrix, linear elements keep their projected tangents: the system is that of the
// matrix.
TEST(LinearSolvers, ProjectTangentsWithoutAMatrixAsInIt) {
  Materials::for_each([&](auto material) {
    for (const double damping : {0.0, 1e-3}) {
      SCOPED_TRACE(std::string(material.name) + ", damping " + std::to_string(damping));
      Problem p = pressed(material.name);
      p.body.damping.stiffness = damping;
      StageCase<Host> stage(p);
      Level<Host>& level = stage.level();
      auto squeezed = random_field(stage.probe.vertices(), 0.003, 1);
      for (std::size_t a = 0; a < squeezed.size(); ++a)
        squeezed[a][2] -= 0.3 * p.body.levels[0].vertices[a][2];
      stage.state =
          State<Host>(device_field<Host>(squeezed), device_field<Host>(stage.probe.zero()));
      level.linearise(stage.state, 0, stage.weights, 0, level.f);
      const auto r = stage.random_right_side();
      const auto solved = [&](const char* matrix, bool projected) {
        const auto solver = make_linear_solver<Host>(
            stage.parts("conjugate_gradients", "block_jacobi", matrix, 1e-12), level);
        EXPECT_EQ(solver->reads_kept(), matrix == std::string("free"));
        if (projected && solver->reads_kept()) level.keep_tangents(stage.state);
        solver->prepare(level, stage.state, stage.weights, projected);
        Vectors<Host> x("test.x", r.size());
        solver->solve(stage.exec(), device_field<Host>(r), x, 1e-12);
        return to_host<Host>(stage.exec(), x);
      };
      const auto expected = solved("assembled", true), exact = solved("assembled", false);
      EXPECT_LE(largest_difference(solved("free", true), expected), 1e-8 * largest(expected));
      if (material.name == std::string("neo_hookean")) {
        EXPECT_GT(largest_difference(exact, expected), 1e-4 * largest(expected));
      }
    }
  });
}

TEST(LinearSolvers, ALargeCoarsestMeshNeedsVerticesThatMayMove) {
  Problem p = body_of({box_mesh(decimetre, {9, 9, 9}), box_mesh(decimetre, {8, 8, 8})});
  p.integration.implicit.preconditioner = "multigrid";
  EXPECT_EQ(describe(linear_solver_parts(p, 0, true, "conjugate_gradients")),
            "conjugate_gradients, multigrid over 3 levels, assembled");
  p.body.fixed = {HalfSpaceSelection{{0.09, 0, 0}, {1, 0, 0}}};
  const auto made = [&] { linear_solver_parts(p, 0, true, "conjugate_gradients"); };
  EXPECT_NE(refusal(made).find("729 vertices, but too few that may move"), std::string::npos)
      << refusal(made);
}

TEST(LinearSolvers, AutoChoosesBySizeAndMeshes) {
  Problem p = pressed("linear", 4);
  EXPECT_EQ(describe(linear_solver_parts(p, 0, true, "auto")), "direct");
  EXPECT_EQ(describe(linear_solver_parts(p, 0, false, "auto")),
            "conjugate_gradients, multigrid over 3 levels, assembled");
  EXPECT_EQ(describe(linear_solver_parts(p, 2, false, "auto")),
            "conjugate_gradients, block_jacobi, assembled");
  p.integration.implicit.iterations = 3;
  EXPECT_EQ(describe(linear_solver_parts(p, 0, true, "auto")),
            "conjugate_gradients, block_jacobi, without a matrix");
}

}  // namespace
