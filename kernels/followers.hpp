// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/model.hpp>
#include <plica/kernels/vectors.hpp>

// Vertices that follow others: u = T y, see FollowingVertices. Nothing is launched where none does.
namespace plica {

/// Computes x = T x for some fields: the value of each follower, from those of its masters.
template <class B, int fields>
struct FollowMasters {
  Transfer<B> place;
  Vectors<B> x[fields];
  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    for (int f = 0; f < fields; ++f)
      set_vector<B>(x[f], place.target(i), value_at<B>(place, x[f], i));
  }
};

/// Adds to the force on each master its part of the forces on its followers.
template <class B>
struct CollectFollowers {
  FollowingVertices<B> followers;
  Vectors<B> f;
  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    const int a = followers.master(i);
    Vec3<typename B::Real> sum = vector_at<B>(f, a);
    for (int s = followers.first(i); s < followers.first(i + 1); ++s)
      sum += followers.weight(s) * vector_at<B>(f, followers.follower(s));
    set_vector<B>(f, a, sum);
  }
};

/// Sets the force on each follower to 0.
template <class B>
struct ClearFollowers {
  Indices<B> follower;
  Vectors<B> f;
  KOKKOS_INLINE_FUNCTION void operator()(int i) const { set_vector<B>(f, follower(i), {}); }
};

/// Puts followers where their masters are, in a field of displacements, velocities or changes of
/// them.
template <class B>
void follow_masters(const typename B::Exec& exec, const Model<B>& model, const Vectors<B>& x) {
  if (model.followers.any())
    update_vertices<B>(exec, "plica::follow_masters", model.followers.place.rows,
                       FollowMasters<B, 1>{model.followers.place, {x}});
}
/// Puts followers where their masters are, with their velocities.
template <class B>
void follow_masters(const typename B::Exec& exec, const Model<B>& model, const State<B>& state) {
  if (model.followers.any())
    update_vertices<B>(exec, "plica::follow_masters", model.followers.place.rows,
                       FollowMasters<B, 2>{model.followers.place, {state.u, state.v}});
}

/// Computes f = T^T f: forces on followers are handed to their masters, and are 0 afterwards. Thus
/// a second call changes nothing.
template <class B>
void collect_followers(const typename B::Exec& exec, const Model<B>& model, const Vectors<B>& f) {
  const FollowingVertices<B>& followers = model.followers;
  if (!followers.any()) return;
  update_vertices<B>(exec, "plica::collect_followers", followers.masters,
                     CollectFollowers<B>{followers, f});
  update_vertices<B>(exec, "plica::clear_followers", followers.place.rows,
                     ClearFollowers<B>{followers.place.target, f});
}

}  // namespace plica
