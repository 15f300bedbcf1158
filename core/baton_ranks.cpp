// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <deque>
#include <exception>
#include <limits>
#include <map>
#include <mutex>
#include <plica/core/baton_ranks.hpp>
#include <plica/core/text.hpp>
#include <random>
#include <stdexcept>
#include <thread>

namespace plica {
namespace {

struct Ended {};  // thrown where a rank waits and nothing can wake it

// Message on its way: of the sender's round, the number of its start() of this exchange.
struct Letter {
  long round;
  Bytes bytes;
};

// Exchange on all ranks, by the number of its open().
struct Mailbox {
  std::string what;
  std::vector<long> starts;                                   // [ranks]
  std::map<std::pair<int, int>, std::deque<Letter>> letters;  // by sender and receiver
};

// One call of sum(), most(), gather() or to_all() by all ranks.
struct Meeting {
  std::string what;
  std::vector<std::vector<Bytes>> given;  // [ranks]
  std::vector<bool> here;                 // [ranks]
  int left = 0;
};

// Data that all ranks share, under the baton. Whoever holds it may read and write.
class Table {
 public:
  Table(int count, std::uint64_t seed) : seats_(static_cast<std::size_t>(count)), seed_(seed) {
    random_.seed(seed);
  }

  std::deque<Mailbox> mailboxes;
  std::deque<Meeting> meetings;

  int count() const { return static_cast<int>(seats_.size()); }

  // Waits for the baton, for the first time.
  void sit_down(int own) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return holder_ == own; });
  }

  // Hands the baton on until `missing` returns no rank. `what` is said in a deadlock.
  void wait(int own, const std::function<int()>& missing, const std::string& what) {
    if (missing() < 0) return;
    at(own).missing = missing, at(own).what = what;
    pass(own);
    at(own).missing = {};
    if (missing() >= 0) throw Ended{};
  }

  // Lets others run first, perhaps.
  void offer(int own) {
    if (seed_ != 0 && random_() % 2 == 0) pass(own);
  }

  void leave(int own, std::exception_ptr failure) {
    at(own).gone = true;
    if (failure && !failure_) failure_ = failure;
    pass(own);
  }

  // Throws the first failure, after all have left.
  void finish() const {
    if (failure_) std::rethrow_exception(failure_);
    for (const Mailbox& box : mailboxes)
      for (const auto& [ways, letters] : box.letters)
        if (!letters.empty())
          throw std::logic_error(text("rank ", ways.second, " did not receive what rank ",
                                      ways.first, " sent: ", box.what));
  }

 private:
  struct Seat {
    std::function<int()> missing;  // rank that it waits for, -1: none; empty: it runs
    std::string what;
    bool gone = false;
  };
  Seat& at(int rank) { return seats_[static_cast<std::size_t>(rank)]; }
  bool can_run(const Seat& seat) const {
    return !seat.gone && (!seat.missing || ended_ || seat.missing() < 0);
  }

  void pass(int own) {
    std::unique_lock lock(mutex_);
    std::vector<int> ready = ready_after(own);
    if (ready.empty() && std::ranges::any_of(seats_, [](const Seat& s) { return !s.gone; })) {
      if (!failure_) failure_ = std::make_exception_ptr(std::logic_error(deadlock()));
      ended_ = true;
      ready = ready_after(own);
    }
    if (ready.empty()) return;  // the last one left
    holder_ = ready[seed_ == 0 ? 0 : random_() % ready.size()];
    changed_.notify_all();
    if (!at(own).gone) changed_.wait(lock, [&] { return holder_ == own; });
  }

  // Returns the ranks that can run, from the one after `own`.
  std::vector<int> ready_after(int own) {
    std::vector<int> ready;
    for (int i = 1; i <= count(); ++i)
      if (const int rank = (own + i) % count(); can_run(at(rank))) ready.push_back(rank);
    return ready;
  }

  std::string deadlock() {
    std::string all = "deadlock";
    for (int r = 0; r < count(); ++r) {
      all += text(r == 0 ? ": " : "; ", "rank ", r);
      all +=
          at(r).gone ? " has ended" : text(" waits for rank ", at(r).missing(), ": ", at(r).what);
    }
    return all;
  }

  std::vector<Seat> seats_;
  std::uint64_t seed_;
  std::mt19937_64 random_;
  std::mutex mutex_;
  std::condition_variable changed_;
  int holder_ = 0;
  bool ended_ = false;  // true: ranks that wait are ended
  std::exception_ptr failure_;
};

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

