// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <numeric>
#include <plica/core/error.hpp>
#include <plica/core/text.hpp>
#include <plica/drivers/solver/registry.hpp>
#include <plica/drivers/solver/set_up/distributions.hpp>

namespace plica {

namespace {

std::vector<double> custom_shares(const std::vector<double>& shares, std::size_t levels) {
  if (shares.size() != levels)
    throw InputError("distribution: " + std::to_string(shares.size()) + " shares for " + std::to_string(levels) +
                     " levels; expected one each, finest first");
  for (double w : shares)
    if (!(w > 0)) throw InputError("distribution: a share is " + std::to_string(w) + "; expected each above 0");
  const double sum = std::accumulate(shares.begin(), shares.end(), 0.0);
  if (!(std::abs(sum - 1) <= 1e-12))
    throw InputError(text("distribution: the shares sum to ", number(sum, 15), "; expected 1"));
  return shares;
}

/// The critical step is 0 under undamped euler and infinite where nothing moves: no proportion then.
void expect_proportions(const std::vector<double>& weights, const std::string& distribution) {
  for (std::size_t i = 0; i < weights.size(); ++i)
    if (!(weights[i] > 0 && std::isfinite(weights[i])))
      throw InputError(text("distribution: '", distribution, "' finds no share for level ", i, ", where it is ",
                            number(weights[i]), "; use equal or custom"));
}

}  // namespace

std::vector<double> make_shares(const IntegrationOptions& options, const LevelFacts& facts) {
  const std::size_t levels = facts.tets.size();
  std::vector<double> w;
  if (options.distribution == "custom") {
    w = custom_shares(options.shares, levels);
  } else {
    const bool known = Distributions::visit(options.distribution, [&](auto d) { w = decltype(d)::weights(facts); });
    if (!known) throw InputError(unknown_name("distribution", options.distribution, names(distributions())));
    if (levels > 1) expect_proportions(w, options.distribution);
    const double sum = std::accumulate(w.begin(), w.end(), 0.0);
    for (double& share : w) share /= sum;
  }
  if (levels == 1) return {1.0};
  double moved = 0;
  for (std::size_t i = 0; i + 1 < levels; ++i) {
    moved += options.shift_to_coarsest * w[i];
    w[i] *= 1 - options.shift_to_coarsest;
  }
  w.back() += moved;
  return w;
}

}  // namespace plica
