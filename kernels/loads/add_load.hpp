// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/level.hpp>

namespace plica {

/// f += factor * the load's forces, vertex by vertex.
template <class B>
struct AddLoad {
  using Real = typename B::Real;
  Indices<B> vertex;
  Vectors<B> force, f;
  Real factor;

  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    for (int k = 0; k < 3; ++k) f(vertex(i), k) += factor * force(i, k);
  }
};

template <class B>
void add_load(const typename B::Exec& exec, const Load<B>& load, double factor, const Vectors<B>& f) {
  Kokkos::parallel_for("plica::load", Kokkos::RangePolicy<typename B::Exec>(exec, 0, load.count),
                       AddLoad<B>{load.vertex, load.force, f, static_cast<typename B::Real>(factor)});
}

}  // namespace plica
