// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/level.hpp>
#include <plica/kernels/him/rigid_motion.hpp>
#include <plica/kernels/vectors.hpp>

namespace plica {

/// For bodies that nothing holds: A' = (1 - T) A (1 - T)^T + 1 1^T / mass, T the mean by mass; and momenta without rigid motion.
template <class B>
class FreeMotion {
 public:
  using Exec = typename B::Exec;
  explicit FreeMotion(const Vectors<B>& rest)
      : rest_(rest),
        blocks_(static_cast<int>(rest.extent(0))),
        sums_(zeros<Doubles<B>>("plica::free.moments", 16)),
        total_(zeros<Doubles<B>>("plica::free.total", 4)),
        frame_("plica::free.frame") {}

  /// Notes the sum of the momenta p; `rest`: what is not translation.
  void take_translation(const Exec& exec, const Model<B>& model, const Vectors<B>& p, const Vectors<B>& rest) const {
    reduce<B, 4>(exec, "plica::free_total", model.vertices, SumOfMomenta<B>{model.mass, p}, blocks_, total_);
    update_vertices<B>(exec, "plica::free_take", model.vertices, TakeTranslation<B>{model.mass, p, rest, total_});
  }

  /// Makes it the sum of m v.
  void put_translation(const Exec& exec, const Model<B>& model, const Vectors<B>& v) const {
    reduce<B, 4>(exec, "plica::free_total", model.vertices, SumOfMotion<B>{model.mass, v}, blocks_, sums_);
    update_vertices<B>(exec, "plica::free_put", model.vertices, PutTranslation<B>{v, total_, sums_});
  }

  /// Takes the rigid part of momenta at a state out of them.
  void take_rigid(const Exec& exec, const Model<B>& model, const Vectors<B>& u, const Vectors<B>& p) const {
    reduce<B, 16>(exec, "plica::free_moments", model.vertices, BodyMoments<B>{model.mass, rest_, u, p}, blocks_, sums_);
    update_vertices<B>(exec, "plica::free_frame", 1, SetRigidFrame<B>{sums_, frame_});
    update_vertices<B>(exec, "plica::free_take", model.vertices, TakeRigidMotion<B>{model.mass, rest_, u, p, frame_});
  }

 private:
  Vectors<B> rest_;
  BlockSums<B> blocks_;
  Doubles<B> sums_, total_;
  RigidFrameOf<B> frame_;
};

}  // namespace plica
