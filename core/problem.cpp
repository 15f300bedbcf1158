// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/core/problem.hpp>

namespace plica {

bool damps_by_mass(const Body& body) {
  return body.damping.mass > 0 || std::any_of(body.regions.begin(), body.regions.end(), [](const auto& region) {
           return region.second.damping.mass.value_or(0) > 0;
         });
}

bool damps_by_stiffness(const Body& body) {
  return body.damping.stiffness > 0 || std::any_of(body.regions.begin(), body.regions.end(), [](const auto& region) {
           return region.second.damping.stiffness.value_or(0) > 0;
         });
}

std::string obstacle_name(const ContactOptions& contact, std::size_t obstacle) {
  const std::string& own = contact.obstacles[obstacle].name;
  return own.empty() ? "obstacle_" + std::to_string(obstacle) : own;
}

}  // namespace plica
