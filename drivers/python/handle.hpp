// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <memory>
#include <plica/drivers/python/access.hpp>
#include <plica/drivers/python/any_simulation.hpp>
#include <stdexcept>
#include <utility>

namespace plica::python {

/// Simulation that can be closed while Python still refers to it, such as in a traceback when the
/// interpreter ends. One thread at a time uses it.
class Handle {
 public:
  explicit Handle(std::shared_ptr<AnySimulation> simulation) : simulation_(std::move(simulation)) {}
  Handle(const Handle&) = default;
  Handle& operator=(const Handle&) = delete;
  ~Handle() { close(); }

  void close() {
    if (!simulation_) return;
    if (Access::lost_by_fork()) {
      new std::shared_ptr(std::move(simulation_));  // never freed: that would need Kokkos
      return;
    }
    const Access access(false);
    simulation_.reset();
  }

  /// The simulation in use. It stays alive, and no other thread uses one, while the object exists.
  class Use {
   public:
    explicit Use(std::shared_ptr<AnySimulation> simulation) : simulation_(std::move(simulation)) {}
    AnySimulation* operator->() const { return simulation_.get(); }

   private:
    Access access_;  // given back after the simulation is freed
    std::shared_ptr<AnySimulation> simulation_;
  };
  /// Waits until no other thread uses a simulation. Throws std::runtime_error if it is closed.
  Use use() const {
    const Access access;
    if (!simulation_) throw std::runtime_error("this simulation is closed");
    return Use(simulation_);
  }
  Use operator->() const { return use(); }

 private:
  std::shared_ptr<AnySimulation> simulation_;
};

}  // namespace plica::python
