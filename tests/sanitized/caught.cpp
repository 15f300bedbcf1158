// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <limits>
#include <vector>

// The sanitizers are there, and end a program that errs.
namespace plica::test {
namespace {

int beyond_the_end(int size) {
  const std::vector<int> numbers(static_cast<std::size_t>(size), 1);
  const volatile int* first = numbers.data();
  return first[size];
}

int too_large(int number) { return number + std::numeric_limits<int>::max(); }

TEST(Sanitizers, CatchWhatReadsBeyondTheEnd) {
  EXPECT_DEATH(beyond_the_end(7), "heap-buffer-overflow");
}
TEST(Sanitizers, CatchWhatOverflows) {
  EXPECT_DEATH(std::exit(too_large(7)), "signed integer overflow");
}

}  // namespace
}  // namespace plica::test
