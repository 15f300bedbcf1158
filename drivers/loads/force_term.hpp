// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/archive.hpp>
#include <plica/core/implicit_weights.hpp>
#include <plica/core/level_data.hpp>
#include <plica/core/load.hpp>
#include <plica/core/matrices.hpp>
#include <vector>

namespace plica {

/// Kind of stiffness that a force term has when an implicit stage is solved.
enum class TermStiffness {
  none,        ///< the force does not depend on the state
  assembled,   ///< add_diagonal() and add_blocks() put it into the matrix
  unassembled  ///< only products have it; preconditioners do without it
};

/// One kind of force on the vertices of a level, besides gravity, elements and contact. A level has
/// a list of terms and adds their forces in its order. What a scene does not ask for is not in the
/// list: see make_force_terms(). Kernels go to `exec`; nothing waits for them unless it says so.
template <class B>
class ForceTerm {
 public:
  using Exec = typename B::Exec;
  virtual ~ForceTerm() = default;

  /// Adds the force of a state at a time [s] to f, [vertices][3] N.
  virtual void add_force(const Exec& exec, const State<B>& at, double time,
                         const Vectors<B>& f) = 0;
  virtual TermStiffness stiffness() const { return TermStiffness::none; }
  /// Adds scale K p to q, [vertices][3]. K is the negative derivative of the last force, its
  /// symmetric part; `projected`: its positive semi-definite part.
  virtual void add_product(const Exec&, const State<B>& /*at*/, const Vectors<B>& /*p*/,
                           double /*scale*/, bool /*projected*/, const Vectors<B>& /*q*/) const {}
  /// Adds scale K of each vertex to its block, [vertices][6] xx yy zz xy xz yz.
  virtual void add_diagonal(const Exec&, const State<B>& /*at*/, double /*scale*/,
                            const Blocks<B>&) const {}
  /// Adds scale K to a matrix of vertex blocks.
  virtual void add_blocks(const Exec&, const State<B>& /*at*/, double /*scale*/,
                          const BlockMatrix<B>&) const {}
  /// Returns the energy of a state at a time [J], whose negative derivative the force is; 0 where
  /// there is none. Waits.
  virtual double energy(const Exec&, const State<B>& /*at*/, double /*time*/) const { return 0; }
  /// Returns an upper bound of what the term adds to the squared frequencies of the level at rest
  /// [1/s^2]. Explicit steps are bounded by it.
  virtual double squared_frequency(const LevelData<B>&) const { return 0; }
  /// Returns volumes and pressures of cavities with a given volume in a state at a time. Waits.
  virtual std::vector<CavityState> cavities(const Exec&, const State<B>& /*at*/,
                                            double /*time*/) const {
    return {};
  }
  /// Names the term's arrays.
  virtual void name_fields(Archive<B>& archive) const = 0;
};

}  // namespace plica
