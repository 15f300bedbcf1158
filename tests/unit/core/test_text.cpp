// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cstdio>
#include <limits>
#include <plica/core/error.hpp>
#include <plica/core/text.hpp>

namespace {

using namespace plica;

TEST(Text, IsAsLongAsItsParts) {
  const std::string name(6000, 'a');
  EXPECT_EQ(text("level ", 2, ": ", name, std::string_view(" of "), std::size_t{3}),
            "level 2: " + name + " of 3");
  EXPECT_EQ(text(), "");
}

TEST(Text, WritesNumbersAsPrintfDoes) {
  const double largest = std::numeric_limits<double>::max(),
               least = std::numeric_limits<double>::denorm_min();
  const double infinite = std::numeric_limits<double>::infinity(),
               nan = std::numeric_limits<double>::quiet_NaN();
  for (const double value : {0.0, 1.0, -2.5, 1e-3, 1e-5, 123456.0, 1234567.0, 1.0 / 3, 1e21,
                             largest, least, -least, infinite, -infinite, nan})
    for (const int digits : {1, 2, 3, 4, 6, 9, 15, 17}) {
      char expected[64];
      std::snprintf(expected, sizeof expected, "%.*g", digits, value);
      EXPECT_EQ(number(value, digits), expected);
    }
  EXPECT_EQ(number(1.0 / 3), "0.333333");
}

TEST(InputError, SaysWhere) {
  EXPECT_STREQ(InputError("bad").what(), "bad");
  EXPECT_STREQ(InputError("bad", {"a.yaml", 12}).what(), "a.yaml:12: bad");
  EXPECT_STREQ(InputError("bad", {"a.yaml", 0}).what(), "a.yaml: bad");
}

TEST(NearestName, FindsMisspellingsAndNothingElse) {
  const std::vector<std::string> choices{"euler", "symplectic_euler", "rk4"};
  EXPECT_EQ(nearest_name("symplectic_eular", choices), "symplectic_euler");
  EXPECT_EQ(nearest_name("eule", choices), "euler");
  EXPECT_EQ(nearest_name("rk5", choices), "rk4");
  EXPECT_EQ(nearest_name("conjugate", choices), "");
  EXPECT_EQ(nearest_name("euler", {}), "");
}

TEST(UnknownName, NamesTheNearestAndAll) {
  EXPECT_EQ(unknown_name("integrator", "rk5", {"euler", "rk4"}),
            "unknown integrator 'rk5'; did you mean 'rk4'? (choices: euler, rk4)");
  EXPECT_EQ(unknown_name("integrator", "wonderful", {"euler", "rk4"}),
            "unknown integrator 'wonderful' (choices: euler, rk4)");
}

const std::string bad = "\xEF\xBF\xBD";  // U+FFFD

TEST(ValidUtf8, KeepsWhatIsValid) {
  for (const char* text : {"", "liver", "L\xC3\xA4nge \xE2\x82\xAC \xF0\x9F\xAB\x80",
                           "\xEF\xBF\xBD", "\xF4\x8F\xBF\xBF"})
    EXPECT_EQ(valid_utf8(text), text);
  EXPECT_EQ(valid_utf8(std::string("a\0b", 3)), std::string("a\0b", 3));
}

TEST(ValidUtf8, ReplacesWhatIsNot) {
  EXPECT_EQ(valid_utf8("L\xE9"
                       "ber"),
            "L" + bad + "ber");                  // Latin-1
  EXPECT_EQ(valid_utf8("L\xE9"), "L" + bad);     // ... at the end
  EXPECT_EQ(valid_utf8("\x80\xBF"), bad + bad);  // nothing to follow
  // cut off: one for all that might have been
  EXPECT_EQ(valid_utf8("\xE2\x82x"), bad + "x");
  EXPECT_EQ(valid_utf8("\xC0\xAF"), bad + bad);                      // overlong
  EXPECT_EQ(valid_utf8("\xED\xA0\x80"), bad + bad + bad);            // half of a surrogate pair
  EXPECT_EQ(valid_utf8("\xF4\x90\x80\x80"), bad + bad + bad + bad);  // beyond U+10FFFF
  // the example of the Unicode standard
  EXPECT_EQ(valid_utf8("\xF0\x80\x80\x41"), bad + bad + bad + "A");
  EXPECT_EQ(valid_utf8("\xFF\xC3\xA4"), bad + "\xC3\xA4");
}

TEST(ValidUtf8, EveryPairOfBytesBecomesValid) {
  for (int a = 0; a < 256; ++a)
    for (int b = 0; b < 256; ++b) {
      const std::string once = valid_utf8(std::string{static_cast<char>(a), static_cast<char>(b)});
      EXPECT_EQ(valid_utf8(once), once) << a << " " << b;
    }
}

TEST(ValidNames, StayDistinct) {
  const auto names = valid_names({"L\xE9", "L\xE8", "L" + bad + " (2)", "skin", "L\xE9"});
  EXPECT_EQ(names.size(), 4);
  EXPECT_EQ(names.at("skin"), "skin");
  EXPECT_EQ(names.at("L\xE9"), "L" + bad);
  EXPECT_EQ(names.at("L" + bad + " (2)"), "L" + bad + " (2)") << "a name that was valid keeps it";
  EXPECT_EQ(names.at("L\xE8"), "L" + bad + " (3)");
}

}  // namespace
