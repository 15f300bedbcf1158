// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <sched.h>

#include <chrono>
#include <plica/drivers/run/core_wait.hpp>
#include <thread>

namespace plica {

namespace {

void work_for(std::chrono::milliseconds time) {
  const auto end = std::chrono::steady_clock::now() + time;
  while (std::chrono::steady_clock::now() < end) {
  }
}

}  // namespace

TEST(CoreWait, TwoThreadsOnOneCoreWaitForEachOther) {
  cpu_set_t before, one;
  ASSERT_EQ(sched_getaffinity(0, sizeof before, &before), 0);
  CPU_ZERO(&one);
  for (int cpu = 0; CPU_COUNT(&one) == 0; ++cpu)
    if (CPU_ISSET(cpu, &before)) CPU_SET(cpu, &one);
  ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
  const CoreWait wait;
  std::optional<double> share;
  {
    // on the same core, as its parent is
    std::jthread other([] { work_for(std::chrono::milliseconds(300)); });
    work_for(std::chrono::milliseconds(250));
    share = wait.share(2);
  }
  sched_setaffinity(0, sizeof before, &before);
  if (!share) GTEST_SKIP() << "the system does not tell";
  EXPECT_GT(*share, 0.2);  // 0.5 on an idle machine
  EXPECT_LE(*share, 1);
}

TEST(CoreWait, SleepIsNoWait) {
  const CoreWait wait;
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  const std::optional<double> share = wait.share(1);
  if (!share) GTEST_SKIP() << "the system does not tell";
  EXPECT_LT(*share, 0.5);
}

}  // namespace plica
