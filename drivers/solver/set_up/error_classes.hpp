// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/type_list.hpp>

// How far cycle auto may be from the finest level alone: parts of its displacements.
namespace plica {

struct InteractiveClass {
  static constexpr const char* name = "interactive";
  static constexpr const char* summary = "5 % of displacement";
  static constexpr double error = 0.05;
};
struct BalancedClass {
  static constexpr const char* name = "balanced";
  static constexpr const char* summary = "1 % of displacement";
  static constexpr double error = 0.01;
};
struct AccurateClass {
  static constexpr const char* name = "accurate";
  static constexpr const char* summary = "0.1 % of displacement";
  static constexpr double error = 0.001;
};

/// Every class there is.
using ErrorClasses = TypeList<InteractiveClass, BalancedClass, AccurateClass>;

}  // namespace plica
