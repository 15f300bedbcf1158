// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <memory>
#include <plica/core/implicit_weights.hpp>
#include <plica/core/level.hpp>
#include <plica/core/matrices.hpp>
#include <plica/drivers/elastic/elements.hpp>
#include <string_view>

namespace plica {

/// The element kernels of one material and one kind of elements, chosen by name at set-up. Each
/// leaves its sums in the level's `partial`, a row for each of the model's shares.
template <class B>
class Elasticity {
 public:
  using Exec = typename B::Exec;
  virtual ~Elasticity() = default;
  /// Of a displacement, and of a velocity where stiffness damps.
  virtual void force(const Exec&, const Level<B>&, const State<B>&, int evaluation) const = 0;
  /// -K(u) p; an empty u: of the state whose gradients level.nodal keeps. `over`: with D(u) p, the
  /// damping of damping_stress.hpp, times this [1/s]; `positive`: of elements whose tangent is
  /// projected to positive semi-definite, which only nodal ones have without a matrix.
  virtual void tangent(const Exec&, const Level<B>&, const Vectors<B>& u, const Vectors<B>& p,
                       double over, bool positive = false) const = 0;
  /// Of the vertices' own blocks of K(u), u likewise, column `direction`: its numbers on the
  /// diagonal and in the next row (cyclic) at least. Without what nodal elements smooth.
  virtual void diagonal(const Exec&, const Level<B>&, const Vectors<B>& u, int direction,
                        double over, bool positive = false) const = 0;
  /// Keeps the projected tangents of the state whose gradients level.nodal keeps, in
  /// level.nodal.tangent: `tangent` and `diagonal` of that state read them where they are
  /// `positive`.
  virtual void keep_tangents(const Exec&, const Level<B>&) const {}
  /// A = (1 + b c) M + a K(u) + b D(u) as blocks, of linear elements; `positive`: of such whose
  /// tangent is projected to positive semi-definite.
  virtual void blocks(const Exec&, const Model<B>&, const PatchPairs<B>&, const Vectors<B>& u,
                      const ImplicitWeights&, bool positive, const Blocks9<B>& shares,
                      const BlockMatrix<B>& A) const = 0;
  /// The elements' energy, in the x components.
  virtual void energy(const Exec&, const Level<B>&, const Vectors<B>& u) const = 0;
  /// von Mises' stress [Pa] and J: of linear elements per tetrahedron of the mesh, of nodal ones
  /// per vertex.
  virtual void stress(const Exec&, const Level<B>&, const Vectors<B>& u,
                      const Scalars<B>& von_mises, const Scalars<B>& J) const = 0;
  /// Takes level.stress.memory further by level.stress.step, to the stress of shape of a
  /// displacement. `constants`: as the model's, without a stiffness of the volume. Of materials
  /// with a shape of their own, see StressMemory.
  virtual void remember(const Exec&, const Level<B>& level, const Vectors<B>& u,
                        const Scalars<B>& constants) const = 0;
};

/// Throws InputError for a name that is not in kernels/materials/list.hpp.
template <class B>
std::unique_ptr<Elasticity<B>> make_elasticity(std::string_view material,
                                               Element element = Element::linear);

}  // namespace plica
