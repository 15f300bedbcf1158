// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <numeric>
#include <plica/core/error.hpp>
#include <plica/core/text.hpp>
#include <plica/drivers/solver/registry.hpp>
#include <plica/drivers/solver/set_up/distributions.hpp>
#include <plica/drivers/solver/set_up/validate.hpp>

namespace plica {

namespace {

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
    validate_shares(options, levels);
    w = options.shares;
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
