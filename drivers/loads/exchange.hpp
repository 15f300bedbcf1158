// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/device_array.hpp>
#include <plica/core/model.hpp>
#include <plica/core/transfer.hpp>

// Between a simulation's fields and a caller's arrays, enqueued. All throw InputError where the
// sizes differ.
namespace plica {

/// to = rest + u
template <class B>
void read_positions(const typename B::Exec&, const Vectors<B>& rest, const Vectors<B>& u,
                    const DeviceOutput<B>& to);
/// to = field
template <class B>
void read_vectors(const typename B::Exec&, const Vectors<B>& field, const DeviceOutput<B>& to);
/// to = the surface's points in a state of its level, or their velocities
template <class B>
void read_surface(const typename B::Exec&, const EmbeddedSurface<B>&, const State<B>&,
                  bool velocities, const DeviceOutput<B>& to);
/// u = from - rest
template <class B>
void write_positions(const typename B::Exec&, const DeviceInput<B>& from, const Vectors<B>& rest,
                     const Vectors<B>& u);
/// field = from
template <class B>
void write_vectors(const typename B::Exec&, const DeviceInput<B>& from, const Vectors<B>& field);

}  // namespace plica
