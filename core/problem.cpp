// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/core/problem.hpp>

namespace plica {

InitialOptions::InitialOptions() = default;
InitialOptions::InitialOptions(const InitialOptions&) = default;
InitialOptions::InitialOptions(InitialOptions&&) noexcept = default;
InitialOptions& InitialOptions::operator=(const InitialOptions&) = default;
InitialOptions& InitialOptions::operator=(InitialOptions&&) noexcept = default;
InitialOptions::~InitialOptions() = default;

Body::Body() = default;
Body::Body(const Body&) = default;
Body::Body(Body&&) noexcept = default;
Body& Body::operator=(const Body&) = default;
Body& Body::operator=(Body&&) noexcept = default;
Body::~Body() = default;

IntegrationOptions::IntegrationOptions() = default;
IntegrationOptions::IntegrationOptions(const IntegrationOptions&) = default;
IntegrationOptions::IntegrationOptions(IntegrationOptions&&) noexcept = default;
IntegrationOptions& IntegrationOptions::operator=(const IntegrationOptions&) = default;
IntegrationOptions& IntegrationOptions::operator=(IntegrationOptions&&) noexcept = default;
IntegrationOptions::~IntegrationOptions() = default;

ContactOptions::ContactOptions() = default;
ContactOptions::ContactOptions(const ContactOptions&) = default;
ContactOptions::ContactOptions(ContactOptions&&) noexcept = default;
ContactOptions& ContactOptions::operator=(const ContactOptions&) = default;
ContactOptions& ContactOptions::operator=(ContactOptions&&) noexcept = default;
ContactOptions::~ContactOptions() = default;

Problem::Problem() = default;
Problem::Problem(const Problem&) = default;
Problem::Problem(Problem&&) noexcept = default;
Problem& Problem::operator=(const Problem&) = default;
Problem& Problem::operator=(Problem&&) noexcept = default;
Problem::~Problem() = default;

bool damps_by_mass(const Body& body) {
  return body.damping.mass > 0 ||
         std::any_of(body.regions.begin(), body.regions.end(),
                     [](const auto& region) { return region.second.damping.mass.value_or(0) > 0; });
}

bool is_viscous(const Body& body) {
  return !body.material.prony.empty() || std::ranges::any_of(body.regions, [](const auto& region) {
    return !region.second.prony.empty();
  });
}

bool damps_by_stiffness(const Body& body) {
  return body.damping.stiffness > 0 ||
         std::any_of(body.regions.begin(), body.regions.end(), [](const auto& region) {
           return region.second.damping.stiffness.value_or(0) > 0;
         });
}

std::string obstacle_name(const ContactOptions& contact, std::size_t obstacle) {
  const std::string& own = contact.obstacles[obstacle].name;
  return own.empty() ? "obstacle_" + std::to_string(obstacle) : own;
}

bool has_pairs(const Problem& problem) {
  const ContactOptions& contact = problem.contact;
  return contact.self || !contact.attachments.empty() ||
         (contact.bodies && problem.body.parts.size() > 1);
}

bool has_contact(const Problem& problem) {
  return !problem.contact.obstacles.empty() || has_pairs(problem);
}

void remove_contact(Problem& problem) {
  problem.contact.obstacles.clear(), problem.contact.attachments.clear();
  problem.contact.bodies = problem.contact.self = false;
  problem.body.surface.reset();
  for (BodyPart& part : problem.body.parts) part.points = 0;
}

std::vector<std::string> wrench_names(const Problem& problem) {
  std::vector<std::string> names;
  for (std::size_t o = 0; o < problem.contact.obstacles.size(); ++o)
    names.push_back(obstacle_name(problem.contact, o));
  if (problem.body.parts.size() > 1 && has_pairs(problem))
    for (const BodyPart& part : problem.body.parts) names.push_back(part.name);
  return names;
}

}  // namespace plica
