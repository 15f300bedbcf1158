// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/launch_queue.hpp>
#include <type_traits>

// Every kernel goes through launch(), every argument that changes from step to step is a Changing.
// A GPU takes a few microseconds for each single launch, and a step has dozens of short ones. So on
// a GPU the launches of a step are gathered, and sequences that repeat unchanged go out as one
// graph (launch_queue.hpp). A CPU launches at once, and nothing of this is left.
namespace plica {

/// Returns true where Kokkos lends the kernel global memory. It may be elsewhere at the next
/// launch.
template <class Policy>
bool takes_pooled_memory(const Policy& policy) {
  if constexpr (requires { policy.league_size(); })
    return policy.scratch_size(1) > 0;
  else
    return false;
}

/// Calls Kokkos::parallel_for, at once or when the queue is emptied. Memory that the kernel points
/// to must live until then.
template <class Policy, class Work>
void launch(const char* label, const Policy& policy, const Work& work) {
  using Exec = typename Policy::execution_space;
  if constexpr (gathers<Exec>)
    if (auto* const queue = LaunchQueue<Exec>::now()) {
      if (!takes_pooled_memory(policy))
        return queue->add(std::make_unique<Gathered<Policy, Work>>(label, policy, work));
      queue->launch_all();
    }
  Kokkos::parallel_for(label, policy, work);
}

/// Calls launch(std::true_type or std::false_type) by a condition that is known at run time only.
template <class Launch>
void by_case(bool condition, const Launch& launch) {
  if (condition)
    launch(std::true_type());
  else
    launch(std::false_type());
}

/// Sends out the launches that wait. Call it before the host waits for a space, or launches there
/// without launch().
template <class Exec>
void launch_gathered() {
  if constexpr (gathers<Exec>)
    if (auto* const queue = LaunchQueue<Exec>::now()) queue->launch_all();
}

/// Waits for all that was launched on an execution space.
template <class Exec>
void fence(const Exec& exec, const char* label) {
  launch_gathered<Exec>();
  exec.fence(label);
}

/// A kernel argument that may change in the next step: a place, a time, a factor. In gathered
/// launches it lies in device memory, so that the launch stays the same. It is made for one launch,
/// which comes at once: when the queue is emptied, its place is used again. Within a step only
/// kernels read it.
template <class B, class T, bool = gathers<typename B::Exec>>
class Changing {
 public:
  Changing() = default;
  Changing(const T& value)
      : value_(value) {}  // NOLINT(google-explicit-constructor): as if it were the value
  KOKKOS_INLINE_FUNCTION const T& operator*() const { return value_; }
  KOKKOS_INLINE_FUNCTION const T* operator->() const { return &value_; }

 private:
  T value_{};
};

template <class B, class T>
class Changing<B, T, true> {
  using Queue = LaunchQueue<typename B::Exec>;
  using Word = typename Queue::Word;
  static_assert(std::is_trivially_copyable_v<T> && alignof(T) <= alignof(Word));

 public:
  Changing() {
    const T value{};
    std::memcpy(bytes_, &value, sizeof value);
  }
  Changing(const T& value) {  // NOLINT(google-explicit-constructor): as if it were the value
    if (auto* const queue = Queue::now())
      place_ = static_cast<const T*>(queue->put(&value, sizeof value));
    if (!place_) std::memcpy(bytes_, &value, sizeof value);
  }
  KOKKOS_INLINE_FUNCTION const T& operator*() const {
    return place_ ? *place_ : *reinterpret_cast<const T*>(bytes_);
  }
  KOKKOS_INLINE_FUNCTION const T* operator->() const { return &**this; }

 private:
  const T* place_ = nullptr;
  // the value where it has no place on the device, in whole words
  alignas(
      Word) unsigned char bytes_[(sizeof(T) + sizeof(Word) - 1) / sizeof(Word) * sizeof(Word)] = {};
};

}  // namespace plica
