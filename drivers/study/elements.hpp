// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <plica/core/error.hpp>
#include <plica/drivers/elastic/elements.hpp>
#include <string>
#include <utility>
#include <vector>

/// The elements that a study compares.
namespace plica {

/// All there are, the one whose limit is the better reference last.
inline std::vector<std::string> element_families() {
  return {name_of(Element::linear), name_of(Element::nodal)};
}

/// InputError for a name that is not one of them, with the nearest.
inline void check_element(const std::string& element) {
  const std::vector<std::string> known = element_families();
  if (std::ranges::find(known, element) == known.end())
    throw InputError("study.elements: " + unknown_name("element", element, known));
}

/// The problem with these elements on all levels; empty: its own.
inline Problem with_element(Problem problem, const std::string& element) {
  if (!element.empty()) problem.body.element = {element};
  return problem;
}

/// The body from this level on, and of the coarser ones as many as make `levels` in all.
inline void keep_levels(Body& body, std::size_t first, std::size_t levels) {
  const auto keep = [&](auto& each) {
    each.erase(each.begin(), each.begin() + static_cast<std::ptrdiff_t>(first));
    each.resize(std::min(each.size(), levels));
  };
  keep(body.levels);
  if (body.element.size() > 1) keep(body.element);
}

}  // namespace plica
