// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/loads/exchange.hpp>
#include <plica/drivers/loads/external_forces.hpp>
#include <plica/kernels/contact/contact_kernels.hpp>

namespace plica {

template <class B>
void ForceRequest<B>::read_surface_positions(const DeviceOutput<B>& x) const {
  read_surface<B>(exec, surface, {displacement, velocity}, false, x);
}

template <class B>
void ForceRequest<B>::read_surface_velocities(const DeviceOutput<B>& v) const {
  read_surface<B>(exec, surface, {displacement, velocity}, true, v);
}

template <class B>
void ForceRequest<B>::add_surface_forces(const Vectors<B>& on_points) const {
  if (static_cast<int>(on_points.extent(0)) != surface.points)
    throw InputError(std::to_string(on_points.extent(0)) + " forces on " +
                     std::to_string(surface.points) + " surface points" +
                     (surface.points > 0 ? "" : ": give the body a surface, set surface_forces"));
  scatter_to_vertices<B>(exec, surface, on_points, force);
}

#define PLICA_INSTANTIATE(Real, Exec) template struct ForceRequest<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
