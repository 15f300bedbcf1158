// SPDX-License-Identifier: BSD-3-Clause
#include <mpi.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstring>
#include <iostream>
#include <numeric>
#include <plica/core/error.hpp>
#include <plica/drivers/mpi/mpi_ranks.hpp>
#include <plica/drivers/mpi/mpi_session.hpp>
#include <string>
#include <thread>

// A program for several processes, which tests/mpi/check starts: ring CASE. It does what the case
// says, and rank 0 prints "ok". Exit status: 0 ok, 1 wrong or ended, 2 an error that all ranks
// have thrown.
namespace {

using namespace plica;

void expect(bool right, const std::string& what) {
  if (!right) throw std::runtime_error("wrong: " + what);
}

// Values go around the ring 100 times, in messages of a size that differs from rank to rank.
void go_around(Ranks& ranks) {
  const int count = ranks.count(), own = ranks.own();
  const int next = (own + 1) % count, before = (own + count - 1) % count;
  const auto length = [](int rank) { return static_cast<std::size_t>(1 + 100 * rank); };
  std::vector<double> sent(length(own)), received(length(before));
  const auto exchange = ranks.open("ring", {{next, std::as_bytes(std::span(sent))}},
                                   {{before, std::as_writable_bytes(std::span(received))}});
  for (int round = 0; round < 100; ++round) {
    std::ranges::fill(sent, 1000.0 * own + round);
    std::ranges::fill(received, -1.0);
    exchange->start();
    exchange->wait();
    expect(std::ranges::count(received, 1000.0 * before + round) == std::ssize(received), "ring");
  }
  const std::int64_t parts = (std::ssize(sent) + 7) / 8;
  expect(ranks.traffic().messages == 100 * parts, "messages");
  expect(ranks.traffic().bytes == 800 * static_cast<std::int64_t>(sent.size()), "bytes");
}

void add_up(Ranks& ranks) {
  const int count = ranks.count(), own = ranks.own();
  std::vector<std::int64_t> sums(68, own + 1);
  sums[0] = -(std::int64_t{1} << 40) * own;
  ranks.sum(sums);
  expect(sums[67] == count * (count + 1) / 2, "sum");
  expect(sums[0] == -(std::int64_t{1} << 40) * (count * (count - 1) / 2), "large sum");
  std::vector<double> most{-1.5 - own, 1e-300 * own, own == 0 ? -std::nan("") : 1e308,
                           own == 0 ? -0.0 : -HUGE_VAL};
  ranks.most(most);
  expect(most[0] == -1.5 && most[1] == 1e-300 * (count - 1), "largest");
  expect(std::isnan(most[2]), "NaN is the largest");
  expect(most[3] == 0, "infinity");
}

void tell_all(Ranks& ranks) {
  const int count = ranks.count(), own = ranks.own();
  const auto bytes = [](int from, int to) {  // longer than the parts that it is sent in
    return Bytes(static_cast<std::size_t>(37 * from + to), static_cast<std::byte>(16 * from + to));
  };
  std::vector<Bytes> for_each;
  for (int r = 0; r < count; ++r) for_each.push_back(bytes(own, r));
  const std::vector<Bytes> received = ranks.to_all(for_each), all = ranks.gather(bytes(own, 0));
  for (int r = 0; r < count; ++r) {
    expect(received[static_cast<std::size_t>(r)] == bytes(r, own), "bytes for each");
    expect(all[static_cast<std::size_t>(r)] == bytes(r, 0), "bytes of each");
  }
}

// Halves of a host's processes are ranks of their own, and may be at different places.
void split(Ranks& ranks, const Waiting& waiting) {
  MPI_Comm half;
  MPI_Comm_split(MPI_COMM_WORLD, ranks.own() % 2, ranks.own(), &half);
  {
    MpiRanks mine(half, waiting);
    go_around(mine);
    for (int round = 0; round <= ranks.own() % 2; ++round) tell_all(mine);
  }
  MPI_Comm_free(&half);
}

// Rank 1 comes late to an exchange, and rank 0 says so.
void come_late(Ranks& ranks, const std::vector<std::string>& said) {
  std::vector<double> one(1), other(1);
  std::vector<Outgoing> sent;
  std::vector<Incoming> received;
  if (ranks.own() == 1) sent.push_back({0, std::as_bytes(std::span(one))});
  if (ranks.own() == 0) received.push_back({1, std::as_writable_bytes(std::span(other))});
  const auto exchange = ranks.open("shares of level 0", sent, received);
  if (ranks.own() == 1) std::this_thread::sleep_for(std::chrono::seconds(2));
  exchange->start();
  exchange->wait();
  if (ranks.own() == 0)
    expect(said == std::vector<std::string>{"rank 0 waits for rank 1: shares of level 0"},
           said.empty() ? "nothing was said" : said.front());
}

void run_case(const std::string& name, Ranks& ranks, const Waiting& waiting,
              const std::vector<std::string>& said) {
  if (name == "values") return add_up(ranks), go_around(ranks), tell_all(ranks);
  if (name == "split") return split(ranks, waiting);
  if (name == "late") return come_late(ranks, said);
  if (name == "input")
    return ranks.together([&] {
      if (ranks.own() == 1) throw InputError("no such file");
    });
  std::int64_t one = 1;
  if (name == "elsewhere")  // the others wait where rank 1 never comes
    return ranks.together([&] {
      if (ranks.own() == 1) throw InputError("no such file");
      ranks.sum({&one, 1});
      ranks.sum({&one, 1});
    });
  if (name == "unexpected" && ranks.own() == 1) throw std::runtime_error("not foreseen");
  if (name == "killed" && ranks.own() == 1) std::raise(SIGKILL);
  ranks.sum({&one, 1});
}

}  // namespace

int main(int argc, char** argv) {
  const std::string name = argc > 1 ? argv[1] : "values";
  std::vector<std::string> said;
  Waiting waiting;
  waiting.patience = std::chrono::milliseconds(name == "values" ? 60'000 : 500);
  waiting.say = [&](const std::string& text) { said.push_back(text); };
  waiting.largest_message = 64;  // eight values
  MpiSession session(argc, argv, waiting);
  try {
    run_case(name, session.ranks(), waiting, said);
    if (session.ranks().own() == 0) std::cout << "ok" << std::endl;
    return 0;
  } catch (const std::exception& error) {
    const bool by_all = dynamic_cast<const ThrownByAll*>(&error) != nullptr;
    if (!by_all || session.ranks().own() == 0) std::cerr << error.what() << std::endl;
    if (!by_all) session.end_all(1);
    return 2;
  }
}
