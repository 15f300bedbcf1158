// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/core/valid_utf8.hpp>

namespace plica {
namespace {

const std::string bad = "\xEF\xBF\xBD";  // U+FFFD

TEST(ValidUtf8, KeepsWhatIsValid) {
  for (const char* text :
       {"", "liver", "L\xC3\xA4nge \xE2\x82\xAC \xF0\x9F\xAB\x80", "\xEF\xBF\xBD", "\xF4\x8F\xBF\xBF"})
    EXPECT_EQ(valid_utf8(text), text);
  EXPECT_EQ(valid_utf8(std::string("a\0b", 3)), std::string("a\0b", 3));
}

TEST(ValidUtf8, ReplacesWhatIsNot) {
  EXPECT_EQ(valid_utf8("L\xE9"
                       "ber"),
            "L" + bad + "ber");                                      // Latin-1
  EXPECT_EQ(valid_utf8("L\xE9"), "L" + bad);                         // ... at the end
  EXPECT_EQ(valid_utf8("\x80\xBF"), bad + bad);                      // nothing to follow
  EXPECT_EQ(valid_utf8("\xE2\x82x"), bad + "x");                     // cut off: one for all that might have been
  EXPECT_EQ(valid_utf8("\xC0\xAF"), bad + bad);                      // overlong
  EXPECT_EQ(valid_utf8("\xED\xA0\x80"), bad + bad + bad);            // half of a surrogate pair
  EXPECT_EQ(valid_utf8("\xF4\x90\x80\x80"), bad + bad + bad + bad);  // beyond U+10FFFF
  EXPECT_EQ(valid_utf8("\xF0\x80\x80\x41"), bad + bad + bad + "A");  // the example of the Unicode standard
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
}  // namespace plica
