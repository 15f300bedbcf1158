// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <plica/core/error.hpp>
#include <plica/core/text.hpp>
#include <plica/drivers/methods/methods.hpp>
#include <plica/drivers/run/compose_levels.hpp>
#include <plica/drivers/run/validate.hpp>

namespace plica {

void validate_pieces(const TetMesh& mesh, int number_of_level) {
  const std::string level = "body.levels: level " + std::to_string(number_of_level);
  constexpr double rounding = 1e-9;
  const Followers& followers = mesh.followers;
  const std::size_t count = followers.vertex.size();
  if (!mesh.piece.empty() && mesh.piece.size() != mesh.tets.size())
    throw InputError(text(level, " has pieces for ", mesh.piece.size(), " of ", mesh.tets.size(),
                          " tetrahedra; expected all or none"));
  if (followers.of.size() != count || followers.weight.size() != count)
    throw InputError(text(level, " has ", count, " followers with ", followers.of.size(),
                          " masters and ", followers.weight.size(), " weights; expected as many"));
  std::vector<char> follows(mesh.vertices.size(), 0);
  for (std::size_t i = 0; i < count; ++i) {
    const int v = followers.vertex[i];
    if (v < 0 || v >= std::ssize(follows) || (i > 0 && v <= followers.vertex[i - 1]))
      throw InputError(text(level, ": follower ", i, " is vertex ", v, "; expected vertices of ",
                            follows.size(), ", ascending"));
    follows[static_cast<std::size_t>(v)] = 1;
  }
  for (std::size_t i = 0; i < count; ++i) {
    double sum = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const int master = followers.of[i][k];
      if (master < 0 || master >= std::ssize(follows) || follows[static_cast<std::size_t>(master)])
        throw InputError(text(level, ": vertex ", followers.vertex[i], " follows vertex ", master,
                              "; expected one that follows no other"));
      sum += followers.weight[i][k];
    }
    if (!(std::abs(sum - 1) < rounding))
      throw InputError(text(level, ": the weights by which vertex ", followers.vertex[i],
                            " follows others have the sum ", number(sum, 12), "; expected 1"));
  }
}

namespace {

bool runs_between_sets(const std::optional<FibreOptions>& fibres) { return fibres && fibres->from; }

/// Returns why a problem's body cannot have a part that follows an obstacle; empty: it can.
std::string refused_by_following(const Problem& problem) {
  const Body& body = problem.body;
  if (const std::string& cycle = problem.integration.cycle; cycle != "single" && cycle != "him")
    return "integration.cycle is " + cycle +
           ", which cannot go on with another part; expected "
           "single or him";
  if (!problem.cuts.empty())
    return "cuts: a body with a part that moves cannot be cut; expected a part that stays, and "
           "cuts, in runs of their own";
  if (!body.surface)
    return "body.surface: contact acts on points that stay when the part moves; expected a surface";
  if (body.initial.position)
    return "body.initial.position: a body whose part is made anew stays where its mesh is; leave "
           "it out, and move the mesh";
  if (is_viscous(body))
    return "prony: stresses that relax cannot go on in other elements; expected no prony, or a "
           "part that stays";
  for (std::size_t i = 0; i < body.loads.size(); ++i)
    if (std::holds_alternative<EnclosedVolume>(body.loads[i].load))
      return text("body.loads.", i,
                  ".enclosed_volume: a cavity cannot go on in other elements; expected "
                  "follower_pressure");
  return {};
}

}  // namespace

void validate_parts(const Problem& problem) {
  const Body& body = problem.body;
  if (body.following) {
    followed_obstacle(body.following->follows, problem.contact);
    if (const std::string why = refused_by_following(problem); !why.empty())
      throw InputError("body.levels.0.refine.follows: " + why);
  }
  const auto part =
      std::ranges::find_if(body.levels, [](const TetMesh& mesh) { return !mesh.piece.empty(); });
  if (part == body.levels.end()) return;
  const std::string level = text("body.levels: level ", part - body.levels.begin(),
                                 " has a part that is finer, by covers or refine, ");
  if (const std::string& cycle = problem.integration.cycle; integrates_coarse_levels(cycle))
    throw InputError(level + "which cycle " + cycle +
                     " cannot integrate; expected cycle single, him or auto");
  const bool flows = runs_between_sets(body.material.fibres) ||
                     std::ranges::any_of(body.regions, [](const auto& region) {
                       return runs_between_sets(region.second.fibres);
                     });
  if (flows)
    throw InputError("body.fibres.from: " + level +
                     "through whose border no direction is found; expected fibres by axis, around "
                     "or field");
}

}  // namespace plica
