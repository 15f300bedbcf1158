// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>
#include <plica/core/baton_ranks.hpp>
#include <plica/core/error.hpp>
#include <plica/core/one_rank.hpp>
#include <random>

using namespace plica;

namespace {

std::span<const std::byte> sent_bytes(const std::vector<double>& values, std::size_t first,
                                      std::size_t count) {
  return std::as_bytes(std::span(values).subspan(first, count));
}

std::span<std::byte> received_bytes(std::vector<double>& values, std::size_t first,
                                    std::size_t count) {
  return std::as_writable_bytes(std::span(values).subspan(first, count));
}

// Bytes of a text.
Bytes in_bytes(const std::string& text) {
  Bytes bytes(text.size());
  if (!text.empty()) std::memcpy(bytes.data(), text.data(), text.size());
  return bytes;
}

std::string in_text(const Bytes& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// Message of the std::logic_error, or other exception, that a run of ranks ends with.
std::string failure(int count, const std::function<void(Ranks&)>& work, std::uint64_t seed = 0) {
  try {
    BatonRanks(count, seed).run(work);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

// Heat conduction in a rod whose cells are shared out to the ranks: each step needs the cells
// beside a rank's own. Cells of ranks without any stay empty.
std::vector<double> conduct(const std::vector<int>& first_cell, int steps, std::uint64_t seed) {
  std::vector<double> whole(static_cast<std::size_t>(first_cell.back()));
  BatonRanks(static_cast<int>(first_cell.size()) - 1, seed).run([&](Ranks& ranks) {
    const auto owner = [&](int cell) {
      int r = 0;
      while (first_cell[static_cast<std::size_t>(r) + 1] <= cell) ++r;
      return r;
    };
    const int first = first_cell[static_cast<std::size_t>(ranks.own())],
              last = first_cell[static_cast<std::size_t>(ranks.own()) + 1];
    const auto own = static_cast<std::size_t>(last - first);
    std::vector<double> t(own + 2, 0.0), next(own + 2, 0.0);
    for (std::size_t i = 0; i < own; ++i) t[i + 1] = std::sin(first + static_cast<double>(i));
    std::vector<Outgoing> sent;
    std::vector<Incoming> received;
    if (own > 0 && first > 0) {
      sent.push_back({owner(first - 1), sent_bytes(t, 1, 1)});
      received.push_back({owner(first - 1), received_bytes(t, 0, 1)});
    }
    if (own > 0 && last < first_cell.back()) {
      sent.push_back({owner(last), sent_bytes(t, own, 1)});
      received.push_back({owner(last), received_bytes(t, own + 1, 1)});
    }
    const auto exchange = ranks.open("cells at the border", sent, received);
    for (int step = 0; step < steps; ++step) {
      exchange->start();
      for (std::size_t i = 2; i < own; ++i) next[i] = t[i] + 0.2 * (t[i - 1] - 2 * t[i] + t[i + 1]);
      exchange->wait();
      for (const std::size_t i : {std::size_t{1}, own})
        if (own > 0) next[i] = t[i] + 0.2 * (t[i - 1] - 2 * t[i] + t[i + 1]);
      std::copy_n(next.begin() + 1, own, t.begin() + 1);
    }
    const std::vector<Bytes> all = ranks.gather(sent_bytes(t, 1, own));
    std::size_t at = 0;
    for (const Bytes& part : all) {
      if (ranks.own() == 0 && !part.empty()) std::memcpy(&whole[at], part.data(), part.size());
      at += part.size() / sizeof(double);
    }
  });
  return whole;
}

}  // namespace

TEST(Ranks, ExchangesGiveTheBitsOfOneRankWhoeverRunsFirst) {
  const std::vector<double> alone = conduct({0, 60}, 50, 0);
  EXPECT_LT(std::abs(alone[30]), 1);
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    std::mt19937_64 random(seed);
    std::vector<int> first{0, 60};
    for (std::uint64_t r = 0; r < seed % 8; ++r)
      first.push_back(static_cast<int>(random() % 61));  // some ranks have no cell
    std::ranges::sort(first);
    EXPECT_EQ(conduct(first, 50, seed), alone) << "seed " << seed;
  }
}

TEST(Ranks, SumsAndLargestValuesAreThoseOfAllRanks) {
  for (const std::uint64_t seed : {0, 1, 2})
    BatonRanks(5, seed).run([](Ranks& ranks) {
      std::vector<std::int64_t> values{ranks.own(), std::int64_t{1} << 61, -ranks.own()};
      ranks.sum(values);
      EXPECT_EQ(values[0], 10);
      EXPECT_EQ(static_cast<std::uint64_t>(values[1]), std::uint64_t{5} << 61);
      EXPECT_EQ(values[2], -10);
      std::vector<double> most{-3.0 - ranks.own(), ranks.own() == 2 ? std::nan("") : 1e300};
      ranks.most(most);
      EXPECT_EQ(most[0], -3);
      EXPECT_TRUE(std::isnan(most[1]));
      EXPECT_EQ(ranks.traffic().sums, 2);
    });
}

TEST(Ranks, BytesReachThoseThatTheyAreFor) {
  BatonRanks(4, 7).run([](Ranks& ranks) {
    std::vector<Bytes> for_each;
    for (int r = 0; r < 4; ++r)
      for_each.push_back(in_bytes(r == ranks.own() + 1 ? "to " + std::to_string(r) : ""));
    const std::vector<Bytes> from = ranks.to_all(for_each);
    for (int r = 0; r < 4; ++r)
      EXPECT_EQ(in_text(from[static_cast<std::size_t>(r)]),
                r + 1 == ranks.own() ? "to " + std::to_string(ranks.own()) : "");
    const std::vector<Bytes> all =
        ranks.gather(in_bytes(std::string(static_cast<std::size_t>(ranks.own()), 'x')));
    for (std::size_t r = 0; r < 4; ++r) EXPECT_EQ(in_text(all[r]), std::string(r, 'x'));
  });
}

TEST(Ranks, ReceivedBytesAreNotANumberUntilTheyAreWaitedFor) {
  BatonRanks(2).run([](Ranks& ranks) {
    std::vector<double> own{1.0 + ranks.own()}, other{0};
    const int peer = 1 - ranks.own();
    const auto exchange =
        ranks.open("pair", {{peer, sent_bytes(own, 0, 1)}}, {{peer, received_bytes(other, 0, 1)}});
    exchange->start();
    EXPECT_TRUE(std::isnan(other[0]));
    exchange->wait();
    EXPECT_EQ(other[0], 1.0 + peer);
    EXPECT_EQ(ranks.traffic().bytes, 8);
  });
}

TEST(Ranks, DeadlockSaysWhoWaitsForWhom) {
  const auto work = [](Ranks& ranks) {
    std::vector<double> own{1}, other{0};
    std::vector<Outgoing> sent;
    std::vector<Incoming> received;
    if (ranks.own() < 2) {
      sent.push_back({1 - ranks.own(), sent_bytes(own, 0, 1)});
      received.push_back({1 - ranks.own(), received_bytes(other, 0, 1)});
    }
    const auto exchange = ranks.open("shares of level 0", sent, received);
    if (ranks.own() == 0) exchange->start(), exchange->wait();
    std::int64_t one = 1;
    if (ranks.own() < 2) ranks.sum({&one, 1});
  };
  for (const std::uint64_t seed : {0, 1, 2, 3})
    EXPECT_EQ(failure(3, work, seed),
              "deadlock: rank 0 waits for rank 1: shares of level 0; rank 1 waits for rank 0: a "
              "sum of 1; rank 2 has ended");
}

TEST(Ranks, MistakesThatMpiWouldNotSeeAreNamed) {
  const auto pair = [](std::size_t sent, std::size_t received, bool change) {
    return [=](Ranks& ranks) {
      std::vector<double> own(4, 1.0), other(4, 0.0);
      const int peer = 1 - ranks.own();
      const std::size_t length = ranks.own() == 0 ? sent : received;
      const auto exchange = ranks.open("pair", {{peer, sent_bytes(own, 0, length)}},
                                       {{peer, received_bytes(other, 0, received)}});
      exchange->start();
      if (change && ranks.own() == 1) own[0] = 2;
      exchange->wait();
    };
  };
  EXPECT_EQ(failure(2, pair(2, 2, false)), "");
  EXPECT_EQ(failure(2, pair(3, 2, false)),
            "rank 1 expects 16 bytes of rank 0, which sends 24: pair");
  EXPECT_EQ(failure(2, pair(2, 2, true)),
            "rank 1 changed what it sends to rank 0 before wait(): pair");
  EXPECT_EQ(failure(2,
                    [](Ranks& ranks) {
                      std::vector<std::int64_t> values(ranks.own() == 0 ? 2 : 3);
                      ranks.sum(values);
                    }),
            "rank 1 calls for a sum of 3 where another rank calls for a sum of 2");
  EXPECT_EQ(failure(2,
                    [](Ranks& ranks) {
                      std::vector<double> own{1};
                      std::vector<Outgoing> sent;
                      if (ranks.own() == 0) sent.push_back({1, sent_bytes(own, 0, 1)});
                      const auto exchange = ranks.open("one way", sent, {});
                      exchange->start();
                      exchange->wait();
                    }),
            "rank 1 did not receive what rank 0 sent: one way");
}

// One rank throws before, between or after what it does with the others: all end, with its words.
TEST(Ranks, FailureOfOneRankEndsAllInEveryPhase) {
  constexpr int phases = 6;
  for (int phase = 0; phase < phases; ++phase)
    for (int bad = 0; bad < 3; ++bad)
      for (const std::uint64_t seed : {0, 5}) {
        const auto work = [&](Ranks& ranks) {
          const auto fail_in = [&](int now) {
            if (now == phase && ranks.own() == bad) throw InputError("bad file");
          };
          std::vector<double> own{1}, other{0};
          const int next = (ranks.own() + 1) % 3, before = (ranks.own() + 2) % 3;
          fail_in(0);
          const auto exchange = ranks.open("ring", {{next, sent_bytes(own, 0, 1)}},
                                           {{before, received_bytes(other, 0, 1)}});
          fail_in(1);
          exchange->start();
          fail_in(2);
          exchange->wait();
          fail_in(3);
          std::int64_t one = 1;
          ranks.sum({&one, 1});
          fail_in(4);
          ranks.together([] {});
          fail_in(5);
        };
        EXPECT_EQ(failure(3, work, seed), "bad file") << "phase " << phase << " rank " << bad;
      }
}

TEST(Ranks, TogetherAllThrowWhatOneThrows) {
  const auto thrown = [](Ranks& ranks, const std::function<void()>& work) -> std::string {
    try {
      ranks.together(work);
    } catch (const InputError& error) {
      EXPECT_NE(dynamic_cast<const ThrownByAll*>(&error), nullptr);
      return std::string("input: ") + error.what();
    } catch (const std::bad_alloc& error) {
      EXPECT_NE(dynamic_cast<const ThrownByAll*>(&error), nullptr);
      return "memory";
    } catch (const std::runtime_error& error) {
      EXPECT_NE(dynamic_cast<const ThrownByAll*>(&error), nullptr);
      return error.what();
    }
    return "";
  };
  for (const std::uint64_t seed : {0, 1, 2, 3, 4})
    BatonRanks(4, seed).run([&](Ranks& ranks) {
      const int own = ranks.own();
      EXPECT_EQ(thrown(ranks, [] {}), "");
      EXPECT_EQ(thrown(ranks,
                       [&] {
                         if (own == 2) throw InputError("no such mesh", {"a.yaml", 3});
                         if (own == 3) throw std::runtime_error("later");
                       }),
                "input: rank 2: a.yaml:3: no such mesh");
      EXPECT_EQ(thrown(ranks, [] { throw InputError("no such key"); }), "input: no such key");
      EXPECT_EQ(thrown(ranks,
                       [&] {
                         if (own == 1) throw std::runtime_error("disk full");
                       }),
                "rank 1: disk full");
      EXPECT_EQ(thrown(ranks,
                       [&] {
                         if (own == 0) throw std::bad_alloc();
                       }),
                "memory");
      // Within each other: the inner one has told it to all.
      EXPECT_EQ(thrown(ranks,
                       [&] {
                         ranks.together([&] {
                           if (own == 1) throw InputError("inner");
                         });
                         ADD_FAILURE() << "went on";
                       }),
                "input: rank 1: inner");
      std::int64_t one = 1;  // all ranks are at the same place afterwards
      ranks.sum({&one, 1});
      EXPECT_EQ(one, 4);
    });
}

TEST(Ranks, OneRankIsAlone) {
  OneRank alone;
  std::int64_t value = 3;
  alone.sum({&value, 1});
  EXPECT_EQ(value, 3);
  EXPECT_EQ(alone.to_all({in_bytes("own")}).front(), in_bytes("own"));
  EXPECT_THROW(alone.together([] { throw std::out_of_range("as it is"); }), std::out_of_range);
  std::vector<double> own{1};
  EXPECT_THROW(alone.open("shares", {{1, sent_bytes(own, 0, 1)}}, {}), std::logic_error);
  alone.open("nothing", {}, {})->wait();
}
