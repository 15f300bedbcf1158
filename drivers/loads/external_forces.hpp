// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <plica/core/device_array.hpp>
#include <plica/core/level.hpp>
#include <plica/kernels/linear/system_kernels.hpp>

namespace plica {

/// A request for a caller's own forces (tools, contact): the state of one level that is about to be
/// integrated, and where the forces go. Its arrays are on the device and belong to the simulation.
template <class B>
struct ForceRequest {
  typename B::Exec exec;    ///< enqueue kernels here; do not wait
  int level = 0;            ///< 0: the finest
  double time = 0;          ///< of the state [s]
  Vectors<B> rest;          ///< [vertices][3] m; a position is rest + displacement
  Vectors<B> displacement;  ///< [vertices][3] m
  Vectors<B> velocity;      ///< [vertices][3] m/s
  Vectors<B> force;         ///< [vertices][3] N: add to it
  /// with Problem::surface_forces, or where there are obstacles; else empty
  EmbeddedSurface<B> surface;

  // On implicit levels: what makes stiff forces part of the solve. On explicit ones: zero and
  // empty.
  double step = 0;  ///< h [s]
  /// 0 or h [s]: take stiff forces and gaps at displacement + ahead * velocity
  double ahead = 0;
  /// [vertices][6] xx yy zz xy xz yz N/m, zero on entry: add -d(force)/d(position) where that is
  /// positive semi-definite, and 1/h times the same of the velocity
  Blocks<B> stiffness;

  /// The embedded surface's points in this state, [points][3] m.
  void read_surface_positions(const DeviceOutput<B>& x) const;
  /// Their velocities, [points][3] m/s.
  void read_surface_velocities(const DeviceOutput<B>& v) const;
  /// Adds forces on these points, [points][3] N, as the level's vertices feel them.
  void add_surface_forces(const Vectors<B>& on_points) const;
};

/// Called by Simulation::step() at every force evaluation of every level, on the thread that steps.
template <class B>
using ExternalForces = std::function<void(const ForceRequest<B>&)>;

}  // namespace plica
