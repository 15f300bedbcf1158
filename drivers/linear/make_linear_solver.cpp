// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <limits>
#include <plica/core/error.hpp>
#include <plica/drivers/body/selection.hpp>
#include <plica/drivers/elastic/elements.hpp>
#include <plica/drivers/level/build_level.hpp>
#include <plica/drivers/linear/list.hpp>
#include <plica/drivers/linear/make_linear_solver.hpp>
#include <plica/drivers/loads/assemble_loads.hpp>
#include <plica/drivers/methods/methods.hpp>
#include <plica/drivers/methods/rest.hpp>
#include <plica/drivers/spaces/coarse_spaces.hpp>

namespace plica {

namespace {

// maximum vertices at which a factorisation is faster: cmake/docs/results/solvers.md
constexpr std::size_t most_direct = 200;
constexpr int fewest_assembled = 8;            // iterations from which an assembled matrix pays
constexpr std::size_t fewest_coarsened = 600;  // minimum vertices of one mesh for multigrid
// maximum vertices; a space below a larger mesh costs less than its dense inverse
constexpr std::size_t most_in_coarsest = 300;
constexpr double multigrid_reach = 1.3;
// Macro step over the critical step from which multigrid over spaces pays: for systems that are
// solved exactly, and for those of Newton's method, which are not. See
// cmake/docs/explanation/coarse_levels.md
constexpr double long_step = 40, long_newton_step = 100;

std::size_t unknowns(const TetMesh& mesh) { return 3 * mesh.vertices.size(); }

/// Mesh at rest with its constrained vertices, and Lame's constants of its regions.
struct RestMesh {
  TetMesh mesh;
  std::vector<char> constrained;
  std::vector<Lame<double>> lame;
};

RestMesh rest_mesh(const Body& body, std::size_t level) {
  RestMesh made{body.levels[level], {}, {}};
  add_regions(made.mesh, body.regions, static_cast<int>(level));
  LevelConstants constants =
      level_constants(body, made.mesh, Point::Zero(), static_cast<int>(level));
  made.constrained = std::move(constants.constrained), made.lame = std::move(constants.lame);
  return made;
}

/// Returns the transfers over the body's coarser meshes, and over spaces made of a large coarsest
/// one.
std::vector<RowMatrix> transfers_below(const Body& body, std::size_t level) {
  std::vector<RestMesh> meshes;
  for (std::size_t i = level; i < body.levels.size(); ++i) meshes.push_back(rest_mesh(body, i));
  std::vector<RestLevel> levels;
  for (const RestMesh& one : meshes) levels.push_back({one.mesh, one.constrained});
  SpaceOptions options{.sizes = {}, .reach = multigrid_reach};
  const RestMesh& coarsest = meshes.back();
  if (levels.size() == 1 || body.coarsen || coarsest.mesh.vertices.size() > most_in_coarsest)
    options.sizes = space_sizes(body.coarsen, coarsest.constrained, multigrid_sizes);
  if (options.sizes.empty() &&
      unknowns(coarsest.mesh) > static_cast<std::size_t>(most_dense_unknowns))
    throw InputError("integration.implicit: multigrid makes no space of level " +
                     std::to_string(body.levels.size() - 1) + ", which has " +
                     std::to_string(coarsest.mesh.vertices.size()) +
                     " vertices, but too few that may move; expected block_jacobi or chebyshev, or "
                     "a coarser mesh");
  return levels_below(levels, {}, {}, options, false).transfers;
}

bool has_multigrid(const Body& body, std::size_t level) {
  const TetMesh &fine = body.levels[level], &coarsest = body.levels.back();
  if (level + 1 == body.levels.size()) return fine.vertices.size() >= fewest_coarsened;
  return coarsest.vertices.size() < fine.vertices.size();
}

/// Adds transfers for multigrid. Where these cannot be made, `asked` decides.
/// `asked`: the user asked for multigrid, and gets the InputError; else vertex blocks are used.
void add_multigrid(LinearSolverParts& parts, const Body& body, std::size_t level, bool asked) {
  try {
    parts.transfers = transfers_below(body, level);
    parts.options.preconditioner = MultigridCycle::name;
  } catch (const InputError&) {
    if (asked) throw;
    parts.options.preconditioner = BlockJacobi::name;
  }
}

/// Returns true where Newton's systems are solved to a residual of a hundredth.
/// They are not with mixed dilatations, nor where the options ask for a smaller residual.
bool solves_loosely(const Problem& problem, std::size_t level) {
  if (problem.integration.implicit.relative_residual < ImplicitOptions().relative_residual)
    return false;
  const auto& names = problem.integration.integrator;
  const bool carries = element_of(problem.body, level) == Element::nodal &&
                       smooths_pressure(problem.body, rest_mesh(problem.body, level).lame);
  return newton_iterations(problem.integration.implicit, names[std::min(level, names.size() - 1)]) >
             1 &&
         !carries;
}

}  // namespace

LinearSolverParts linear_solver_parts(const Problem& problem, std::size_t level, bool on_host,
                                      std::string solver, double critical_step) {
  LinearSolverParts parts{problem.integration.implicit, {}, problem.body.material.model};
  ImplicitOptions& o = parts.options;
  const Body& body = problem.body;
  const bool fixed = o.iterations > 0, multigrid = has_multigrid(body, level);
  const bool nodal = element_of(body, level) == Element::nodal;
  if (solver == "auto") {
    const bool small = on_host && !fixed && !nodal &&
                       body.levels[level].vertices.size() <= most_direct &&
                       !has_follower_loads(body);  // follower loads are in no matrix
    solver = small && o.preconditioner == "auto" && o.matrix != "free" ? Direct::name
                                                                       : ConjugateGradients::name;
  }
  o.solver = std::move(solver);
  if (nodal && (o.solver == Direct::name || o.matrix == "assembled"))
    throw InputError("integration.implicit: level " + std::to_string(level) +
                     " has nodal elements, whose matrix is not assembled; expected solver "
                     "conjugate_gradients or auto, and "
                     "matrix free or auto");
  if (o.solver == VCycleSolver::name && nodal &&
      smooths_pressure(body, rest_mesh(body, level).lame))
    throw InputError(
        "level " + std::to_string(level) +
        " is nearly incompressible (its nodal elements smooth their pressures), which one V-cycle "
        "of elements "
        "that do not lock cannot answer; expected implicit_euler, solved by conjugate gradients");
  // the cycle of one level is a direct solve
  if (o.solver == VCycleSolver::name && !multigrid) {
    if (!on_host || unknowns(body.levels[level]) > static_cast<std::size_t>(most_dense_unknowns))
      throw InputError("level " + std::to_string(level) +
                       " is solved by a V-cycle, but has no coarser mesh of at most " +
                       std::to_string(most_dense_unknowns / 3) +
                       " vertices below it; expected more of body.levels, or another integrator");
    o.solver = Direct::name;
  }
  const bool cycle = o.solver == VCycleSolver::name,
             asked = cycle || o.preconditioner == MultigridCycle::name;
  if (o.solver == Direct::name) {
    o.preconditioner = "none", o.matrix = "assembled";
    return parts;
  }
  if (o.preconditioner == "auto" || asked) {
    // for a level without a coarser one, too, where other levels have one
    o.preconditioner = BlockJacobi::name;
    double over =
        critical_step > 0 ? problem.integration.macro_step.value_or(0) / critical_step : 0;
    if (seeks_rest(problem.integration)) over = std::numeric_limits<double>::infinity();
    const double least = solves_loosely(problem, level) ? long_newton_step : long_step;
    const bool pays = body.levels.size() == 1 ? over > least : level + 1 < body.levels.size();
    if (multigrid && (asked || (pays && !fixed))) add_multigrid(parts, body, level, asked);
  }
  if (o.matrix == "auto") {
    // projected tangents of linear elements cost more to keep than a matrix does
    const bool few = fixed && o.iterations < fewest_assembled && o.tangent != "positive";
    o.matrix = cycle || nodal || few ? "free" : "assembled";
  }
  return parts;
}

std::string describe(const LinearSolverParts& parts) {
  const ImplicitOptions& o = parts.options;
  if (o.solver == Direct::name) return o.solver;
  const std::string over = parts.transfers.empty()
                               ? ""
                               : " over " + std::to_string(parts.transfers.size() + 1) + " levels";
  return o.solver + ", " + o.preconditioner + over +
         (o.matrix == "free" ? ", without a matrix" : ", assembled");
}

template <class B>
std::unique_ptr<LinearSolver<B>> make_linear_solver(const LinearSolverParts& parts,
                                                    const LevelData<B>& level) {
  if (!B::on_host && parts.options.solver == Direct::name)
    throw InputError(
        "integration.implicit.solver is direct, which factorises on the host; this run's fields "
        "are in a device's "
        "memory; "
        "expected conjugate_gradients or auto");
  std::unique_ptr<LinearSolver<B>> made;
  LinearSolvers::require("linear solver", parts.options.solver, [&](auto kind) {
    made = std::make_unique<typename decltype(kind)::template Of<B>>(level, parts);
  });
  return made;
}

#define PLICA_INSTANTIATE(Real, Exec)                               \
  template std::unique_ptr<LinearSolver<Backend<Real, Exec>>>       \
  make_linear_solver<Backend<Real, Exec>>(const LinearSolverParts&, \
                                          const LevelData<Backend<Real, Exec>>&);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
