// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <memory>
#include <plica/core/backend.hpp>
#include <string>
#include <type_traits>
#include <vector>

// What is done with whole fields: memory, equal values, copies, the way to the host. Kokkos's own
// functions for this are large templates, which every source would compile again for every kind of
// field: here they are compiled once, in fields.cpp.
namespace plica {

namespace fields {

/// Copies bytes within the memory of an execution space, in the order of `exec`.
template <class Exec>
void copy_bytes(const Exec& exec, void* to, const void* from, std::size_t bytes);
/// New memory, before it is first written: where it is large and the host's, huge pages are asked
/// for. Kernels that read it in order then wait less.
template <class Memory>
void prepare_new(void* x, std::size_t bytes);
/// New memory is 0.
template <class Memory>
void clear_new(void* x, std::size_t bytes);
/// Bytes from the host to a memory space. Waits for all work.
template <class Memory>
void upload(void* to, const void* from, std::size_t bytes);
/// Bytes from an execution space's memory to the host, when `exec` has done all it was given. Waits
/// for that.
template <class Exec>
void download(const Exec& exec, void* to, const void* from, std::size_t bytes);
/// Sets numbers, in the order of `exec`. For float, double, int and unsigned long long.
template <class Exec, class Number>
void set(const Exec& exec, Number* x, std::size_t count, Number value);

template <class View>
std::size_t bytes_of(const View& x) {
  static_assert(std::is_same_v<typename View::array_layout, Kokkos::LayoutRight> ||
                View::rank() <= 1);
  return x.span() * sizeof(typename View::value_type);
}

}  // namespace fields

/// A field of n rows that are still to be written.
template <class View>
View unset(const std::string& label, std::size_t n) {
  const View view(Kokkos::view_alloc(label, Kokkos::WithoutInitializing), n);
  fields::prepare_new<typename View::memory_space>(view.data(), fields::bytes_of(view));
  return view;
}

/// A field of n rows, all zero.
template <class View>
View zeros(const std::string& label, std::size_t n) {
  const View view = unset<View>(label, n);
  fields::clear_new<typename View::memory_space>(view.data(), fields::bytes_of(view));
  return view;
}

/// A field whose memory another one owns, which outlives it. Copies of it cost nothing, those of an
/// owner count how many there are.
template <class View>
View lent(const View& x) {
  return View(x.data(), x.extent(0));
}

/// x = value, in the order of `exec`.
template <class Exec, class View>
void fill(const Exec& exec, const View& x, typename View::non_const_value_type value) {
  fields::set(exec, x.data(), fields::bytes_of(x) / sizeof value, value);
}

/// to = from, of the same kind and size, in the order of `exec`.
template <class Exec, class View>
void copy(const Exec& exec, const View& to, const std::type_identity_t<View>& from) {
  fields::copy_bytes(exec, to.data(), from.data(), fields::bytes_of(to));
}

/// Its numbers, row by row, when `exec` has done all it was given. Waits for that.
template <class Exec, class View>
std::vector<typename View::non_const_value_type> host_values(const Exec& exec, const View& x) {
  std::vector<typename View::non_const_value_type> values(x.span());
  fields::download(exec, values.data(), x.data(), fields::bytes_of(x));
  return values;
}

/// The field where the host reads it: itself, or a copy. Waits for all work.
template <class View>
auto on_host(const View& x) {
  return Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), x);
}

/// A field named "plica::NAME" with the values of a host vector, whose elements are rows of the
/// field: an element of std::array<T, N> for a View<T*[N]>. Fields of other number types are
/// converted by the caller.
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

/// A large field that the host writes: in its place where host and device share their memory, else
/// in a copy that upload() takes there.
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

// The kinds of fields that are common. Others work as well: they are compiled where they are used.
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
