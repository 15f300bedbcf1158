// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdlib>
#include <new>
#include <optional>
#include <plica/core/launch_queue.hpp>

#if defined(KOKKOS_ENABLE_CUDA)
#include <Kokkos_Graph.hpp>
#endif

namespace plica {

namespace {

constexpr std::size_t room = 2048;   // words for values
constexpr std::size_t shortest = 3;  // launches that are worth a graph
constexpr std::size_t most_known = 16;

/// Values as arguments: they are on the way when the launch returns, and the host may change its own.
template <class Memory>
struct PutWords {
  static constexpr std::size_t most = 400;
  std::uint64_t word[most];
  std::size_t first;
  Kokkos::View<std::uint64_t*, Memory> to;
  KOKKOS_INLINE_FUNCTION void operator()(std::size_t i) const { to(first + i) = word[i]; }
};

template <class Exec>
struct Recorded {
  /// The launches as they are: a CPU has no graphs, but tests of how they are used.
  template <class Launches>
  void make(const Exec&, const Launches&) {}
  template <class Launches>
  void replay(const Exec&, const Launches& launches) const {
    for (const auto& launch : launches) launch->go();
  }
};

#if defined(KOKKOS_ENABLE_CUDA)
template <>
struct Recorded<Kokkos::Cuda> {
  std::optional<Kokkos::Experimental::Graph<Kokkos::Cuda>> graph;

  template <class Launches>
  void make(const Kokkos::Cuda& exec, const Launches& launches) {
    graph.emplace(Kokkos::Experimental::get_device_handle(exec));
    const auto all = [&launches](const Kokkos::Cuda&) {
      for (const auto& launch : launches) launch->go();
    };
    static_cast<void>(graph->root_node().cuda_capture(exec, all));
    graph->instantiate();
  }
  template <class Launches>
  void replay(const Kokkos::Cuda& exec, const Launches&) const {
    graph->submit(exec);
  }
};
#endif

}  // namespace

void* Launch::operator new(std::size_t bytes) {
  if (void* const memory = std::calloc(1, bytes)) return memory;
  throw std::bad_alloc();
}
void Launch::operator delete(void* memory) { std::free(memory); }

template <class Exec, bool on>
struct LaunchQueue<Exec, on>::Sequence {
  Launches launches;
  std::optional<Recorded<Exec>> graph = {};

  bool is(const Launches& others) const {
    return std::ranges::equal(launches, others, [](const auto& a, const auto& b) { return a->same(*b); });
  }
};

template <class Exec, bool on>
LaunchQueue<Exec, on>::LaunchQueue(const Exec& exec) : exec_(exec), place_("plica::changing_values", room) {}
template <class Exec, bool on>
LaunchQueue<Exec, on>::~LaunchQueue() = default;

template <class Exec, bool on>
const void* LaunchQueue<Exec, on>::put(const void* value, std::size_t bytes) {
  const std::size_t first = values_.size(), words = (bytes + sizeof(Word) - 1) / sizeof(Word);
  if (first + words > room) return nullptr;
  values_.resize(first + words);
  std::memcpy(&values_[first], value, bytes);
  return place_.data() + first;
}

template <class Exec, bool on>
void LaunchQueue<Exec, on>::send_values() {
  using Put = PutWords<typename Exec::memory_space>;
  using Policy = Kokkos::RangePolicy<Exec, Kokkos::IndexType<std::size_t>>;
  for (std::size_t first = 0; first < values_.size(); first += Put::most) {
    const std::size_t count = std::min(Put::most, values_.size() - first);
    Put put{{}, first, place_};
    std::copy_n(values_.begin() + static_cast<std::ptrdiff_t>(first), count, put.word);
    Kokkos::parallel_for("plica::changing_values", Policy(exec_, 0, count), put);
  }
  values_.clear();
}

template <class Exec, bool on>
void LaunchQueue<Exec, on>::launch_all() {
  if (waiting_.empty()) return;
  send_values();
  Launches launches;
  launches.swap(waiting_);
  const auto known = std::ranges::find_if(known_, [&](const Sequence& s) { return s.is(launches); });
  if (known == known_.end()) {
    for (const auto& launch : launches) launch->go();
    alone_ += static_cast<long>(launches.size());
    if (launches.size() < shortest) return;
    if (known_.size() == most_known) known_.pop_back();
    known_.insert(known_.begin(), Sequence{std::move(launches)});
    return;
  }
  if (!known->graph) known->graph.emplace().make(exec_, known->launches);
  known->graph->replay(exec_, known->launches);
  in_graphs_ += static_cast<long>(launches.size());
  std::rotate(known_.begin(), known, known + 1);
}

#define PLICA_INSTANTIATE(Exec) template class LaunchQueue<Exec>;
PLICA_FOR_EACH_GATHERING_SPACE(PLICA_INSTANTIATE)

}  // namespace plica
