// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Kokkos_Core.hpp>
#include <array>
#include <cstring>
#include <plica/core/mesh.hpp>
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

/// Points as the rows of a view.
template <class Real>
std::vector<std::array<Real, 3>> rows(const std::vector<Point>& points) {
  std::vector<std::array<Real, 3>> result;
  result.reserve(points.size());
  for (const Point& p : points)
    result.push_back({static_cast<Real>(p[0]), static_cast<Real>(p[1]), static_cast<Real>(p[2])});
  return result;
}

}  // namespace plica
