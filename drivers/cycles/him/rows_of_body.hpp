// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstddef>

namespace plica {

/// Rows of one body's vertices among those of a level; they follow each other.
struct RowsOfBody {
  int first = 0, count = 0;

  /// Returns these rows of a field, without a copy; an empty field stays empty.
  template <class View>
  View of(const View& x) const {
    if (x.extent(0) == 0) return x;
    const std::size_t row = x.span() / x.extent(0);
    return View(x.data() + static_cast<std::size_t>(first) * row, static_cast<std::size_t>(count));
  }
};

}  // namespace plica
