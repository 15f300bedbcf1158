// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <numeric>
#include <plica/core/error.hpp>
#include <plica/drivers/body/selection.hpp>
#include <plica/drivers/elastic/fibres.hpp>
#include <plica/drivers/elastic/materials.hpp>
#include <plica/drivers/run/compose_levels.hpp>
#include <plica/drivers/run/join_bodies.hpp>

namespace plica {

namespace {

using NamedBody = std::pair<std::string, Body>;

std::string to_text(const std::string& value) { return value; }
std::string to_text(double value) { return std::to_string(value); }
std::string to_text(const std::vector<std::string>& values) {
  return std::accumulate(values.begin(), values.end(), std::string(),
                         [](const std::string& all, const std::string& one) {
                           return all.empty() ? one : all + ", " + one;
                         });
}
std::string to_text(const std::optional<bool>& value) {
  return !value ? "left out" : *value ? "true" : "false";
}
std::string to_text(const std::optional<std::string>& value) { return value.value_or("left out"); }

/// Throws InputError where two bodies differ in options that a simulation has once.
void expect_alike(const NamedBody& first, const NamedBody& other) {
  const auto same = [&](const char* key, const auto& a, const auto& b) {
    if (a != b)
      throw InputError("bodies." + other.first + "." + key + " is " + to_text(b) + ", of bodies." +
                       first.first + " " + to_text(a) +
                       "; bodies can differ in the values of a law, expected the same " + key);
  };
  const Body &a = first.second, &b = other.second;
  same("element", a.element, b.element);
  same("stabilisation", a.stabilisation, b.stabilisation);
  same("volumetric_smoothing", a.pressure, b.pressure);
  same("material.model", a.material.model, b.material.model);
  same("material.volume", a.material.volume, b.material.volume);
  same("material.convention", a.material.convention, b.material.convention);
  same("material.allow_inversion", a.material.allow_inversion, b.material.allow_inversion);
}

void expect_joinable(const std::vector<NamedBody>& bodies) {
  if (bodies.empty()) throw InputError("bodies: expected at least one");
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const auto& [name, body] = bodies[i];
    const std::string path = "bodies." + name;
    if (name.empty() || name.find_first_of("/,\"\n\r") != std::string::npos)
      throw InputError(path +
                       ": expected a name without slash, comma, quotation mark or line break");
    if (std::any_of(bodies.begin(), bodies.begin() + static_cast<std::ptrdiff_t>(i),
                    [&](const NamedBody& other) { return other.first == name; }))
      throw InputError(path + ": two bodies have this name");
    if (body.levels.empty())
      throw InputError(path + ".levels is empty; expected at least one mesh, finest first");
    const InitialOptions& start = body.initial;
    for (const auto& [key, given] : {std::pair{"twist", start.twist.has_value()},
                                     std::pair{"stretch", start.stretch != Point::Ones()},
                                     std::pair{"random", start.random.has_value()}})
      if (given)
        throw InputError(path + ".initial." + key +
                         ": one of several bodies starts in its shape; leave it out");
    expect_alike(bodies.front(), bodies[i]);
  }
}

/// Returns the options of a region of a body with all values given: its own, else the body's.
RegionOptions made_of(const Body& body, const RegionOptions& own, const Point& shift) {
  const MaterialInfo& law = *find_material(body.material.model);
  const auto takes = [&](const MaterialParameter& p) {
    return std::any_of(
        law.parameters.begin(), law.parameters.end(),
        [&](const MaterialParameter& other) { return std::string_view(other.name) == p.name; });
  };
  RegionOptions all = own;
  all.where.reset();
  if (takes(parameter::young_modulus))
    all.young_modulus = own.young_modulus.value_or(body.material.young_modulus);
  if (takes(parameter::poisson_ratio))
    all.poisson_ratio = own.poisson_ratio.value_or(body.material.poisson_ratio);
  all.density = own.density.value_or(body.material.density);
  all.damping.mass = own.damping.mass.value_or(body.damping.mass);
  all.damping.stiffness = own.damping.stiffness.value_or(body.damping.stiffness);
  all.parameters.insert(body.material.parameters.begin(), body.material.parameters.end());
  if (own.terms.empty()) all.terms = body.material.terms;
  if (own.prony.empty()) all.prony = body.material.prony;
  if (!own.fibres) all.fibres = body.material.fibres;
  if (all.fibres && all.fibres->around) all.fibres->around->point += shift;
  return all;
}

/// Joins bodies to one.
class Joiner {
 public:
  explicit Joiner(const std::vector<NamedBody>& bodies) {
    std::size_t levels = 0;
    for (const auto& [name, body] : bodies) levels = std::max(levels, body.levels.size());
    const Body& first = bodies.front().second;
    all_.levels.resize(levels);
    all_.element = first.element, all_.stabilisation = first.stabilisation,
    all_.pressure = first.pressure;
    all_.material = first.material, all_.material.prony.clear();  // each part has its own
    for (const NamedBody& one : bodies) add(one.first, one.second);
  }
  Body take() {
    all_.coarsen = points_of_all();
    return std::move(all_);
  }

 private:
  Body all_;

