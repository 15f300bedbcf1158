// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <plica/core/fields.hpp>
#include <plica/core/launch.hpp>

#if __has_include(<sys/mman.h>)
#include <sys/mman.h>
#endif

namespace plica {

namespace fields {

namespace {

constexpr std::size_t huge_page = std::size_t{1} << 21;

using Unmanaged = Kokkos::MemoryTraits<Kokkos::Unmanaged>;
template <class Memory>
using Bytes = Kokkos::View<unsigned char*, Kokkos::LayoutRight, Memory, Unmanaged>;
template <class Memory>
using ConstBytes = Kokkos::View<const unsigned char*, Kokkos::LayoutRight, Memory, Unmanaged>;

template <class Memory>
Bytes<Memory> at(void* x, std::size_t bytes) {
  return Bytes<Memory>(static_cast<unsigned char*>(x), bytes);
}
template <class Memory>
ConstBytes<Memory> at(const void* x, std::size_t bytes) {
  return ConstBytes<Memory>(static_cast<const unsigned char*>(x), bytes);
}

/// Asks for huge pages for the whole pages within these bytes, before they are first written.
void ask_for_huge_pages([[maybe_unused]] void* x, [[maybe_unused]] std::size_t bytes) {
#ifdef MADV_HUGEPAGE
  if (bytes < 2 * huge_page) return;
  const auto begin = (reinterpret_cast<std::uintptr_t>(x) + huge_page - 1) / huge_page * huge_page;
  const auto end = (reinterpret_cast<std::uintptr_t>(x) + bytes) / huge_page * huge_page;
  // only a hint: a system without huge pages goes on
  madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
#endif
}

/// Clears memory by all threads of the host. Pages then come where they are used, and the threads
/// share the handing out, which takes a system long.
void clear_on_host(void* x, std::size_t bytes) {
  using Exec = Kokkos::DefaultHostExecutionSpace;
  Kokkos::parallel_for(
      "plica::clear", Kokkos::RangePolicy<Exec>(0, (bytes + huge_page - 1) / huge_page),
      [=](std::size_t page) {
        const std::size_t begin = page * huge_page;
        std::memset(static_cast<char*>(x) + begin, 0, std::min(huge_page, bytes - begin));
      });
}

template <class Exec>
struct Copy {
  Exec exec;
  void* to;
  const void* from;
  std::size_t bytes;

  void operator()() const {
    using Memory = typename Exec::memory_space;
    Kokkos::deep_copy(exec, at<Memory>(to, bytes), at<Memory>(from, bytes));
  }
  bool operator==(const Copy& other) const {
    return to == other.to && from == other.from && bytes == other.bytes;
  }
};

template <class Exec, class Number>
struct Set {
  Exec exec;
  Number* x;
  std::size_t count;
  Number value;

  void operator()() const {
    using Memory = typename Exec::memory_space;
    Kokkos::deep_copy(exec, Kokkos::View<Number*, Kokkos::LayoutRight, Memory, Unmanaged>(x, count),
                      value);
  }
  bool operator==(const Set& other) const {
    return x == other.x && count == other.count &&
           std::memcmp(&value, &other.value, sizeof value) == 0;
  }
};

/// A Copy or a Set that waits among the launches.
template <class Task>
class GatheredTask final : public Launch {
 public:
  explicit GatheredTask(const Task& task) : task_(task) {}
  void go() const override { task_(); }
  bool same(const Launch& other) const override {
    const auto* const its = dynamic_cast<const GatheredTask*>(&other);
    return its && task_ == its->task_;
  }

 private:
  Task task_;
};

template <class Exec, class Task>
void in_order(const Task& task) {
  if constexpr (gathers<Exec>)
    if (auto* const queue = LaunchQueue<Exec>::now())
      return queue->add(std::make_unique<GatheredTask<Task>>(task));
  task();
}

}  // namespace

template <class Memory>
void prepare_new([[maybe_unused]] void* x, [[maybe_unused]] std::size_t bytes) {
  if constexpr (std::is_same_v<Memory, Kokkos::HostSpace>) ask_for_huge_pages(x, bytes);
}

template <class Memory>
void clear_new(void* x, std::size_t bytes) {
  if (bytes == 0) return;
  if constexpr (std::is_same_v<Memory, Kokkos::HostSpace>)
    bytes < 2 * huge_page ? void(std::memset(x, 0, bytes)) : clear_on_host(x, bytes);
  else
    Kokkos::deep_copy(at<Memory>(x, bytes), static_cast<unsigned char>(0));
}

template <class Exec>
void copy_bytes(const Exec& exec, void* to, const void* from, std::size_t bytes) {
  if (bytes > 0) in_order<Exec>(Copy<Exec>{exec, to, from, bytes});
}

template <class Memory>
void upload(void* to, const void* from, std::size_t bytes) {
  if (bytes > 0) Kokkos::deep_copy(at<Memory>(to, bytes), at<Kokkos::HostSpace>(from, bytes));
}

template <class Exec>
void download(const Exec& exec, void* to, const void* from, std::size_t bytes) {
  using Memory = typename Exec::memory_space;
  launch_gathered<Exec>();
  if constexpr (std::is_same_v<Memory, Kokkos::HostSpace>) {
    exec.fence("plica::download");
    if (bytes > 0) std::memcpy(to, from, bytes);
  } else {
    Kokkos::deep_copy(exec, at<Kokkos::HostSpace>(to, bytes), at<Memory>(from, bytes));
    exec.fence("plica::download");
  }
}

template <class Exec, class Number>
void set(const Exec& exec, Number* x, std::size_t count, Number value) {
  if (count > 0) in_order<Exec>(Set<Exec, Number>{exec, x, count, value});
}

#define PLICA_INSTANTIATE_SPACE(Exec)                                                        \
  template void copy_bytes<Exec>(const Exec&, void*, const void*, std::size_t);              \
  template void download<Exec>(const Exec&, void*, const void*, std::size_t);                \
  template void set<Exec, float>(const Exec&, float*, std::size_t, float);                   \
  template void set<Exec, double>(const Exec&, double*, std::size_t, double);                \
  template void set<Exec, int>(const Exec&, int*, std::size_t, int);                         \
  template void set<Exec, unsigned long long>(const Exec&, unsigned long long*, std::size_t, \
                                              unsigned long long);
PLICA_FOR_EACH_SPACE(PLICA_INSTANTIATE_SPACE)

#define PLICA_INSTANTIATE_MEMORY(Memory)                         \
  template void upload<Memory>(void*, const void*, std::size_t); \
  template void prepare_new<Memory>(void*, std::size_t);         \
  template void clear_new<Memory>(void*, std::size_t);
PLICA_FOR_EACH_MEMORY(PLICA_INSTANTIATE_MEMORY)

}  // namespace fields

#define PLICA_INSTANTIATE_FIELDS(Memory) PLICA_FIELDS(, Memory)
PLICA_FOR_EACH_MEMORY(PLICA_INSTANTIATE_FIELDS)

}  // namespace plica
