// SPDX-License-Identifier: BSD-3-Clause
#include <plica/core/error.hpp>
#include <plica/drivers/elastic/elasticity.hpp>
#include <plica/drivers/elastic/elements.hpp>
#include <plica/kernels/materials/list.hpp>

namespace plica {

// Defined in sources that the build writes, one for each material, one for all laws of tissue.
template <class B, class Material>
std::unique_ptr<Elasticity<B>> make_nodal_elasticity();

template <class B>
std::unique_ptr<Elasticity<B>> make_elasticity(std::string_view material, Element element) {
  std::unique_ptr<Elasticity<B>> made;
  Materials::visit(material, [&](auto m) {
    using Material = KernelsOf<decltype(m)>;
    if (element == Element::nodal)
      made = make_nodal_elasticity<B, Material>();
    else
      made = linear_elasticity<B, Material>();
  });
  if (!made) throw InputError(unknown_name("material", material, names(materials())));
  return made;
}

#define PLICA_INSTANTIATE(Real, Exec)                                                             \
  template std::unique_ptr<Elasticity<Backend<Real, Exec>>> make_elasticity<Backend<Real, Exec>>( \
      std::string_view, Element);
PLICA_FOR_EACH_PRECISION(PLICA_INSTANTIATE)

}  // namespace plica
