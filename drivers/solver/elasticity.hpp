// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <memory>
#include <plica/core/element_flags.hpp>
#include <plica/core/implicit_weights.hpp>
#include <plica/core/model.hpp>
#include <plica/core/patch_pairs.hpp>
#include <string_view>

namespace plica {

/// The element kernels of one material, chosen by name at set-up. Each writes its sums per patch vertex into `partial`.
template <class B>
class Elasticity {
 public:
  using Exec = typename B::Exec;
  virtual ~Elasticity() = default;
  /// Of a displacement, and of a velocity where stiffness damps.
  virtual void force(const Exec&, const Patches<B>&, const State<B>&, const ElementFlags<B>&, int evaluation,
                     const Vectors<B>& partial) const = 0;
  /// `over`: with the stiffness that damps times this [1/s].
  virtual void tangent(const Exec&, const Patches<B>&, const Vectors<B>& u, const Vectors<B>& p, double over,
                       const Vectors<B>& partial) const = 0;
  virtual void diagonal(const Exec&, const Patches<B>&, const Vectors<B>& u, int direction, double over,
                        const Vectors<B>& partial) const = 0;
  /// A = (1 + b c) M + a K(u) as blocks; `positive`: of elements whose tangent is projected to positive semi-definite.
  virtual void blocks(const Exec&, const Model<B>&, const PatchPairs<B>&, const Vectors<B>& u, const ImplicitWeights&,
                      bool positive, const Blocks9<B>& shares, const BlockMatrix<B>& A) const = 0;
  virtual void energy(const Exec&, const Patches<B>&, const Vectors<B>& u, const Vectors<B>& partial) const = 0;
  /// Per tetrahedron of the mesh: von Mises' stress [Pa] and J.
  virtual void stress(const Exec&, const Patches<B>&, const Vectors<B>& u, const Scalars<B>& von_mises,
                      const Scalars<B>& J) const = 0;
};

/// Throws InputError for a name that is not in kernels/materials/list.hpp.
template <class B>
std::unique_ptr<Elasticity<B>> make_elasticity(std::string_view material);

}  // namespace plica
