// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <memory>
#include <plica/core/implicit_weights.hpp>
#include <plica/core/level_data.hpp>
#include <plica/core/matrices.hpp>
#include <plica/drivers/elastic/elements.hpp>
#include <plica/kernels/elastic/stress_fields.hpp>
#include <string_view>

namespace plica {

/// Element kernels of one material and one kind of elements, chosen by name at set-up.
/// Results at vertices are left as sums in the level's `partial`, a row for each of the model's
/// shares.
template <class B>
class Elasticity {
 public:
  using Exec = typename B::Exec;
  virtual ~Elasticity() = default;
  /// Computes the forces of a state's displacement, and of its velocity where stiffness damps [N].
  virtual void force(const Exec&, const LevelData<B>&, const State<B>&, int evaluation) const = 0;
  /// Computes -(K(u) + `damping_scale` D(u)) p, D the damping of damping_stress.hpp,
  /// `damping_scale` in [1/s]. An empty u: the state whose gradients level.nodal keeps.
  /// `projected`: the tangents of elements are projected to positive semi-definite; linear elements
  /// have those of keep_tangents(), and without it their tangents as they are.
  virtual void tangent(const Exec&, const LevelData<B>&, const Vectors<B>& u, const Vectors<B>& p,
                       double damping_scale, bool projected = false) const = 0;
  /// Computes column `direction` of each vertex's own block of K(u) + `damping_scale` D(u).
  /// At least the entries on the diagonal and in the next row (cyclic) are set. An empty u and
  /// `projected`: see tangent(). Smoothed pressures of nodal elements are left out.
  virtual void diagonal(const Exec&, const LevelData<B>&, const Vectors<B>& u, int direction,
                        double damping_scale, bool projected = false) const = 0;
  /// Stores the projected tangents of a displacement; with nodal elements, of the one whose
  /// gradients level.nodal keeps. They go to level.nodal.tangent, from where tangent() and
  /// diagonal() of that state read them if `projected`.
  virtual void keep_tangents(const Exec&, const LevelData<B>&, const Vectors<B>& u) const = 0;
  /// Assembles A = (1 + b c) M + a K(u) + b D(u) in blocks, of linear elements.
  /// `projected`: the tangents of elements are projected to positive semi-definite.
  virtual void blocks(const Exec&, const Model<B>&, const PatchPairs<B>&, const Vectors<B>& u,
                      const ImplicitWeights&, bool projected, const Blocks9<B>& shares,
                      const BlockMatrix<B>& A) const = 0;
  /// Computes the elements' elastic energy, into the x components of `partial` [J].
  virtual void energy(const Exec&, const LevelData<B>&, const Vectors<B>& u) const = 0;
  /// Computes stress and strain: of each tetrahedron of the mesh with linear elements, of each
  /// vertex with nodal ones.
  virtual void stress(const Exec&, const LevelData<B>&, const Vectors<B>& u,
                      const StressFields<B>&) const = 0;
  /// Computes the mixed dilatations of an implicit stage after a change du of the displacements,
  /// where u includes du already; see kernels/elastic/mixed_dilatations.hpp. Only for levels whose
  /// pressures are smoothed.
  virtual void carry_dilatations(const Exec&, const LevelData<B>&, const Vectors<B>& /*u*/,
                                 const Vectors<B>& /*du*/) const {}
  /// Advances level.stress.memory by level.stress.step, to the stress of shape of a displacement.
  /// `constants`: the model's constants without a stiffness of the volume. Does nothing for
  /// materials that do not split shape from volume, see ViscousHistory.
  virtual void accept_state(const Exec&, const LevelData<B>& level, const Vectors<B>& u,
                            const Scalars<B>& constants) const = 0;
};

/// Returns the kernels of a material, with elements of a kind.
/// Throws InputError for a name that is not in kernels/materials/list.hpp.
template <class B>
std::unique_ptr<Elasticity<B>> make_elasticity(std::string_view material,
                                               Element element = Element::linear);

/// Returns the kernels of linear elements of a material; compiled in a source for each material.
template <class B, class Material>
std::unique_ptr<Elasticity<B>> make_linear_elasticity();

/// Returns the kernels of linear elements of a material; none in a precision that no simulation
/// runs in, where only nodal elements are needed.
template <class B, class Material>
std::unique_ptr<Elasticity<B>> linear_elasticity() {
  if constexpr (is_built<typename B::Real>)
    return make_linear_elasticity<B, Material>();
  else
    return nullptr;
}

}  // namespace plica
