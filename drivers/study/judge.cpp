// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <plica/drivers/study/verify.hpp>

namespace plica {

namespace {

std::optional<double> finite(double value) {
  return std::isfinite(value) ? std::optional<double>(value) : std::nullopt;
}

/// p of errors that go with h^p, from the last two.
std::optional<double> order_of_errors(const std::vector<VerifyValue>& v, double exact) {
  if (v.size() < 2) return {};
  const VerifyValue &coarse = v[v.size() - 2], &fine = v.back();
  return finite(std::log(std::abs((coarse.value - exact) / (fine.value - exact))) / std::log(coarse.size / fine.size));
}

/// Of three values at sizes in constant ratio: what they tend to, and how fast (Roache, Verification and Validation in
/// Computational Science and Engineering, 5.10). None where they do not tend to anything.
void extrapolate(VerifyRow& row) {
  const auto& v = row.ours;
  if (v.size() < 3) return;
  const VerifyValue &a = v[v.size() - 3], &b = v[v.size() - 2], &c = v.back();
  const double ratio = b.size / c.size, shrink = (b.value - a.value) / (c.value - b.value);
  if (!(ratio > 1) || !(std::abs(a.size / b.size - ratio) < 1e-9 * ratio) || !(shrink > 1)) return;
  row.order = std::log(shrink) / std::log(ratio);
  row.limit = c.value + (c.value - b.value) / (shrink - 1);
}

bool within(double value, const VerifyRow& row) {
  return std::abs(value - *row.accepted) <= row.tolerance * std::abs(*row.accepted);
}

bool from_above(const VerifyRow& row) {
  for (std::size_t i = 0; i < row.ours.size(); ++i)
    if (!(row.ours[i].value > *row.accepted) || (i > 0 && !(row.ours[i].value < row.ours[i - 1].value))) return false;
  return true;
}

bool fulfilled(const VerifyRow& row) {
  const auto small = [&](const VerifyValue& v) { return std::abs(v.value) <= row.tolerance; };
  switch (row.judged) {
    case Judged::finest:
      return within(row.ours.back().value, row);
    case Judged::limit:
      return row.limit && within(*row.limit, row);
    case Judged::size:
      return std::ranges::all_of(row.ours, small);
    case Judged::order:
      return row.order && std::abs(*row.order - *row.accepted) <= row.tolerance;
    case Judged::above:
      return from_above(row);
    case Judged::nothing:
      break;
  }
  return true;
}

}  // namespace

void judge(VerifyRow& row) {
  if (row.judged == Judged::order)
    row.order = order_of_errors(row.ours, 0);
  else if (row.judged == Judged::finest && row.accepted)
    row.order = order_of_errors(row.ours, *row.accepted);
  else if (row.judged != Judged::size)
    extrapolate(row);
  const bool ok = !row.ours.empty() && fulfilled(row);
  row.outcome = !ok ? "not ok" : row.judged == Judged::nothing ? "shown" : "ok";
}

}  // namespace plica
