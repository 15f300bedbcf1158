// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "beam.hpp"

namespace plica::bench {

struct Case {
  std::string name;  ///< material/precision/tets
  std::string material;
  Cells cells;
};

/// f.operator()<Backend, Material>(case) for every material of the list, precision and size.
template <class Materials, class F>
void for_each_case(const F& f, const std::vector<Cells>& sizes = {small_beam, medium_beam}) {
  using Exec = Kokkos::DefaultExecutionSpace;
  for (const Cells& cells : sizes)
    Materials::for_each([&](auto material) {
      using Material = decltype(material);
      const std::string model = Material::name, tets = std::to_string(beam_tets(cells));
      f.template operator()<Backend<double, Exec>, Material>({model + "/double/" + tets, model, cells});
      f.template operator()<Backend<float, Exec>, Material>({model + "/float/" + tets, model, cells});
    });
}

}  // namespace plica::bench
