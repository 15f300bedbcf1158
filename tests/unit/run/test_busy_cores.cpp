// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <sched.h>

#include <algorithm>
#include <chrono>
#include <plica/drivers/run/busy_cores.hpp>
#include <thread>
#include <vector>

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

namespace {

// A machine on which a step takes so long by so many threads, and which tells how long they wait
template <class Pace>
std::vector<int> taken(int all, int looks, double waited, const Pace& pace) {
  ThreadChoice choice(all);
  std::vector<int> threads;
  for (int n = 0; n < looks; ++n) {
    threads.push_back(choice.threads());
    choice.look(0.1 * n, pace(choice.threads()), choice.threads() > 1 ? waited : 0);
  }
  return threads;
}

}  // namespace

TEST(ThreadChoice, StaysWithAllThreadsThatHaveCores) {
  const std::vector<int> threads = taken(8, 100, 0.01, [](int n) { return 1.0 / n; });
  EXPECT_EQ(std::count(threads.begin(), threads.end(), 8), 99);  // and one trial
}

TEST(ThreadChoice, TakesAsManyThreadsAsASmallBodyGainsBy) {
  for (const int best : {1, 2, 4}) {
    const std::vector<int> threads =
        taken(16, 300, 0, [&](int n) { return n > best ? 2.0 * n : 1.0 / n; });
    EXPECT_GT(std::count(threads.begin() + 10, threads.end(), best), 0.9 * 290) << best;
  }
}

TEST(ThreadChoice, OneCoreThatIsTakenHoldsUpTwoThreads) {
  const std::vector<int> threads =
      taken(2, 300, 0.3, [](int n) { return n == 2 ? 15e-3 : 3.3e-3; });
  EXPECT_EQ(threads[0], 2);
  EXPECT_GT(std::count(threads.begin() + 2, threads.end(), 1), 0.95 * 298);  // the rest are trials
  EXPECT_GT(std::count(threads.begin() + 2, threads.end(), 2), 1);
}

TEST(ThreadChoice, OneOfSixteenCoresIsLeftToOthers) {
  const std::vector<int> threads =
      taken(16, 300, 0.1, [](int n) { return n == 16 ? 2.0 / 16 : 1.0 / n; });
  EXPECT_GT(std::count(threads.begin(), threads.end(), 15), 0.8 * 300);
}

TEST(ThreadChoice, WaitsThatFewerThreadsDoNotShortenAreEndured) {
  const std::vector<int> threads = taken(2, 300, 0.3, [](int n) { return 1.0 / n; });
  EXPECT_GT(std::count(threads.begin(), threads.end(), 2), 0.95 * 300);
}

TEST(ThreadChoice, AllThreadsComeBackWhenCoresAreFree) {
  ThreadChoice choice(2);
  for (int n = 0; n < 1000; ++n) {
    const bool busy = n < 200;
    const double pace = busy && choice.threads() == 2 ? 15e-3 : 3.3e-3 / choice.threads();
    choice.look(0.1 * n, pace, busy && choice.threads() == 2 ? 0.3 : 0);
    if (n == 199) {
      EXPECT_EQ(choice.threads(), 1);
    }
  }
  EXPECT_EQ(choice.threads(), 2);
}

}  // namespace plica
