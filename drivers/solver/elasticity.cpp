// SPDX-License-Identifier: BSD-3-Clause
#include <plica/core/error.hpp>
#include <plica/drivers/solver/elasticity.hpp>
#include <plica/drivers/solver/registry.hpp>
#include <plica/kernels/materials/list.hpp>

namespace plica {

/// In a source of its own for each material.
template <class B, class Material>
std::unique_ptr<Elasticity<B>> make_elasticity_of();

template <class B>
std::unique_ptr<Elasticity<B>> make_elasticity(std::string_view material) {
  std::unique_ptr<Elasticity<B>> made;
  Materials::visit(material, [&](auto m) { made = make_elasticity_of<B, decltype(m)>(); });
  if (!made) throw InputError(unknown_name("material", material, names(materials())));
  return made;
}

#define PLICA_INSTANTIATE(Real, Exec) \
  template std::unique_ptr<Elasticity<Backend<Real, Exec>>> make_elasticity<Backend<Real, Exec>>(std::string_view);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
