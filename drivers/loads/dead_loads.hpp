// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/loads/force_term.hpp>
#include <vector>

namespace plica {

/// Forces on vertices that depend on time alone: tractions at rest and total forces.
template <class B>
class DeadLoads final : public ForceTerm<B> {
 public:
  using Exec = typename B::Exec;
  explicit DeadLoads(std::vector<Load<B>> loads) : loads_(std::move(loads)) {}

  void add_force(const Exec& exec, const State<B>& at, double time, const Vectors<B>& f) override;
  std::size_t bytes() const override;

 private:
  std::vector<Load<B>> loads_;
};

}  // namespace plica
