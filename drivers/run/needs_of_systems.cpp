// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/linear/list.hpp>
#include <plica/drivers/linear/preconditioners.hpp>
#include <plica/drivers/methods/integrators.hpp>
#include <plica/drivers/methods/methods.hpp>
#include <plica/drivers/run/needs_of_systems.hpp>
#include <plica/meshes/mesh_quality.hpp>

namespace plica {

bool may_need_matrix(const Problem& problem, const std::string& integrator) {
  if (is_explicit(integrator)) return false;
  const ImplicitOptions& o = problem.integration.implicit;
  return o.matrix != "free" || o.preconditioner != BlockJacobi::name ||
         o.solver == VCycleSolver::name || integrator == VCycleEuler::name;
}

BesideNodal beside_nodal(const Problem& problem, const std::string& integrator, const TetMesh& mesh,
                         const LevelConstants& constants) {
  constexpr double thick = 8;  // elements across
  if (constants.element != Element::nodal || !may_need_matrix(problem, integrator))
    return BesideNodal::nothing;
  // products in float know nothing of vertices that slide or follow others
  if (!constants.sliding.empty() || !mesh.followers.vertex.empty()) return BesideNodal::matrix;
  const bool by_products = has_contact(problem) || smooths_pressure(problem.body, constants.lame) ||
                           elements_across(mesh) >= thick;
  return by_products ? BesideNodal::matrix_and_rows : BesideNodal::matrix;
}

}  // namespace plica
