// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Kokkos_Core.hpp>
#include <cstring>
#include <string>
#include <vector>

namespace plica {

/// A device view named "plica::NAME" with the values of a host vector, whose elements are rows of the view: an element of
/// std::array<T, N> for a View<T*[N]>. Views of other number types are converted by the caller.
template <class View, class Element>
View to_device(const std::string& name, const std::vector<Element>& values) {
  View view(Kokkos::view_alloc(Kokkos::WithoutInitializing, "plica::" + name), values.size());
  const auto host = Kokkos::create_mirror_view(view);
  static_assert(std::is_trivially_copyable_v<Element>);
  if (!values.empty()) {
    if (host.span() * sizeof(*host.data()) != values.size() * sizeof(Element))
      throw std::logic_error("to_device: rows of " + name + " differ in size");
    std::memcpy(static_cast<void*>(host.data()), values.data(), values.size() * sizeof(Element));
  }
  Kokkos::deep_copy(view, host);
  return view;
}

}  // namespace plica
