// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cstdio>
#include <limits>
#include <plica/core/text.hpp>

namespace {

using namespace plica;

TEST(Text, IsAsLongAsItsParts) {
  const std::string name(6000, 'a');
  EXPECT_EQ(text("level ", 2, ": ", name, std::string_view(" of "), std::size_t{3}), "level 2: " + name + " of 3");
  EXPECT_EQ(text(), "");
}

TEST(Text, WritesNumbersAsPrintfDoes) {
  const double largest = std::numeric_limits<double>::max(), least = std::numeric_limits<double>::denorm_min();
  const double infinite = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  for (const double value : {0.0, 1.0, -2.5, 1e-3, 1e-5, 123456.0, 1234567.0, 1.0 / 3, 1e21, largest, least, -least,
                             infinite, -infinite, nan})
    for (const int digits : {1, 2, 3, 4, 6, 9, 15, 17}) {
      char expected[64];
      std::snprintf(expected, sizeof expected, "%.*g", digits, value);
      EXPECT_EQ(number(value, digits), expected);
    }
  EXPECT_EQ(number(1.0 / 3), "0.333333");
}

}  // namespace
