// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <plica/core/row_ranges.hpp>
#include <plica/drivers/level/rank_lists.hpp>
#include <plica/drivers/run/rank_fields.hpp>
#include <span>
#include <utility>

namespace plica {

namespace {

/// Replaces numbers of points by those that `number` has for them. Negative ones stay.
template <class Number>
void renumber(std::vector<unsigned char>& field, const Number& number) {
  for (std::size_t at = 0; at + sizeof(int) <= field.size(); at += sizeof(int)) {
    int point = -1;
    std::memcpy(&point, &field[at], sizeof point);
    if (point >= 0) point = number(point);
    std::memcpy(&field[at], &point, sizeof point);
  }
}

}  // namespace

RankFields::RankFields(Ranks& ranks, std::vector<RankItems> levels) : ranks_(ranks) {
  for (RankItems& own : levels) levels_.push_back(found(std::move(own)));
}

RankFields::LevelItems RankFields::found(RankItems own) const {
  LevelItems level{.own = std::move(own)};
  if (!level.own.part) return level;
  std::vector<int> points;
  for (const int p : level.own.owned_points) points.push_back(level.own.points[index_of(p)]);
  level.points_of = values_of_all(ranks_, points);
  for (const std::vector<int>& one : level.points_of) level.points += one.size();
  const auto sizes =
      values_of_all(ranks_, std::vector{static_cast<std::uint64_t>(level.own.part->owned()),
                                        static_cast<std::uint64_t>(level.own.element_bytes),
                                        static_cast<std::uint64_t>(level.own.slots)});
  for (std::size_t r = 0; r < sizes.size(); ++r) {
    if (r == index_of(ranks_.own()))
      level.elements_before = level.elements, level.slots_before = level.slots;
    level.vertices += sizes[r][0], level.elements += sizes[r][1], level.slots += sizes[r][2];
  }
  return level;
}

bool RankFields::shares(const RowsOfField& rows) const {
  if (rows.of == RowItems::numbered) return rows.numbers != nullptr;
  return rows.of != RowItems::whole && levels_[rows.level].own.part;
}

std::size_t RankFields::bytes(const RowsOfField& rows) const {
  const LevelItems& level = levels_[rows.level];
  if (!rows.present && rows.of == RowItems::vertices) return 0;
  switch (rows.of) {
    case RowItems::vertices:
      return level.vertices * rows.bytes;
    case RowItems::elements:
      return level.elements;
    case RowItems::slots:
      return level.slots * rows.bytes;
    case RowItems::numbered:
      return rows.numbers->all * rows.bytes;
    default:
      return index_of(level.own.obstacles) * level.points * rows.bytes;
  }
}

/// Returns the rows that the rank owns, of those that it has.
RankFields::Field RankFields::owned(const LevelItems& level, const RowsOfField& rows,
                                    const Field& local) {
  const RankItems& own = level.own;
  if (rows.of == RowItems::elements || rows.of == RowItems::slots || local.empty()) return local;
  const auto row = [&](std::size_t i) {
    return local.begin() + static_cast<std::ptrdiff_t>(i * rows.bytes);
  };
  if (rows.of == RowItems::vertices)
    return {row(index_of(own.part->first_owned)), row(index_of(own.part->last_owned))};
  Field of_points;
  for (int o = 0; o < own.obstacles; ++o)
    for (const int p : own.owned_points) {
      const std::size_t slot = index_of(o) * own.points.size() + index_of(p);
      of_points.insert(of_points.end(), row(slot), row(slot + 1));
    }
  return of_points;
}

/// Returns the whole field on rank 0, of rows that each rank sends with their numbers.
RankFields::Field RankFields::whole_of_numbered(const RowsOfField& rows, const Field& local) const {
  std::vector<Bytes> sent(index_of(ranks_.count()));
  const auto add = [&](const void* from, std::size_t size) {
    const auto* const bytes = static_cast<const std::byte*>(from);
    sent.front().insert(sent.front().end(), bytes, bytes + size);
  };
  for (std::size_t i = 0; i < rows.numbers->number.size(); ++i)
    if (rows.numbers->is_own[i])
      add(&rows.numbers->number[i], sizeof(int)), add(&local[i * rows.bytes], rows.bytes);
  const std::vector<Bytes> received = ranks_.to_all(sent);
  if (ranks_.own() > 0) return {};
  Field all(bytes(rows));
  for (const Bytes& one : received)
    for (std::size_t at = 0; at < one.size(); at += sizeof(int) + rows.bytes) {
      int number = 0;
      std::memcpy(&number, &one[at], sizeof number);
      std::memcpy(&all[index_of(number) * rows.bytes], &one[at + sizeof number], rows.bytes);
    }
  return all;
}

RankFields::Field RankFields::whole(const RowsOfField& rows, const Field& local) const {
  if (rows.of == RowItems::numbered) return whole_of_numbered(rows, local);
  const LevelItems& level = levels_[rows.level];
  Field own = owned(level, rows, local);
  if (rows.of == RowItems::points_of_contacts)
    renumber(own, [&](int p) { return level.own.points[index_of(p)]; });
  std::vector<Bytes> sent(index_of(ranks_.count()));
  const auto bytes_of_own = std::as_bytes(std::span(own));
  sent.front().assign(bytes_of_own.begin(), bytes_of_own.end());
  const std::vector<Bytes> received = ranks_.to_all(sent);
  if (ranks_.own() > 0) return {};
  Field all(bytes(rows));
  const bool by_point = rows.of == RowItems::contacts || rows.of == RowItems::points_of_contacts;
  std::size_t end = 0;
  for (std::size_t r = 0; r < received.size(); ++r) {
    const auto* from = reinterpret_cast<const unsigned char*>(received[r].data());
    if (!by_point) {
      std::copy_n(from, received[r].size(), all.begin() + static_cast<std::ptrdiff_t>(end));
      end += received[r].size();
      continue;
    }
    for (std::size_t o = 0; o < index_of(level.own.obstacles); ++o)
      for (const int p : level.points_of[r]) {
        std::memcpy(&all[(o * level.points + index_of(p)) * rows.bytes], from, rows.bytes);
        from += rows.bytes;
      }
  }
  return all;
}

RankFields::Field RankFields::local(const RowsOfField& rows, const unsigned char* whole) const {
  if (rows.of == RowItems::numbered) {
    const std::vector<int>& numbers = rows.numbers->number;
    Field own(numbers.size() * rows.bytes);
    for (std::size_t i = 0; i < numbers.size(); ++i)
      if (numbers[i] >= 0)
        std::memcpy(&own[i * rows.bytes], whole + index_of(numbers[i]) * rows.bytes, rows.bytes);
    return own;
  }
  const LevelItems& level = levels_[rows.level];
  const RankItems& own = level.own;
  if (rows.of == RowItems::elements)
    return {whole + level.elements_before, whole + level.elements_before + own.element_bytes};
  if (rows.of == RowItems::slots) {
    const unsigned char* const first = whole + level.slots_before * rows.bytes;
    return {first, first + own.slots * rows.bytes};
  }
  Field all;
  const auto add = [&](std::size_t row) {
    all.insert(all.end(), whole + row * rows.bytes, whole + (row + 1) * rows.bytes);
  };
  if (rows.of == RowItems::vertices) {
    for (const int v : own.part->vertex) add(index_of(v));
    return all;
  }
  for (int o = 0; o < own.obstacles; ++o)
    for (const int p : own.points) add(index_of(o) * level.points + index_of(p));
  if (rows.of == RowItems::points_of_contacts)
    renumber(all, [&](int p) {
      const auto at = std::ranges::lower_bound(own.points, p);
      return at != own.points.end() && *at == p ? static_cast<int>(at - own.points.begin()) : -1;
    });
  return all;
}

}  // namespace plica
