// SPDX-License-Identifier: BSD-3-Clause
#include <plica/core/to_device.hpp>
#include <plica/drivers/loads/exchange.hpp>
#include <plica/kernels/loads/exchange.hpp>

namespace plica {

namespace {

/// Launches kernel(view) over the rows of a caller's array. Throws InputError unless it has `count`
/// rows.
template <class B, class Array, class Kernel>
void over_rows(const typename B::Exec& exec, const char* label, const Array& array,
               std::size_t count, const Kernel& kernel) {
  if (array.size() != count)
    throw InputError("an array of " + std::to_string(array.size()) + " vectors where there are " +
                     std::to_string(count));
  array.visit([&](const auto& view) {
    Kokkos::parallel_for(label,
                         Kokkos::RangePolicy<typename B::Exec>(exec, 0, static_cast<int>(count)),
                         kernel(view));
  });
}

}  // namespace

template <class B>
void read_positions(const typename B::Exec& exec, const Vectors<B>& rest, const Vectors<B>& u,
                    const DeviceOutput<B>& to) {
  over_rows<B>(exec, "plica::read_positions", to, u.extent(0), [&]<class Out>(const Out& view) {
    return ReadPositions<B, Out>{rest, u, view};
  });
}

template <class B>
void read_vectors(const typename B::Exec& exec, const Vectors<B>& field,
                  const DeviceOutput<B>& to) {
  over_rows<B>(exec, "plica::read_vectors", to, field.extent(0), [&]<class Out>(const Out& view) {
    return ReadVectors<B, Out>{field, view};
  });
}

template <class B>
void read_surface(const typename B::Exec& exec, const EmbeddedSurface<B>& surface,
                  const State<B>& state, bool velocities, const DeviceOutput<B>& to) {
  over_rows<B>(exec, "plica::read_surface", to, static_cast<std::size_t>(surface.points),
               [&]<class Out>(const Out& view) {
                 return ReadSurfacePoints<B, Out>{surface, state, velocities, view};
               });
}

template <class B>
SurfaceFans<B> build_fans(const TriangleSurface& surface) {
  std::vector<std::vector<int>> around(surface.vertices.size());
  for (const auto& t : surface.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      for (const std::size_t next : {k + 1, k + 2})
        around[static_cast<std::size_t>(t[k])].push_back(t[next % 3]);
  std::vector<int> first{0}, others;
  for (const std::vector<int>& own : around) {
    others.insert(others.end(), own.begin(), own.end());
    first.push_back(static_cast<int>(others.size()));
  }
  return {to_device<Indices<B>>("surface.first_around", first),
          to_device<Indices<B>>("surface.around", others)};
}

template <class B>
void read_normals(const typename B::Exec& exec, const SurfaceFans<B>& fans, const Vectors<B>& x,
                  const DeviceOutput<B>& to) {
  over_rows<B>(exec, "plica::read_normals", to, x.extent(0), [&]<class Out>(const Out& view) {
    return SurfaceNormals<B, Out>{fans, x, view};
  });
}

template <class B>
void write_positions(const typename B::Exec& exec, const DeviceInput<B>& from,
                     const Vectors<B>& rest, const Vectors<B>& u) {
  over_rows<B>(exec, "plica::write_positions", from, u.extent(0), [&]<class In>(const In& view) {
    return WritePositions<B, In>{view, rest, u};
  });
}

template <class B>
void write_vectors(const typename B::Exec& exec, const DeviceInput<B>& from,
                   const Vectors<B>& field) {
  over_rows<B>(exec, "plica::write_vectors", from, field.extent(0), [&]<class In>(const In& view) {
    return WriteVectors<B, In>{view, field};
  });
}

#define PLICA_INSTANTIATE(Real, Exec)                                                              \
  template void read_positions<Backend<Real, Exec>>(                                               \
      const Exec&, const Vectors<Backend<Real, Exec>>&, const Vectors<Backend<Real, Exec>>&,       \
      const DeviceOutput<Backend<Real, Exec>>&);                                                   \
  template void read_vectors<Backend<Real, Exec>>(                                                 \
      const Exec&, const Vectors<Backend<Real, Exec>>&, const DeviceOutput<Backend<Real, Exec>>&); \
  template void read_surface<Backend<Real, Exec>>(                                                 \
      const Exec&, const EmbeddedSurface<Backend<Real, Exec>>&, const State<Backend<Real, Exec>>&, \
      bool, const DeviceOutput<Backend<Real, Exec>>&);                                             \
  template SurfaceFans<Backend<Real, Exec>> build_fans<Backend<Real, Exec>>(                       \
      const TriangleSurface&);                                                                     \
  template void read_normals<Backend<Real, Exec>>(                                                 \
      const Exec&, const SurfaceFans<Backend<Real, Exec>>&, const Vectors<Backend<Real, Exec>>&,   \
      const DeviceOutput<Backend<Real, Exec>>&);                                                   \
  template void write_positions<Backend<Real, Exec>>(                                              \
      const Exec&, const DeviceInput<Backend<Real, Exec>>&, const Vectors<Backend<Real, Exec>>&,   \
      const Vectors<Backend<Real, Exec>>&);                                                        \
  template void write_vectors<Backend<Real, Exec>>(                                                \
      const Exec&, const DeviceInput<Backend<Real, Exec>>&, const Vectors<Backend<Real, Exec>>&);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
