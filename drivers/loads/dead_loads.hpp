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
  void name_fields(Archive<B>& archive) const override {
    for (const Load<B>& load : loads_) archive.owns(load.vertex, load.force);
  }

 private:
  std::vector<Load<B>> loads_;
};

/// Returns the weight of vertices as a load, which grows as its course says; gravity does not.
/// @param mass     [vertices] [kg]
/// @param gravity  [m/s^2]
template <class B>
Load<B> weight_load(const std::vector<double>& mass, const Point& gravity,
                    const LoadCourse& course);

}  // namespace plica
