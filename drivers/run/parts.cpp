// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/drivers/elastic/elements.hpp>
#include <plica/drivers/run/simulation_impl.hpp>

namespace plica {

namespace {

std::string counted(std::size_t n, const std::string& what) {
  return std::to_string(n) + " " + what + (n == 1 ? "" : "s");
}

std::string holding_parts(const ContactOptions& contact) {
  std::string all;
  for (std::size_t o = 0; o < contact.obstacles.size(); ++o) {
    const auto& grasp = contact.obstacles[o].grasp;
    if (!grasp) continue;
    all += (all.empty() ? "" : "; ") + obstacle_name(contact, o);
    if (grasp->from.empty()) all += " by a program";
    const auto time = [](double t) { return keys::Quantity{keys::duration}.to_text(t); };
    for (std::size_t i = 0; i < grasp->from.size(); ++i) {
      all += (i > 0 ? ", from " : " from ") + time(grasp->from[i]);
      if (i < grasp->until.size()) all += " until " + time(grasp->until[i]);
    }
  }
  return all;
}

std::string viscous_parts(const Body& body) {
  std::string all = body.material.prony.empty()
                        ? ""
                        : "body.material.prony: " + counted(body.material.prony.size(), "term");
  for (const auto& [name, region] : body.regions)
    if (!region.prony.empty())
      all += (all.empty() ? "" : "; ") + ("body.regions." + name) +
             ".prony: " + counted(region.prony.size(), "term");
  return all;
}

}  // namespace

template <class B>
std::vector<Part> list_parts(const Problem& problem, const BuiltHierarchy<B>& built) {
  using L = Level<B>;
  Archive<B> archive;  // counts an array once, in the first part that has it
  const auto sum = [&](auto of_level) {
    for (L& level : built.hierarchy->levels) of_level(level);
    return archive.measured();
  };
  std::vector<Part> parts;
  const auto add = [&](const std::string& name, bool in, const std::string& yes,
                       const std::string& no, std::size_t size) {
    parts.push_back({name, in, in ? yes : no, size});
  };
  const auto levels = built.hierarchy->levels.size();
  const auto& body = problem.body;
  bool friction = false;
  std::string solver;
  for (const LevelReport& r : built.reports)
    if (solver.empty()) solver = r.linear_solver;
  for (const ObstacleOptions& o : problem.contact.obstacles)
    friction = friction || o.friction.has_value();
  const bool contact = has_contact(problem), pairs = has_pairs(problem);
  friction = friction || (pairs && problem.contact.friction);
  std::string touched = counted(problem.contact.obstacles.size(), "obstacle");
  if (pairs && problem.contact.bodies && body.parts.size() > 1)
    touched += ", " + std::to_string(body.parts.size()) + " bodies";
  if (pairs && problem.contact.self) touched += ", itself";
  const Contact<B>* touching = (*built.hierarchy)[0].contact();
  if (touching && touching->whole() > 0)
    touched += ", " + std::to_string(touching->whole()) + " of them between points";
  const auto turning = std::ranges::count_if(
      problem.contact.obstacles, [](const ObstacleOptions& o) { return o.turn.has_value(); });
  if (turning > 0) touched += ", " + std::to_string(turning) + " of them turning";
  const std::size_t variations = sum([&](L& l) { archive.owns(l.start, l.previous); });
  const std::size_t limits = sum([&](L& l) { archive.owns(l.drift_limit); });
  const std::size_t flags = sum([&](L& l) { archive.owns(l.flags); });
  const std::size_t stiffness = sum([&](L& l) {
    archive.owns(l.model.patches.damping, l.model.rows.damping, l.model.float_rows.damping);
  });

  std::string kinds;
  for (std::size_t i = 0; i < levels; ++i)
    kinds += std::string(i ? ", " : "") + name_of(element_of(body, i));
  add("elastic elements", true, body.material.model + "; " + kinds, "", sum([&](L& l) {
        archive.owns(l.model.patches, l.model.rows, l.model.float_rows, l.nodal, l.partial);
        archive.owns(l.model.followers, l.model.shares.weight);
      }));
  add("state, mass and force", true, counted(levels, "level"), "",
      sum([&](L& l) { archive.owns(l.state, l.model.mass, l.model.inverse_mass, l.f); }));
  add("gravity", problem.gravity.norm() > 0, "gravity", "zero", 0);
  add("mass damping", damps_by_mass(body), "body.damping.mass", "zero",
      sum([&](L& l) { archive.owns(l.model.damping); }));
  add("stiffness damping", damps_by_stiffness(body),
      "body.damping.stiffness: a stress of the strain rate with every force", "zero", stiffness);
  add("viscosity", is_viscous(body), viscous_parts(body),
      "neither body.material nor a region has prony", sum([&](L& l) {
        if (l.viscosity) l.viscosity->name_fields(archive, l, {});
      }));
  add("fixed vertices", !body.fixed.empty(), "body.fixed", "none asked for",
      sum([&](L& l) { archive.owns(l.sliding); }));
  add("prescribed motion", !body.prescribed.empty(), counted(body.prescribed.size(), "motion"),
      "none asked for", sum([&](L& l) { archive.owns(l.prescribed); }));
  add("loads", !body.loads.empty(), counted(body.loads.size(), "load"), "none asked for",
      sum([&](L& l) {
        for (const auto& term : l.terms) term->name_fields(archive);
      }));
  add("transfers", levels > 1, "cycle " + problem.integration.cycle,
      levels < body.levels.size() ? "cycle single uses level 0 alone" : "one level",
      sum([&](L& l) { archive.owns(l.from_finer, l.to_finer, l.adjoint); }));
  add("variation mapping", variations > 0, "cycle " + problem.integration.cycle,
      "not in cycle " + problem.integration.cycle, variations);
  add("switched mapping", limits > 0, "switch_threshold",
      "not in cycle " + problem.integration.cycle, limits);
  built.stepper->name_fields(archive);
  const std::size_t inverse_mass = archive.measured();
  add("hierarchical inverse mass", inverse_mass > 0, "cycle " + problem.integration.cycle,
      "not in cycle " + problem.integration.cycle, inverse_mass);
  add("embedded surface", body.surface.has_value(), contact ? "contact, output" : "output",
      "no body.surface", sum([&](L& l) { archive.owns(l.surface); }));
  const std::string holding = holding_parts(problem.contact);
  if (!holding.empty()) archive.owns(touching->memory());
  const std::size_t held = archive.measured();
  const std::size_t attached = problem.contact.attachments.size();
  if (attached > 0) archive.owns(touching->attached_points());
  const std::size_t attachments = archive.measured();
  add("contact", contact, touched, "no obstacle",
      sum([&](L& l) { l.response().name_fields(archive, {}, l.exec(), l); }));
  add("held points", !holding.empty(), holding, "no obstacle has grasp", held);
  add("attachments", attached > 0,
      touching ? counted(attached, "attachment") + ", " +
                     counted(static_cast<std::size_t>(touching->attached()), "point")
               : "",
      "none asked for", attachments);
  const std::size_t grids = touching ? touching->grid_bytes() : 0;
  add("distance grids", grids > 0, "contact.obstacles", "no obstacle is a triangulated surface",
      grids);
  add("friction", friction, "contact.obstacles", "neither obstacles nor pairs have it", 0);
  add("implicit solver", !solver.empty(), solver, "every level is explicit",
      sum([&](L& l) { l.integrator->name_fields(archive); }));
  add("inversion flags", flags > 0, body.material.model + " may not be inverted",
      body.material.model + " may be inverted", flags);
  return parts;
}

#define PLICA_INSTANTIATE(Real, Exec)                         \
  template std::vector<Part> list_parts<Backend<Real, Exec>>( \
      const Problem&, const BuiltHierarchy<Backend<Real, Exec>>&);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
