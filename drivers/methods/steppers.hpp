// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <memory>
#include <plica/core/type_list.hpp>
#include <string_view>

// The steppers by name: what a scene's integration.cycle chooses from. Light, without any kernel:
// each makes itself in a source of its own.
namespace plica {

template <class B>
class Stepper;

/// What a stepper needs from set-up.
struct StepperNeeds {
  bool coarse_meshes = false;  ///< it uses more than the finest mesh
  bool coarse_states = false;  ///< coarser levels have states of their own and are integrated
  /// per vertex, for mappings that switch between state and variation
  bool drift_limits = false;
  bool inherited_masses = false;  ///< coarse masses are restricted from the finer ones
  bool extrapolation = false;     ///< its embeddings extrapolate, for any integration.outside
};

/// Level 0 alone.
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

/// Every stepper there is. One more: its entry above, its name here, and its source.
using Steppers = TypeList<Single, Rs, Rv, Rsv, RsvSv, Fas, Him>;

// How far cycle auto, which is him or single, may be from the finest level alone: parts of its
// displacements.
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

/// Every class of error there is.
using ErrorClasses = TypeList<InteractiveClass, BalancedClass, AccurateClass>;

/// The needs of the stepper of that name; of level 0 alone for a name that is not in the list.
inline StepperNeeds stepper_needs(std::string_view name) {
  StepperNeeds needs;
  Steppers::visit(name, [&](auto stepper) { needs = decltype(stepper)::needs; });
  return needs;
}

}  // namespace plica
