// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/drivers/app/commands/resume.hpp>
#include <plica/drivers/app/scene/interval.hpp>
#include <stdexcept>

namespace plica::app {
namespace {

std::vector<long> due_steps(const Interval& every, double step, long last) {
  const Schedule schedule(every, step);
  std::vector<long> due;
  for (long n = 0; n <= last; ++n)
    if (schedule.due(n)) due.push_back(n);
  return due;
}

TEST(Interval, ReadsTimesAndSteps) {
  EXPECT_EQ(parse_interval("20 ms"), (Interval{0.02, 0}));
  EXPECT_EQ(parse_interval("0.5"), (Interval{0.5, 0}));
  EXPECT_EQ(parse_interval("10 steps"), (Interval{0, 10}));
  EXPECT_EQ(parse_interval("1step"), (Interval{0, 1}));
  for (const char* bad : {"", "steps", "0 steps", "-2 steps", "1.5 steps", "3 cm", "0 s", "-1", "10 stepps"})
    EXPECT_THROW(parse_interval(bad), std::invalid_argument) << bad;
}

TEST(Interval, OfCheckpoints) {
  EXPECT_EQ(checkpoint_interval("every=100"), (Interval{0, 100}));
  EXPECT_EQ(checkpoint_interval("every=100 steps"), (Interval{0, 100}));
  EXPECT_EQ(checkpoint_interval("every=0.1s"), (Interval{0.1, 0}));
  for (const char* bad :
       {"", "100", "every=", "every=0", "every=-1", "evry=1", "every=1 m", "every=99999999999999999999"})
    EXPECT_THROW(checkpoint_interval(bad), InputError) << bad;
}

TEST(Schedule, OfSteps) { EXPECT_EQ(due_steps({0, 4}, 0.1, 10), (std::vector<long>{0, 4, 8})); }

TEST(Schedule, TakesTheFirstStepAtOrAfterEachMultiple) {
  EXPECT_EQ(due_steps({0.25, 0}, 0.1, 10), (std::vector<long>{0, 3, 5, 8, 10}));
  EXPECT_EQ(due_steps({0.01, 0}, 0.1, 3), (std::vector<long>{0, 1, 2, 3}));
  EXPECT_EQ(due_steps({1e-300, 0}, 0.1, 3), (std::vector<long>{0, 1, 2, 3}));
}

TEST(Schedule, RoundingLosesNoStep) {
  for (const double step : {0.1, 0.03, 1e-3, 1.0 / 3, 3.7e-5}) {
    const auto due = due_steps({7 * step, 0}, step, 70000);
    ASSERT_EQ(due.size(), 10001) << step;
    for (std::size_t i = 0; i < due.size(); ++i) ASSERT_EQ(due[i], static_cast<long>(7 * i)) << step;
  }
}

}  // namespace
}  // namespace plica::app
