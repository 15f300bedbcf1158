// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <any>
#include <map>
#include <plica/core/error.hpp>
#include <plica/core/keys.hpp>
#include <plica/drivers/body/selection.hpp>
#include <plica/drivers/methods/integrators.hpp>
#include <plica/drivers/methods/methods.hpp>
#include <plica/drivers/methods/rest.hpp>
#include <plica/drivers/run/validate.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/boundary_triangles.hpp>

namespace plica {

namespace {

using namespace keys;

void check_numbers(const std::string& option, const TriangleSurface& surface) {
  for (const Point& p : surface.vertices) Vector{length}.check(option + " vertex", p);
  const Count vertex{0, static_cast<int>(surface.vertices.size()) - 1};
  for (const auto& t : surface.triangles)
    for (const int v : t) vertex.check(option + " triangle's vertex", v);
}

void check_triangles(const std::string& option, const TriangleSurface& surface) {
  if (surface.triangles.empty()) throw InputError(option + " has no triangle");
  check_numbers(option, surface);
}

void check_closed(const std::string& option, const TriangleSurface& surface,
                  const std::string& expected = "; expected a closed surface") {
  check_triangles(option, surface);
  SurfaceReport edges;
  count_edges(surface, edges);
  if (!edges.closed())
    throw InputError(option + " has no inside: of its edges " + std::to_string(edges.open_edges) +
                     " are open (of one triangle), " + std::to_string(edges.crowded_edges) +
                     " of more than two triangles and " + std::to_string(edges.inconsistent_edges) +
                     " between triangles that face different sides" + expected);
  Quantity{{.length = 3}, positive}.check(option + ", as an enclosed volume,",
                                          enclosed_volume(surface));
}

/// Refuses methods that need all of the stage's system in a matrix: `what` is only in its products.
void refuse_matrix(const Problem& problem, const std::string& what) {
  if (const std::string by = needs_matrix(problem.integration); !by.empty())
    throw InputError(
        by + ", whose matrix has no room for " + what +
        "; expected an explicit integrator, or an implicit one with integration.implicit.solver "
        "conjugate_gradients or auto");
}

void check_attachments(const Problem& problem) {
  std::vector<std::string> bodies;
  for (const BodyPart& part : problem.body.parts) bodies.push_back(part.name);
  const auto& all = problem.contact.attachments;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::string path = "attachments." + std::to_string(i);
    for (std::size_t o = 0; o < problem.contact.obstacles.size(); ++o)
      if (const std::string to = obstacle_name(problem.contact, o); to == all[i].to)
        throw InputError(
            path + ".to: " + to +
            " is an obstacle; expected a body, or in place of this contact.obstacles." +
            std::to_string(o) +
            ".grasp with from: 0, where and reach, which holds points from the start");
    if (bodies.empty())
      throw InputError(path + ": there is one body; expected several, by the key bodies");
    for (const auto& [key, name] : {std::pair{".body", all[i].body}, std::pair{".to", all[i].to}})
      if (std::ranges::find(bodies, name) == bodies.end())
        throw InputError(path + key + ": " + unknown_name("body", name, bodies));
    if (all[i].body == all[i].to)
      throw InputError(path + ".to is " + all[i].to +
                       ", as is the body that is attached; expected another one");
    if (all[i].where) expect_without_name(*all[i].where, path + ".where");
    Quantity{length, not_negative}.check(path + ".reach", all[i].reach);
    if (all[i].stiffness)
      Quantity{{.mass = 1, .time = -2}, positive}.check(path + ".stiffness", *all[i].stiffness);
  }
}

void check_pairs(const Problem& problem) {
  const Body& body = problem.body;
  check_attachments(problem);
  const bool touches = problem.contact.self || problem.contact.bodies;
  const std::string key = problem.contact.self     ? "contact.self"
                          : problem.contact.bodies ? "contact.bodies"
                                                   : "attachments",
                    instead = touches ? key + ": false" : "no attachments";
  if (!body.surface)
    throw InputError(key + ": there is no surface to touch with; expected body.surface, or " +
                     instead);
  for (const BodyPart& part : body.parts)
    if (part.points == 0)
      throw InputError("bodies." + part.name +
                       ": it has no surface, which touching other bodies needs; expected bodies." +
                       part.name + ".surface, or " + instead);
  const bool part =
      std::ranges::any_of(body.levels, [](const TetMesh& mesh) { return !mesh.piece.empty(); });
  check_closed(
      "body.surface", *body.surface,
      part ? ". The boundary of a body with a part (refine, covers) is open along the part's "
             "border; expected body.surface: {file: SURFACE}, a closed surface of the body, "
             "or " +
                 instead
           : "; expected a closed surface");
  refuse_matrix(problem, key);
}

}  // namespace

std::string needs_matrix(const IntegrationOptions& options) {
  bool implicit = seeks_rest(options);
  for (const std::string& name : options.integrator) {
    if (name == VCycleEuler::name) return "integration.integrator is " + name;
    implicit = implicit || !is_explicit(name);
  }
  const std::string& solver = options.implicit.solver;
  return implicit && solver != "auto" && solver != "conjugate_gradients"
             ? "integration.implicit.solver is " + solver
             : "";
}

void validate_cavities(const Problem& problem) {
  const auto& loads = problem.body.loads;
  for (std::size_t i = 0; i < loads.size(); ++i)
    if (std::holds_alternative<EnclosedVolume>(loads[i].load))
      refuse_matrix(problem, "body.loads." + std::to_string(i) + ".enclosed_volume");
}

void validate_contact(const Problem& problem) {
  const auto& obstacles = problem.contact.obstacles;
  if (problem.body.surface) check_numbers("body.surface", *problem.body.surface);
  if (has_pairs(problem)) check_pairs(problem);
  if (!obstacles.empty() && !problem.body.surface)
    throw InputError(
        "contact has obstacles but the body has no surface to touch them with; expected "
        "body.surface");
  if (!obstacles.empty() && problem.body.surface->triangles.empty())
    throw InputError("body.surface has no triangle; contact needs its area");
  if (!obstacles.empty() && problem.contact.whole_surface == "always")
    refuse_matrix(problem, "contact.whole_surface: always");
  std::map<std::string, std::size_t> named;
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    const std::string name = obstacle_name(problem.contact, i),
                      path = "contact.obstacles." + std::to_string(i) + ".name";
    if (name.find_first_of(",\"\n\r") != std::string::npos)
      throw InputError(path + " is '" + name +
                       "', which would break the columns of history.csv; expected no comma, "
                       "quotation mark or line break");
    if (const auto [other, first] = named.emplace(name, i); !first)
      throw InputError(path + " is '" + name + "', as is that of obstacle " +
                       std::to_string(other->second) + "; expected names that differ");
  }
  for (std::size_t i = 0; i < obstacles.size(); ++i)
    if (const auto* solid = std::any_cast<SurfaceOptions>(&obstacles[i].shape)) {
      const std::string option = "contact.obstacles." + std::to_string(i) + ".surface";
      solid->thickness > 0 ? check_triangles(option, solid->surface)
                           : check_closed(option, solid->surface);
    }
  for (const BodyPart& part : problem.body.parts)
    if (const auto other = named.find(part.name); other != named.end())
      throw InputError("contact.obstacles." + std::to_string(other->second) + ".name is '" +
                       part.name + "', as is that of a body; expected names that differ");
}

}  // namespace plica
