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

/// Whether launches on an execution space are gathered, and for which spaces of this build they
/// are.
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

/// A launch that waits.
class Launch {
 public:
  Launch() = default;
  virtual ~Launch() = default;
  Launch(const Launch&) = delete;
  Launch& operator=(const Launch&) = delete;
  /// Memory that is 0: what lies between the members of equal launches is equal, too.
  static void* operator new(std::size_t bytes);
  static void operator delete(void* memory);
  virtual void go() const = 0;
  /// The same kernel over the same range with the same arguments.
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
    if constexpr (std::is_trivially_copyable_v<Work>) clear_padding();  // or it is the caller's
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

/// Launches of one simulation, from the start of a step to its end or to where the host waits in
/// it. A sequence that comes for the second time is made a graph (on CUDA: captured), which is
/// replayed from then on: one launch in place of many. Any other goes out launch by launch. So what
/// is computed is the same in any case.
///
///   launch(), launch(), ...   waiting_: kernels and their arguments    values_: what Changing ones are now
///   launch_all()              the values to the device; then, of a sequence that is known_, its graph,
///                             of a new one each launch, and it is known_
template <class Exec, bool = gathers<Exec>>
class LaunchQueue {
 public:
  using Word = std::uint64_t;

  explicit LaunchQueue(const Exec& exec);
  ~LaunchQueue();
  LaunchQueue(const LaunchQueue&) = delete;
  LaunchQueue& operator=(const LaunchQueue&) = delete;

  /// While it lives, launches of this thread are gathered.
  class Scope {
   public:
    /// none: they go out at once
    explicit Scope(LaunchQueue* queue) : before_(now_) { now_ = queue; }
    /// Sends out what an exception left. Else launch_all() comes before it, since that may throw.
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
  /// The one that gathers; none: nothing does.
  static LaunchQueue* now() { return now_; }

  /// Where values then take up much of their room, all that waits goes out.
  void add(std::unique_ptr<Launch> launch);
  /// Where a value will lie on the device when the launches go out; none where there is no room.
  const void* put(const void* value, std::size_t bytes);
  /// Sends out what waits. Throws what the launches throw.
  void launch_all();

  long in_graphs() const { return in_graphs_; }  ///< launches so far that went out in a graph
  long alone() const { return alone_; }          ///< and one by one

 private:
  using Launches = std::vector<std::unique_ptr<Launch>>;
  struct Sequence;
  inline static thread_local LaunchQueue* now_ = nullptr;

  Exec exec_;
  Launches waiting_;
  std::vector<Word> values_;
  Kokkos::View<Word*, typename Exec::memory_space> place_;  // of the values
  std::vector<std::unique_ptr<Sequence>> known_;            // the last one first
  long in_graphs_ = 0, alone_ = 0;

  void send_values();
};

/// Where launches are not gathered.
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
