// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <map>
#include <plica/core/baton_ranks.hpp>
#include <plica/drivers/run/simulation.hpp>
#include <string>
#include <vector>

// Runs on one process and on several ranks, and what they come to.
namespace plica::test {

inline constexpr int macro_steps = 6;

/// Changes of the pressed organ, by name.
using ProblemOptions = std::map<std::string, std::function<void(Problem&)>>;

/// Returns these options, and those of the body and its tool that every method takes.
inline ProblemOptions with_body_options(ProblemOptions options) {
  options.merge(ProblemOptions{
      {"relaxation",
       [](Problem& p) {
         p.body.material.prony = {{0.3, 0.01}, {0.2, 0.1}};
       }},
      {"regions",
       [](Problem& p) {
         p.body.regions["inclusion"].young_modulus = 60e3;
         p.body.regions["inclusion"].damping.mass = 9;
       }},
      {"sliding", [](Problem& p) { p.body.fixed.front().along = {"x"}; }},
      {"turn",
       [](Problem& p) {
         p.body.prescribed.front().motion = {};
         p.body.prescribed.front().rotate = Turn{Point::UnitX(), {}, Point::Zero(), SteadyTurn{3}};
       }},
      {"tool with mass", [](Problem& p) {
         p.contact.obstacles.front().mass = 0.05;
         p.contact.obstacles.front().coupling.stiffness = 50;
       }}});
  return options;
}

/// All that a run comes to.
struct Outcome {
  std::vector<Point> positions, velocities;
  std::vector<double> numbers;  ///< steps, energies, forces
  double contact_energy = 0;    ///< energy of contact at the end [J]
  Point force = Point::Zero();  ///< force of the ball over the last macro step [N]
};

/// Adds the numbers that all ranks know.
template <class B>
void add_numbers(const Simulation<B>& simulation, std::vector<double>& numbers) {
  const auto add = [&](const Point& p) { numbers.insert(numbers.end(), {p[0], p[1], p[2]}); };
  const Energies e = simulation.energies();
  numbers.insert(numbers.end(),
                 {simulation.macro_step(), simulation.levels()[0].critical_step, e.kinetic,
                  e.elastic, e.potential, e.contact, simulation.friction_work()});
  for (const Wrench& w : simulation.wrenches()) add(w.force), add(w.torque);
  for (const Reaction& r : simulation.reactions()) add(r.force), add(r.torque);
  for (const ToolState& t : simulation.tools()) add(t.displacement), add(t.velocity);
  for (const double depth : simulation.contact_depths()) numbers.push_back(depth);
  for (const double part : simulation.slipping()) numbers.push_back(part);
  for (const auto& [name, count] : simulation.counters())
    if (!name.starts_with("launches")) numbers.push_back(static_cast<double>(count));
  numbers.push_back(simulation.worst_residual());
}

inline bool equal_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}
inline bool equal_bits(const std::vector<Point>& a, const std::vector<Point>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Point)) == 0;
}

template <class B>
void take_steps(Simulation<B>& simulation, int steps = macro_steps) {
  for (int n = 0; n < steps; ++n)
    if (const auto bad = simulation.step_checked()) {
      ADD_FAILURE() << bad->text();
      return;
    }
}

template <class B>
Outcome on_one_process(const Problem& problem, int steps = macro_steps) {
  Simulation<B> simulation(problem);
  take_steps(simulation, steps);
  Outcome outcome{simulation.positions(), simulation.velocities(), {}};
  add_numbers(simulation, outcome.numbers);
  outcome.contact_energy = simulation.energies().contact;
  for (const Wrench& w : simulation.wrenches()) outcome.force += w.force;
  return outcome;
}

/// Expects that the ranks together have the same outcome, and each the same numbers.
template <class B>
void expect_on_ranks(const Outcome& expected, const Problem& problem, int count,
                     int steps = macro_steps) {
  SCOPED_TRACE(std::to_string(count) + " ranks");
  Outcome all;
  all.positions.resize(expected.positions.size(), Point::Zero());
  all.velocities = all.positions;
  BatonRanks(count).run([&](Ranks& ranks) {
    Simulation<B> simulation(problem, typename B::Exec(), ranks);
    take_steps(simulation, steps);
    const std::vector<Point> x = simulation.positions(), v = simulation.velocities();
    const std::vector<int> numbers = simulation.numbers();
    ASSERT_EQ(x.size(), numbers.size());
    for (std::size_t i = 0; i < numbers.size(); ++i)
      all.positions[static_cast<std::size_t>(numbers[i])] = x[i],
      all.velocities[static_cast<std::size_t>(numbers[i])] = v[i];
    std::vector<double> own;
    add_numbers(simulation, own);
    EXPECT_TRUE(equal_bits(own, expected.numbers)) << "rank " << ranks.own();
  });
  EXPECT_TRUE(equal_bits(all.positions, expected.positions));
  EXPECT_TRUE(equal_bits(all.velocities, expected.velocities));
}

/// Expects that the ranks save the bytes of one process, and that from its state they go on to its
/// end.
template <class B>
void expect_saved_on_ranks(const Problem& problem, const std::vector<int>& counts, int before,
                           int after) {
  Simulation<B> one(problem);
  take_steps(one, before);
  EXPECT_EQ(one.counters().contains("pressure_updates"), problem.body.pressure == "smoothed");
  const SavedState saved = one.save();
  take_steps(one, after);
  const SavedState end = one.save();
  for (const int count : counts)
    BatonRanks(count).run([&](Ranks& ranks) {
      Simulation<B> first(problem, typename B::Exec(), ranks);
      take_steps(first, before);
      const SavedState own = first.save();
      Simulation<B> second(problem, typename B::Exec(), ranks);
      second.restore(ranks.own() == 0 ? saved : SavedState{});
      take_steps(second, after);
      const SavedState last = second.save();
      if (ranks.own() > 0) return;
      EXPECT_TRUE(own.bytes == saved.bytes) << count << " ranks";
      EXPECT_TRUE(last.bytes == end.bytes) << count << " ranks";
    });
}

}  // namespace plica::test
