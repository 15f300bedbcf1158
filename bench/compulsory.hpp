// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <plica/core/model.hpp>

namespace plica::bench {

template <class... Views>
double bytes_of(const Views&... views) {
  return static_cast<double>((fields::bytes_of(views) + ...));
}

/// Compulsory bytes, each array once: per tetrahedron its corners and shape, or per pair of
/// neighbours their constants; per vertex `numbers` of the precision.
template <class B>
double compulsory_bytes(const Model<B>& model, int numbers) {
  constexpr double s = sizeof(typename B::Real);
  if (const NodalRows<B>& rows = model.rows; rows.slices > 0)
    return bytes_of(rows.first, rows.neighbour, rows.gradient, rows.coupling, rows.first_surface,
                    rows.surface_neighbour, rows.surface_gradient, rows.inverse_volume) +
           model.vertices * (numbers * s);
  return model.tets * (4 * sizeof(std::uint16_t) + 10 * s) + model.vertices * (numbers * s);
}

}  // namespace plica::bench
