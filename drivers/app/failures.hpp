// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <plica/core/ranks.hpp>
#include <plica/drivers/app/commands/commands.hpp>
#include <stdexcept>

namespace plica::app {

/// Failure of one rank of which the others do not know: they wait for it.
class LostRank : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Prints an error on the standard error, and returns the status.
ExitStatus failed(const std::string& text, ExitStatus status);

/// Returns the status that `work` returns, or that of the exception that it throws.
/// @param speaks  true: prints the exception
ExitStatus guarded(const std::function<ExitStatus()>& work, bool speaks);

/// Returns what `work` returns. An exception of this rank alone becomes a LostRank; not that of
/// rank 0, which leads and ends the others in order, unless it was to be told to them.
/// @param ranks  processes that do this work together; null: this one alone
ExitStatus with_ranks(const std::function<ExitStatus()>& work, const Ranks* ranks);

}  // namespace plica::app