  /// Returns the numbers of points of coarse spaces, for methods that make spaces of all bodies
  /// together. They are the sums of what each body asks for, the coarsest with the coarsest. The
  /// list is empty where a body gives no numbers: as many as it takes. None where no body asks for
  /// spaces.
  std::optional<std::vector<int>> points_of_all() const {
    std::vector<int> sums;
    bool asked = false, numbers = true;
    for (const BodyPart& part : all_.parts) {
      asked = asked || part.coarsen, numbers = numbers && part.coarsen && !part.coarsen->empty();
      if (!numbers) continue;
      sums.resize(std::max(sums.size(), part.coarsen->size()), 0);
    }
    if (!asked) return {};
    if (!numbers) return std::vector<int>{};
    for (const BodyPart& part : all_.parts)
      for (std::size_t i = 1; i <= sums.size(); ++i) {
        const std::vector<int>& own = *part.coarsen;
        sums[sums.size() - i] += i <= own.size() ? own[own.size() - i] : own.front();
      }
    return sums;
  }

  void add(const std::string& name, Body body) {
    flows_to_fields(body, "fibres of " + name);
    fields_to_levels(body);
    const Box box = bounding_box(body.levels.front().vertices);
    const Point middle = 0.5 * (box.min + box.max),
                shift = body.initial.position.value_or(middle) - middle;
    for (std::size_t level = 0; level < all_.levels.size(); ++level) {
      TetMesh mesh = body.levels[std::min(level, body.levels.size() - 1)];
      add_regions(mesh, body.regions, static_cast<int>(level));
      add_selections(name, body, mesh, static_cast<int>(level));
      add_mesh(name, mesh, shift, all_.levels[level]);
    }
    for (const auto& [region, own] : body.regions)
      all_.regions[name + "/" + region] = made_of(body, own, shift);
    // regions of the mesh that the body has no options for
    for (const std::string& region : all_.levels.front().region_names)
      if (region == name || region.starts_with(name + "/"))
        all_.regions.try_emplace(region, made_of(body, {}, shift));
    keep_selections(name, body);
    const int points = body.surface ? static_cast<int>(body.surface->vertices.size()) : 0;
    if (body.surface) add_surface(*body.surface, shift);
    all_.parts.push_back({name, body.material, points, body.coarsen});
  }

  /// Appends the values of `count` elements to those of the elements `before` them. Where values
  /// are missing, they are `none`.
  template <class Value>
  static void append(std::vector<Value>& all, std::size_t before, const std::vector<Value>& more,
                     std::size_t count, const Value& none) {
    all.resize(before, none);
    all.insert(all.end(), more.begin(), more.end());
    all.resize(before + count, none);
  }

  /// Adds what a mesh has at borders between its pieces. Its first vertex becomes number `first`.
  static void add_followers(const TetMesh& mesh, int first, TetMesh& to) {
    const auto moved = [first](auto vertices) {
      for (int& v : vertices) v += first;
      return vertices;
    };
    for (const int v : mesh.followers.vertex) to.followers.vertex.push_back(v + first);
    for (const auto& masters : mesh.followers.of) to.followers.of.push_back(moved(masters));
    to.followers.weight.insert(to.followers.weight.end(), mesh.followers.weight.begin(),
                               mesh.followers.weight.end());
    for (const auto& face : mesh.inner_faces) to.inner_faces.push_back(moved(face));
    for (const auto& face : mesh.opened) to.opened.push_back(moved(face));
  }

  static void add_mesh(const std::string& name, const TetMesh& mesh, const Point& shift,
                       TetMesh& to) {
    const std::size_t before = to.tets.size(), count = mesh.tets.size();
    if (!to.filled.empty() || !mesh.filled.empty())
      append(to.filled, before, mesh.filled, count, 1.0);
    if (!to.piece.empty() || !mesh.piece.empty()) append(to.piece, before, mesh.piece, count, 0);
    to.covered.resize(std::max(to.covered.size(), mesh.covered.size()));
    for (std::size_t i = 0; i < mesh.covered.size(); ++i)
      to.covered[i].dropped += mesh.covered[i].dropped,
          to.covered[i].volume += mesh.covered[i].volume;
    for (const auto& [field, vectors] : mesh.tet_vectors) to.tet_vectors.try_emplace(field);
    for (auto& [field, all] : to.tet_vectors) {
      const auto own = mesh.tet_vectors.find(field);
      append(all, before, own == mesh.tet_vectors.end() ? std::vector<Point>{} : own->second, count,
             Point(0, 0, 0));
    }
    const int vertices = static_cast<int>(to.vertices.size()),
              regions = static_cast<int>(to.region_names.size());
    for (const Point& x : mesh.vertices) to.vertices.emplace_back(x + shift);
    for (auto tet : mesh.tets) {
      for (int& v : tet) v += vertices;
      to.tets.push_back(tet);
    }
    if (mesh.region.empty()) {
      to.region_names.push_back(name);
      to.region.insert(to.region.end(), mesh.tets.size(), regions);
    } else {
      for (const std::string& region : mesh.region_names)
        to.region_names.push_back(region.empty() ? name : name + "/" + region);
      for (const int region : mesh.region) to.region.push_back(region + regions);
    }
    add_followers(mesh, vertices, to);
    for (const auto& [set, of] : mesh.vertex_sets) {
      std::vector<int>& moved = to.vertex_sets[set];
      for (const int v : of) moved.push_back(v + vertices);
    }
    for (const auto& [set, of] : mesh.triangle_sets)
      for (auto triangle : of) {
        for (int& v : triangle) v += vertices;
        to.triangle_sets[set].push_back(triangle);
      }
  }

