// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <functional>
#include <plica/core/ranks.hpp>

namespace plica {

/// Ranks that are threads of one process, to try programs for several ranks. One thread runs at a
/// time; it hands the baton on where it waits. Messages come as late as they may, and what is
/// received is filled with NaN until then.
///
/// Mistakes that MPI would answer by a hang or wrong values throw std::logic_error here: all ranks
/// wait (it says who waits for whom), ranks call different functions, messages differ in length,
/// bytes change while they are sent.
class BatonRanks {
 public:
  /// @param seed  chooses who is next; 0: the next rank in turn
  explicit BatonRanks(int count, std::uint64_t seed = 0) : count_(count), seed_(seed) {}

  /// Does `work` as each rank. Throws what the first of them threw; the others are ended where they
  /// wait.
  void run(const std::function<void(Ranks&)>& work) const;

 private:
  int count_;
  std::uint64_t seed_;
};

}  // namespace plica
