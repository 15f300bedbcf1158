// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/core/error.hpp>
#include <plica/drivers/body/selection.hpp>
#include <plica/drivers/run/compose_levels.hpp>
#include <plica/drivers/run/validate.hpp>
#include <plica/meshes/composite.hpp>

namespace plica {

namespace {

std::string level_path(std::size_t level) { return "body.levels." + std::to_string(level); }

std::string cover_key(const LevelCover& cover) { return cover.refined ? ".refine" : ".covers"; }

/// Returns the mesh of a level that covers a part. `below`: mesh of the next coarser level.
PartMesh part_of_level(const Body& body, std::size_t level, const PartMesh& below) {
  const LevelCover& cover = body.covers.at(level);
  const TetMesh& own = body.levels[level];
  if (cover.refined != own.tets.empty())
    throw InputError(level_path(level) + (cover.refined
                                              ? " has a mesh and is to be refined; expected one"
                                              : " has no tetrahedron"));
  if (!cover.refined) validate_mesh(own, static_cast<int>(level));
  if (!cover.where) return cover.refined ? refined(below) : PartMesh{own};
  const Selecting who{level_path(level) + cover_key(cover),
                      static_cast<int>(level) + (cover.refined ? 1 : 0)};
  if (std::holds_alternative<NearestSelection>(*cover.where))
    throw InputError(
        who.option +
        ".nearest: one element is no part; expected sphere, box, half_space or region");
  const PartMesh whole = cover.refined ? below : whole_mesh(own);
  TetMesh named = whole.mesh;
  add_regions(named, body.regions, who.level);
  const PartMesh part = cut_out(whole, select_elements(named, *cover.where, who));
  return cover.refined ? refined(part) : part;
}

}  // namespace

std::vector<std::string> compose_levels(Body& body) {
  std::vector<std::string> doubts;
  if (body.covers.empty()) return doubts;
  if (const auto& [last, cover] = *body.covers.rbegin(); last + 1 >= body.levels.size())
    throw InputError(level_path(last) + cover_key(cover) +
                     (cover.refined ? ": the last level has none after it to refine"
                                    : ": the last level covers a part") +
                     "; expected a coarser one of the whole body after it");
  std::vector<TetMesh> levels;  // coarsest first
  PartMesh below;               // next coarser mesh, as it was given
  for (std::size_t i = body.levels.size(); i-- > 0;) {
    if (!body.covers.contains(i)) {
      validate_mesh(body.levels[i], static_cast<int>(i));
      levels.push_back(body.levels[i]), below = whole_mesh(body.levels[i]);
      continue;
    }
    below = part_of_level(body, i, below);
    try {
      Composite made = compose(below, levels.back(), body.covers.at(i).border);
      levels.back() = std::move(made.mesh);
      for (const std::string& doubt : made.doubts) doubts.push_back(level_path(i) + ": " + doubt);
    } catch (const InputError& error) {
      throw InputError(level_path(i) + ": " + error.what());
    }
  }
  std::ranges::reverse(levels);
  body.levels = std::move(levels), body.covers.clear();
  return doubts;
}

}  // namespace plica
