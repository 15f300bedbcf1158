// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Kokkos_Core.hpp>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <plica/core/like_device.hpp>
#include <vector>

namespace plica {

/// True where launches on an execution space are gathered. PLICA_FOR_EACH_GATHERING_SPACE lists the
/// spaces of this build for which they are.
#if defined(PLICA_LIKE_DEVICE)
template <class Exec>
inline constexpr bool gathers = true;
#define PLICA_FOR_EACH_GATHERING_SPACE(DO) DO(Kokkos::OpenMP)
#elif defined(KOKKOS_ENABLE_CUDA) && \
    defined(KOKKOS_IMPL_CUDA_USE_GRID_CONSTANT)  // arguments go along with a launch
template <class Exec>
inline constexpr bool gathers = std::is_same_v<Exec, Kokkos::Cuda>;
#define PLICA_FOR_EACH_GATHERING_SPACE(DO) DO(Kokkos::Cuda)
#else
template <class Exec>
inline constexpr bool gathers = false;
#define PLICA_FOR_EACH_GATHERING_SPACE(DO)
#endif

/// A launch that waits in a queue.
class Launch {
 public:
  Launch() = default;
  virtual ~Launch() = default;
  Launch(const Launch&) = delete;
  Launch& operator=(const Launch&) = delete;
  /// Returns memory that is 0. Bytes between the members of equal launches are then equal, too.
  static void* operator new(std::size_t bytes);
  static void operator delete(void* memory);
  virtual void go() const = 0;
  /// Returns true for the same kernel over the same range with the same arguments.
  virtual bool same(const Launch& other) const = 0;
};

template <class Policy, class Work>
class Gathered final : public Launch {
 public:
  static_assert(sizeof(Work) < 3500,
                "arguments are copied and compared in every step: take those that are read");
  static_assert(alignof(Work) <= alignof(std::max_align_t));

  Gathered(const char* label, const Policy& policy, const Work& work)
      : label_(label), policy_(policy), work_(work) {
    // otherwise padding would be that of the caller's copy
    if constexpr (std::is_trivially_copyable_v<Work>) clear_padding();
  }

  void go() const override { Kokkos::parallel_for(label_, policy_, work_); }
  bool same(const Launch& other) const override {
    const auto* const its = dynamic_cast<const Gathered*>(&other);
    return its && is_same_range(policy_, its->policy_) &&
           std::memcmp(&work_, &its->work_, sizeof work_) == 0;
  }

 private:
  const char* label_;
  Policy policy_;
  Work work_;

  void clear_padding() {
#if defined(__has_builtin)
#if __has_builtin(__builtin_clear_padding)
    __builtin_clear_padding(&work_);
#endif
#endif
  }
  static bool is_same_range(const Policy& a, const Policy& b) {
    if constexpr (requires { a.league_size(); })
      return a.league_size() == b.league_size() && a.team_size() == b.team_size() &&
             a.scratch_size(0) == b.scratch_size(0);
    else
      return a.begin() == b.begin() && a.end() == b.end();
  }
};

/// Queue of the launches of one simulation, from the start of a step to its end. Where the host
/// waits within the step, the launches go out before. A sequence that comes for the second time is
/// made a graph (on CUDA: captured). The graph is then replayed: one launch in place of many. Any
/// other sequence goes out launch by launch. The results are the same in any case.
///
///   launch(), launch(), ...   waiting_: kernels and arguments; values_: of the Changing ones
///   launch_all()              the values to the device; then for a sequence in known_ its graph,
///                             for a new one each launch, and it goes into known_
template <class Exec, bool = gathers<Exec>>
class LaunchQueue {
 public:
  using Word = std::uint64_t;

  explicit LaunchQueue(const Exec& exec);
  ~LaunchQueue();
  LaunchQueue(const LaunchQueue&) = delete;
  LaunchQueue& operator=(const LaunchQueue&) = delete;

  /// Gathers the launches of this thread while it lives.
  class Scope {
   public:
    /// Gathers into a queue; none: launches go out at once.
    explicit Scope(LaunchQueue* queue) : before_(now_) { now_ = queue; }
    /// Sends out the launches that an exception left. Without one, launch_all() is called before,
    /// since it may throw.
    ~Scope() {
      try {
        if (now_) now_->launch_all();
      } catch (...) {  // the first exception says what is wrong
      }
      now_ = before_;
    }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    LaunchQueue* before_;
  };
  /// Returns the queue that gathers on this thread; none: launches are not gathered.
  static LaunchQueue* now() { return now_; }

  /// Adds a launch. Sends out all launches that wait where values take up more than half of their
  /// room.
  void add(std::unique_ptr<Launch> launch);
  /// Returns the address that a value will have on the device when the launches go out. None where
  /// there is no room.
  const void* put(const void* value, std::size_t bytes);
  /// Sends out the launches that wait. Throws what they throw.
  void launch_all();

  long in_graphs() const { return in_graphs_; }  ///< launches so far that went out in a graph
  long alone() const { return alone_; }          ///< launches so far that went out one by one

 private:
  using Launches = std::vector<std::unique_ptr<Launch>>;
  struct Sequence;
  inline static thread_local LaunchQueue* now_ = nullptr;

  Exec exec_;
  Launches waiting_;
  std::vector<Word> values_;
  Kokkos::View<Word*, typename Exec::memory_space> place_;  // memory of the values
  std::vector<std::unique_ptr<Sequence>> known_;            // the last used first
  long in_graphs_ = 0, alone_ = 0;

  void send_values();
};

/// Queue for a space where launches are not gathered.
template <class Exec>
class LaunchQueue<Exec, false> {
 public:
  explicit LaunchQueue(const Exec&) {}
  struct Scope {
    explicit Scope(LaunchQueue*) {}
    ~Scope() {}  // NOLINT(modernize-use-equals-default): not unused where it is named
  };
  static constexpr long in_graphs() { return 0; }
  static constexpr long alone() { return 0; }
};

}  // namespace plica
