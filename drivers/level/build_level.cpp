// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <memory>
#include <plica/core/grouping.hpp>
#include <plica/core/time_functions.hpp>
#include <plica/core/to_device.hpp>
#include <plica/drivers/contact/turning.hpp>
#include <plica/drivers/elastic/build_nodal_rows.hpp>
#include <plica/drivers/elastic/build_patches.hpp>
#include <plica/drivers/elastic/materials.hpp>
#include <plica/drivers/level/build_followers.hpp>
#include <plica/drivers/level/build_level.hpp>
#include <plica/kernels/halo.hpp>
#include <plica/kernels/loads/boundary_conditions.hpp>

namespace plica {

namespace {

template <class B>
PrescribedVertices<B> prescribed_vertices(const LevelConstants& c, const std::vector<Path>& paths,
                                          const std::vector<PathKnot>& knots) {
  PrescribedVertices<B> p;
  p.count = static_cast<int>(c.prescribed_vertex.size());
  if (p.count == 0) return p;
  p.vertex = to_device<Indices<B>>("prescribed.vertex", c.prescribed_vertex);
  p.path = to_device<Indices<B>>("prescribed.path", c.prescribed_motion);
  p.paths = to_device<decltype(p.paths)>("prescribed.paths", paths);
  p.knots = to_device<decltype(p.knots)>("prescribed.knots", knots);
  return p;
}

Path angle_path(const Turn& turn, std::vector<PathKnot>& knots) {
  return make_path(angle_of({.axis = Point::UnitX(), .angle = turn.angle}), knots);
}

TurnAxis turn_axis(const std::optional<Turn>& turn) {
  if (!turn) return {};
  const Point axis = turn->axis.normalized();
  return {true, {axis[0], axis[1], axis[2]}, rotation_by(turn->rotation)};
}

template <class B>
SlidingVertices<B> sliding_vertices(const LevelConstants& c) {
  SlidingVertices<B> s;
  s.count = static_cast<int>(c.sliding.size());
  if (s.count == 0) return s;
  std::vector<int> vertex, place(c.mass.size(), -1);
  std::vector<std::array<double, 6>> normals;
  for (const SlidingVertex& one : c.sliding) {
    place[static_cast<std::size_t>(one.vertex)] = static_cast<int>(vertex.size());
    vertex.push_back(one.vertex);
    const auto& [a, b] = one.normals;
    normals.push_back({a[0], a[1], a[2], b[0], b[1], b[2]});
  }
  s.vertex = to_device<Indices<B>>("sliding.vertex", vertex);
  s.normals = to_device<decltype(s.normals)>("sliding.normals", normals);
  s.place = to_device<Indices<B>>("sliding.place", place);
  return s;
}

template <class B>
void add_preconditioning(Model<B>& model, const TetMesh& placed, NodalConstants constants,
                         const LevelConstants& c, BesideNodal beside) {
  using F = Backend<float, typename B::Exec>;
  if (beside == BesideNodal::nothing) return;
  model.patches = build_patches<B>(placed, constants.material, c.stiffness_damping);
  if (!c.fibres.empty())
    model.patches.fibres = device_fibres<B>(model.patches, placed, c.fibres, c.families);
  if (beside == BesideNodal::matrix) return;
  constants.bulk_excess.clear();
  model.float_rows = build_nodal_rows<F>(placed, constants, c.constrained);
  if (!c.fibres.empty())
    model.float_rows.fibres = device_fibres<F>(model.float_rows, placed, c.fibres, c.families);
}

/// Returns the shares of a part's vertices, own ones and those that are received.
template <class B>
VertexShares<B> shares_of_part(const LevelPart& part) {
  const Grouping of_vertex(part.share_vertex, part.part.vertex.size());
  std::vector<int> row;
  for (const int i : of_vertex.number) row.push_back(part.share_row[index_of(i)]);
  return {part.shares.own + part.shares.received(),
          to_device<Indices<B>>("shares.first", of_vertex.first),
          to_device<Indices<B>>("shares.row", row)};
}

template <class B>
void add_elements(LevelData<B>& level, const Body& body, const TetMesh& placed,
                  const LevelConstants& c, BesideNodal beside, const LevelPart* part,
                  HaloRows& slots) {
  Model<B>& model = level.model;
  if (c.element == Element::linear) {
    model.patches =
        build_patches<B>(placed, c.material, c.stiffness_damping, part ? &part->runs : nullptr);
    if (!c.fibres.empty())
      model.patches.fibres = device_fibres<B>(model.patches, placed, c.fibres, c.families);
    model.shares = part ? shares_of_part<B>(*part) : with_followers(model.patches.shares, placed);
  } else {
    const bool smoothed = smooths_pressure(body, c.lame);
    NodalConstants constants{smoothed ? c.capped : c.material, {}, {}, c.stiffness_damping};
    for (const Lame<double>& lame : c.lame) {
      constants.stabiliser.push_back(body.stabilisation * lame.mu);
      if (smoothed) constants.bulk_excess.push_back(lame.lambda - capped_lambda(lame));
    }
    if (part) {
      auto [rows, halo] = build_nodal_part<B>(placed, constants, c.constrained, part->part);
      model.rows = rows, slots = std::move(halo);
    } else {
      model.rows = build_nodal_rows<B>(placed, constants, c.constrained);
    }
    model.shares = with_followers(model.rows.shares, placed);
    level.nodal = make_nodal_work<B>(model.rows);
    if (!c.fibres.empty())
      model.rows.fibres = device_fibres<B>(model.rows, placed, c.fibres, c.families);
    add_preconditioning<B>(model, placed, std::move(constants), c, beside);
  }
  level.partial = zeros<Vectors<B>>("plica::work.partial",
                                    std::max(model.shares.rows, model.patches.shares.rows));
  if (!allows_inversion(body.material))
    level.flags = make_element_flags<B>(c.element == Element::linear ? model.patches.count
                                                                     : model.rows.slices);
}

/// Makes the messages of a part. Rows of `partial` are received in place.
template <class B>
std::shared_ptr<const RankLevel<B>> rank_level(const LevelPart& part, const LevelData<B>& level,
                                               Element element, const HaloRows& slots) {
  auto made = std::make_shared<RankLevel<B>>(RankLevel<B>{
      part.ranks, part.part, to_device<Indices<B>>("level.number", part.part.vertex), {}, {}, {}});
  Ranks& ranks = *part.ranks;
  const std::string of_level = " of level " + std::to_string(part.number);
  if (element == Element::linear) {
    made->shares = std::make_unique<Halo<B>>(ranks, "shares" + of_level, part.shares,
                                             std::vector{3}, level.partial.data());
    return made;
  }
  constexpr int record = 12;  // numbers of a slot
  const bool smoothed = level.model.rows.bulk_excess.extent(0) > 0;
  made->vertices =
      std::make_unique<Halo<B>>(ranks, "vertices" + of_level, part.vertices, std::vector{3});
  made->slots =
      std::make_unique<Halo<B>>(ranks, "records" + of_level, slots,
                                smoothed ? std::vector{1, 2, record} : std::vector{record});
  return made;
}

}  // namespace

template <class B>
LevelData<B> build_level(const Body& body, const TetMesh& placed, const LevelConstants& c,
                         BesideNodal beside, const LevelPart* part) {
  using Real = typename B::Real;
  const std::size_t n = placed.vertices.size();
  LevelData<B> level;
  level.model.vertices = static_cast<int>(n);
  level.model.tets = static_cast<int>(placed.tets.size());
  level.model.followers = following_vertices<B>(placed);
  HaloRows slots;
  add_elements(level, body, placed, c, beside, part, slots);
  if (part) level.ranks = rank_level(*part, level, c.element, slots);

  std::vector<Real> mass(n), inverse(n);
  std::vector<Point> velocity(n, Point::Zero()), displacement(n, Point::Zero());
  for (std::size_t v = 0; v < n; ++v) {
    mass[v] = static_cast<Real>(c.mass[v]);
    // a follower has no mass, and forces do not move it
    const bool moves = !c.constrained[v] && c.mass[v] > 0;
    inverse[v] = moves ? static_cast<Real>(1 / c.mass[v]) : Real(0);
    if (!c.constrained[v]) velocity[v] = c.velocity[v];
  }
  std::vector<PathKnot> knots;
  std::vector<Path> paths;
  std::vector<TurnAxis> turns;
  for (const PrescribedMotion& given : body.prescribed) {
    paths.push_back(given.rotate ? angle_path(*given.rotate, knots)
                                 : make_path(given.motion, knots));
    turns.push_back(turn_axis(given.rotate));
  }
  level.prescribed = prescribed_vertices<B>(c, paths, knots);
  std::vector<std::array<double, 3>> arms;
  for (std::size_t i = 0; i < c.prescribed_vertex.size(); ++i) {
    const auto v = static_cast<std::size_t>(c.prescribed_vertex[i]),
               motion = static_cast<std::size_t>(c.prescribed_motion[i]);
    Point arm = Point::Zero();
    if (turns[motion].turns) arm = placed.vertices[v] - c.turned_about[motion];
    arms.push_back({arm[0], arm[1], arm[2]});
    const PathPoint at =
        given_step(paths[motion], knots.data(), turns[motion], {arm[0], arm[1], arm[2]}, 0, 0);
    for (int k = 0; k < 3; ++k)
      displacement[v][k] = at.displacement[k], velocity[v][k] = at.velocity[k];
  }
  if (std::ranges::any_of(turns, &TurnAxis::turns)) {
    PrescribedVertices<B>& given = level.prescribed;
    given.turns = to_device<decltype(given.turns)>("prescribed.turns", turns);
    given.arm = to_device<decltype(given.arm)>("prescribed.arm", arms);
  }
  level.sliding = sliding_vertices<B>(c);
  for (const SlidingVertex& one : c.sliding)
    for (const Point& normal : one.normals) {
      Point& v = velocity[static_cast<std::size_t>(one.vertex)];
      v -= normal.dot(v) * normal;
    }
  const std::vector<Real> damping(c.mass_damping.begin(), c.mass_damping.end());
  level.model.damping.everywhere = damping.front();
  if (damping.size() > 1)
    level.model.damping.of_vertex = to_device<Scalars<B>>("model.damping", damping);
  level.model.mass = to_device<Scalars<B>>("model.mass", mass);
  level.model.inverse_mass = to_device<Scalars<B>>("model.inverse_mass", inverse);
  level.state.u = to_device<Vectors<B>>("state.u", rows<Real>(displacement));
  level.state.v = to_device<Vectors<B>>("state.v", rows<Real>(velocity));
  level.f = zeros<Vectors<B>>("plica::work.f", n);
  return level;
}

#define PLICA_INSTANTIATE(Real, Exec)                                       \
  template LevelData<Backend<Real, Exec>> build_level<Backend<Real, Exec>>( \
      const Body&, const TetMesh&, const LevelConstants&, BesideNodal, const LevelPart*);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
