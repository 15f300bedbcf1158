// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <limits>
#include <plica/core/error.hpp>
#include <plica/meshes/checked.hpp>
#include <sstream>

namespace plica {

namespace {

template <typename Value>
[[noreturn]] void refuse(const std::string& what, const Value& value, const std::string& expected) {
  std::ostringstream text;
  text.precision(12);
  text << what << " is " << value << "; it must be " << expected;
  throw InputError(text.str());
}

}  // namespace

double checked_size(const std::string& what, double value) {
  if (!std::isfinite(value) || value <= 0.0) refuse(what, value, "finite and above zero");
  return value;
}

Point checked_point(const std::string& what, const Point& point) {
  if (!point.allFinite())
    refuse(what, point.transpose().format({12, Eigen::DontAlignCols, ", "}), "finite");
  return point;
}

int checked_cells(const std::string& what, int cells) {
  if (cells < 1) refuse(what, cells, "1 or more");
  return cells;
}

void checked_count(const std::string& what, double count) {
  if (count > std::numeric_limits<int>::max()) refuse(what, count, "below 2^31");
}

}  // namespace plica
