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
constexpr long shortest = 3;        // launches that are worth a graph
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

using Launches = std::vector<std::unique_ptr<Launch>>;

void go(const Launches& launches) {
  for (const auto& launch : launches) launch->go();
}

/// A sequence that is launched as one: as it is, on a CPU, which has no graphs.
template <class Exec>
class Graph {
 public:
  Graph(const Exec&, const Launches& launches) : launches_(launches) {}
  void go() const { plica::go(launches_); }

 private:
  const Launches& launches_;
};

#if defined(KOKKOS_ENABLE_CUDA)
void expect_cuda(cudaError_t result, const char* what) {
  if (result == cudaSuccess) return;
  throw std::runtime_error(std::string("CUDA graphs: ") + what + ": " + cudaGetErrorString(result));
}

template <>
class Graph<Kokkos::Cuda> {
 public:
  /// Captured, which launches nothing. Other threads may go on with theirs meanwhile, which Kokkos's own cuda_capture() does not let them.
  Graph(const Kokkos::Cuda& exec, const Launches& launches) : exec_(exec) {
    cudaGraph_t captured = nullptr;
    expect_cuda(cudaStreamBeginCapture(exec.cuda_stream(), cudaStreamCaptureModeThreadLocal), "begin of a capture");
    plica::go(launches);
    expect_cuda(cudaStreamEndCapture(exec.cuda_stream(), &captured), "end of a capture");
    const cudaError_t made = cudaGraphInstantiate(&graph_, captured, 0);
    cudaGraphDestroy(captured);
    expect_cuda(made, "instantiation");
  }
  ~Graph() {
    exec_.fence("plica::graph");
    cudaGraphExecDestroy(graph_);
  }
  Graph(const Graph&) = delete;
  Graph& operator=(const Graph&) = delete;
  void go() const { expect_cuda(cudaGraphLaunch(graph_, exec_.cuda_stream()), "launch"); }

 private:
  Kokkos::Cuda exec_;
  cudaGraphExec_t graph_ = nullptr;
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
  send_values();  // also for a launch that is not gathered
  if (waiting_.empty()) return;
  Launches launches;
  launches.swap(waiting_);
  const auto count = static_cast<long>(launches.size());
  const auto known = std::ranges::find_if(known_, [&](const auto& s) { return s->is(launches); });
  if (known != known_.end()) {
    Sequence& sequence = **known;
    if (!sequence.graph) sequence.graph = std::make_unique<Graph<Exec>>(exec_, sequence.launches);
    sequence.graph->go();
    in_graphs_ += count;
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
