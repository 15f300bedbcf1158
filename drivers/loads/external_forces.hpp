// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <plica/core/device_array.hpp>
#include <plica/core/level_data.hpp>
#include <plica/kernels/linear/system_kernels.hpp>

namespace plica {

/// A request for a caller's own forces (tools, contact). It has the state of one level that is
/// about to be integrated, and the array to which forces are added. Its arrays are on the device
/// and belong to the simulation.
template <class B>
struct ForceRequest {
  typename B::Exec exec;    ///< enqueue kernels here; do not wait
  int level = 0;            ///< 0: the finest
  double time = 0;          ///< time of the state [s]
  Vectors<B> rest;          ///< [vertices][3] m; a position is rest + displacement
  Vectors<B> displacement;  ///< [vertices][3] m
  Vectors<B> velocity;      ///< [vertices][3] m/s
  Vectors<B> force;         ///< [vertices][3] N: add to it
  /// surface, with Problem::surface_forces or where there are obstacles; else empty
  EmbeddedSurface<B> surface;

  // On implicit levels, these make stiff forces part of the solve. On explicit ones they are zero
  // and empty.
  double step = 0;  ///< h [s]
  /// 0 or h [s]: take stiff forces and gaps at displacement + ahead * velocity
  double ahead = 0;
  /// [vertices][6] xx yy zz xy xz yz N/m, zero on entry: add -d(force)/d(position) where that is
  /// positive semi-definite, and 1/h times -d(force)/d(velocity) where that is
  Blocks<B> stiffness;

  /// Copies the positions of the embedded surface's points in this state to x, [points][3] m.
  void read_surface_positions(const DeviceOutput<B>& x) const;
  /// Copies the velocities of the embedded surface's points in this state to v, [points][3] m/s.
  void read_surface_velocities(const DeviceOutput<B>& v) const;
  /// Adds forces on the embedded surface's points, [points][3] N, to those on the level's vertices.
  void add_surface_forces(const Vectors<B>& on_points) const;
};

/// Function that adds a caller's forces. Simulation::step() calls it at every force evaluation of
/// every level, on the thread that steps.
template <class B>
using ExternalForces = std::function<void(const ForceRequest<B>&)>;

}  // namespace plica
