// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <plica/core/time_functions.hpp>
#include <plica/core/to_device.hpp>
#include <plica/drivers/body/selection.hpp>
#include <plica/drivers/contact/contact.hpp>
#include <plica/drivers/contact/sample_distance.hpp>
#include <plica/drivers/elastic/materials.hpp>
#include <plica/kernels/contact/find_on_points.hpp>

namespace plica {

namespace {

// Contact stiffness over that of the layer of elements under the surface. A body then stays visibly
// outside an obstacle.
constexpr double stiffening = 64;

// Radius from which on an obstacle touches points only, over the mean edge of the surface. A
// smaller tool that is pressed in by its radius spreads the points under it and comes between them,
// however fine the mesh is.
constexpr double wide = 16;

constexpr double pair_reach = 0.5, pair_margin = 0.25;  // lengths over the mean edge

template <class Use>
void each_side(const TriangleSurface& surface, const Use& use) {
  for (const auto& t : surface.triangles)
    for (std::size_t c = 0; c < 3; ++c) {
      const auto x = [&](std::size_t k) {
        return surface.vertices[static_cast<std::size_t>(t[k % 3])];
      };
      use((x(c + 1) - x(c)).norm());
    }
}

double mean_surface_edge(const TriangleSurface& surface) {
  double sum = 0;
  each_side(surface, [&](double length) { sum += length; });
  return sum / static_cast<double>(3 * surface.triangles.size());
}

double longest_surface_edge(const TriangleSurface& surface) {
  double longest = 0;
  each_side(surface, [&](double length) { longest = std::max(longest, length); });
  return longest;
}

}  // namespace

template <class B>
Contact<B>::Contact(const ContactOptions& options, const TouchingSurface& surface, bool pairs)
    : points_(static_cast<int>(surface.surface.vertices.size())),
      attached_count_(static_cast<int>(surface.attached.size())),
      bodies_(static_cast<int>(surface.parts.size())),
      pairs_(pairs),
      rubs_((pairs && options.friction.value_or(0) > 0) ||
            std::ranges::any_of(options.obstacles,
                                [](const auto& o) { return o.friction.value_or(0) > 0; })),
      reach_(surface.edge),
      deepest_(surface.size),
      lost_(zeros<Indices<B>>("plica::contact.lost", 1)) {
  const DepthWatch<B> watch{lost_, static_cast<Real>(deepest_)};
  const auto& all = options.obstacles;
  const double longest = longest_surface_edge(surface.surface);
  for (const ObstacleOptions& o : all) options_.push_back(o.grasp);
  make_memory(options);
  for (const ObstacleOptions& o : all)
    obstacles_.push_back(make_obstacle<B>(o, watch, memory_, obstacles(), longest));
  choose_held(surface.held);
  make_laws(options, surface);
  choose_whole(options.whole_surface, surface.surface);
  if (couples()) connect(surface.surface);
  if (!pairs) return;
  limits_ = {static_cast<Real>(pair_reach * surface.edge),
             static_cast<Real>(pair_margin * surface.edge), static_cast<Real>(surface.edge),
             options.bodies, options.self};
}

/// Makes the memory: | tools with mass | grasped points | attached points that are torn |
template <class B>
void Contact<B>::make_memory(const ContactOptions& options) {
  const auto& all = options.obstacles;
  const bool tools = std::ranges::any_of(all, [](const auto& o) { return o.mass.has_value(); });
  const bool tear = std::ranges::any_of(options.attachments,
                                        [](const auto& a) { return a.strength.has_value(); });
  if (tools) grasps_.first = ObstacleMotion<B>::numbers * static_cast<int>(all.size());
  if (std::ranges::any_of(all, [](const auto& o) { return o.grasp.has_value(); }))
    grasps_.places = static_cast<int>(all.size()) * points_;
  attached_.first = grasps_.at(grasps_.places);
  std::vector<double> start(static_cast<std::size_t>(attached_.first + (tear ? points_ : 0)), 0.0);
  for (std::size_t o = 0; tools && o < all.size(); ++o) {
    const Point turned = all[o].turn ? all[o].turn->rotation : Point(Point::Zero());
    const double half = turned.norm() / 2;
    double* const attitude = &start[o * ObstacleMotion<B>::numbers + ObstacleMotion<B>::attitude];
    attitude[0] = std::cos(half);
    for (int k = 0; k < 3; ++k)
      attitude[1 + k] = half > 0 ? std::sin(half) / (2 * half) * turned[k] : 0;
  }
  if (start.empty()) return;
  grasps_.memory = memory_ = to_device<Doubles<B>>("contact.memory", start);
  if (tear) attached_.memory = memory_;
}

template <class B>
void Contact<B>::choose_held(const std::vector<std::vector<int>>& chosen) {
  if (std::ranges::all_of(chosen, [](const auto& points) { return points.empty(); })) return;
  std::vector<int> left_out(static_cast<std::size_t>(grasps_.places), 0);
  auto own = left_out.begin();
  for (const auto& points : chosen) {
    if (!points.empty()) std::fill(own, own + points_, 1);
    for (const int p : points) own[p] = 0;
    own += points_;
  }
  grasps_.left_out = to_device<Indices<B>>("contact.left_out", left_out);
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

/// Makes the laws of obstacles and bodies, of grasped points, of pairs of bodies, of attachments.
/// The stiffness of a law is a multiple of E A / h: the layer of elements under the surface, of
/// thickness h, with an area A for each point. For a pair of bodies the two layers are in series,
/// with the smaller area.
template <class B>
void Contact<B>::make_laws(const ContactOptions& options, const TouchingSurface& of) {
  struct Layer {
    double area, edge, modulus, density;
  };
  std::vector<double> area(of.parts.size(), 0), points(of.parts.size(), 0);
  const auto part = [&](int p) {
    return of.body.empty() ? 0u : static_cast<std::size_t>(of.body[static_cast<std::size_t>(p)]);
  };
  for (int p = 0; p < points_; ++p) ++points[part(p)];
  for (const auto& t : of.surface.triangles) {
    const auto x = [&](std::size_t c) {
      return of.surface.vertices[static_cast<std::size_t>(t[c])];
    };
    area[part(t[0])] += 0.5 * (x(1) - x(0)).cross(x(2) - x(0)).norm();
  }
  std::vector<Layer> layers;
  for (std::size_t b = 0; b < of.parts.size(); ++b)
    layers.push_back({area[b] / std::max(points[b], 1.0), of.parts[b].edge,
                      stiffness_at_rest(*of.parts[b].material), of.parts[b].material->density});
  const double scale = stiffening * options.stiffness_scale;
  // damping of ratio 0.5: 2 * 0.5 sqrt(k m)
  const auto critical = [](double k, double mass) { return std::sqrt(k * mass); };
  const auto law = [&](double k, double mass, const std::optional<double>& friction) {
    ContactLaw<Real> made;
    made.stiffness = static_cast<Real>(k);
    made.damping = static_cast<Real>(options.damping_scale * critical(k, mass));
    if (friction) {
      made.shear_stiffness = static_cast<Real>(options.friction_stiffness_scale * k);
      made.shear_damping = static_cast<Real>(options.tangential_damping_scale *
                                             critical(options.friction_stiffness_scale * k, mass));
      made.friction = static_cast<Real>(*friction);
    }
    return made;
  };
  const auto tie = [&](ContactLaw<Real> made, const std::optional<double>& k,
                       const std::optional<double>& strength) {
    if (k) made.damping *= static_cast<Real>(std::sqrt(*k / static_cast<double>(made.stiffness)));
    if (k) made.stiffness = static_cast<Real>(*k);
    made.strength = strength ? static_cast<Real>(*strength) : std::numeric_limits<Real>::infinity();
    return made;
  };
  std::vector<ContactLaw<Real>> laws;
  const auto of_layer = [&](const Layer& l, const std::optional<double>& friction) {
    return law(scale * l.modulus * l.area / l.edge, l.density * l.area * l.edge, friction);
  };
  for (const ObstacleOptions& o : options.obstacles)
    for (const Layer& l : layers) laws.push_back(of_layer(l, o.friction));
  grasps_.first_law = static_cast<int>(laws.size());
  for (const ObstacleOptions& o : options.obstacles)
    for (const Layer& l : layers)
      laws.push_back(o.grasp ? tie(of_layer(l, {}), o.grasp->stiffness, o.grasp->strength)
                             : of_layer(l, {}));
  const std::size_t first_pair = laws.size();
  for (const Layer& a : layers)
    for (const Layer& b : layers) {
      const double least = std::min(a.area, b.area),
                   k = scale * least / (a.edge / a.modulus + b.edge / b.modulus);
      laws.push_back(
          law(k, least * std::min(a.density * a.edge, b.density * b.edge), options.friction));
    }
  attached_.first_law = static_cast<int>(laws.size());
  for (std::size_t a = 0; a < options.attachments.size(); ++a) {
    const auto one =
        std::ranges::find(of.attached, static_cast<int>(a), &AttachedPoint::attachment);
    const auto [own, other] =
        one == of.attached.end()
            ? std::pair<std::size_t, std::size_t>{0, 0}
            : std::pair{static_cast<std::size_t>(part(one->point)),
                        static_cast<std::size_t>(part(
                            of.surface.triangles[static_cast<std::size_t>(one->triangle)][0]))};
    const AttachmentOptions& its = options.attachments[a];
    laws.push_back(
        tie(laws[first_pair + own * layers.size() + other], its.stiffness, its.strength));
  }
  const Layer& first = layers.front();
  stiffness_ = scale * first.modulus * first.area / first.edge;
  damping_ = options.damping_scale * critical(stiffness_, first.density * first.area * first.edge);
  body_ = of.body;
  laws_ = to_device<decltype(laws_)>("contact.laws", laws);
  if (attached_count_ > 0) attach(of);
}

template <class B>
void Contact<B>::attach(const TouchingSurface& of) {
  const auto n = static_cast<std::size_t>(points_);
  std::vector<int> attachment(n, Attachments<B>::none), triangle(n, -1);
  std::vector<std::array<Real, 3>> weight(n);
  for (const AttachedPoint& one : of.attached) {
    const auto p = static_cast<std::size_t>(one.point);
    attachment[p] = one.attachment, triangle[p] = one.triangle;
    for (std::size_t c = 0; c < 3; ++c) weight[p][c] = static_cast<Real>(one.weight[c]);
  }
  for (const AttachedPoint& one : of.attached)
    for (const int corner : of.surface.triangles[static_cast<std::size_t>(one.triangle)])
      if (int& number = attachment[static_cast<std::size_t>(corner)]; number < 0)
        number = Attachments<B>::beside - one.point;
  attached_.attachment = to_device<Indices<B>>("contact.attachment", attachment);
  attached_.triangle = to_device<Indices<B>>("contact.attached_to", triangle);
  attached_.weight = to_device<Vectors<B>>("contact.attached_weight", weight);
}

/// Copies the triangles and the triangles around each point to the device.
/// Pairs and obstacles that touch between points need them.
template <class B>
void Contact<B>::connect(const TriangleSurface& surface) {
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
  mesh_.triangles = static_cast<int>(surface.triangles.size());
  mesh_.corner = to_device<Indices<B>>("contact.corner", corner);
  mesh_.first = to_device<Indices<B>>("contact.first", first);
  mesh_.triangle = to_device<Indices<B>>("contact.triangle", triangle);
  if (pairs_) connect_edges(surface);
}

/// Copies the edges to the device, sorted by their ends; the end with the lower number is first.
template <class B>
void Contact<B>::connect_edges(const TriangleSurface& surface) {
  struct Edge {
    // third corners of the triangles left and right of the way from its first end to the second
    std::array<int, 2> opposite{-1, -1};
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
  mesh_.edge = to_device<Indices<B>>("contact.edge", edge);
  mesh_.first_edge = to_device<Indices<B>>("contact.first_edge", first);
  mesh_.side = to_device<Indices<B>>("contact.side", side);
}

/// Returns the body of each point that the level has.
template <class B>
Indices<B> Contact<B>::bodies_of(const EmbeddedSurface<B>& surface) const {
  if (body_.empty()) return {};
  if (surface.number.extent(0) == 0) return to_device<Indices<B>>("contact.body", body_);
  std::vector<int> body;
  for (const int p : host_values(Exec(), surface.number))
    body.push_back(body_[static_cast<std::size_t>(p)]);
  return to_device<Indices<B>>("contact.body", body);
}

template <class B>
ContactRecords<B> Contact<B>::make_records(const EmbeddedSurface<B>& surface, int vertices,
                                           bool implicit) const {
  ContactRecords<B> records;
  records.points = surface.points, records.obstacles = obstacles(), records.bodies = bodies_,
  records.pairs = pairs_;
  records.faces = whole() > 0 ? mesh_.triangles : 0;
  records.reach = records.edge = static_cast<Real>(reach_);
  records.law = laws_, records.body = bodies_of(surface), records.counted = surface.counted;
  records.mesh = mesh_, records.grasps = grasps_, records.attached = attached_;
  const auto slots = static_cast<std::size_t>(records.slots());
  const auto vectors = [&](const char* name) { return zeros<Vectors<B>>(name, slots); };
  const auto list = [](const char* name, int most) {
    return DeviceList<B>{zeros<Indices<B>>(name, static_cast<std::size_t>(most)),
                         zeros<Doubles<B>>("plica::contact.count", 1), most};
  };
  records.list = list("plica::contact.list", records.slots());
  records.touching = zeros<Doubles<B>>("plica::contact.touching", 1);
  records.near = zeros<Indices<B>>("plica::contact.near", slots);
  records.close = zeros<Indices<B>>("plica::contact.close", 1);
  records.places =
      zeros<Vectors<B>>("plica::contact.places", static_cast<std::size_t>(surface.points));
  records.fastest = zeros<Doubles<B>>("plica::contact.fastest", 1);
  records.point = unset<typename ContactRecords<B>::Stencil>("plica::contact.point", slots);
  fill(Exec(), records.point, -1);
  records.weight = zeros<typename ContactRecords<B>::Weights>("plica::contact.weight", slots);
  records.law_of = zeros<Indices<B>>("plica::contact.law_of", slots);
  records.normal = vectors("plica::contact.normal"), records.way = vectors("plica::contact.way");
  records.stretch = vectors("plica::contact.stretch"),
  records.force = vectors("plica::contact.force");
  records.drift = vectors("plica::contact.drift");
  records.depth =
      to_device<Scalars<B>>("contact.depth", std::vector<Real>(slots, -records.nowhere()));
  if (implicit) {
    records.cap = zeros<Scalars<B>>("plica::contact.cap", slots);
    records.block = zeros<Blocks<B>>("plica::contact.block", slots);
    if (!std::ranges::all_of(obstacles_, [](const auto& obstacle) { return obstacle->convex(); }))
      records.concavity = zeros<Blocks<B>>("plica::contact.concavity", slots);
  }
  records.response = zeros<Scalars<B>>("plica::contact.response", slots);
  if (pairs_)
    records.partner = to_device<Indices<B>>(
        "contact.partner", std::vector<int>(static_cast<std::size_t>(surface.points), -1));
  // a record has at most as many entries as its points have vertices of weight other than 0
  std::vector<int> place(static_cast<std::size_t>(vertices), -1);
  const auto touched = host_values(Exec(), surface.vertex);
  for (std::size_t i = 0; i < touched.size(); ++i)
    place[static_cast<std::size_t>(touched[i])] = static_cast<int>(i);
  std::size_t of_points = 0;
  std::size_t most = 0;
  const auto weights = host_values(Exec(), surface.embedding.weight);
  for (std::size_t p = 0; p < static_cast<std::size_t>(surface.points); ++p) {
    std::size_t own = 0;
    for (std::size_t c = 0; c < 4; ++c) own += weights[4 * p + c] != 0;
    of_points += own, most = std::max(most, own);
  }
  const std::size_t entries =
      static_cast<std::size_t>(records.obstacles) *
          (of_points + 3 * most * static_cast<std::size_t>(records.faces)) +
      (pairs_ ? 2 * 4 * most * static_cast<std::size_t>(surface.points) : 0);
  ContactTranspose<B>& W = records.transpose;
  W.vertices = list("plica::contact.vertices", surface.touched);
  W.place = to_device<Indices<B>>("contact.place", place);
  const auto n = static_cast<std::size_t>(surface.touched);
  W.filled = zeros<Indices<B>>("plica::contact.filled", n);
  W.first = zeros<Indices<B>>("plica::contact.first", n),
  W.last = zeros<Indices<B>>("plica::contact.last", n);
  W.record = zeros<Indices<B>>("plica::contact.record", entries);
  W.weight = zeros<Scalars<B>>("plica::contact.entry", entries);
  return records;
}

template <class B>
void Contact<B>::find(const Exec& exec, const LevelData<B>& level, const State<B>& s, double time,
                      const ContactRecords<B>& records) const {
  for (std::size_t o = 0; o < obstacles_.size(); ++o)
    obstacles_[o]->find(exec, level.surface, s, time, static_cast<int>(o), whole_[o], records);
}

template <class B>
void Contact<B>::move_tools(const Exec& exec, const Doubles<B>& wrench, double end,
                            double span) const {
  for (int o = 0; o < obstacles(); ++o)
    obstacles_[static_cast<std::size_t>(o)]->move(exec, wrench, o, end, span);
}

template <class B>
void Contact<B>::grasp(const Exec& exec, const LevelData<B>& level, double time, int obstacle,
                       const ContactRecords<B>& records) const {
  // a point that touches is held, on whichever side rounding puts it
  const double reach = grasp_reach(*grasp_options(obstacle)) + same_place(deepest_);
  obstacles_[static_cast<std::size_t>(obstacle)]->grasp(exec, level.surface, level.state, time,
                                                        obstacle, reach, records);
}

template <class B>
void Contact<B>::release(const Exec& exec, int obstacle) const {
  update_vertices<B>(exec, "plica::contact_release", points_,
                     LetGo<B>{grasps_, obstacle * points_});
}

template <class B>
void Contact<B>::take_memory(const Exec& exec, const Contact& before,
                             const std::vector<int>& former) const {
  if (memory_.extent(0) == 0) return;
  const std::vector<double> old = host_values(exec, before.memory_);
  std::vector<double> now = host_values(exec, memory_);
  std::copy_n(old.begin(), grasps_.first, now.begin());
  for (int o = 0; grasps_.places > 0 && o < obstacles(); ++o)
    for (int p = 0; p < points_; ++p) {
      const int from =
          p < before.points_ ? p : former[static_cast<std::size_t>(p - before.points_)];
      if (from >= 0)
        std::copy_n(old.begin() + before.grasps_.at(o * before.points_ + from), Grasps<B>::numbers,
                    now.begin() + grasps_.at(o * points_ + p));
    }
  copy(exec, memory_, to_device<Doubles<B>>("contact.taken", now));
}

template <class B>
std::vector<int> Contact<B>::held_by(const Exec& exec, int obstacle) const {
  const std::vector<double> all = host_values(exec, memory_);
  std::vector<int> held;
  for (int p = 0; p < points_; ++p)
    if (all[static_cast<std::size_t>(grasps_.at(obstacle * points_ + p) + 3)] > 0)
      held.push_back(p);
  return held;
}

template <class B>
int Contact<B>::torn(const Exec& exec) const {
  const std::vector<double> all = host_values(exec, attached_.memory);
  return all.empty()
             ? 0
             : static_cast<int>(std::ranges::count(all.begin() + attached_.first, all.end(), 1.0));
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
