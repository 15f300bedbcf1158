// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/core/error.hpp>
#include <plica/core/keys.hpp>
#include <plica/core/text.hpp>
#include <plica/drivers/body/selection.hpp>
#include <plica/drivers/contact/turning.hpp>
#include <plica/drivers/run/compose_levels.hpp>
#include <plica/drivers/run/validate.hpp>
#include <plica/kernels/contact/gap.hpp>
#include <plica/meshes/composite.hpp>
#include <plica/meshes/partly_refined.hpp>

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

/// Chooses the regions of all meshes, so that elements keep theirs when they are cut in eight.
void choose_regions(Body& body) {
  for (std::size_t i = 0; i < body.levels.size(); ++i)
    add_regions(body.levels[i], body.regions, static_cast<int>(i));
  for (auto& [name, region] : body.regions) region.where.reset();
}

void expect_to_follow(const Body& body, std::size_t level) {
  const std::string path = level_path(level) + ".refine.follows";
  if (level != 0 || body.covers.size() > 1)
    throw InputError(path +
                     ": a part that follows an obstacle is the only one; expected one level "
                     "with refine, the first, and none with covers");
  if (const TetMesh& own = body.levels.front(); !own.tets.empty())
    throw InputError(level_path(level) + " has a mesh and is to be refined; expected one");
  validate_mesh(body.levels[1], 1);
  if (!body.levels[1].filled.empty() || !body.levels[1].piece.empty())
    throw InputError(path + ": level 1 is a lattice, or has pieces; expected one mesh that fits");
  if (!body.covers.at(level).refined || body.covers.at(level).where)
    throw InputError(path + ": expected a part that is refined, without another choice");
  if (!body.parts.empty()) throw InputError(path + ": expected one body, got several");
}

/// Makes level 0 of level 1 and a part of it round an obstacle.
std::vector<std::string> start_following(Body& body, std::size_t level,
                                         const ContactOptions& contact) {
  expect_to_follow(body, level);
  const FollowOptions follows = *body.covers.at(0).follows;
  keys::Quantity{keys::length, keys::positive}.check(level_path(0) + ".refine.follows.radius",
                                                     follows.radius);
  const ObstacleOptions& tool = contact.obstacles[followed_obstacle(follows, contact)];
  const Vec3<double> at =
      pose_at_start(tool).placed(vec3<double>(follows.at.value_or(origin_of(tool))));
  body.levels.erase(body.levels.begin());
  choose_regions(body);
  const TetMesh& whole = body.levels.front();
  std::vector<int> tets =
      tets_within(whole.tets, whole.vertices, Point(at[0], at[1], at[2]), follows.radius);
  Composite made = partly_refined(whole, tets);
  body.following = FollowingPart{follows, whole, std::move(tets)};
  body.levels.front() = std::move(made.mesh), body.covers.clear();
  for (std::string& doubt : made.doubts) doubt = level_path(0) + ": " + doubt;
  return std::move(made.doubts);
}

}  // namespace

std::size_t followed_obstacle(const FollowOptions& follows, const ContactOptions& contact) {
  std::vector<std::string> names;
  for (std::size_t o = 0; o < contact.obstacles.size(); ++o) {
    names.push_back(obstacle_name(contact, o));
    if (names.back() == follows.obstacle) return o;
  }
  throw InputError(level_path(0) + ".refine.follows.obstacle: " +
                   (names.empty() ? "there is no obstacle '" + follows.obstacle +
                                        "'; expected one under contact.obstacles"
                                  : unknown_name("obstacle", follows.obstacle, names)));
}

std::vector<std::string> compose_levels(Body& body, const ContactOptions& contact) {
  std::vector<std::string> doubts;
  if (body.covers.empty()) return doubts;
  if (const auto& [last, cover] = *body.covers.rbegin(); last + 1 >= body.levels.size())
    throw InputError(level_path(last) + cover_key(cover) +
                     (cover.refined ? ": the last level has none after it to refine"
                                    : ": the last level covers a part") +
                     "; expected a coarser one of the whole body after it");
  const auto follows = [](const auto& cover) { return cover.second.follows.has_value(); };
  if (const auto part = std::ranges::find_if(body.covers, follows); part != body.covers.end())
    return start_following(body, part->first, contact);
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
