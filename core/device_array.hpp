// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/backend.hpp>
#include <plica/core/error.hpp>
#include <string>
#include <type_traits>
#include <variant>

namespace plica {

/// A caller's vectors [n][3] in this backend's memory, float or double, in any layout. They come
/// from a Kokkos view, without a copy. The array does not own them: they must live until the work
/// that uses them is done.
template <class B, bool writable>
class DeviceArray {
  template <class T>
  using Of = Kokkos::View<std::conditional_t<writable, T, const T>* [3], Kokkos::LayoutStride,
                          typename B::Memory, Kokkos::MemoryTraits<Kokkos::Unmanaged>>;
  std::variant<Of<float>, Of<double>> view_;

 public:
  /// Throws InputError unless there are 3 columns.
  template <class View>
  requires Kokkos::is_view_v<View> DeviceArray(
      const View& view) {  // NOLINT(google-explicit-constructor): callers pass their views
    using T = typename View::non_const_value_type;
    static_assert(View::rank() == 2, "an array of vectors is a view of rank 2, [n][3]");
    static_assert(std::is_same_v<T, float> || std::is_same_v<T, double>,
                  "vectors are float or double");
    static_assert(!writable || std::is_same_v<T, typename View::value_type>,
                  "results need a view that is not const");
    static_assert(
        Kokkos::SpaceAccessibility<typename B::Exec, typename View::memory_space>::accessible,
        "the view must be where the simulation runs");
    if (view.extent(1) != 3)
      throw InputError("an array of vectors has 3 columns; this one is [" +
                       std::to_string(view.extent(0)) + "][" + std::to_string(view.extent(1)) +
                       "]");
    view_ =
        Of<T>(view.data(), Kokkos::LayoutStride(view.extent(0), view.stride(0), 3, view.stride(1)));
  }

  /// Returns the number of vectors.
  std::size_t size() const {
    return std::visit([](const auto& view) { return view.extent(0); }, view_);
  }
  /// Calls action(view) with the view in its own number type.
  template <class Action>
  void visit(const Action& action) const {
    std::visit(action, view_);
  }
};

/// Vectors that a simulation writes.
template <class B>
using DeviceOutput = DeviceArray<B, true>;
/// Vectors that a simulation reads.
template <class B>
using DeviceInput = DeviceArray<B, false>;

}  // namespace plica
