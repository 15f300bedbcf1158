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

/// Returns patches with what their kernels read.
/// @param fibres  per tetrahedron; empty: they do not vary within a region
template <class B>
Patches<B> patches_of(const TetMesh& mesh, const std::vector<std::vector<double>>& material,
                      const LevelConstants& c, const std::vector<FibreAxes>& fibres,
                      const std::vector<std::vector<int>>* runs) {
  Patches<B> patches = build_patches<B>(mesh, material, c.stiffness_damping, runs);
  if (!fibres.empty()) patches.fibres = device_fibres<B>(patches, mesh, fibres, c.families);
  return patches;
}

/// Constants of nodal elements, and whether their pressures are smoothed.
NodalConstants nodal_constants(const Body& body, const LevelConstants& c) {
  const bool smoothed = smooths_pressure(body, c.lame);
  NodalConstants constants{smoothed ? c.capped : c.material, {}, {}, c.stiffness_damping};
  for (const Lame<double>& lame : c.lame) {
    constants.stabiliser.push_back(body.stabilisation * lame.mu);
    if (smoothed) constants.bulk_excess.push_back(lame.lambda - capped_lambda(lame));
  }
  return constants;
}

/// Rows of nodal elements, of the mesh or of one rank, and the slots that the rank exchanges.
template <class B>
NodalPart<B> nodal_rows(const TetMesh& placed, const NodalConstants& constants,
                        const LevelConstants& c, const LevelPart* part) {
  NodalPart<B> made;
  if (part)
    made = build_nodal_part<B>(placed, constants, c.constrained, part->part);
  else
    made.rows = build_nodal_rows<B>(placed, constants, c.constrained);
  if (!c.fibres.empty())
    made.rows.fibres = device_fibres<B>(made.rows, placed, c.fibres, c.families);
  return made;
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

/// Begins what a rank exchanges of a level: the values of vertices.
template <class B>
std::shared_ptr<RankLevel<B>> rank_level(const LevelPart& part) {
  auto made = std::make_shared<RankLevel<B>>();
  made->ranks = part.ranks, made->part = part.part, made->vertex_rows = part.vertices;
  made->number = to_device<Indices<B>>("level.number", part.part.vertex);
  if (part.nodal || part.matrix)
    made->vertices = std::make_unique<Halo<B>>(*part.ranks, part.named("vertices"), part.vertices,
                                               std::vector{3});
  return made;
}

/// Adds the records of slots to what a rank exchanges.
template <class B>
void exchange_slots(RankLevel<B>& level, const LevelPart& part, const NodalPart<B>& nodal) {
  constexpr int record = 12;  // numbers of a slot
  const bool smoothed = nodal.rows.bulk_excess.extent(0) > 0;
  level.slots =
      std::make_unique<Halo<B>>(*part.ranks, part.named("records"), nodal.slots,
                                smoothed ? std::vector{1, 2, record} : std::vector{record});
}

/// Adds the patches of which a rank assembles its rows of a matrix.
template <class B>
void add_patches_around(RankLevel<B>& level, const LevelPart& part,
                        const std::vector<std::vector<double>>& material, const LevelConstants& c) {
  if (!part.matrix) return;
  const MatrixPart& matrix = *part.matrix;
  level.around_owned = patches_of<B>(matrix.mesh, material, c, matrix.fibres, &matrix.runs);
  for (const std::vector<int>& run : matrix.runs)
    level.region_around.push_back(
        matrix.mesh.region.empty() ? 0 : matrix.mesh.region[index_of(run.front())]);
}

template <class B>
void add_linear_elements(LevelData<B>& level, const TetMesh& placed, const LevelConstants& c,
                         const LevelPart* part, RankLevel<B>* ranks) {
  Model<B>& model = level.model;
  model.patches = patches_of<B>(placed, c.material, c, c.fibres, part ? &part->runs : nullptr);
  model.shares = part ? shares_of_part<B>(*part) : with_followers(model.patches.shares, placed);
  level.partial = zeros<Vectors<B>>("plica::work.partial", model.shares.rows);
  if (!part) return;
  // rows of `partial` are received in place
  ranks->shares = std::make_unique<Halo<B>>(*part->ranks, part->named("shares"), part->shares,
                                            std::vector{3}, level.partial.data());
  add_patches_around(*ranks, *part, c.material, c);
}

template <class B>
void add_nodal_elements(LevelData<B>& level, const Body& body, const TetMesh& placed,
                        const LevelConstants& c, BesideNodal beside, const LevelPart* part,
                        RankLevel<B>* ranks) {
  using F = Backend<float, typename B::Exec>;
  Model<B>& model = level.model;
  NodalConstants constants = nodal_constants(body, c);
  const NodalPart<B> nodal = nodal_rows<B>(placed, constants, c, part);
  model.rows = nodal.rows;
  model.shares = with_followers(model.rows.shares, placed);
  level.nodal = make_nodal_work<B>(model.rows);
  if (part) exchange_slots(*ranks, *part, nodal);
  if (beside != BesideNodal::nothing) {
    if (!part)
      model.patches = patches_of<B>(placed, constants.material, c, c.fibres, nullptr);
    else
      add_patches_around(*ranks, *part, constants.material, c);
  }
  level.partial = zeros<Vectors<B>>("plica::work.partial",
                                    std::max(model.shares.rows, model.patches.shares.rows));
  if (beside != BesideNodal::matrix_and_rows) return;
  constants.bulk_excess.clear();
  const NodalPart<F> in_float = nodal_rows<F>(placed, constants, c, part);
  model.float_rows = in_float.rows;
  if (!part) return;
  const auto float_ranks = rank_level<F>(*part);
  exchange_slots(*float_ranks, *part, in_float);
  level.float_ranks = float_ranks;
}

/// Adds elements, and what several ranks exchange of them.
template <class B>
void add_elements(LevelData<B>& level, const Body& body, const TetMesh& placed,
                  const LevelConstants& c, BesideNodal beside, const LevelPart* part) {
  std::shared_ptr<RankLevel<B>> ranks = part ? rank_level<B>(*part) : nullptr;
  const bool linear = c.element == Element::linear;
  if (linear)
    add_linear_elements<B>(level, placed, c, part, ranks.get());
  else
    add_nodal_elements<B>(level, body, placed, c, beside, part, ranks.get());
  if (ranks)
    for (std::size_t v = 0; v < c.mass.size(); ++v)
      ranks->given.push_back(c.constrained[v] || !(c.mass[v] > 0));
  level.ranks = ranks;
  if (!allows_inversion(body.material))
    level.flags =
        make_element_flags<B>(linear ? level.model.patches.count : level.model.rows.slices);
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
  add_elements(level, body, placed, c, beside, part);

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
