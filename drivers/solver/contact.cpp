// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <plica/drivers/solver/contact.hpp>
#include <plica/drivers/solver/courses.hpp>
#include <plica/drivers/solver/materials.hpp>
#include <plica/drivers/solver/set_up/sample_distance.hpp>
#include <plica/drivers/solver/set_up/to_device.hpp>
#include <plica/kernels/contact/implicit_response.hpp>

namespace plica {

namespace {

// Over the layer of elements under the surface. Of contact that is implicit in an explicit step: what keeps a body visibly outside.
// The linear systems of implicit levels take less, and then the other levels as well: what one level leaves inside an obstacle, the
// next must not throw out.
constexpr double most_stiffening = 64, stiffening_in_systems = 4;

// In mean edges of the surface, the radius from which on an obstacle is left to the points. A tool that is pressed in by its radius
// spreads the points under it and comes between them, however fine the mesh is.
constexpr double wide = 16;

constexpr double pair_reach = 0.5, pair_margin = 0.25, face_reach = 0.25;  // of an edge

double mean_surface_edge(const TriangleSurface& surface) {
  double sum = 0;
  for (const auto& t : surface.triangles)
    for (std::size_t c = 0; c < 3; ++c) {
      const auto x = [&](std::size_t k) { return surface.vertices[static_cast<std::size_t>(t[k % 3])]; };
      sum += (x(c + 1) - x(c)).norm();
    }
  return sum / static_cast<double>(3 * surface.triangles.size());
}

}  // namespace

template <class B>
Contact<B>::Contact(const ContactOptions& options, const TouchingSurface& surface, bool pairs, bool stiff)
    : points_(static_cast<int>(surface.surface.vertices.size())),
      attached_count_(static_cast<int>(surface.attached.size())),
      reach_(surface.edge),
      deepest_(surface.size),
      lost_(zeros<Indices<B>>("plica::contact.lost", 1)) {
  const DepthWatch<B> watch{lost_, static_cast<Real>(deepest_)};
  const auto& all = options.obstacles;
  for (const ObstacleOptions& o : all) grasps_.push_back(o.grasp);
  make_memory(std::ranges::any_of(all, [](const ObstacleOptions& o) { return o.mass.has_value(); }));
  for (const ObstacleOptions& o : all) obstacles_.push_back(make_obstacle<B>(o, watch, memory_, obstacles()));
  choose_held(surface.held);
  make_laws(options, surface, stiff);
  choose_whole(options.whole_surface, surface.surface);
  if (pairs || whole() > 0) connect(surface.surface, pairs);
  if (!pairs) return;
  limits_ = {static_cast<Real>(pair_reach * surface.edge), static_cast<Real>(pair_margin * surface.edge),
             static_cast<Real>(surface.edge), options.bodies, options.self};
}

template <class B>
void Contact<B>::make_memory(bool tools) {
  const int count = static_cast<int>(grasps_.size());
  if (tools) held_.first = ObstaclePlace<B>::numbers * count;
  if (std::ranges::any_of(grasps_, [](const auto& grasp) { return grasp.has_value(); }))
    held_.records = count * points_;
  if (const int size = held_.at(held_.records); size > 0)
    held_.memory = memory_ = zeros<Doubles<B>>("plica::contact.memory", static_cast<std::size_t>(size));
}

template <class B>
void Contact<B>::choose_held(const std::vector<std::vector<int>>& chosen) {
  if (std::ranges::all_of(chosen, [](const auto& points) { return points.empty(); })) return;
  std::vector<int> left_out(static_cast<std::size_t>(held_.records), 0);
  auto own = left_out.begin();
  for (const auto& points : chosen) {
    if (!points.empty()) std::fill(own, own + points_, 1);
    for (const int p : points) own[p] = 0;
    own += points_;
  }
  held_.left_out = to_device<Indices<B>>("contact.left_out", left_out);
}

template <class B>
void Contact<B>::choose_whole(const std::string& rule, const TriangleSurface& surface) {
  const double edge = mean_surface_edge(surface);
  for (const auto& obstacle : obstacles_)
    whole_.push_back(rule == "always" || (rule == "auto" && obstacle->radius() < wide * edge));
}

template <class B>
int Contact<B>::whole() const {
  return static_cast<int>(std::count(whole_.begin(), whole_.end(), true));
}

/// A row of laws for every obstacle and one for pairs; in it one for every body.
template <class B>
void Contact<B>::make_laws(const ContactOptions& options, const TouchingSurface& of, bool stiff) {
  std::vector<double> area(of.parts.size(), 0), points(of.parts.size(), 0);
  const auto part = [&](int p) {
    return of.body.empty() ? 0u : static_cast<std::size_t>(of.body[static_cast<std::size_t>(p)]);
  };
  for (int p = 0; p < points_; ++p) ++points[part(p)];
  for (const auto& t : of.surface.triangles) {
    const auto x = [&](std::size_t c) { return of.surface.vertices[static_cast<std::size_t>(t[c])]; };
    area[part(t[0])] += 0.5 * (x(1) - x(0)).cross(x(2) - x(0)).norm();
  }
  std::vector<PenaltyLaw<Real>> laws, held_laws;
  const auto add_row = [&](const std::optional<double>& friction, const std::optional<GraspOptions>& grasp) {
    for (std::size_t b = 0; b < of.parts.size(); ++b) {
      const MaterialOptions& material = *of.parts[b].material;
      const double per_point = area[b] / std::max(points[b], 1.0), edge = of.parts[b].edge;
      const double soft = options.stiffness_scale * stiffness_at_rest(material) * per_point / edge;
      const auto critical = [&](double k) {
        return std::sqrt(k * material.density * per_point * edge);
      };  // 2 * 0.5 sqrt(k m)
      const auto law = [&](double k) {
        return PenaltyLaw<Real>{static_cast<Real>(k), static_cast<Real>(options.damping_scale * critical(k)),
                                static_cast<Real>(friction ? options.tangential_damping_scale * critical(k) : 0),
                                static_cast<Real>(friction.value_or(0))};
      };
      const double pushing = (stiff ? most_stiffening : stiffening_in_systems) * soft,
                   holding = (stiff ? most_stiffening : 1) * soft;
      laws.push_back(law(pushing));
      held_laws.push_back(law(grasp && grasp->stiffness ? *grasp->stiffness : holding));
      if (laws.size() == 1) stiffness_ = pushing, damping_ = options.damping_scale * critical(stiffness_);
    }
  };
  for (const ObstacleOptions& o : options.obstacles) add_row(o.friction, o.grasp);
  add_row(options.friction, {});
  laws_.body = of.body.empty() ? Indices<B>{} : to_device<Indices<B>>("contact.body", of.body);
  laws_.bodies = static_cast<int>(of.parts.size());
  held_.law = laws_;
  laws_.law = to_device<decltype(laws_.law)>("contact.laws", laws);
  if (held_.records > 0) held_.law.law = to_device<decltype(laws_.law)>("contact.held_laws", held_laws);
  if (attached_count_ > 0) attach(options, of, {laws.end() - laws_.bodies, laws.end()});
}

/// `pair_laws`: one for every body. A spring of another stiffness has its damping in proportion, as a critical one has.
template <class B>
void Contact<B>::attach(const ContactOptions& options, const TouchingSurface& of,
                        const std::vector<PenaltyLaw<Real>>& pair_laws) {
  const auto n = static_cast<std::size_t>(points_);
  std::vector<int> attachment(n, AttachedPoints<B>::none), triangle(n, -1);
  std::vector<std::array<Real, 3>> weight(n);
  std::vector<PenaltyLaw<Real>> laws(options.attachments.size());
  for (const AttachedPoint& one : of.attached) {
    const auto p = static_cast<std::size_t>(one.point), a = static_cast<std::size_t>(one.attachment);
    attachment[p] = one.attachment, triangle[p] = one.triangle;
    for (std::size_t c = 0; c < 3; ++c) weight[p][c] = static_cast<Real>(one.weight[c]);
    PenaltyLaw<Real>& law = laws[a] = pair_laws[static_cast<std::size_t>(of.body[p])];
    const Real k = static_cast<Real>(options.attachments[a].stiffness.value_or(static_cast<double>(law.stiffness)));
    law.damping *= std::sqrt(k / law.stiffness), law.stiffness = k;
  }
  for (const AttachedPoint& one : of.attached)
    for (const int corner : of.surface.triangles[static_cast<std::size_t>(one.triangle)])
      if (int& number = attachment[static_cast<std::size_t>(corner)]; number < 0) number = AttachedPoints<B>::beside;
  attached_.attachment = to_device<Indices<B>>("contact.attachment", attachment);
  attached_.triangle = to_device<Indices<B>>("contact.attached_to", triangle);
  attached_.weight = to_device<Vectors<B>>("contact.attached_weight", weight);
  attached_.law = to_device<decltype(attached_.law)>("contact.attached_laws", laws);
}

/// The surface's triangles, and those around each point: for pairs, for thin obstacles.
template <class B>
void Contact<B>::connect(const TriangleSurface& surface, bool pairs) {
  std::vector<std::vector<int>> around(surface.vertices.size());
  std::vector<int> corner, first{0}, triangle;
  for (const auto& t : surface.triangles)
    for (const int p : t) {
      around[static_cast<std::size_t>(p)].push_back(static_cast<int>(corner.size() / 3));
      corner.push_back(p);
    }
  for (const auto& list : around) {
    triangle.insert(triangle.end(), list.begin(), list.end());
    first.push_back(static_cast<int>(triangle.size()));
  }
  const int triangles = static_cast<int>(surface.triangles.size());
  pairs_.points = points_;
  pairs_.triangles = pairs ? triangles : 0;
  faces_.triangles = whole() > 0 ? triangles : 0;
  faces_.reach = static_cast<Real>(face_reach * reach_);
  faces_.corner = pairs_.corner = to_device<Indices<B>>("contact.corner", corner);
  faces_.first = pairs_.first = to_device<Indices<B>>("contact.first", first);
  faces_.triangle = pairs_.triangle = to_device<Indices<B>>("contact.triangle", triangle);
  if (pairs) connect_edges(surface);
}

/// Edges in the order of their ends, the end with the lower number first.
template <class B>
void Contact<B>::connect_edges(const TriangleSurface& surface) {
  struct Edge {
    std::array<int, 2> opposite{-1, -1};  // left and right of the way from its first end to the second
    int number = 0;
  };
  std::map<std::array<int, 2>, Edge> edges;  // by their ends
  const auto each_side = [&](const auto& use) {
    for (const auto& t : surface.triangles)
      for (std::size_t c = 0; c < 3; ++c) {
        const int a = t[c], b = t[(c + 1) % 3];
        use(edges[{std::min(a, b), std::max(a, b)}], a < b ? 0u : 1u, t[(c + 2) % 3]);
      }
  };
  each_side([](Edge& e, std::size_t right, int third) { e.opposite[right] = third; });
  std::vector<int> edge, side, first(surface.vertices.size() + 1, 0);
  for (auto& [ends, e] : edges) {
    e.number = static_cast<int>(edge.size() / 4);
    edge.insert(edge.end(), {ends[0], ends[1], e.opposite[0], e.opposite[1]});
    ++first[static_cast<std::size_t>(ends[0]) + 1];
  }
  std::partial_sum(first.begin(), first.end(), first.begin());
  each_side([&](const Edge& e, std::size_t, int) { side.push_back(e.number); });
  pairs_.edge = to_device<Indices<B>>("contact.edge", edge);
  pairs_.first_edge = to_device<Indices<B>>("contact.first_edge", first);
  pairs_.side = to_device<Indices<B>>("contact.side", side);
}

template <class B>
TouchingPoints<B> Contact<B>::make_points(bool implicit) const {
  const std::size_t n = static_cast<std::size_t>(points_);
  TouchingPoints<B> points;
  points.points = points_, points.obstacles = obstacles();
  points.reach = points.edge = static_cast<Real>(reach_);
  points.law = laws_;
  points.pairs = pairs_, points.faces = faces_, points.held = held_, points.attached = attached_;
  if (pairs_.triangles > 0) {
    points.pairs.partner = to_device<Indices<B>>("contact.partner", std::vector<int>(n, -1));
    points.pairs.weight = zeros<Vectors<B>>("plica::contact.weight", 2 * n);
    points.pairs.other = to_device<Indices<B>>("contact.other", std::vector<int>(6 * n, -1));
    points.pairs.found = zeros<Doubles<B>>("plica::contact.found", 2);
    points.pairs.from = zeros<Indices<B>>("plica::contact.from", n + 1);
    points.pairs.part = zeros<Indices<B>>("plica::contact.part", 6 * n);
  }
  const auto faces = static_cast<std::size_t>(points.obstacles) * static_cast<std::size_t>(faces_.triangles);
  if (pairs_.triangles > 0 || faces > 0) points.pairs.sum = zeros<Vectors<B>>("plica::contact.sum", n);
  points.faces.weight = zeros<Vectors<B>>("plica::contact.face_weight", faces);
  if (implicit) points.faces.kept = zeros<Vectors<B>>("plica::contact.face_kept", faces);
  const std::size_t records = n * static_cast<std::size_t>(points.rows()) + faces;
  points.normal = zeros<Vectors<B>>("plica::contact.normal", records);
  points.velocity = zeros<Vectors<B>>("plica::contact.velocity", records);
  points.smooth = zeros<Vectors<B>>("plica::contact.smooth", records);
  points.force = zeros<Vectors<B>>("plica::contact.force", records);
  points.depth = to_device<Scalars<B>>(
      "contact.depth", std::vector<Real>(records, std::numeric_limits<Real>::lowest()));  // what no kernel looks at
  points.mobility = zeros<Scalars<B>>("plica::contact.mobility", records);
  points.count = zeros<Doubles<B>>("plica::contact.count", 1);
  if (implicit) points.block = zeros<Blocks<B>>("plica::contact.block", records);
  if (implicit && !std::ranges::all_of(obstacles_, [](const auto& obstacle) { return obstacle->convex(); }))
    points.concavity = zeros<Blocks<B>>("plica::contact.concavity", records);
  return points;
}

template <class B>
void Contact<B>::find(const Exec& exec, const Level<B>& level, const State<B>& s, double time, double ahead,
                      const TouchingPoints<B>& points) const {
  for (int o = 0; o < obstacles(); ++o)
    obstacles_[static_cast<std::size_t>(o)]->find(exec, level.surface, s, time, ahead, o, points);
  for (std::size_t o = 0; o < whole_.size(); ++o)
    if (whole_[o]) obstacles_[o]->find_on_faces(exec, level.surface, s, time, ahead, static_cast<int>(o), points);
  for (int o = 0; o < obstacles(); ++o)
    if (grasp_options(o))
      update_vertices<B>(exec, "plica::contact_held", points_,
                         StretchHeld<B>{level.surface, s, place(o, time, ahead), points, o});
}

template <class B>
double Contact<B>::energy(const Exec& exec, const Level<B>& level, double time, const BlockSums<B>& blocks) const {
  const auto result = zeros<Doubles<B>>("plica::contact_energy", 1);
  double total = 0;
  for (int o = 0; o < obstacles(); ++o) {
    obstacles_[static_cast<std::size_t>(o)]->energy(exec, level.surface, level.state, time, o, laws_, held_, blocks,
                                                    result);
    total += host_values(exec, result)[0];
  }
  return total;
}

template <class B>
void Contact<B>::move_tools(const Exec& exec, const Doubles<B>& wrench, double end, double span) const {
  for (int o = 0; o < obstacles(); ++o) obstacles_[static_cast<std::size_t>(o)]->move(exec, wrench, o, end, span);
}

template <class B>
void Contact<B>::grasp(const Exec& exec, const Level<B>& level, double time, int obstacle,
                       const TouchingPoints<B>& points) const {
  find(exec, level, level.state, time, 0, points);
  const auto reach = static_cast<Real>(grasp_options(obstacle)->reach);
  update_vertices<B>(exec, "plica::contact_grasp", points_,
                     TakeHold<B>{level.surface, level.state.u, place(obstacle, time), points, obstacle, reach});
}

template <class B>
void Contact<B>::release(const Exec& exec, int obstacle) const {
  update_vertices<B>(exec, "plica::contact_release", points_, LetGo<B>{held_, obstacle * points_});
}

template <class B>
std::vector<int> Contact<B>::held_by(const Exec& exec, int obstacle) const {
  const std::vector<double> all = host_values(exec, memory_);
  std::vector<int> held;
  for (int p = 0; p < points_; ++p)
    if (all[static_cast<std::size_t>(held_.at(obstacle * points_ + p) + 3)] > 0) held.push_back(p);
  return held;
}

template <class B>
int Contact<B>::take_lost(const Exec& exec) const {
  const int last = host_values(exec, lost_)[0];
  if (last > 0) fill(exec, lost_, 0);
  return last - 1;
}

template <class B>
std::size_t Contact<B>::grid_bytes() const {
  std::size_t total = 0;
  for (const auto& obstacle : obstacles_) total += obstacle->bytes();
  return total;
}

#define PLICA_INSTANTIATE(Real, Exec) template class Contact<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
