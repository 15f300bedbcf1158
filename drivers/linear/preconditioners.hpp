// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <memory>
#include <plica/core/type_list.hpp>
#include <plica/drivers/linear/linear_solver.hpp>
#include <plica/drivers/linear/multigrid.hpp>
#include <plica/drivers/linear/stage_system.hpp>

namespace plica {

struct BlockJacobi {
  static constexpr const char* name = "block_jacobi";
  static constexpr const char* summary = "the vertices' own 3x3 blocks; nothing to fit";
  template <class B>
  static std::unique_ptr<Preconditioner<B>> make(const LinearSolverParts&, StageSystem<B>&) {
    return nullptr;  // conjugate gradients use the vertex blocks anyway
  }
};

template <class B>
std::unique_ptr<Preconditioner<B>> make_cycle(const LinearSolverParts& parts,
                                              const std::vector<RowMatrix>& transfers,
                                              StageSystem<B>& system) {
  return std::make_unique<Multigrid<B>>(system.pattern(), transfers,
                                        parts.options.polynomial_degree,
                                        system.cycle_product(parts.material), system.ranks());
}

struct ChebyshevPolynomial {
  static constexpr const char* name = "chebyshev";
  static constexpr const char* summary = "a polynomial in the matrix, scaled by the vertex blocks";
  template <class B>
  static std::unique_ptr<Preconditioner<B>> make(const LinearSolverParts& parts,
                                                 StageSystem<B>& system) {
    return make_cycle<B>(parts, {}, system);
  }
};

struct MultigridCycle {
  static constexpr const char* name = "multigrid";
  static constexpr const char* summary =
      "one V-cycle over the body's meshes; iterations hardly grow with the mesh";
  template <class B>
  static std::unique_ptr<Preconditioner<B>> make(const LinearSolverParts& parts,
                                                 StageSystem<B>& system) {
    return make_cycle<B>(parts, parts.transfers, system);
  }
};

/// All preconditioners. To add one, write a struct with the same members and its name here.
using Preconditioners = TypeList<BlockJacobi, ChebyshevPolynomial, MultigridCycle>;

/// Makes a preconditioner. Throws InputError for a name that is not in the list, with the nearest
/// one.
template <class B>
std::unique_ptr<Preconditioner<B>> make_preconditioner(const LinearSolverParts& parts,
                                                       StageSystem<B>& system) {
  std::unique_ptr<Preconditioner<B>> made;
  Preconditioners::require("preconditioner", parts.options.preconditioner, [&](auto kind) {
    made = decltype(kind)::template make<B>(parts, system);
  });
  return made;
}

}  // namespace plica