class BatonExchange final : public Exchange {
 public:
  BatonExchange(Table& table, int own, Mailbox& box, std::vector<Outgoing> sent,
                std::vector<Incoming> received, Traffic& traffic)
      : table_(table),
        own_(own),
        box_(box),
        sent_(std::move(sent)),
        received_(std::move(received)),
        traffic_(traffic) {}

  void start() override {
    if (started_) throw std::logic_error("start() before wait(): " + box_.what);
    started_ = true;
    const long round = ++starts(own_);
    copies_.clear();
    for (const Outgoing& out : sent_) {
      copies_.emplace_back(out.bytes.begin(), out.bytes.end());
      box_.letters[{own_, out.rank}].push_back({round, copies_.back()});
      ++traffic_.messages, traffic_.bytes += std::ssize(out.bytes);
    }
    for (const Incoming& in : received_)  // all bits set is NaN
      std::ranges::fill(in.bytes, std::byte{0xff});
    table_.offer(own_);
  }

  void wait() override {
    if (!started_) throw std::logic_error("wait() without start(): " + box_.what);
    const auto start = std::chrono::steady_clock::now();
    table_.wait(
        own_, [this] { return late_neighbour(); }, box_.what);
    traffic_.waited += seconds_since(start);
    started_ = false;
    for (std::size_t i = 0; i < sent_.size(); ++i)
      if (!std::ranges::equal(sent_[i].bytes, copies_[i]))
        throw std::logic_error(text("rank ", own_, " changed what it sends to rank ", sent_[i].rank,
                                    " before wait(): ", box_.what));
    for (const Incoming& in : received_) receive(in);
  }

 private:
  long& starts(int rank) { return box_.starts[static_cast<std::size_t>(rank)]; }

  // A message may leave only when it is received, too: MPI need not keep copies.
  int late_neighbour() {
    const long round = starts(own_);
    for (const Outgoing& out : sent_)
      if (starts(out.rank) < round) return out.rank;
    for (const Incoming& in : received_)
      if (starts(in.rank) < round) return in.rank;
    return -1;
  }

  void receive(const Incoming& in) {
    std::deque<Letter>& letters = box_.letters[{in.rank, own_}];
    const std::string who = text("rank ", own_, " expects ", in.bytes.size(), " bytes of rank ",
                                 in.rank, ", which sends ");
    if (letters.empty() || letters.front().round > starts(own_))
      throw std::logic_error(who + "nothing: " + box_.what);
    const Letter letter = std::move(letters.front());
    letters.pop_front();
    if (letter.round < starts(own_))
      throw std::logic_error(who + "more messages than are received: " + box_.what);
    if (letter.bytes.size() != in.bytes.size())
      throw std::logic_error(text(who, letter.bytes.size(), ": ", box_.what));
    std::ranges::copy(letter.bytes, in.bytes.begin());
  }

  Table& table_;
  int own_;
  Mailbox& box_;
  std::vector<Outgoing> sent_;
  std::vector<Incoming> received_;
  Traffic& traffic_;
  std::vector<Bytes> copies_;  // [sent] since start()
  bool started_ = false;
};

class BatonRank final : public Ranks {
 public:
  BatonRank(Table& table, int own) : table_(table), own_(own) {}
  int count() const override { return table_.count(); }
  int own() const override { return own_; }
  bool device_pointers() const override { return false; }
  Traffic traffic() const override { return traffic_; }

  std::unique_ptr<Exchange> open(std::string what, std::vector<Outgoing> sent,
                                 std::vector<Incoming> received) override {
    if (opened_ == table_.mailboxes.size())
      table_.mailboxes.push_back(
          {what, std::vector<long>(static_cast<std::size_t>(count()), 0), {}});
    Mailbox& box = table_.mailboxes[opened_++];
    expect_same("opens '" + what + "'", "opens '" + box.what + "'");
    return std::make_unique<BatonExchange>(table_, own_, box, std::move(sent), std::move(received),
                                           traffic_);
  }

