// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>
#include <plica/core/text.hpp>
#include <plica/drivers/solver/simulation.hpp>
#include <string>
#include <vector>

// Whether the cycle him is right for a scene with obstacles. The numbers were measured, see cmake/docs/him.md.
namespace plica {

/// The largest speed that an obstacle is given [m/s].
inline double fastest_obstacle(const ContactOptions& contact) {
  double fastest = 0;
  const auto speed = [](const auto& motion) {
    using M = std::decay_t<decltype(motion)>;
    if constexpr (std::is_same_v<M, SteadyMotion>) {
      return motion.velocity.norm();
    } else if constexpr (std::is_same_v<M, SineMotion>) {
      return 2 * std::numbers::pi * motion.frequency * motion.amplitude.norm();
    } else {
      double most = 0;
      for (std::size_t k = 1; k < motion.knots.size(); ++k)
        most = std::max(most, (motion.knots[k].displacement - motion.knots[k - 1].displacement).norm() /
                                  (motion.knots[k].time - motion.knots[k - 1].time));
      return most;
    }
  };
  for (const ObstacleOptions& o : contact.obstacles) fastest = std::max(fastest, std::visit(speed, o.motion));
  return fastest;
}

/// A sentence where a tool is too fast for him: it excites detail, which him slows. Else nothing.
inline std::string too_fast_for_him(const ContactOptions& contact, double macro_step, double edge) {
  constexpr double most = 0.1;  // edges per step: there the error of displacement was 10 %
  const double speed = fastest_obstacle(contact), edges = speed * macro_step / edge;
  if (!(edges > most)) return {};
  return text("cycle him: an obstacle moves at ", number(speed, 3), " m/s, ", number(edges, 2),
              " of an edge in a macro step; above ", number(most, 2),
              " displacements are off by 10 % and more: expected a macro step below ", number(most * edge / speed, 3),
              " s, or cycle: single");
}

/// What the levels lack for contact, in a sentence each.
inline std::vector<std::string> him_advice(const Problem& problem, const std::vector<LevelReport>& levels,
                                           double macro_step) {
  constexpr int fewest = 300;  // 6 to 7 cells across are 343 to 512 vertices; the spaces that are made have 300
  std::vector<std::string> sentences;
  if (!has_contact(problem)) return sentences;
  if (const LevelReport& last = levels.back(); levels.size() > 1 && last.vertices < fewest)
    sentences.push_back(
        text("cycle him: the coarsest level has ", last.vertices, " vertices, about ",
             number(std::cbrt(last.vertices) - 1, 2),
             " cells across; with 343 to 512, 6 to 7 across, errors of contact are 1.5 to 2 times smaller: "
             "expected a finer last one in body.levels, or {coarsen: 430}"));
  if (std::string fast = too_fast_for_him(problem.contact, macro_step, levels.front().mean_edge); !fast.empty())
    sentences.push_back(std::move(fast));
  return sentences;
}

}  // namespace plica
