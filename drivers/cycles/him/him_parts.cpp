// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <limits>
#include <plica/core/error.hpp>
#include <plica/core/text.hpp>
#include <plica/core/to_device.hpp>
#include <plica/drivers/body/body_parts.hpp>
#include <plica/drivers/cycles/him/him_parts.hpp>
#include <plica/drivers/spaces/coarse_spaces.hpp>
#include <plica/drivers/spaces/coarse_stiffness.hpp>

namespace plica {

namespace {

// Automatic step over the critical step of the finest level, or of the space for slivers made of
// its mesh
constexpr double automatic_step = 8, step_with_contact = 4;
/// Maximum vertices of the coarsest mesh for which its dense matrix costs less than a space below
/// it. See cmake/docs/explanation/him.md.
constexpr int most_in_coarsest_mesh = 600;

/// Meshes of one body at rest, finest first, separate from other bodies.
struct BodyAtRest {
  RowsOfBody rows;  ///< rows of its vertices on the finest level
  std::vector<TetMesh> meshes;
  std::vector<std::vector<char>> constrained;
  std::vector<double> mass;  ///< mass of each vertex of the finest level [kg]
  std::optional<std::vector<int>> coarsen;
  /// [meshes] vertices of the next finer level in each mesh; null: finest mesh, or several bodies
  std::vector<const Embedding*> up;

