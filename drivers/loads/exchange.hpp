// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/device_array.hpp>
#include <plica/core/mesh.hpp>
#include <plica/core/model.hpp>
#include <plica/core/transfer.hpp>
#include <plica/kernels/loads/surface_normals.hpp>

// Copies between a simulation's fields and a caller's arrays. All are enqueued, and throw
// InputError where the sizes differ.
namespace plica {

/// Computes to = rest + u.
template <class B>
void read_positions(const typename B::Exec&, const Vectors<B>& rest, const Vectors<B>& u,
                    const DeviceOutput<B>& to);
/// Computes to = field.
template <class B>
void read_vectors(const typename B::Exec&, const Vectors<B>& field, const DeviceOutput<B>& to);
/// Computes to = the positions of the surface's points in a state of its level, or their
/// velocities.
template <class B>
void read_surface(const typename B::Exec&, const EmbeddedSurface<B>&, const State<B>&,
                  bool velocities, const DeviceOutput<B>& to);
/// Returns the triangles around each point of a surface.
template <class B>
SurfaceFans<B> build_fans(const TriangleSurface& surface);
/// Computes to = the unit normals of a surface whose points are at x [m].
template <class B>
void read_normals(const typename B::Exec&, const SurfaceFans<B>&, const Vectors<B>& x,
                  const DeviceOutput<B>& to);
/// Computes u = from - rest.
template <class B>
void write_positions(const typename B::Exec&, const DeviceInput<B>& from, const Vectors<B>& rest,
                     const Vectors<B>& u);
/// Computes field = from.
template <class B>
void write_vectors(const typename B::Exec&, const DeviceInput<B>& from, const Vectors<B>& field);

}  // namespace plica
