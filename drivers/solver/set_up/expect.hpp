// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cmath>
#include <plica/core/error.hpp>
#include <plica/core/mesh.hpp>
#include <plica/core/text.hpp>
#include <string>

/// The sentences in which validation refuses a value: InputError "OPTION is VALUE; expected WHAT".
namespace plica {

inline void expect(bool good, const std::string& option, double value, const std::string& expectation) {
  if (!good) throw InputError(option + " is " + number(value, 9) + "; expected " + expectation);
}
inline void positive(const std::string& option, double v, const std::string& unit) {
  expect(v > 0 && std::isfinite(v), option, v, "a number above 0" + unit);
}
inline void not_negative(const std::string& option, double v, const std::string& unit) {
  expect(v >= 0 && std::isfinite(v), option, v, "0 or more" + unit);
}
inline void finite(const std::string& option, const Point& p) {
  for (int k = 0; k < 3; ++k) expect(std::isfinite(p[k]), option, p[k], "finite numbers");
}

inline void direction(const std::string& option, const Point& p) {
  finite(option, p);
  expect(p.norm() > 0, option + ", as a length,", p.norm(), "a number above 0");
}

}  // namespace plica