  bool free() const { return std::ranges::count(constrained.front(), 1) == 0; }
};

template <class Value>
std::vector<Value> some(const std::vector<Value>& all, const RowsOfBody& rows) {
  const auto first = all.begin() + rows.first;
  return {first, first + rows.count};
}

/// Returns the mesh of the tetrahedra of these vertices, numbered from the first of them.
TetMesh mesh_of(const TetMesh& all, const RowsOfBody& rows) {
  TetMesh mesh;
  mesh.vertices = some(all.vertices, rows);
  mesh.region_names = all.region_names;
  for (std::size_t e = 0; e < all.tets.size(); ++e) {
    auto tet = all.tets[e];
    if (tet[0] < rows.first || tet[0] >= rows.first + rows.count) continue;
    for (int& v : tet) v -= rows.first;
    mesh.tets.push_back(tet);
    if (!all.region.empty()) mesh.region.push_back(all.region[e]);
    if (!all.filled.empty()) mesh.filled.push_back(all.filled[e]);
  }
  const Followers& followers = all.followers;
  for (std::size_t i = 0; i < followers.vertex.size(); ++i) {
    const int v = followers.vertex[i] - rows.first;
    if (v < 0 || v >= rows.count) continue;
    std::array<int, 4> of = followers.of[i];
    for (int& master : of) master -= rows.first;
    mesh.followers.vertex.push_back(v), mesh.followers.of.push_back(of);
    mesh.followers.weight.push_back(followers.weight[i]);
  }
  return mesh;
}

/// Returns the bodies of a scene.
/// A body that has fewer meshes than others gets its coarsest mesh only once.
template <class B>
std::vector<BodyAtRest> bodies_at_rest(const StepperSetup<B>& setup) {
  const Body& body = setup.problem.body;
  std::vector<BodyAtRest> bodies(std::max<std::size_t>(1, body.parts.size()));
  for (std::size_t i = 0; i < setup.meshes.size(); ++i) {
    const TetMesh& mesh = setup.meshes[i];
    std::vector<int> part = parts_of_vertices(mesh, body.parts);
    part.resize(mesh.vertices.size(), 0);
    for (int b = 0, first = 0; b < static_cast<int>(bodies.size()); ++b) {
      BodyAtRest& one = bodies[static_cast<std::size_t>(b)];
      const RowsOfBody rows{first, static_cast<int>(std::ranges::count(part, b))};
      first += rows.count;
      TetMesh own = mesh_of(mesh, rows);
      if (i > 0 && own.vertices == one.meshes.back().vertices) continue;
      one.meshes.push_back(std::move(own));
      one.constrained.push_back(some(setup.constants[i].constrained, rows));
      one.up.push_back(bodies.size() == 1 && i > 0 ? &setup.up[i] : nullptr);
      if (i > 0) continue;
      one.rows = rows;
      one.mass = some(setup.constants[i].mass, rows);
      one.coarsen =
          body.parts.empty() ? body.coarsen : body.parts[static_cast<std::size_t>(b)].coarsen;
    }
  }
  return bodies;
}

/// Returns the numbers of points of the spaces that are made of the coarsest mesh.
/// Empty: the coarsest mesh is the coarsest level.
std::vector<int> sizes_below(const BodyAtRest& body, bool contact) {
  const bool alone = body.meshes.size() == 1;
  if (!alone && !body.coarsen &&
      static_cast<int>(body.meshes.back().vertices.size()) <= most_in_coarsest_mesh)
    return {};
  const SizeRule rule = !alone    ? him_sizes_below_meshes
                        : contact ? him_sizes_with_contact
                                  : him_sizes;
  return space_sizes(body.coarsen, body.constrained.back(), rule);
}

void expect_small(const BodyAtRest& body, Eigen::Index vertices) {
  const auto most = CoarseModes::most_unknowns / 3;
  if (vertices <= most) return;
  const bool given = body.coarsen && !body.coarsen->empty();
  throw InputError(
      text("body.levels: cycle him solves its coarsest level by a dense matrix; it has ", vertices,
           " ", given ? "points" : "vertices", ", expected at most ", most,
           given ? ": {coarsen: auto}, or a last one of 200 to 350"
                 : ": a coarser level, of 200 to 350 vertices"));
}

template <class B>
HimParts<B> parts_of(const StepperSetup<B>& setup, const BodyAtRest& body, const LevelsBelow& below,
                     const std::vector<std::array<double, 2>>& lame,
                     std::optional<double> eigenvalue) {
  const TetMesh& finest = body.meshes.front();
  const auto spaces = mass_spaces(below.transfers, body.mass);
  HimParts<B> parts;
  const LevelData<B>& level = setup.hierarchy[0];
  // on several ranks a body is alone, and has all vertices of this rank
  parts.rows = level.ranks ? RowsOfBody{0, level.model.vertices} : body.rows;
  parts.detail = body.meshes.size() == 1 && !below.made.empty() && below.made.front().slivers;
  std::optional<CoarseModes> modes;
  FrameShape frames;
  if (!spaces.empty()) {
    expect_small(body, spaces.back().up.cols());
    const RowMatrix whole = to_finest(spaces);
    const bool follows = !finest.followers.vertex.empty();  // rows of followers are empty
    modes.emplace(
        coarse_stiffness(finest, lame, follows ? product(follower_matrix(finest), whole) : whole),
        spaces.back().mass);
    const bool of_mesh =
        below.made.empty() || (body.meshes.size() > 1 && below.made.back().slivers);
    frames = of_mesh ? frames_of_mesh(finest, body.meshes.back(), body.mass)
                     : frames_of_space(finest, whole, body.mass);
  }
  parts.inverse_mass = std::make_unique<InverseMass<B>>(parts.rows.of(level.model.inverse_mass),
                                                        spaces, frames, level.ranks.get());
  parts.fitter = std::make_unique<InertiaFitter<B>>(setup.hierarchy.exec(), level, parts.rows,
                                                    setup.elasticity, eigenvalue,
                                                    *parts.inverse_mass, std::move(modes));
  if (body.free() && !spaces.empty()) {
    const Box box = bounding_box(finest.vertices);
    std::vector<Point> rest = finest.vertices;
    for (Point& p : rest) p -= (box.min + box.max) / 2;
    if (level.ranks) rest = level.ranks->part.local(rest);
    parts.free.emplace(to_device<Vectors<B>>("him.rest", rows<typename B::Real>(rest)),
                       level.ranks ? vertices_of<B>(level) : Items(parts.rows.count),
                       ranks_of<B>(level));
  }
  return parts;
}

/// Places of the bodies' levels in the list of reports.
/// The order is: finest levels, spaces for slivers, coarser meshes, other spaces. Bodies share a
/// place: their finest levels, their spaces for slivers, and their last spaces.
struct Places {
  bool slivers = false;                ///< true: a body has a space for slivers
  std::size_t meshes = 1, spaces = 0;  ///< maximum over the bodies

