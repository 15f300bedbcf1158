// SPDX-License-Identifier: BSD-3-Clause
#include "any_order.hpp"
#include "step_problems.hpp"
#include "support/simulate.hpp"

// Launches that are gathered (core/launch_queue.hpp). What a queue keeps is replayed with its own
// arguments: one that changes from step to step and is no Changing would show as other results, or
// as steps that are launched one by one for ever.
namespace {

using namespace plica;
using namespace plica::test;

using Exec = Host::Exec;
using Queue = LaunchQueue<Exec>;

std::vector<double> numbers_of(const Simulation<Host>& simulation) {
  std::vector<double> all;
  for (const auto& field : {simulation.positions(), simulation.velocities()})
    for (const Point& x : field) all.insert(all.end(), x.begin(), x.end());
  return all;
}

/// Other bytes on the stack each time: those between the arguments of kernels must not come from
/// there.
[[gnu::noinline]] void leave_rubbish(int n) {
  volatile unsigned char rubbish[1 << 17];
  for (volatile unsigned char& byte : rubbish) byte = static_cast<unsigned char>(n);
}

bool is_implicit(const Problem& problem) {
  return problem.integration.integrator[0] == "implicit_euler";
}

class Graphs : public testing::TestWithParam<StepProblem> {};

TEST_P(Graphs, AreWhatEveryStepIs) {
  constexpr int until_all_was_seen = 12;  // some arrays take turns
  const Problem problem = GetParam().make();
  Simulation<Host> gathered(problem), apart(problem);
  apart.use_graphs(false);
  const auto launched = [&](const char* how) { return gathered.counters().at(how); };
  advance(gathered, until_all_was_seen), advance(apart, until_all_was_seen);
  const long alone = launched("launches_alone"), in_graphs = launched("launches_in_graphs");
  for (int n = 0; n < 5; ++n) {
    leave_rubbish(n);
    gathered.step(), apart.step();
    EXPECT_TRUE(same_bits(numbers_of(gathered), numbers_of(apart))) << n;
  }
  const long more_alone = launched("launches_alone") - alone,
             more_in_graphs = launched("launches_in_graphs") - in_graphs;
  EXPECT_GE(more_in_graphs, 5 * 3);
  // an implicit step's iterations are as many as it takes, and what is done where they end is
  // seldom the same
  EXPECT_LE(more_alone, is_implicit(problem) ? more_in_graphs / 5 : 0);
  EXPECT_EQ(apart.counters().at("launches_in_graphs"), 0);
  EXPECT_EQ(apart.counters().at("launches_alone"), 0);  // that were gathered before
}

INSTANTIATE_TEST_SUITE_P(LikeDevice, Graphs, testing::ValuesIn(step_problems()),
                         [](const auto& each) { return std::string(each.param.name); });

// A step of another length, a state from outside, a tool that is told to go elsewhere: none is what
// came before.
TEST(Graphs, FollowWhatIsDoneBetweenSteps) {
  const Problem problem = driven("single", "symplectic_euler");
  Simulation<Host> gathered(problem), apart(problem);
  apart.use_graphs(false);
  for (Simulation<Host>* s : {&gathered, &apart}) {
    advance(*s, 6);
    s->move_obstacle(1, {0.001, 0, -0.003}, {0, 0, 0.2});
    advance(*s, 6);
    s->set_state(std::vector<Point>(s->positions().size(), Point(0, 0, 1e-3)), s->velocities());
    s->set_time(0.5);
    advance(*s, 6);
    s->end_at(s->time() + 2.5 * problem.integration.macro_step.value());
    advance(*s, 3);
  }
  EXPECT_TRUE(same_bits(numbers_of(gathered), numbers_of(apart)));
  EXPECT_GT(gathered.counters().at("launches_in_graphs"), 100);
}

struct Put {
  Changing<Host, double> value;
  Doubles<Host> to;
  void operator()(int i) const { to(i) = *value; }
};

// What the host waits for comes after what was launched before.
TEST(LaunchQueue, KeepsTheOrder) {
  const Exec exec;
  Queue queue(exec);
  const auto x = zeros<Doubles<Host>>("x", 2), y = zeros<Doubles<Host>>("y", 2);
  for (int n = 1; n <= 4; ++n) {
    const Queue::Scope gather(&queue);
    fill(exec, x, 1.0 * n);
    copy(exec, y, x);
    update_vertices<Host>(exec, "put", 1, Put{10.0 * n, x});
    EXPECT_EQ(x(0), n == 1 ? 0 : -1);
    EXPECT_EQ(host_values(exec, x), (std::vector<double>{10.0 * n, 1.0 * n}));
    EXPECT_EQ(y(0), n);
    update_vertices<Host>(exec, "put", 2, Put{-1, x});
  }
  EXPECT_EQ(x(1), -1);
  // another number is set every time, and one launch is no graph
  EXPECT_EQ(queue.alone(), 4 * 3 + 4);
}

struct PutByTeam {
  Changing<Host, double> value;
  Doubles<Host> to;
  void operator()(const Kokkos::TeamPolicy<Exec>::member_type& team) const {
    to(team.league_rank()) += *value;
  }
};

// A kernel that Kokkos lends memory is not gathered: it comes between what was launched before and
// after it.
TEST(LaunchQueue, LetsSomeLaunchesThrough) {
  const Exec exec;
  Queue queue(exec);
  const auto x = zeros<Doubles<Host>>("x", 1);
  const auto lent = Kokkos::TeamPolicy<Exec>(exec, 1, 1).set_scratch_size(1, Kokkos::PerTeam(64));
  for (int n = 1; n <= 4; ++n) {
    const Queue::Scope gather(&queue);
    launch("put", lent, PutByTeam{1.0 * n, x});
    EXPECT_EQ(x(0), n == 1 ? 1 : 1000.0 * (n - 1) + n);
    for (int i = 0; i < 3; ++i) update_vertices<Host>(exec, "put", 1, Put{10.0 * n, x});
    launch("put", lent, PutByTeam{1.0 * n, x});
    EXPECT_EQ(x(0), 11.0 * n);
    for (int i = 0; i < 3; ++i) update_vertices<Host>(exec, "put", 1, Put{1000.0 * n, x});
  }
  EXPECT_EQ(x(0), 4000);
  EXPECT_EQ(queue.alone(), 3);  // both are the same sequence: of three launches, with other values
  EXPECT_EQ(queue.in_graphs(), 7 * 3);
}

TEST(LaunchQueue, GoesOutInPartsWhereValuesAreMany) {
  const Exec exec;
  Queue queue(exec);
  const auto x = zeros<Doubles<Host>>("x", 3000);
  for (const int values : {5, 3000})
    for (int n = 1; n <= 3; ++n) {
      {
        const Queue::Scope gather(&queue);
        for (int i = 0; i < values; ++i)
          update_vertices<Host>(exec, "put", 1,
                                Put{100.0 * n + i, Kokkos::subview(x, std::pair(i, i + 1))});
        queue.launch_all();
      }
      for (int i = 0; i < values; ++i) ASSERT_EQ(x(i), 100.0 * n + i);
    }
  EXPECT_EQ(queue.in_graphs(), 2 * (5 + 3000));
  EXPECT_EQ(queue.alone(), 5 + 3000);
}

}  // namespace
