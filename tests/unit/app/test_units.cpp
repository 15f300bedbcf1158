// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <numbers>
#include <plica/drivers/app/commands/run_output.hpp>
#include <plica/drivers/app/scene/units.hpp>
#include <stdexcept>

namespace plica::app {
namespace {

struct Case {
  const char* text;
  double value;
  Dimension dimension;
};

TEST(Units, ReadsNumbersWithUnits) {
  const Case cases[] = {{"20 kPa", 20e3, pressure},
                        {"20kPa", 20e3, pressure},
                        {"1.5 MPa", 1.5e6, pressure},
                        {"2e-3 GPa", 2e6, pressure},
                        {"17 ms", 0.017, duration},
                        {"3 us", 3e-6, duration},
                        {"2 min", 120, duration},
                        {"4 cm", 0.04, length},
                        {"5 mm", 0.005, length},
                        {"5 um", 5e-6, length},
                        {"1000 kg/m^3", 1000, density},
                        {"1 g/cm^3", 1000, density},
                        {"1 g / cm3", 1000, density},
                        {"0.5 1/s", 0.5, rate},
                        {"0.5 /s", 0.5, rate},
                        {"2 Hz", 2, rate},
                        {"-9.81 m/s^2", -9.81, acceleration},
                        {"3 m/s", 3, velocity},
                        {"180 deg/s", std::numbers::pi, angular_velocity},
                        {"2 N/m^2", 2, pressure},
                        {"40 %", 0.4, plain}};
  for (const Case& c : cases) {
    const Measured measured = measure(c.text);
    EXPECT_NEAR(measured.value, c.value, 1e-12 * std::abs(c.value)) << c.text;
    ASSERT_TRUE(measured.dimension.has_value()) << c.text;
    EXPECT_EQ(*measured.dimension, c.dimension) << c.text << " is " << name_of(*measured.dimension);
  }
}

TEST(Units, ReadsPlainNumbers) {
  for (const auto& [text, value] : {std::pair{"3", 3.0}, {"-3.5", -3.5}, {"+2", 2.0}, {"1e3", 1e3}, {" .5 ", 0.5}}) {
    EXPECT_EQ(measure(text).value, value);
    EXPECT_FALSE(measure(text).dimension.has_value()) << text;
  }
}

TEST(Units, RefusesWhatIsNone) {
  for (const char* text : {"", "kPa", "nan", "inf", "1e999", "4 cmm", "4 m^x", "4 m^", "4 m//s", "4 m/", "4 *", "--3",
                           "+-3", "3 4", "0x10", "1,5"})
    EXPECT_THROW(measure(text), std::invalid_argument) << text;
}

TEST(Units, SuggestsTheNearestUnit) {
  try {
    measure("4 kpa");
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "unknown unit 'kpa'; did you mean 'kPa'?");
  }
}

TEST(Units, NamesDimensions) {
  EXPECT_EQ(name_of(pressure), "a pressure");
  EXPECT_EQ(unit_of(pressure), "Pa");
  EXPECT_EQ(name_of({.mass = 2, .time = -1}), "a quantity in kg^2 s^-1");
}

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
