// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/archive.hpp>
#include <plica/kernels/him/leapfrog.hpp>
#include <plica/kernels/vectors.hpp>

// Symbols of cmake/docs/explanation/him.md: p are momenta. A is the inverse mass without the exact
// translation, A' the one with it.
namespace plica {

/// Exact translation of a body that nothing holds, and the rigid part of its momenta.
/// A' = (1 - T) A (1 - T)^T + 1 1^T / mass, T the mean by mass: a translation has the whole mass.
template <class B>
class FreeMotion {
 public:
  using Exec = typename B::Exec;
  /// @param rest      positions at rest [m]
  /// @param vertices  the body's vertices, and which of them this process owns
  /// @param ranks     ranks that share them; null: one process has all
  FreeMotion(const Vectors<B>& rest, const Items& vertices, Ranks* ranks)
      : rest_(rest),
        owned_(vertices),
        blocks_(vertices.n, ranks),
        sums_(zeros<Doubles<B>>("plica::free.moments", 16)),
        total_(zeros<Doubles<B>>("plica::free.total", 4)),
        frame_("plica::free.frame") {}

  /// Stores the sum of the momenta p, and sets `rest` to p without translation.
  /// With a `count` on the device, only where that is above 0.
  void take_translation(const Exec& exec, const VertexModel<B>& model, const Vectors<B>& p,
                        const Vectors<B>& rest, const Doubles<B>& count) const {
    reduce<B, 4>(exec, "plica::free_total", owned_,
                 TermWhereTouching<B, SumOfMomenta<B>>{count.data(), {model.mass, p}}, blocks_,
                 total_);
    where_touching<B>(exec, count, "plica::free_take", vertices(),
                      TakeTranslation<B>{model.mass, p, rest, total_});
  }

  /// Changes the mean of v so that the sum of m v is the stored sum of momenta.
  /// With a `count` on the device, only where that is above 0.
  void put_translation(const Exec& exec, const VertexModel<B>& model, const Vectors<B>& v,
                       const Doubles<B>& count) const {
    reduce<B, 4>(exec, "plica::free_total", owned_,
                 TermWhereTouching<B, SumOfMotion<B>>{count.data(), {model.mass, v}}, blocks_,
                 sums_);
    where_touching<B>(exec, count, "plica::free_put", vertices(),
                      PutTranslation<B>{v, total_, sums_});
  }

  /// Returns the rigid part of p - m v at a state.
  RigidMotion<B> rigid_part(const Exec& exec, const VertexModel<B>& model, const State<B>& state,
                            const Vectors<B>& p) const {
    reduce<B, 16>(exec, "plica::free_moments", owned_,
                  BodyMoments<B>{model.mass, rest_, state.u, p, state.v}, blocks_, sums_,
                  SetRigidFrame<B>{sums_, frame_});
    return {rest_, state.u, frame_};
  }
  /// Kicks the momenta, stores their sum and sets `rest` to the momenta without translation.
  void kick(const Exec& exec, const VertexModel<B>& model, const KickMomentum<B>& kick,
            const Vectors<B>& rest) const {
    reduce<B, 4>(exec, "plica::him_momenta", owned_, KickAndSum<B>{kick}, blocks_, total_);
    update_vertices<B>(exec, "plica::free_take", vertices(),
                       TakeTranslation<B>{model.mass, kick.p, rest, total_});
  }
  /// Adds the translation to a = A p, and turns it into mean accelerations a = (a - v) / t.
  void accelerate(const Exec& exec, const VertexModel<B>& model, const Vectors<B>& v,
                  const Vectors<B>& a, double t) const {
    reduce<B, 4>(exec, "plica::free_total", owned_, SumOfMotion<B>{model.mass, a}, blocks_, sums_);
    update_vertices<B>(exec, "plica::him_acceleration", vertices(),
                       AccelerationOfTranslated<B>{{a, total_, sums_},
                                                   {v, a, static_cast<typename B::Real>(1 / t)}});
  }

  void name_fields(Archive<B>& archive) const {
    archive.owns(rest_, blocks_.view(), sums_, total_, frame_);
  }

 private:
  Vectors<B> rest_;
  Items owned_;
  BlockSums<B> blocks_;
  Doubles<B> sums_, total_;
  RigidFrameOf<B> frame_;

  int vertices() const { return owned_.n; }
};

}  // namespace plica
