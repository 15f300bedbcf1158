// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/solver/linear/stage_system.hpp>
#include <plica/drivers/solver/state_archive.hpp>
#include <plica/kernels/linear/solution_space.hpp>

namespace plica {

/// Where a solve starts: the best combination of the last few solutions; see kernels/linear/solution_space.hpp.
template <class B>
class LastSolutions {
 public:
  using Exec = typename B::Exec;

  explicit LastSolutions(int vertices);
  /// Where there are any: adds the guess to x, which is zero, and takes its part from r.
  void start(const Exec& exec, const StageSystem<B>& system, const BlockSums<B>& sums, const Vectors<B>& r,
             const Vectors<B>& x) const;
  bool any() const { return count_ > 0; }
  /// Takes in a solution, for the oldest.
  void add(const Exec& exec, const Vectors<B>& x);
  std::size_t bytes() const;
  void persist(StateArchive<B>& archive);

 private:
  SolutionSpace<B> space_;
  long count_ = 0;
};

}  // namespace plica
