// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/level.hpp>
#include <plica/kernels/explicit/updates.hpp>
#include <plica/kernels/him/rigid_motion.hpp>

namespace plica {

/// A' = (1 - Pr) A (1 - Pr)^T + the exact answer to rigid motion, Pr the mass projection on it: for bodies that nothing holds.
template <class B>
class RigidPart {
 public:
  using Exec = typename B::Exec;
  explicit RigidPart(const Vectors<B>& rest)
      : rest_(rest),
        blocks_(static_cast<int>(rest.extent(0))),
        sums_("plica::him.moments", 16),
        frame_("plica::him.frame") {}

  /// Notes the rigid part of the forces f at a state and takes it out of them.
  void take(const Exec& exec, const Model<B>& model, const Vectors<B>& u, const Vectors<B>& f) const {
    reduce<B, 16>(exec, "plica::him_moments", model.vertices, BodyMoments<B>{model.mass, rest_, u, f}, blocks_, sums_);
    update_vertices<B>(exec, "plica::him_frame", 1, SetRigidFrame<B>{sums_, frame_});
    update_vertices<B>(exec, "plica::him_take_rigid", model.vertices,
                       TakeRigidForce<B>{model.mass, rest_, u, f, frame_});
  }

  /// Makes it the rigid part of the answer a.
  void put(const Exec& exec, const Model<B>& model, const Vectors<B>& u, const Vectors<B>& a) const {
    reduce<B, 6>(exec, "plica::him_momentum", model.vertices, MomentumOfAnswer<B>{model.mass, rest_, u, a, frame_},
                 blocks_, sums_);
    update_vertices<B>(exec, "plica::him_frame", 1, SetRigidRest<B>{sums_, frame_});
    update_vertices<B>(exec, "plica::him_put_rigid", model.vertices, AddRigidRest<B>{rest_, u, a, frame_});
  }

 private:
  Vectors<B> rest_;
  BlockSums<B> blocks_;
  Totals<B> sums_;
  RigidFrameOf<B> frame_;
};

}  // namespace plica
