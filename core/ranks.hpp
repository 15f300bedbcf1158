// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace plica {

/// Bytes of any content.
using Bytes = std::vector<std::byte>;

/// Bytes of an array that go to another rank.
struct Outgoing {
  int rank = 0;                      ///< the one that receives them
  std::span<const std::byte> bytes;  ///< read from start() to wait()
};

/// Bytes of an array that come from another rank.
struct Incoming {
  int rank = 0;                ///< the one that sends them
  std::span<std::byte> bytes;  ///< written from start() to wait()
};

/// Messages between ranks that are sent again and again, from and to the same arrays. It is closed,
/// by its destructor, before its Ranks and before its arrays.
class Exchange {
 public:
  virtual ~Exchange() = default;
  /// Begins to send and to receive. From here to wait() the caller changes no byte that is sent,
  /// and reads none that is received. Kernels that write what is sent are complete, by a fence.
  virtual void start() = 0;
  /// Returns when all has been sent and received.
  virtual void wait() = 0;
};

/// Messages of one rank since it began.
struct Traffic {
  std::int64_t messages = 0;  ///< sent by exchanges
  std::int64_t bytes = 0;     ///< in these
  std::int64_t sums = 0;      ///< calls of sum() and most()
  double waited = 0;          ///< time in which it waited for other ranks [s]
};

/// Processes that simulate one body together, each its own part. Rank 0 speaks for all.
///
/// All functions but count(), own(), device_pointers() and traffic() are called by all ranks, in
/// the same order. One thread of a rank calls them.
class Ranks {
 public:
  virtual ~Ranks() = default;

  /// Returns the number of ranks.
  virtual int count() const = 0;
  /// Returns this rank's number, from 0.
  virtual int own() const = 0;
  /// Returns whether bytes of an exchange may be in a device's memory. Others are in the host's.
  virtual bool device_pointers() const = 0;

  /// Makes an exchange. What rank a sends to rank b is, in order and length, what b receives from
  /// a; a rank may be named several times, and a rank without messages calls this too.
  /// @param what      names the exchange in messages: "shares of level 0"
  /// @param sent      bytes for other ranks, in this rank's memory until the exchange is destroyed
  /// @param received  places for the bytes of other ranks
  virtual std::unique_ptr<Exchange> open(std::string what, std::vector<Outgoing> sent,
                                         std::vector<Incoming> received) = 0;

  /// Replaces each value by its sum over all ranks. Overflow wraps around.
  virtual void sum(std::span<std::int64_t> values) = 0;
  /// Replaces each value by the largest of all ranks. NaN is larger than any number.
  virtual void most(std::span<double> values) = 0;
  /// Returns, on every rank, the bytes of each rank.
  virtual std::vector<Bytes> gather(std::span<const std::byte> bytes) = 0;
  /// Sends bytes to each rank and returns those that each sent to this one.
  /// @param for_each [count()]; many may be empty
  virtual std::vector<Bytes> to_all(const std::vector<Bytes>& for_each) = 0;

  /// Does `work`, which waits for no other rank unless within a further together(). Where it throws
  /// on some ranks, all throw: InputError where the first of these threw one, std::bad_alloc, or
  /// std::runtime_error, each of them a ThrownByAll too. The text names the rank where not all
  /// throw the same.
  void together(const std::function<void()>& work);

  /// Returns what this rank has sent, and how long it waited.
  virtual Traffic traffic() const = 0;

 protected:
  /// Returns whether together() calls most() or gather(), to tell of failures. While a rank waits
  /// in these, others may wait in another call that it never comes to. An implementation keeps the
  /// two apart.
  bool tells_failure() const { return tells_failure_; }
  /// Returns the failure that together() tells; empty: this rank has none. An implementation throws
  /// it, as an UnheardFailure, where the others do not come to hear it.
  const std::string& own_failure() const { return own_failure_; }

 private:
  bool tells_failure_ = false;
  std::string own_failure_;
};

/// Mark of an exception that all ranks throw, by Ranks::together(). Another exception leaves the
/// other ranks waiting: the program then has to end them.
struct ThrownByAll {
  virtual ~ThrownByAll() = default;
};

/// Failure that together() could not tell, as other ranks wait elsewhere: the program then has to
/// end them.
class UnheardFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace plica
