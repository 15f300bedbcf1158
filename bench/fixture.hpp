// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <memory>
#include <string>

namespace plica::bench {

namespace fixtures {
inline std::string name;
inline std::shared_ptr<void> last;
}  // namespace fixtures

/// What a benchmark works on. Google Benchmark calls it several times to find how often to repeat; the last fixture is
/// kept between the calls. `name` must tell fixtures of different types apart, too;
/// make() returns a shared pointer.
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
