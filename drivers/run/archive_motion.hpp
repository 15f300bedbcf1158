// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <optional>
#include <plica/core/archive.hpp>
#include <plica/core/motion.hpp>
#include <utility>
#include <variant>

// Motions and turns in saved states.
namespace plica {

/// Names which alternative a variant holds. Reading a state, makes it that one.
template <class B, class... T>
void name_alternative(Archive<B>& archive, std::variant<T...>& value) {
  const std::size_t saved = archive.count(value.index());
  if (saved >= sizeof...(T))
    throw InputError("the saved state is damaged: there is no motion of kind " +
                     std::to_string(saved));
  if (saved == value.index()) return;
  [&]<std::size_t... i>(std::index_sequence<i...>) {
    ((saved == i ? static_cast<void>(value.template emplace<i>()) : void()), ...);
  }
  (std::index_sequence_for<T...>());
}

/// Names a point or vector.
template <class B>
void name_point(Archive<B>& archive, Point& point) {
  archive.number(point.data(), 3 * sizeof(double));
}

/// Names a translation.
template <class B>
void name_motion(Archive<B>& archive, Motion& motion) {
  name_alternative(archive, motion);
  if (auto* const steady = std::get_if<SteadyMotion>(&motion))
    name_point(archive, steady->velocity);
  if (auto* const path = std::get_if<PathMotion>(&motion)) {
    path->knots.resize(archive.count(path->knots.size()));
    for (PathMotion::Knot& knot : path->knots)
      archive.number(knot.time), name_point(archive, knot.displacement);
  }
  if (auto* const sine = std::get_if<SineMotion>(&motion)) {
    name_point(archive, sine->amplitude);
    archive.number(sine->frequency), archive.number(sine->phase);
  }
}

/// Names a turn, or that there is none.
template <class B>
void name_turn(Archive<B>& archive, std::optional<Turn>& turn) {
  if (archive.count(turn ? 1 : 0) == 0) return turn.reset();
  if (!turn) turn.emplace();
  name_point(archive, turn->axis);
  if (archive.count(turn->about ? 1 : 0) == 0)
    turn->about.reset();
  else
    name_point(archive, turn->about ? *turn->about : turn->about.emplace());
  name_point(archive, turn->rotation);
  name_alternative(archive, turn->angle);
  if (auto* const steady = std::get_if<SteadyTurn>(&turn->angle))
    archive.number(steady->angular_velocity);
  if (auto* const path = std::get_if<PathTurn>(&turn->angle)) {
    path->knots.resize(archive.count(path->knots.size()));
    for (PathTurn::Knot& knot : path->knots) archive.number(knot.time), archive.number(knot.angle);
  }
  if (auto* const sine = std::get_if<SineTurn>(&turn->angle))
    archive.number(sine->amplitude), archive.number(sine->frequency), archive.number(sine->phase);
}

}  // namespace plica
