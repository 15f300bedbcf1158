// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <plica/core/error.hpp>
#include <plica/drivers/elastic/elements.hpp>
#include <plica/drivers/elastic/fibres.hpp>
#include <string>
#include <utility>
#include <vector>

/// Elements that a study compares.
namespace plica {

/// Returns all kinds of elements; last the kind whose limit is the better reference.
inline std::vector<std::string> element_families() {
  return {name_of(Element::linear), name_of(Element::nodal)};
}

/// Throws InputError for a name that is not in element_families(); the message has the nearest
/// name.
inline void check_element(const std::string& element) {
  const std::vector<std::string> known = element_families();
  if (std::ranges::find(known, element) == known.end())
    throw InputError("study.elements: " + unknown_name("element", element, known));
}

/// Returns the problem with these elements on all levels; empty: with its own.
inline Problem with_element(Problem problem, const std::string& element) {
  if (!element.empty()) problem.body.element = {element};
  return problem;
}

/// Keeps at most `levels` levels of the body, from level `first` on; removes the others.
inline void keep_levels(Body& body, std::size_t first, std::size_t levels) {
  const auto keep = [&](auto& each) {
    each.erase(each.begin(), each.begin() + static_cast<std::ptrdiff_t>(first));
    each.resize(std::min(each.size(), levels));
  };
  if (first > 0) fields_to_levels(body);
  keep(body.levels);
  if (body.element.size() > 1) keep(body.element);
}

}  // namespace plica
