// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <memory>
#include <plica/core/type_list.hpp>
#include <string_view>

// The steppers by name, from which a scene's integration.cycle chooses. This header has no kernels:
// each stepper's make() is in a source of its own.
namespace plica {

template <class B>
class Stepper;

/// Needs of a stepper at set-up.
struct StepperNeeds {
  bool coarse_meshes = false;  ///< whether it uses more meshes than the finest
  bool coarse_states = false;  ///< coarser levels have states of their own and are integrated
  /// limits of drift per vertex are needed, for mappings that switch between state and variation
  bool drift_limits = false;
  bool inherited_masses = false;  ///< coarse masses are restricted from the finer ones
  bool extrapolation = false;     ///< embeddings extrapolate, for any integration.outside
};

/// The finest level alone, without the others.
struct Single {
  static constexpr const char* name = "single";
  static constexpr const char* summary = "the finest level alone";
  static constexpr StepperNeeds needs{};
  template <class B>
  static std::unique_ptr<Stepper<B>> make();
};

// The paper's V-cycle with one of its mappings each way.
struct Rs {
  static constexpr const char* name = "rs";
  static constexpr const char* summary = "state down and up";
  static constexpr StepperNeeds needs{.coarse_meshes = true, .coarse_states = true};
  template <class B>
  static std::unique_ptr<Stepper<B>> make();
};
struct Rv {
  static constexpr const char* name = "rv";
  static constexpr const char* summary = "variation down and up";
  static constexpr StepperNeeds needs{.coarse_meshes = true, .coarse_states = true};
  template <class B>
  static std::unique_ptr<Stepper<B>> make();
};
struct Rsv {
  static constexpr const char* name = "rsv";
  static constexpr const char* summary =
      "the paper's: state where levels have drifted apart, variation elsewhere, down and up";
  static constexpr StepperNeeds needs{
      .coarse_meshes = true, .coarse_states = true, .drift_limits = true};
  template <class B>
  static std::unique_ptr<Stepper<B>> make();
};
struct RsvSv {
  static constexpr const char* name = "rsv_sv";
  static constexpr const char* summary = "state down, variation up";
  static constexpr StepperNeeds needs{.coarse_meshes = true, .coarse_states = true};
  template <class B>
  static std::unique_ptr<Stepper<B>> make();
};

struct Fas {
  static constexpr const char* name = "fas";
  static constexpr const char* summary =
      "state down, variation up, coarse forces corrected to the finest level's";
  static constexpr StepperNeeds needs{
      .coarse_meshes = true, .coarse_states = true, .inherited_masses = true};
  template <class B>
  static std::unique_ptr<Stepper<B>> make();
};

struct Him {
  static constexpr const char* name = "him";
  static constexpr const char* summary =
      "hierarchical inverse mass: one force of the finest level per step, answered by all levels";
  static constexpr StepperNeeds needs{.coarse_meshes = true, .extrapolation = true};
  template <class B>
  static std::unique_ptr<Stepper<B>> make();
};

/// All steppers. A new one needs an entry above, its name here, and its source.
using Steppers = TypeList<Single, Rs, Rv, Rsv, RsvSv, Fas, Him>;

// Classes of error for cycle auto, which is him or single: how far its displacements may be from
// those of the finest level alone, as a part of these.
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

/// All classes of error.
using ErrorClasses = TypeList<InteractiveClass, BalancedClass, AccurateClass>;

/// Returns the needs of the stepper of that name. For a name that is not in the list, they are
/// those of level 0 alone.
inline StepperNeeds stepper_needs(std::string_view name) {
  StepperNeeds needs;
  Steppers::visit(name, [&](auto stepper) { needs = decltype(stepper)::needs; });
  return needs;
}

}  // namespace plica
