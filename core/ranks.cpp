// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <exception>
#include <new>
#include <plica/core/error.hpp>
#include <plica/core/one_rank.hpp>
#include <plica/core/ranks.hpp>
#include <plica/core/text.hpp>
#include <stdexcept>

namespace plica {
namespace {

enum class FailureKind : unsigned char { none, input, memory, other };

// Failure of one rank, as it is sent to the others: its kind, then its text.
struct Failure {
  FailureKind kind = FailureKind::none;
  std::string text;
};

template <class Error>
struct OnAllRanks final : Error, ThrownByAll {
  using Error::Error;
};

Failure failure_of(const std::function<void()>& work) {
  try {
    work();
    return {};
  } catch (const ThrownByAll&) {
    throw;  // a further together() has told all ranks
  } catch (const InputError& error) {
    return {FailureKind::input, error.what()};
  } catch (const std::bad_alloc& error) {
    return {FailureKind::memory, error.what()};
  } catch (const std::exception& error) {
    return {FailureKind::other, error.what()};
  } catch (...) {
    return {FailureKind::other, "an exception without a text"};
  }
}

Bytes to_bytes(const Failure& failure) {
  Bytes bytes{static_cast<std::byte>(failure.kind)};
  for (const char c : failure.text) bytes.push_back(static_cast<std::byte>(c));
  return bytes;
}

Failure from_bytes(const Bytes& bytes) {
  Failure failure{static_cast<FailureKind>(bytes.front()), {}};
  std::for_each(bytes.begin() + 1, bytes.end(),
                [&](std::byte b) { failure.text += static_cast<char>(b); });
  return failure;
}

[[noreturn]] void throw_on_all(const Failure& failure) {
  if (failure.kind == FailureKind::input) throw OnAllRanks<InputError>(failure.text);
  if (failure.kind == FailureKind::memory) throw OnAllRanks<std::bad_alloc>();
  throw OnAllRanks<std::runtime_error>(failure.text);
}

class NoMessages final : public Exchange {
 public:
  void start() override {}
  void wait() override {}
};

}  // namespace

void Ranks::together(const std::function<void()>& work) {
  if (count() == 1) return work();
  const Failure own = failure_of(work);
  own_failure_ = own.text, tells_failure_ = true;
  double any = own.kind == FailureKind::none ? 0 : 1;
  most({&any, 1});
  const std::vector<Bytes> all = any == 0 ? std::vector<Bytes>{} : gather(to_bytes(own));
  own_failure_.clear(), tells_failure_ = false;
  if (any == 0) return;
  const auto failed = [](const Bytes& one) { return from_bytes(one).kind != FailureKind::none; };
  const auto first = std::ranges::find_if(all, failed);
  Failure failure = from_bytes(*first);
  if (std::ranges::any_of(all, [&](const Bytes& one) { return one != *first; }))
    failure.text = text("rank ", first - all.begin(), ": ", failure.text);
  throw_on_all(failure);
}

std::unique_ptr<Exchange> OneRank::open(std::string what, std::vector<Outgoing> sent,
                                        std::vector<Incoming> received) {
  if (!sent.empty() || !received.empty())
    throw std::logic_error("one rank has nobody to exchange with: " + what);
  return std::make_unique<NoMessages>();
}

}  // namespace plica
