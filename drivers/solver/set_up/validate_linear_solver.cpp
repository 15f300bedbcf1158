// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/drivers/solver/linear/linear_solver_parts.hpp>
#include <plica/drivers/solver/registry.hpp>
#include <plica/drivers/solver/set_up/expect.hpp>
#include <plica/drivers/solver/set_up/validate_linear_solver.hpp>

namespace plica {

namespace {

void known(const std::string& kind, const std::string& name, const std::vector<Choice>& choices) {
  const auto all = names(choices);
  if (std::find(all.begin(), all.end(), name) == all.end()) throw InputError(unknown_name(kind, name, all));
}

void check_direct(const ImplicitOptions& o) {
  const auto refuse = [](const std::string& what, const std::string& why) {
    throw InputError("integration.implicit." + what + ", but solver direct " + why + "; leave it out");
  };
  if (o.preconditioner != "auto") refuse("preconditioner is " + o.preconditioner, "has no iterations to precondition");
  if (o.matrix == "free") refuse("matrix is free", "factorises the assembled matrix");
  if (o.iterations > 0) refuse("iterations is " + std::to_string(o.iterations), "does not iterate");
}

void check_v_cycle(const ImplicitOptions& o) {
  const auto refuse = [](const std::string& what, const std::string& why) {
    throw InputError("integration.implicit." + what + ", but solver v_cycle " + why + "; leave it out");
  };
  if (o.preconditioner != "auto" && o.preconditioner != "multigrid")
    refuse("preconditioner is " + o.preconditioner, "is a cycle of multigrid");
  if (o.matrix == "assembled") refuse("matrix is assembled", "needs one only where its cycle is fitted");
  if (o.iterations > 0) refuse("iterations is " + std::to_string(o.iterations), "does not iterate");
}

void check_multigrid(const Body& body) {
  if (body.levels.size() < 2)
    throw InputError(
        "integration.implicit.preconditioner is multigrid, or its solver v_cycle, which needs a coarser mesh, but the "
        "body has one "
        "level; expected more of body.levels, or block_jacobi or chebyshev");
  const std::size_t vertices = body.levels.back().vertices.size();
  if (3 * vertices > static_cast<std::size_t>(most_dense_unknowns))
    throw InputError(
        "integration.implicit.preconditioner is multigrid, which answers its coarsest level by a dense matrix; level " +
        std::to_string(body.levels.size() - 1) + " has " + std::to_string(vertices) + " vertices, expected at most " +
        std::to_string(most_dense_unknowns / 3) + ": add a coarser level, of 50 to 200 vertices");
}

}  // namespace

void validate_linear_solver(const Problem& problem) {
  const ImplicitOptions& o = problem.integration.implicit;
  known("solver", o.solver, linear_solver_choices());
  known("preconditioner", o.preconditioner, preconditioner_choices());
  known("matrix", o.matrix, matrix_choices());
  expect(o.polynomial_degree >= 2 && o.polynomial_degree <= 16, "integration.implicit.polynomial_degree",
         o.polynomial_degree, "2 to 16");
  if (o.solver == "direct") check_direct(o);
  if (o.solver == "v_cycle") check_v_cycle(o);
  if (o.preconditioner == "multigrid" || o.solver == "v_cycle") check_multigrid(problem.body);
  if (o.matrix == "free" && o.tangent == "positive")
    throw InputError(
        "integration.implicit.matrix is free, but tangents projected to positive ones are assembled; expected auto");
}

}  // namespace plica
