// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <plica/drivers/app/output/progress.hpp>
#include <plica/drivers/app/output/terminal.hpp>

namespace plica::app {
namespace {

TEST(Text, NumbersInUnits) {
  EXPECT_EQ(in_units(0.00194, "s"), "1.94 ms");
  EXPECT_EQ(in_units(0.99999, "s"), "1 s");
  EXPECT_EQ(in_units(4500, "s"), "4.5e+03 s");
  EXPECT_EQ(in_units(50e3, "Pa"), "50 kPa");
  EXPECT_EQ(in_units(3e-6, "m"), "3 um");
  EXPECT_EQ(in_units(1.331, "kg"), "1.331 kg");
  EXPECT_EQ(in_units(0, "s"), "0 s");
  EXPECT_EQ(counted(1, "frame"), "1 frame");
  EXPECT_EQ(counted(0, "frame"), "0 frames");
  EXPECT_EQ(in_bytes(999), "999 B");
  EXPECT_EQ(in_bytes(12345678), "12.3 MB");
}

TEST(Text, TablesAlign) {
  EXPECT_EQ(text_table({{"a", "bb", "c"}, {"aaa", "b", ""}}, "<>>", ""), "a    bb  c\naaa   b\n");
}

TEST(Text, LinesWrap) { EXPECT_EQ(wrapped("one two three", 10, "  "), "  one two\n  three\n"); }

TEST(Text, ProgressFitsItsTerminal) {
  const std::string line = progress_line(0.62, 3, 500, 0.5, 100);
  EXPECT_EQ(line,
            "0.62 / 3.00 s [#####........................]  21 %   1000 steps/s   1.24 x real time    1.9 s left");
  for (int width = 1; width < 140; ++width)
    EXPECT_LT(progress_line(0.62, 3, 500, 0.5, width).size(), static_cast<std::size_t>(width)) << width;
}

}  // namespace
}  // namespace plica::app