  static std::size_t spaces_of(const LevelsBelow& below) {
    return below.made.size() - (!below.made.empty() && below.made.front().slivers);
  }
  void add(const BodyAtRest& body, const LevelsBelow& below) {
    slivers = slivers || (!below.made.empty() && below.made.front().slivers);
    meshes = std::max(meshes, body.meshes.size()), spaces = std::max(spaces, spaces_of(below));
  }
  std::size_t count() const { return meshes + slivers + spaces; }
  /// Returns the places of one body's levels, finest first.
  std::vector<std::size_t> of(std::size_t own_meshes, const LevelsBelow& below) const {
    std::vector<std::size_t> places{0};
    if (spaces_of(below) < below.made.size()) places.push_back(1);
    for (std::size_t i = 1; i < own_meshes; ++i) places.push_back(i + slivers);
    for (std::size_t i = spaces_of(below); i > 0; --i) places.push_back(count() - i);
    return places;
  }
};

/// Adds a space to the report of its place, where another body's space may already be.
void report_space(const CoarseSpace& space, LevelReport& report) {
  const auto old = static_cast<double>(report.vertices),
             own = static_cast<double>(space.points.size());
  const double per_row =
      static_cast<double>(space.up.nonZeros()) / static_cast<double>(space.up.rows());
  report.kind = space.slivers ? LevelKind::slivers : LevelKind::space;
  report.mean_edge =
      old > 0 ? (old * report.mean_edge + own * space.spacing) / (old + own) : space.spacing;
  report.nonzeros = old > 0 ? (old * report.nonzeros + own * per_row) / (old + own) : per_row;
  report.vertices += static_cast<int>(space.points.size());
  report.element = "none";
}

[[noreturn]] void refuse_step(double t, double fits, double critical) {
  throw InputError(text("integration.macro_step ", number(t, 4), " s is ", number(t / critical, 3),
                        " times the finest level's critical step ", number(critical, 4),
                        " s, and no inertia makes it stable in cycle him; expected at most about ",
                        number(fits, 3), " s, or a finer coarsest level"));
}

}  // namespace

template <class B>
std::vector<HimParts<B>> him_parts(StepperSetup<B>& setup) {
  std::vector<std::array<double, 2>> lame;
  for (const auto& one : setup.constants[0].lame) lame.push_back({one.lambda, one.mu});
  const std::vector<BodyAtRest> bodies = bodies_at_rest(setup);
  std::vector<LevelsBelow> below;
  Places places;
  for (const BodyAtRest& body : bodies) {
    if (std::ranges::find(body.constrained.front(), 0) == body.constrained.front().end())
      throw InputError(
          "integration.cycle is him, but all vertices of a body are fixed or have given motions, "
          "and nothing is left to step; expected cycle: single");
    std::vector<RestLevel> levels;
    for (std::size_t i = 0; i < body.meshes.size(); ++i)
      levels.push_back({body.meshes[i], body.constrained[i], body.up[i]});
    const SpaceOptions options{.sizes = sizes_below(body, setup.contact != nullptr),
                               .slivers = true};
    below.push_back(levels_below(levels, body.mass, rest_stiffness(body.meshes.front(), lame),
                                 options, setup.problem.integration.him.smoothing));
    places.add(body, below.back());
  }
  if (places.slivers) setup.reports.emplace(setup.reports.begin() + 1);
  setup.reports.resize(places.count());
  std::vector<HimParts<B>> parts;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    parts.push_back(parts_of(setup, bodies[b], below[b], lame,
                             bodies.size() == 1 ? std::optional(setup.eigenvalue) : std::nullopt));
    parts.back().places = places.of(bodies[b].meshes.size(), below[b]);
    for (std::size_t i = 0; i < below[b].made.size(); ++i) {
      const CoarseSpace& space = below[b].made[i];
      report_space(space,
                   setup.reports[space.slivers ? 1 : places.count() - (below[b].made.size() - i)]);
    }
  }
  return parts;
}

