// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/drivers/elastic/elements.hpp>
#include <plica/drivers/run/simulation_impl.hpp>

namespace plica {

namespace {

template <class... Views>
std::size_t bytes(const Views&... views) {
  return ((views.span() * sizeof(*views.data())) + ... + 0);
}
template <class B>
std::size_t bytes_of(const Transfer<B>& t) {
  return bytes(t.target, t.source, t.weight);
}
template <class B>
std::size_t bytes_of(const Restriction<B>& r) {
  return bytes(r.first, r.source, r.weight, r.average);
}
template <class B>
std::size_t bytes_of(const State<B>& s) {
  return bytes(s.u, s.v);
}
template <class B>
std::size_t bytes_of(const Patches<B>& p) {
  return bytes(p.first_pack, p.first_vertex, p.vertex, p.corner, p.shape, p.constants, p.fibres,
               p.summed, p.first_sum, p.first_slot, p.slot, p.shares.first, p.shares.row,
               p.element);
}
template <class B>
std::size_t bytes_of(const NodalRows<B>& r) {
  return bytes(r.first, r.region, r.vertex, r.volume, r.inverse_volume, r.neighbour, r.gradient,
               r.coupling, r.smoothing, r.first_surface, r.surface_neighbour, r.surface_gradient,
               r.constants, r.fibres, r.shares.first, r.shares.row);
}
template <class B>
std::size_t bytes_of(const NodalWork<B>& w) {
  return bytes(w.near, w.records, w.ratio, w.pressure, w.gradient);
}
template <class B>
std::size_t bytes_of(const EmbeddedSurface<B>& s) {
  return bytes(s.rest, s.vertex, s.first, s.point, s.weight) + bytes_of(s.embedding);
}

template <class B>
std::size_t bytes_of(const Attachments<B>& a) {
  return bytes(a.attachment, a.triangle, a.weight);
}

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
  const auto sum = [&](auto of_level) {
    std::size_t total = 0;
    for (const auto& part : built.hierarchy->levels) total += of_level(part);
    return total;
  };
  using L = Level<B>;
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
  const std::size_t variations =
      sum([](const L& l) { return bytes_of(l.start) + bytes_of(l.previous); });
  const std::size_t limits = sum([](const L& l) { return bytes(l.drift_limit); });
  const std::size_t flags = sum([](const L& l) { return bytes(l.flags.evaluation, l.flags.word); });

  std::string kinds;
  for (std::size_t i = 0; i < levels; ++i)
    kinds += std::string(i ? ", " : "") + name_of(element_of(body, i));
  add("elastic elements", true, body.material.model + "; " + kinds, "", sum([](const L& l) {
        return bytes_of(l.model.patches) + bytes_of(l.model.rows) + bytes_of(l.model.float_rows) +
               bytes_of(l.nodal) + bytes(l.partial);
      }));
  add("state, mass and force", true, counted(levels, "level"), "", sum([](const L& l) {
        return bytes_of(l.state) + bytes(l.model.mass, l.model.inverse_mass, l.f);
      }));
  add("gravity", problem.gravity.norm() > 0, "gravity", "zero", 0);
  add("mass damping", damps_by_mass(body), "body.damping.mass", "zero",
      sum([](const L& l) { return bytes(l.model.damping.of_vertex); }));
  add("stiffness damping", damps_by_stiffness(body),
      "body.damping.stiffness: a stress of the strain rate with every force", "zero",
      sum([](const L& l) { return bytes(l.model.patches.damping); }));
  add("viscosity", is_viscous(body), viscous_parts(body),
      "neither body.material nor a region has prony",
      sum([](const L& l) { return l.viscosity ? l.viscosity->bytes(l) : 0; }));
  add("fixed vertices", !body.fixed.empty(), "body.fixed", "none asked for", 0);
  add("prescribed motion", !body.prescribed.empty(), counted(body.prescribed.size(), "motion"),
      "none asked for", sum([](const L& l) {
        const auto& p = l.prescribed;
        return bytes(p.vertex, p.path, p.paths, p.knots);
      }));
  add("loads", !body.loads.empty(), counted(body.loads.size(), "load"), "none asked for",
      sum([](const L& l) {
        std::size_t total = 0;
        for (const auto& term : l.terms) total += term->bytes();
        return total;
      }));
  add("transfers", levels > 1, "cycle " + problem.integration.cycle,
      levels < body.levels.size() ? "cycle single uses level 0 alone" : "one level",
      sum([](const L& l) {
        return bytes_of(l.from_finer) + bytes_of(l.to_finer) + bytes_of(l.adjoint);
      }));
  add("variation mapping", variations > 0, "cycle " + problem.integration.cycle,
      "not in cycle " + problem.integration.cycle, variations);
  add("switched mapping", limits > 0, "switch_threshold",
      "not in cycle " + problem.integration.cycle, limits);
  add("hierarchical inverse mass", built.stepper->bytes() > 0, "cycle " + problem.integration.cycle,
      "not in cycle " + problem.integration.cycle, built.stepper->bytes());
  add("embedded surface", body.surface.has_value(), contact ? "contact, output" : "output",
      "no body.surface", sum([](const L& l) { return bytes_of(l.surface); }));
  add("contact", contact, touched, "no obstacle",
      sum([](const L& l) { return l.response().bytes(); }));
  const std::string holding = holding_parts(problem.contact);
  add("held points", !holding.empty(), holding, "no obstacle has grasp",
      holding.empty() ? 0 : bytes(touching->memory()));
  const std::size_t attached = problem.contact.attachments.size();
  add("attachments", attached > 0,
      touching ? counted(attached, "attachment") + ", " +
                     counted(static_cast<std::size_t>(touching->attached()), "point")
               : "",
      "none asked for", attached > 0 ? bytes_of(touching->attached_points()) : 0);
  const std::size_t grids = touching ? touching->grid_bytes() : 0;
  add("distance grids", grids > 0, "contact.obstacles", "no obstacle is a triangulated surface",
      grids);
  add("friction", friction, "contact.obstacles", "neither obstacles nor pairs have it", 0);
  add("implicit solver", !solver.empty(), solver, "every level is explicit",
      sum([](const L& l) { return l.integrator->bytes(); }));
  add("inversion flags", flags > 0, body.material.model + " may not be inverted",
      body.material.model + " may be inverted", flags);
  return parts;
}

#define PLICA_INSTANTIATE(Real, Exec)                         \
  template std::vector<Part> list_parts<Backend<Real, Exec>>( \
      const Problem&, const BuiltHierarchy<Backend<Real, Exec>>&);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
