// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdlib>
#include <new>
#include <plica/core/launch_queue.hpp>
#include <stdexcept>
#include <string>

namespace plica {

namespace {

constexpr std::size_t room = 2048;  // words for values
constexpr long shortest = 3;        // launches that are worth a graph, at least
constexpr std::size_t most_known = 64;

/// Values as kernel arguments. They are on the way when the launch returns, and the host may change
/// its own copy.
template <class Memory>
struct PutWords {
  static constexpr std::size_t most = 400;
  std::uint64_t word[most];
  std::size_t first;
  Kokkos::View<std::uint64_t*, Memory> to;
  KOKKOS_INLINE_FUNCTION void operator()(std::size_t i) const { to(first + i) = word[i]; }
};

using Launches = std::vector<std::unique_ptr<Launch>>;

void go(const Launches& launches) {
  for (const auto& launch : launches) launch->go();
}

/// A sequence that is launched as one. A CPU has no graphs: its launches go out one by one.
template <class Exec>
class Graph {
 public:
  explicit Graph(const Launches& launches) : launches_(launches) {}
  static std::unique_ptr<Graph> capture(const Exec&, const Launches& launches) {
    return std::make_unique<Graph>(launches);
  }
  void go() const { plica::go(launches_); }

 private:
  const Launches& launches_;
};

#if defined(KOKKOS_ENABLE_CUDA)
template <>
class Graph<Kokkos::Cuda> {
 public:
  /// Captures launches without running them. Returns none where CUDA refuses, as in a stream that
  /// the caller captures. What a capture forbids is forbidden to this thread only; Kokkos's own
  /// cuda_capture() forbids it to all threads.
  static std::unique_ptr<Graph> capture(const Kokkos::Cuda& exec, const Launches& launches) {
    if (cudaStreamBeginCapture(exec.cuda_stream(), cudaStreamCaptureModeThreadLocal) != cudaSuccess)
      return refused();
    bool sound = true;
    try {
      plica::go(launches);
    } catch (const std::exception&) {
      sound = false;
    }
    cudaGraph_t captured = nullptr;
    sound = cudaStreamEndCapture(exec.cuda_stream(), &captured) == cudaSuccess && sound;
    cudaGraphExec_t graph = nullptr;
    sound = sound && cudaGraphInstantiate(&graph, captured, 0) == cudaSuccess;
    if (captured) cudaGraphDestroy(captured);
    return sound ? std::unique_ptr<Graph>(new Graph(exec, graph)) : refused();
  }
  ~Graph() {
    exec_.fence("plica::graph");
    cudaGraphExecDestroy(graph_);
  }
  Graph(const Graph&) = delete;
  Graph& operator=(const Graph&) = delete;
  void go() const {
    if (const cudaError_t result = cudaGraphLaunch(graph_, exec_.cuda_stream());
        result != cudaSuccess)
      throw std::runtime_error(std::string("launch of a CUDA graph: ") +
                               cudaGetErrorString(result));
  }

 private:
  Kokkos::Cuda exec_;
  cudaGraphExec_t graph_;

  Graph(const Kokkos::Cuda& exec, cudaGraphExec_t graph) : exec_(exec), graph_(graph) {}
  static std::unique_ptr<Graph> refused() {
    static_cast<void>(cudaGetLastError());  // else a later call reports it
    return {};
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
  std::unique_ptr<Graph<Exec>> graph = {};
  bool refused = false;  // CUDA does not make it a graph

  bool is(const Launches& others) const {
    return std::ranges::equal(launches, others,
                              [](const auto& a, const auto& b) { return a->same(*b); });
  }
};

template <class Exec, bool on>
LaunchQueue<Exec, on>::LaunchQueue(const Exec& exec)
    : exec_(exec), place_("plica::changing_values", room) {}
template <class Exec, bool on>
LaunchQueue<Exec, on>::~LaunchQueue() = default;

template <class Exec, bool on>
void LaunchQueue<Exec, on>::add(std::unique_ptr<Launch> launch) {
  waiting_.push_back(std::move(launch));
  if (values_.size() > room / 2) launch_all();
}

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
  send_values();  // a launch that is not gathered needs them, too
  if (waiting_.empty()) return;
  Launches launches;
  launches.swap(waiting_);
  const auto count = static_cast<long>(launches.size());
  const auto known = std::ranges::find_if(known_, [&](const auto& s) { return s->is(launches); });
  if (known != known_.end()) {
    Sequence& sequence = **known;
    if (!sequence.graph && !sequence.refused) {
      sequence.graph = Graph<Exec>::capture(exec_, sequence.launches);
      sequence.refused = !sequence.graph;
    }
    if (sequence.graph)
      sequence.graph->go(), in_graphs_ += count;
    else
      go(launches), alone_ += count;
    std::rotate(known_.begin(), known, known + 1);
    return;
  }
  go(launches);
  alone_ += count;
  if (count < shortest) return;
  if (known_.size() == most_known) known_.pop_back();
  known_.insert(known_.begin(), std::unique_ptr<Sequence>(new Sequence{std::move(launches)}));
}

#define PLICA_INSTANTIATE(Exec) template class LaunchQueue<Exec>;
PLICA_FOR_EACH_GATHERING_SPACE(PLICA_INSTANTIATE)

}  // namespace plica
