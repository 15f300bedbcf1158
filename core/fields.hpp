// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <memory>
#include <plica/core/backend.hpp>
#include <string>
#include <type_traits>
#include <vector>

// Operations on whole fields: allocation, filling, copies, transfer to the host. Kokkos's own
// functions for these are large templates. Every source would compile them again for every kind of
// field; here they are compiled once, in fields.cpp.
namespace plica {

namespace fields {

/// Copies bytes within the memory of an execution space, in the order of `exec`.
template <class Exec>
void copy_bytes(const Exec& exec, void* to, const void* from, std::size_t bytes);
/// Asks for huge pages for new memory, where it is large and the host's. Call it before the first
/// write. Kernels that read the memory in order then wait less.
template <class Memory>
void prepare_new(void* x, std::size_t bytes);
/// Sets new memory to 0.
template <class Memory>
void clear_new(void* x, std::size_t bytes);
/// Copies bytes from the host to a memory space. Waits for all work.
template <class Memory>
void upload(void* to, const void* from, std::size_t bytes);
/// Copies bytes from an execution space's memory to the host, after all work that `exec` was given.
/// Waits for that work.
template <class Exec>
void download(const Exec& exec, void* to, const void* from, std::size_t bytes);
/// Sets numbers to a value, in the order of `exec`. A number is float, double, int or unsigned long
/// long.
template <class Exec, class Number>
void set(const Exec& exec, Number* x, std::size_t count, Number value);

template <class View>
std::size_t bytes_of(const View& x) {
  static_assert(std::is_same_v<typename View::array_layout, Kokkos::LayoutRight> ||
                View::rank() <= 1);
  return x.span() * sizeof(typename View::value_type);
}

}  // namespace fields

/// Makes a field of n rows that are still to be written.
template <class View>
View unset(const std::string& label, std::size_t n) {
  const View view(Kokkos::view_alloc(label, Kokkos::WithoutInitializing), n);
  fields::prepare_new<typename View::memory_space>(view.data(), fields::bytes_of(view));
  return view;
}

/// Makes a field of n rows, all zero.
template <class View>
View zeros(const std::string& label, std::size_t n) {
  const View view = unset<View>(label, n);
  fields::clear_new<typename View::memory_space>(view.data(), fields::bytes_of(view));
  return view;
}

/// Returns a view of a field that another view owns and that outlives it. Copies of it cost
/// nothing, while copies of an owning view count references.
template <class View>
View lent(const View& x) {
  return View(x.data(), x.extent(0));
}

/// Sets x = value, in the order of `exec`.
template <class Exec, class View>
void fill(const Exec& exec, const View& x, typename View::non_const_value_type value) {
  fields::set(exec, x.data(), fields::bytes_of(x) / sizeof value, value);
}

/// Copies `from` into `to`, of the same kind and size, in the order of `exec`.
template <class Exec, class View>
void copy(const Exec& exec, const View& to, const std::type_identity_t<View>& from) {
  fields::copy_bytes(exec, to.data(), from.data(), fields::bytes_of(to));
}

/// Returns the numbers of a field, row by row, after all work that `exec` was given. Waits for that
/// work.
template <class Exec, class View>
std::vector<typename View::non_const_value_type> host_values(const Exec& exec, const View& x) {
  std::vector<typename View::non_const_value_type> values(x.span());
  fields::download(exec, values.data(), x.data(), fields::bytes_of(x));
  return values;
}

/// Returns the field where the host can read it: itself, or a copy. Waits for all work.
template <class View>
auto on_host(const View& x) {
  return Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), x);
}

/// Makes a field named "plica::NAME" with the values of a host vector. Elements of the vector are
/// rows of the field: an element is std::array<T, N> for a View<T*[N]>. The caller converts values
/// for fields of other number types.
template <class View, class Element>
View to_device(const std::string& name, const std::vector<Element>& values) {
  static_assert(std::is_trivially_copyable_v<Element> &&
                alignof(typename View::value_type) <= alignof(Element) &&
                sizeof(Element) % sizeof(typename View::value_type) == 0);
  const View view = unset<View>("plica::" + name, values.size());
  const std::size_t bytes = values.size() * sizeof(Element);
  if (fields::bytes_of(view) != bytes)
    throw std::logic_error("to_device: rows of " + name + " differ in size");
  fields::upload<typename View::memory_space>(view.data(), values.data(), bytes);
  return view;
}

/// A large field that the host writes. Where host and device share their memory, the host writes in
/// place. Elsewhere it writes a copy, which upload() takes to the device.
template <class B, class View>
class HostWritten {
 public:
  using Number = typename View::value_type;
  HostWritten(const std::string& name, std::size_t n) : view_(unset<View>("plica::" + name, n)) {
    if constexpr (!B::for_cpu) copy_ = std::make_unique_for_overwrite<Number[]>(view_.span());
  }
  Number* data() const { return B::for_cpu ? view_.data() : copy_.get(); }
  View upload() const {
    if constexpr (!B::for_cpu)
      fields::upload<typename View::memory_space>(view_.data(), copy_.get(),
                                                  fields::bytes_of(view_));
    return view_;
  }

 private:
  View view_;
  std::unique_ptr<Number[]> copy_;
};

// Common kinds of fields, compiled in fields.cpp. Others work as well: they are compiled where they
// are used.
#define PLICA_FIELD(EXTERN, Memory, ...)                                                  \
  EXTERN template Kokkos::View<__VA_ARGS__, Kokkos::LayoutRight, Memory>                  \
  zeros<Kokkos::View<__VA_ARGS__, Kokkos::LayoutRight, Memory>>(const std::string& label, \
                                                                std::size_t n);
#define PLICA_FIELDS_OF(EXTERN, Memory, Number) \
  PLICA_FIELD(EXTERN, Memory, Number*)          \
  PLICA_FIELD(EXTERN, Memory, Number* [2])      \
  PLICA_FIELD(EXTERN, Memory, Number* [3])      \
  PLICA_FIELD(EXTERN, Memory, Number* [4])      \
  PLICA_FIELD(EXTERN, Memory, Number* [6])      \
  PLICA_FIELD(EXTERN, Memory, Number* [9]) PLICA_FIELD(EXTERN, Memory, Number* [10])
#define PLICA_FIELDS(EXTERN, Memory)      \
  PLICA_FIELDS_OF(EXTERN, Memory, float)  \
  PLICA_FIELDS_OF(EXTERN, Memory, double) \
  PLICA_FIELD(EXTERN, Memory, int*)       \
  PLICA_FIELD(EXTERN, Memory, int* [4])   \
  PLICA_FIELD(EXTERN, Memory, std::uint16_t*) PLICA_FIELD(EXTERN, Memory, double* [16])

#define PLICA_EXTERN_FIELDS(Memory) PLICA_FIELDS(extern, Memory)
PLICA_FOR_EACH_MEMORY(PLICA_EXTERN_FIELDS)
#undef PLICA_EXTERN_FIELDS

}  // namespace plica