template <class B>
double fit_step(const StepperSetup<B>& setup, std::vector<HimParts<B>>& bodies, double& usual) {
  const std::optional<double>& given = setup.problem.integration.macro_step;
  const Vectors<B>& u = setup.hierarchy[0].state.u;
  const double sigma = setup.problem.integration.him.sigma,
               times = setup.contact ? step_with_contact : automatic_step;
  double critical = std::numeric_limits<double>::infinity(), asked = critical;
  for (const HimParts<B>& one : bodies) {
    const double own = one.fitter->critical_steps()[one.detail];
    critical = std::min(critical, own);
    asked = std::min(asked, (one.inverse_mass->levels() > 1 ? times : sigma) * own);
  }
  if (given) asked = *given;
  usual = given ? 0 : asked;
  for (double t = asked; t > 0.01 * std::min(asked, critical); t /= 2) {
    const auto fits = [&](HimParts<B>& one) {
      const auto fit = one.fitter->fit(t, sigma, u);
      if (fit) one.fit = *fit;
      return fit.has_value();
    };
    if (!std::ranges::all_of(bodies, fits)) continue;
    if (given && t < asked) refuse_step(asked, t, setup.reports.front().critical_step);
    return t;
  }
  refuse_step(asked, 0, setup.reports.front().critical_step);
}

template <class B>
bool fit_given_step(const StepperSetup<B>& setup, std::vector<HimParts<B>>& bodies) {
  const double t = *setup.problem.integration.macro_step,
               sigma = setup.problem.integration.him.sigma;
  bool all = true;
  for (HimParts<B>& one : bodies) {
    const auto fit = one.fitter->fit(t, sigma, setup.hierarchy[0].state.u);
    one.fit = fit ? *fit : one.fitter->use(t, sigma, 1);
    all = all && fit;
  }
  return all;
}

template <class B>
void report_fits(StepperSetup<B>& setup, const std::vector<HimParts<B>>& bodies) {
  for (std::size_t i = 0; i < setup.reports.size(); ++i) {
    LevelReport& report = setup.reports[i];
    report.explicit_integrator = false;  // no critical step limits it
    report.share = i == 0 ? 1 : 0, report.substeps = i == 0 ? 1 : 0;
    if (i > 0) report.integrator = "none";
  }
  HimReport all;
  all.all_modes = true;
  for (const HimParts<B>& one : bodies) {
    const std::vector<double>& own = one.fitter->critical_steps();
    for (std::size_t i = 0; i < one.places.size(); ++i) {
      LevelReport& report = setup.reports[one.places[i]];
      report.inertia = std::max(report.inertia, one.fit.inertia[i]);
      if (i < own.size() && !(report.detail_step > 0 && report.detail_step < own[i]))
        report.detail_step = own[i];
    }
    const int coarsest = one.inverse_mass->levels() > 1 ? one.inverse_mass->filter().vertices : 0;
    all.product = std::max(all.product, one.fit.product),
    all.bound = std::max(all.bound, one.fit.bound);
    all.coarsest = &one == &bodies.front() ? coarsest : std::min(all.coarsest, coarsest);
    all.all_modes = all.all_modes && 3 * coarsest <= CoarseModes::most_modes;
  }
  setup.him = all;
}

#define PLICA_INSTANTIATE(Real, Exec)                                             \
  template std::vector<HimParts<Backend<Real, Exec>>> him_parts(                  \
      StepperSetup<Backend<Real, Exec>>&);                                        \
  template double fit_step(const StepperSetup<Backend<Real, Exec>>&,              \
                           std::vector<HimParts<Backend<Real, Exec>>>&, double&); \
  template bool fit_given_step(const StepperSetup<Backend<Real, Exec>>&,          \
                               std::vector<HimParts<Backend<Real, Exec>>>&);      \
  template void report_fits(StepperSetup<Backend<Real, Exec>>&,                   \
                            const std::vector<HimParts<Backend<Real, Exec>>>&);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
