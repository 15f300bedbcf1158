// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/core/error.hpp>
#include <plica/core/text.hpp>
#include <plica/drivers/body/selection.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/composite.hpp>
#include <utility>

namespace plica {

namespace {

std::string coordinates(const Point& p) {
  return text("[", number(p[0]), ", ", number(p[1]), ", ", number(p[2]), "]");
}

/// Chooses among points: the vertices, or the elements' centroids.
struct Among {
  const std::vector<Point>& points;
  double slack;  // tolerance [m]: a face is chosen by its own coordinates

  template <class Inside>
  std::vector<int> where(const Inside& inside) const {
    std::vector<int> chosen;
    for (std::size_t i = 0; i < points.size(); ++i)
      if (inside(points[i])) chosen.push_back(static_cast<int>(i));
    return chosen;
  }
  std::vector<int> operator()(const Box& box) const {
    return where([&](const Point& p) {
      return (p.array() >= box.min.array() - slack).all() &&
             (p.array() <= box.max.array() + slack).all();
    });
  }
  std::vector<int> operator()(const BallSelection& ball) const {
    return where([&](const Point& p) { return (p - ball.centre).norm() <= ball.radius + slack; });
  }
  std::vector<int> operator()(const HalfSpaceSelection& half) const {
    const Point normal = half.normal.normalized();
    return where([&](const Point& p) { return normal.dot(p - half.point) <= slack; });
  }
  std::vector<int> operator()(const NearestSelection& nearest) const {
    const auto nearer = [&](const Point& a, const Point& b) {
      return (a - nearest.to).squaredNorm() < (b - nearest.to).squaredNorm();
    };
    const Point found = *std::min_element(points.begin(), points.end(), nearer);
    return where([&](const Point& p) { return p == found; });  // cuts leave several at one place
  }
  template <class Named>
  std::vector<int> operator()(const Named&) const {
    return {};
  }
};

std::string described(const Selection& selection) {
  if (const auto* box = std::get_if<Box>(&selection))
    return "the box from " + coordinates(box->min) + " to " + coordinates(box->max) + " m";
  if (const auto* ball = std::get_if<BallSelection>(&selection))
    return "the sphere of radius " + number(ball->radius) + " m at " + coordinates(ball->centre) +
           " m";
  const auto& half = std::get<HalfSpaceSelection>(selection);
  return "the plane at " + coordinates(half.point) + " m with normal " + coordinates(half.normal);
}

/// Returns the points that a selection chooses. For messages, `what` names a point, `all` is the
/// box that the points reach over, and `when` says when they do.
std::vector<int> select(const std::vector<Point>& points, const Selection& selection,
                        const std::string& option, const std::string& what, const Box& all,
                        const std::string& when) {
  const auto chosen = std::visit(Among{points, same_place(all)}, selection);
  if (chosen.empty())
    throw InputError(option + ": " + described(selection) + " selects no " + what +
                     ", which reaches from " + coordinates(all.min) + " to " +
                     coordinates(all.max) + " m " + when);
  return chosen;
}

std::vector<int> select(const TetMesh& mesh, const std::vector<Point>& points,
                        const Selection& selection, const Selecting& who, const std::string& what) {
  return select(points, selection, who.option, what + " on level " + std::to_string(who.level),
                bounding_box(mesh.vertices), "at rest");
}

const std::string* name_in(const Selection& selection) {
  if (const auto* group = std::get_if<GroupSelection>(&selection)) return &group->name;
  const auto* region = std::get_if<RegionSelection>(&selection);
  return region ? &region->name : nullptr;
}

/// Returns the number of the region of that name. With `sets`, the message about an unknown name
/// lists the mesh's vertex sets too.
int region_named(const TetMesh& mesh, const std::string& name, const Selecting& who, bool sets) {
  const auto region = std::find(mesh.region_names.begin(), mesh.region_names.end(), name);
  if (region != mesh.region_names.end() && !name.empty())
    return static_cast<int>(region - mesh.region_names.begin());
  std::vector<std::string> choices;
  for (const std::string& other : mesh.region_names)
    if (!other.empty()) choices.push_back(other);
  for (const auto& [set, unused] : mesh.vertex_sets)
    if (sets) choices.push_back(set);
  throw InputError(
      who.option + ": " +
      unknown_name((sets ? "group on level " : "region on level ") + std::to_string(who.level),
                   name, choices));
}

std::vector<int> elements_of(const TetMesh& mesh, int region) {
  std::vector<int> chosen;
  for (std::size_t e = 0; e < mesh.tets.size(); ++e)
    if (mesh.region[e] == region) chosen.push_back(static_cast<int>(e));
  return chosen;
}

std::vector<int> vertices_of(const TetMesh& mesh, int region) {
  std::vector<char> in(mesh.vertices.size(), 0);
  for (int e : elements_of(mesh, region))
    for (int v : mesh.tets[static_cast<std::size_t>(e)]) in[static_cast<std::size_t>(v)] = 1;
  std::vector<int> chosen;
  for (std::size_t v = 0; v < in.size(); ++v)
    if (in[v]) chosen.push_back(static_cast<int>(v));
  return chosen;
}

std::vector<int> named_vertices(const TetMesh& mesh, const std::string& name, bool group,
                                const Selecting& who) {
  const auto set = mesh.vertex_sets.find(name);
  if (group && set != mesh.vertex_sets.end()) return set->second;
  return vertices_of(mesh, region_named(mesh, name, who, group));
}

/// Returns what a selection chooses among all vertices.
std::vector<int> select_all_vertices(const TetMesh& mesh, const Selection& selection,
                                     const Selecting& who) {
  if (const std::string* name = name_in(selection))
    return named_vertices(mesh, *name, std::holds_alternative<GroupSelection>(selection), who);
  return select(mesh, mesh.vertices, selection, who, "vertex");
}

/// Returns what a selection chooses among the vertices that follow no others.
std::vector<int> select_free_vertices(const TetMesh& mesh, const Selection& selection,
                                      const Selecting& who) {
  const std::vector<char> follows = follows_others(mesh);
  if (const std::string* name = name_in(selection)) {
    const bool group = std::holds_alternative<GroupSelection>(selection);
    std::vector<int> chosen = named_vertices(mesh, *name, group, who);
    std::erase_if(chosen, [&](int v) { return follows[static_cast<std::size_t>(v)] != 0; });
    if (chosen.empty())
      throw InputError(who.option + ": all vertices of '" + *name + "' on level " +
                       std::to_string(who.level) +
                       " are at the border of a part, where they follow the coarser mesh; expected "
                       "others");
    return chosen;
  }
  std::vector<Point> places;
  std::vector<int> number;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    if (follows[v] == 0) places.push_back(mesh.vertices[v]), number.push_back(static_cast<int>(v));
  std::vector<int> chosen = select(mesh, places, selection, who, "vertex");
  for (int& v : chosen) v = number[static_cast<std::size_t>(v)];
  return chosen;
}

}  // namespace

std::vector<int> select_vertices(const TetMesh& mesh, const Selection& selection,
                                 const Selecting& who) {
  return mesh.followers.vertex.empty() ? select_all_vertices(mesh, selection, who)
                                       : select_free_vertices(mesh, selection, who);
}

void expect_without_name(const Selection& selection, const std::string& option) {
  if (name_in(selection))
    throw InputError(
        option +
        ": a surface has no groups and regions; expected box, sphere, half_space or nearest");
}

std::vector<int> select_points(const std::vector<Point>& points, const Selection& selection,
                               const std::string& option) {
  expect_without_name(selection, option);
  return select(points, selection, option, "point of the surface", bounding_box(points),
                "at the start");
}

std::vector<int> select_elements(const TetMesh& mesh, const Selection& selection,
                                 const Selecting& who) {
  if (const std::string* name = name_in(selection))
    return elements_of(mesh, region_named(mesh, *name, who, false));
  std::vector<Point> centroids;
  for (const auto& t : mesh.tets) {
    Point sum = Point::Zero();
    for (int v : t) sum += mesh.vertices[static_cast<std::size_t>(v)];
    centroids.emplace_back(sum / 4);
  }
  return select(mesh, centroids, selection, who, "element's centroid");
}

namespace {

std::array<int, 3> ascending(std::array<int, 3> triangle) {
  std::sort(triangle.begin(), triangle.end());
  return triangle;
}

/// Returns the boundary triangles that are in a set, whatever their orientation there.
std::vector<std::array<int, 3>> boundary_triangles_of(const TetMesh& mesh,
                                                      std::vector<std::array<int, 3>> set,
                                                      const Selecting& who) {
  for (auto& triangle : set) triangle = ascending(triangle);
  std::sort(set.begin(), set.end());
  std::vector<std::array<int, 3>> chosen;
  for (const auto& t : boundary_triangles(mesh))
    if (std::binary_search(set.begin(), set.end(), ascending(t))) chosen.push_back(t);
  if (chosen.empty())
    throw InputError(who.option + ": the group has " + std::to_string(set.size()) +
                     " triangles on level " + std::to_string(who.level) +
                     ", but none is on the boundary; a traction needs some");
  return chosen;
}

/// Returns the triangles. Throws InputError where one is of a tetrahedron that counts in part, so
/// that not all of the triangle is the body's.
std::vector<std::array<int, 3>> expect_whole(const TetMesh& mesh,
                                             std::vector<std::array<int, 3>> triangles,
                                             const Selecting& who) {
  std::vector<std::array<int, 3>> cut;  // faces of tetrahedra that count in part
  for (std::size_t e = 0; e < mesh.filled.size(); ++e) {
    const auto& t = mesh.tets[e];
    if (mesh.filled[e] < 1)
      for (std::size_t k = 0; k < 4; ++k)
        cut.push_back(ascending({t[k], t[(k + 1) % 4], t[(k + 2) % 4]}));
  }
  std::sort(cut.begin(), cut.end());
  for (const auto& t : triangles)
    if (std::binary_search(cut.begin(), cut.end(), ascending(t)))
      throw InputError(who.option + ": a triangle at " +
                       coordinates(mesh.vertices[static_cast<std::size_t>(t[0])]) +
                       " m is of an element that a finer part cuts on level " +
                       std::to_string(who.level) +
                       "; expected triangles inside the part or away from it, a force, or a part "
                       "whose border lies on faces of the coarser mesh");
  return triangles;
}

}  // namespace

std::vector<std::array<int, 3>> select_triangles(const TetMesh& mesh, const Selection& selection,
                                                 const Selecting& who, OpenedFaces opened) {
  if (!mesh.filled.empty() && mesh.piece.empty())
    throw InputError(who.option + ": level " + std::to_string(who.level) +
                     " is a lattice, whose faces are not the body's; expected a force, contact, or "
                     "a mesh that fits");
  if (const auto* group = std::get_if<GroupSelection>(&selection))
    if (const auto set = mesh.triangle_sets.find(group->name); set != mesh.triangle_sets.end())
      return expect_whole(mesh, boundary_triangles_of(mesh, set->second, who), who);
  const std::vector<int> vertices = select_all_vertices(mesh, selection, who);
  std::vector<char> in(mesh.vertices.size(), 0);
  for (int v : vertices) in[static_cast<std::size_t>(v)] = 1;
  std::vector<std::array<int, 3>> chosen;
  const auto may_be = [&](const std::array<int, 3>& t) {
    return opened == OpenedFaces::included ||
           !std::binary_search(mesh.opened.begin(), mesh.opened.end(), ascending(t));
  };
  for (const auto& t : boundary_triangles(mesh))
    if (std::all_of(t.begin(), t.end(),
                    [&](int v) { return in[static_cast<std::size_t>(v)] != 0; }) &&
        may_be(t))
      chosen.push_back(t);
  if (chosen.empty())
    throw InputError(
        who.option + ": selects " + std::to_string(vertices.size()) + " vertices on level " +
        std::to_string(who.level) +
        ", but no boundary triangle with all three of its vertices; a traction needs some");
  return expect_whole(mesh, std::move(chosen), who);
}

void add_regions(TetMesh& mesh, const std::map<std::string, RegionOptions>& regions, int level) {
  if (std::none_of(regions.begin(), regions.end(),
                   [](const auto& entry) { return entry.second.where.has_value(); }))
    return;
  const TetMesh given = mesh;
  std::vector<const std::string*> owner(mesh.tets.size(), nullptr);
  for (const auto& [name, options] : regions) {
    if (!options.where) continue;
    const std::string option = "body.regions." + name;
    if (std::find(mesh.region_names.begin(), mesh.region_names.end(), name) !=
        mesh.region_names.end())
      throw InputError(option + ".where: the mesh of level " + std::to_string(level) +
                       " has a region of that name; leave `where` out, or choose another name");
    if (mesh.region.empty()) mesh.region.assign(mesh.tets.size(), 0), mesh.region_names = {""};
    const int number = static_cast<int>(mesh.region_names.size());
    mesh.region_names.push_back(name);
    for (int e : select_elements(given, *options.where, {option + ".where", level})) {
      const auto i = static_cast<std::size_t>(e);
      if (owner[i])
        throw InputError(option + ".where: element " + std::to_string(e) + " of level " +
                         std::to_string(level) + " belongs to region '" + *owner[i] +
                         "' as well; regions must not overlap");
      owner[i] = &name;
      mesh.region[i] = number;
    }
  }
}

}  // namespace plica
