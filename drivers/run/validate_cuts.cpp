// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/core/error.hpp>
#include <plica/core/keys.hpp>
#include <plica/core/text.hpp>
#include <plica/drivers/run/validate.hpp>
#include <plica/meshes/cut.hpp>

namespace plica {

namespace {

bool run_as_heat_flows(const std::optional<FibreOptions>& fibres) { return fibres && fibres->from; }

}  // namespace

std::string refused_by_cuts(const Problem& problem) {
  const std::string& cycle = problem.integration.cycle;
  const Body& body = problem.body;
  if (cycle != "single" && cycle != "him")
    return "integration.cycle is " + cycle +
           ", whose levels cannot follow a cut; expected single or him";
  if (!body.covers.empty())
    return "body.levels: a level that covers a part of the body cannot be cut; expected levels of "
           "the whole body, without covers";
  if (!body.parts.empty()) return "bodies: several cannot be cut; expected one, as body";
  if (body.initial.position)
    return "body.initial.position: a body that is cut stays where its mesh is; leave it out, and "
           "move the mesh";
  for (std::size_t i = 0; i < body.loads.size(); ++i)
    if (std::holds_alternative<EnclosedVolume>(body.loads[i].load))
      return text("body.loads.", i,
                  ".enclosed_volume: a cavity that is cut encloses nothing; expected "
                  "follower_pressure");
  bool any_flows = run_as_heat_flows(body.material.fibres);
  for (const auto& [name, region] : body.regions)
    any_flows = any_flows || run_as_heat_flows(region.fibres);
  if (any_flows)
    return "fibres.from: fibres that run as heat flows would change with a cut; expected "
           "fibres.field, with the directions in the mesh file";
  return {};
}

std::string refused_by_cuts(const TetMesh& mesh) {
  if (mesh.filled.empty() && mesh.followers.vertex.empty()) return {};
  return "level 0 is a lattice, or has parts of other resolutions, whose faces are not the body's; "
         "expected one mesh that fits";
}

void validate_cut_meshes(const Problem& problem) {
  if (problem.cuts.empty()) return;
  const Body& body = problem.body;
  if (const std::string why = refused_by_cuts(body.levels.front()); !why.empty())
    throw InputError("cuts: " + why);
  if (body.surface && !body.surface->vertices.empty() &&
      boundary_vertices_of(*body.surface, body.levels.front()).empty())
    throw InputError(
        "cuts: body.surface is not the boundary of level 0, whose faces open; expected "
        "body.surface: {boundary: true}");
}

void validate_cuts(const Problem& problem) {
  if (problem.cuts.empty()) return;
  if (const std::string why = refused_by_cuts(problem); !why.empty())
    throw InputError("cuts: " + why);
  const auto seconds = [](double time) { return keys::Quantity{keys::duration}.to_text(time); };
  for (std::size_t i = 0; i < problem.cuts.size(); ++i) {
    const CutOptions& cut = problem.cuts[i];
    const std::string path = text("cuts.", i);
    const std::vector<Point>& ends = cut.blade.segment;
    if (ends.size() != 2)
      throw InputError(text(path, ".blade.segment has ", ends.size(),
                            ends.size() == 1 ? " point" : " points", "; expected two, its ends"));
    if (ends[0] == ends[1])
      throw InputError(path + ".blade.segment has no length: both ends are " +
                       keys::Vector{keys::length}.to_text(ends[0]) + "; expected two places");
    if (!(cut.to > cut.from))
      throw InputError(path + ".to is " + seconds(cut.to) + "; expected a time after from, " +
                       seconds(cut.from));
  }
}

}  // namespace plica
