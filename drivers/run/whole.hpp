// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstring>
#include <plica/core/ranks.hpp>
#include <plica/drivers/level/level.hpp>
#include <plica/drivers/run/diagnose.hpp>
#include <plica/kernels/halo.hpp>
#include <span>
#include <vector>

// Values of a whole body, of the parts that ranks have. All ranks call these functions.
namespace plica {

/// Ranks that get what all of them have.
enum class Receiver { all, first };

/// Returns the values of all ranks, one rank after the other; on ranks that get them.
template <class T>
std::vector<T> joined(Ranks& ranks, const std::vector<T>& own, Receiver who = Receiver::all) {
  static_assert(std::is_trivially_copyable_v<T>);
  const auto bytes = std::as_bytes(std::span(own));
  std::vector<Bytes> parts;
  if (who == Receiver::all) {
    parts = ranks.gather(bytes);
  } else {
    std::vector<Bytes> sent(static_cast<std::size_t>(ranks.count()));
    sent.front().assign(bytes.begin(), bytes.end());
    parts = ranks.to_all(sent);
  }
  std::vector<T> all;
  for (const Bytes& part : parts) {
    const std::size_t before = all.size();
    all.resize(before + part.size() / sizeof(T));
    if (!part.empty()) std::memcpy(all.data() + before, part.data(), part.size());
  }
  return all;
}

/// Returns points as numbers, three each, and back.
inline std::vector<double> numbers_of(const std::vector<Point>& points) {
  std::vector<double> numbers;
  for (const Point& p : points) numbers.insert(numbers.end(), {p[0], p[1], p[2]});
  return numbers;
}
inline std::vector<Point> points_of_numbers(const std::vector<double>& numbers) {
  std::vector<Point> points;
  for (std::size_t i = 0; i + 2 < numbers.size(); i += 3)
    points.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
  return points;
}

/// Returns a field of a level's vertices, those of all ranks, on each of them.
template <class B>
std::vector<Point> whole_field(const Level<B>& level, const Vectors<B>& field) {
  const std::vector<Point> local = to_host<B>(level.exec(), field);
  if (!level.ranks) return local;
  return points_of_numbers(
      joined(*level.ranks->ranks, numbers_of(level.ranks->part.of_owned(local))));
}

}  // namespace plica
