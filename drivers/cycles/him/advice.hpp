// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>
#include <plica/core/reports.hpp>
#include <plica/core/text.hpp>
#include <plica/drivers/body/initial_state.hpp>
#include <plica/drivers/contact/turning.hpp>
#include <string>
#include <vector>

// Advice on the cycle him for a scene with obstacles. The numbers were measured, see
// cmake/docs/explanation/him.md.
namespace plica {

/// Returns the largest speed of a given motion [m/s].
inline double fastest(const Motion& motion) {
  if (const auto* steady = std::get_if<SteadyMotion>(&motion)) return steady->velocity.norm();
  if (const auto* sine = std::get_if<SineMotion>(&motion))
    return 2 * std::numbers::pi * sine->frequency * sine->amplitude.norm();
  const auto& knots = std::get<PathMotion>(motion).knots;
  double most = 0;
  for (std::size_t k = 1; k < knots.size(); ++k)
    most = std::max(most, (knots[k].displacement - knots[k - 1].displacement).norm() /
                              (knots[k].time - knots[k - 1].time));
  return most;
}

/// Returns the largest speed of the obstacles near the body at its start [m/s].
/// It is the speed of an obstacle's motion plus that of its turn, at the distance from the axis
/// that both the body and the obstacle reach.
inline double fastest_obstacle(const Problem& problem) {
  double most = 0;
  for (const ObstacleOptions& o : problem.contact.obstacles) {
    double speed = fastest(o.motion);
    if (o.turn) {
      const Point about = turned_about(o);
      double reach = 0;
      for (const Point& x : places_at_start(problem.body))
        reach = std::max(reach, o.turn->axis.normalized().cross(x - about).norm());
      speed +=
          fastest(angle_of(*o.turn)) * std::min(reach, reach_from(about, o.turn->axis, o.shape));
    }
    most = std::max(most, speed);
  }
  return most;
}

/// Returns a sentence where an obstacle is too fast for him, else an empty string.
/// A fast obstacle excites detail, which him slows. `edge`: mean edge of the finest level [m].
inline std::string too_fast_for_him(const Problem& problem, double macro_step, double edge) {
  constexpr double most = 0.1;  // edges per step: there the error of displacement was 10 %
  const double speed = fastest_obstacle(problem), edges = speed * macro_step / edge;
  if (!(edges > most)) return {};
  return text("cycle him: an obstacle moves at ", number(speed, 3), " m/s, ", number(edges, 2),
              " of an edge in a macro step; above ", number(most, 2),
              " displacements are off by 10 % and more: expected a macro step below ",
              number(most * edge / speed, 3), " s, or cycle: single");
}

/// Returns a sentence where no inertia fitted the automatic step, else an empty string.
inline std::string shorter_than_usual(const HimReport& him, double macro_step) {
  if (!(him.usual_step > (1 + 1e-9) * macro_step)) return {};
  return text("cycle him: no inertia fits the automatic macro step of ", number(him.usual_step, 3),
              " s, and it was halved to ", number(macro_step, 3),
              " s: the run takes so much longer; expected a finer coarsest level, as by {coarsen: "
              "auto}, or cycle: single");
}

/// Returns sentences to print before a run: on its step, and on levels too coarse for contact.
inline std::vector<std::string> him_advice(const Problem& problem, const HimReport& him,
                                           const std::vector<LevelReport>& levels,
                                           double macro_step) {
  // 6 to 7 cells across are 343 to 512 vertices; the spaces that are made have 300
  constexpr int fewest = 300;
  std::vector<std::string> sentences;
  if (std::string shorter = shorter_than_usual(him, macro_step); !shorter.empty())
    sentences.push_back(std::move(shorter));
  if (!has_contact(problem)) return sentences;
  if (levels.size() > 1 && him.coarsest < fewest)
    sentences.push_back(text("cycle him: the coarsest level has ", him.coarsest,
                             " vertices, about ", number(std::cbrt(him.coarsest) - 1, 2),
                             " cells across; with 343 to 512, 6 to 7 across, errors of contact are "
                             "1.5 to 2 times smaller: "
                             "expected a finer last one in body.levels, or {coarsen: 430}"));
  if (std::string fast = too_fast_for_him(problem, macro_step, levels.front().mean_edge);
      !fast.empty())
    sentences.push_back(std::move(fast));
  return sentences;
}

}  // namespace plica