  void sum(std::span<std::int64_t> values) override {
    ++traffic_.sums;
    const std::vector<std::int64_t> own(values.begin(), values.end());
    std::ranges::fill(values, 0);
    const auto add = [](std::int64_t& all, std::int64_t one) {
      all = static_cast<std::int64_t>(static_cast<std::uint64_t>(all) +
                                      static_cast<std::uint64_t>(one));
    };
    combine<std::int64_t>(text("a sum of ", own.size()), own, values, add);
  }

  void most(std::span<double> values) override {
    ++traffic_.sums;
    const std::vector<double> own(values.begin(), values.end());
    std::ranges::fill(values, -std::numeric_limits<double>::infinity());
    combine<double>(text("the largest of ", own.size()), own, values, [](double& all, double one) {
      if (!(one <= all) && all == all) all = one;
    });
  }

  std::vector<Bytes> gather(std::span<const std::byte> bytes) override {
    std::vector<Bytes> all;
    for (const auto& given : meet("a gather", {Bytes(bytes.begin(), bytes.end())}))
      all.push_back(given.front());
    return all;
  }

  std::vector<Bytes> to_all(const std::vector<Bytes>& for_each) override {
    if (std::ssize(for_each) != count())
      throw std::logic_error(
          text("to_all() has ", for_each.size(), " parts; expected one a rank, ", count()));
    std::vector<Bytes> all;
    for (const auto& given : meet("bytes for each", for_each))
      all.push_back(given[static_cast<std::size_t>(own_)]);
    return all;
  }

 private:
  void expect_same(const std::string& call, const std::string& first) const {
    if (call != first)
      throw std::logic_error(text("rank ", own_, " ", call, " where another rank ", first));
  }

  // Returns what each rank gave to this call.
  std::vector<std::vector<Bytes>> meet(const std::string& what, std::vector<Bytes> own) {
    const auto ranks = static_cast<std::size_t>(count());
    if (met_ == table_.meetings.size())
      table_.meetings.push_back(
          {what, std::vector<std::vector<Bytes>>(ranks), std::vector<bool>(ranks, false)});
    Meeting& meeting = table_.meetings[met_++];
    expect_same("calls for " + what, "calls for " + meeting.what);
    meeting.given[static_cast<std::size_t>(own_)] = std::move(own);
    meeting.here[static_cast<std::size_t>(own_)] = true;
    const auto start = std::chrono::steady_clock::now();
    const auto missing = [&] {
      const auto late = std::ranges::find(meeting.here, false);
      return late == meeting.here.end() ? -1 : static_cast<int>(late - meeting.here.begin());
    };
    table_.wait(own_, missing, what);
    traffic_.waited += seconds_since(start);
    if (++meeting.left == count()) return std::move(meeting.given);
    return meeting.given;
  }

  template <class T, class Combine>
  void combine(const std::string& what, const std::vector<T>& own, std::span<T> all,
               const Combine& combine) {
    Bytes bytes(own.size() * sizeof(T));
    if (!bytes.empty()) std::memcpy(bytes.data(), own.data(), bytes.size());
    for (const auto& given : meet(what, {bytes}))
      for (std::size_t i = 0; i < all.size(); ++i) {
        T one;
        std::memcpy(&one, given.front().data() + i * sizeof(T), sizeof(T));
        combine(all[i], one);
      }
  }

  Table& table_;
  int own_;
  std::size_t opened_ = 0, met_ = 0;
  Traffic traffic_;
};

void work_as(Table& table, int own, const std::function<void(Ranks&)>& work) {
  std::exception_ptr failure;
  table.sit_down(own);
  try {
    BatonRank rank(table, own);
    work(rank);
  } catch (const Ended&) {
  } catch (...) {
    failure = std::current_exception();
  }
  table.leave(own, failure);
}

}  // namespace

void BatonRanks::run(const std::function<void(Ranks&)>& work) const {
  Table table(count_, seed_);
  std::vector<std::thread> threads;
  for (int r = 0; r < count_; ++r)
    threads.emplace_back([&table, &work, r] { work_as(table, r, work); });
  for (std::thread& thread : threads) thread.join();
  table.finish();
}

}  // namespace plica