  /// Replaces the mesh's sets of vertices and triangles by those of the joined body.
  static void add_selections(const std::string& name, const Body& body, TetMesh& mesh, int level) {
    std::map<std::string, std::vector<int>> sets;
    for (const auto& [set, vertices] : mesh.vertex_sets) sets[name + "/" + set] = vertices;
    std::vector<int>& everything = sets[name];
    everything.resize(mesh.vertices.size());
    std::iota(everything.begin(), everything.end(), 0);
    const auto add = [&](const std::string& key, std::size_t i, const Selection& where) {
      const std::string path = key + "." + std::to_string(i);
      sets[name + "/" + path] =
          select_vertices(mesh, where, {"bodies." + name + "." + path, level});
    };
    for (std::size_t i = 0; i < body.fixed.size(); ++i) add("fixed", i, body.fixed[i].where);
    for (std::size_t i = 0; i < body.prescribed.size(); ++i)
      add("prescribed", i, body.prescribed[i].where);
    for (std::size_t i = 0; i < body.loads.size(); ++i) add("loads", i, body.loads[i].where);
    if (level == 0)
      for (std::size_t i = 0; i < body.initial.parts.size(); ++i)
        add("initial.parts", i, body.initial.parts[i].where);
    mesh.vertex_sets = std::move(sets);
    std::map<std::string, std::vector<std::array<int, 3>>> triangles;
    for (const auto& [set, of] : mesh.triangle_sets) triangles[name + "/" + set] = of;
    for (std::size_t i = 0; i < body.loads.size(); ++i)
      if (const auto* group = std::get_if<GroupSelection>(&body.loads[i].where))
        if (const auto of = mesh.triangle_sets.find(group->name); of != mesh.triangle_sets.end())
          triangles[name + "/loads." + std::to_string(i)] = of->second;
    mesh.triangle_sets = std::move(triangles);
  }

  void keep_selections(const std::string& name, const Body& body) {
    const auto set = [&](const std::string& key, std::size_t i) -> Selection {
      return GroupSelection{name + "/" + key + "." + std::to_string(i)};
    };
    for (std::size_t i = 0; i < body.fixed.size(); ++i) {
      all_.fixed.push_back(body.fixed[i]);
      all_.fixed.back().where = set("fixed", i);
    }
    for (std::size_t i = 0; i < body.prescribed.size(); ++i) {
      all_.prescribed.push_back(body.prescribed[i]);
      all_.prescribed.back().where = set("prescribed", i);
    }
    for (std::size_t i = 0; i < body.loads.size(); ++i)
      all_.loads.push_back({set("loads", i), body.loads[i].load, body.loads[i].course});
    const InitialOptions& start = body.initial;
    if (!start.velocity.isZero(0) || !start.angular_velocity.isZero(0))
      all_.initial.parts.push_back({GroupSelection{name}, start.velocity, start.angular_velocity});
    for (std::size_t i = 0; i < start.parts.size(); ++i)
      all_.initial.parts.push_back(
          {set("initial.parts", i), start.parts[i].velocity, start.parts[i].angular_velocity});
  }

  void add_surface(const TriangleSurface& surface, const Point& shift) {
    if (!all_.surface) all_.surface.emplace();
    const int points = static_cast<int>(all_.surface->vertices.size());
    for (const Point& x : surface.vertices) all_.surface->vertices.emplace_back(x + shift);
    for (auto t : surface.triangles) {
      for (int& p : t) p += points;
      all_.surface->triangles.push_back(t);
    }
    std::vector<CornerTexture>& texture = all_.surface->texture;
    if (texture.empty() && surface.texture.empty()) return;
    texture.resize(all_.surface->triangles.size());  // 0 for bodies without
    std::ranges::copy(surface.texture,
                      texture.end() - static_cast<std::ptrdiff_t>(surface.texture.size()));
  }
};

}  // namespace

Body join_bodies(const std::vector<NamedBody>& bodies) {
  for (const auto& [name, body] : bodies)
    if (body.following || std::ranges::any_of(body.covers, [](const auto& cover) {
          return cover.second.follows.has_value();
        }))
      throw InputError("bodies." + name +
                       ".levels.0.refine.follows: of several bodies none has a part that follows "
                       "an obstacle; expected a choice that stays, such as sphere");
  if (std::ranges::any_of(bodies,
                          [](const NamedBody& one) { return !one.second.covers.empty(); })) {
    std::vector<NamedBody> composed = bodies;
    for (auto& [name, body] : composed) compose_levels(body);
    return join_bodies(composed);
  }
  expect_joinable(bodies);
  return Joiner(bodies).take();
}

}  // namespace plica
