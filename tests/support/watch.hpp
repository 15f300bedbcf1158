// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Kokkos_Core.hpp>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace plica::test {

/// Counts kernels, allocations, fences and regions by label, through Kokkos' profiling callbacks,
/// while it lives. One at a time.
class Watch {
 public:
  Watch() {
    current() = this;
    namespace tools = Kokkos::Tools::Experimental;
    tools::set_begin_parallel_for_callback(
        [](const char* label, std::uint32_t, std::uint64_t*) { launched(label); });
    tools::set_begin_parallel_reduce_callback(
        [](const char* label, std::uint32_t, std::uint64_t*) { launched(label); });
    tools::set_begin_parallel_scan_callback(
        [](const char* label, std::uint32_t, std::uint64_t*) { launched(label); });
    tools::set_allocate_data_callback(
        [](Kokkos_Profiling_SpaceHandle, const char* label, const void*, std::uint64_t) {
          if (current()) ++current()->allocations[label];
        });
    tools::set_push_region_callback([](const char* label) {
      if (current()) ++current()->regions[label];
    });
    tools::set_begin_fence_callback([](const char* label, std::uint32_t, std::uint64_t*) {
      // watching makes Kokkos itself wait, before and after each kernel
      if (current() && !std::string_view(label).starts_with("Kokkos::Tools::"))
        ++current()->fences[label];
    });
  }
  ~Watch() {
    current() = nullptr;
    namespace tools = Kokkos::Tools::Experimental;
    tools::set_begin_parallel_for_callback(nullptr);
    tools::set_begin_parallel_reduce_callback(nullptr);
    tools::set_begin_parallel_scan_callback(nullptr);
    tools::set_allocate_data_callback(nullptr);
    tools::set_push_region_callback(nullptr);
    tools::set_begin_fence_callback(nullptr);
  }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  std::map<std::string, int> launches, allocations, fences, regions;

  /// Labels of kernels and allocations that contain one of the words.
  std::vector<std::string> about(const std::vector<std::string>& words) const {
    std::vector<std::string> found;
    for (const auto* list : {&launches, &allocations})
      for (const auto& [label, count] : *list)
        for (const std::string& word : words)
          if (label.find(word) != std::string::npos) found.push_back(label);
    return found;
  }

 private:
  static Watch*& current() {
    static Watch* watch = nullptr;
    return watch;
  }
  static void launched(const char* label) {
    if (current()) ++current()->launches[label];
  }
};

}  // namespace plica::test
