// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <unistd.h>

#include <memory>
#include <string>

#include "beam.hpp"

namespace plica::bench {

struct Case {
  std::string name;  ///< material/precision/tets
  std::string material;
  Cells cells;
};

/// Sizes of the body; on a device one more, which fills it.
inline std::vector<Cells> body_sizes() {
  std::vector<Cells> sizes{small_beam, medium_beam};
  if (!Backend<float, Kokkos::DefaultExecutionSpace>::on_host) sizes.push_back(large_beam);
  return sizes;
}

/// f.operator()<Backend, Material>(case) for every material of the list, precision and size.
template <class Materials, class F>
void for_each_case(const F& f, const std::vector<Cells>& sizes = body_sizes()) {
  using Exec = Kokkos::DefaultExecutionSpace;
  for (const Cells& cells : sizes)
    Materials::for_each([&](auto material) {
      using Material = decltype(material);
      const std::string model = Material::name, tets = std::to_string(beam_tets(cells));
      f.template operator()<Backend<double, Exec>, Material>(
          {model + "/double/" + tets, model, cells});
      f.template operator()<Backend<float, Exec>, Material>(
          {model + "/float/" + tets, model, cells});
    });
}

/// Returns whether the machine's memory is larger than so many bytes.
inline bool has_room_for(double bytes) {
  return bytes <
         static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
}

namespace fixtures {
inline std::string name;
inline std::shared_ptr<void> last;
}  // namespace fixtures

/// What a benchmark works on. Google Benchmark calls it several times to find how often to repeat;
/// the last fixture is kept between the calls. `name` must tell fixtures of different types apart,
/// too; make() returns a shared pointer.
template <class F, class Make>
F& fixture(const std::string& name, const Make& make) {
  if (fixtures::name != name) {
    fixtures::last.reset();
    fixtures::last = std::shared_ptr<F>(make());
    fixtures::name = name;
  }
  return *static_cast<F*>(fixtures::last.get());
}

/// Before Kokkos ends.
inline void drop_fixture() { fixtures::last.reset(), fixtures::name.clear(); }

}  // namespace plica::bench
