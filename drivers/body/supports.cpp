// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <map>
#include <plica/core/error.hpp>
#include <plica/core/text.hpp>
#include <plica/drivers/body/selection.hpp>
#include <plica/drivers/body/supports.hpp>

namespace plica {

namespace {

const std::array<Point, 3> all_axes = {Point(1, 0, 0), Point(0, 1, 0), Point(0, 0, 1)};

/// Directions along which a set holds each of its vertices.
using HeldDirections = std::map<int, std::vector<Point>>;

std::string direction_text(const Point& p) {
  return text("[", number(p[0], 3), ", ", number(p[1], 3), ", ", number(p[2], 3), "]");
}

/// Returns the unit normals of the boundary triangles that are chosen, of each of their vertices:
/// the mean by area.
HeldDirections surface_normals(const TetMesh& mesh, const Selection& where, const Selecting& who) {
  constexpr double least_cosine = 0.76;  // cosine of 40 degrees
  const auto triangles = select_triangles(mesh, where, who);
  std::vector<Point> areas;
  std::map<int, Point> sum;
  for (const auto& t : triangles) {
    const auto x = [&](std::size_t k) -> const Point& {
      return mesh.vertices[static_cast<std::size_t>(t[k])];
    };
    areas.emplace_back((x(1) - x(0)).cross(x(2) - x(0)));
    for (const int v : t) sum.try_emplace(v, Point::Zero()).first->second += areas.back();
  }
  HeldDirections normals;
  for (const auto& [v, area] : sum) normals[v] = {area.normalized()};
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (const int v : triangles[i])
      if (!(normals[v].front().dot(areas[i].normalized()) >= least_cosine))
        throw InputError(text(who.option, ".slide is normal, but vertex ", v, " of level ",
                              who.level,
                              " is at an edge of the surface chosen, where there is none; expected "
                              "an entry for each of its sides"));
  for (const int v : mesh.followers.vertex) normals.erase(v);
  return normals;
}

/// Returns along which directions an entry of body.fixed holds each of its vertices.
HeldDirections held_directions(const FixedVertices& fixed, const TetMesh& mesh,
                               const Selecting& who) {
  if (fixed.slide && fixed.slide->isZero(0)) return surface_normals(mesh, fixed.where, who);
  std::vector<Point> directions(all_axes.begin(), all_axes.end());
  if (fixed.slide) directions = {fixed.slide->normalized()};
  if (!fixed.along.empty()) directions.clear();
  for (const std::string& axis : fixed.along)
    directions.push_back(all_axes[static_cast<std::size_t>(axis.front() - 'x')]);
  HeldDirections held;
  for (const int v : select_vertices(mesh, fixed.where, who)) held[v] = directions;
  return held;
}

/// Returns whether a motion ever leads out of the plane across a unit vector.
bool leaves_plane(const PrescribedMotion& given, const Point& normal) {
  constexpr double rounding = 1e-9;
  const auto leaves = [&](const Point& d) { return std::abs(d.dot(normal)) > rounding * d.norm(); };
  const auto turns_out = [&](const Point& axis) {
    return axis.cross(normal).norm() > rounding * axis.norm();
  };
  if (given.rotate) return turns_out(given.rotate->axis) || turns_out(given.rotate->rotation);
  if (const auto* steady = std::get_if<SteadyMotion>(&given.motion))
    return leaves(steady->velocity);
  if (const auto* sine = std::get_if<SineMotion>(&given.motion)) return leaves(sine->amplitude);
  for (const auto& knot : std::get<PathMotion>(given.motion).knots)
    if (leaves(knot.displacement)) return true;
  return false;
}

Point box_centre_of(const TetMesh& mesh, const std::vector<int>& vertices) {
  std::vector<Point> points;
  for (const int v : vertices) points.push_back(mesh.vertices[static_cast<std::size_t>(v)]);
  const Box box = bounding_box(points);
  return 0.5 * (box.min + box.max);
}

/// Directions that hold one vertex, and the sets that they come from.
class HoldingDirections {
 public:
  /// Adds a unit vector, unless those before hold along it already.
  void add(std::size_t set, const Point& direction) {
    constexpr double least = 0.1;
    Point across = direction;
    for (const Point& one : basis_) across -= one.dot(across) * one;
    if (basis_.size() == 3 || across.norm() <= least) return;
    set_.push_back(set), direction_.push_back(direction), basis_.push_back(across.normalized());
  }
  bool hold_all() const { return basis_.size() == 3; }
  SlidingVertex sliding(int vertex) const {
    SlidingVertex made{vertex};
    for (std::size_t k = 0; k < basis_.size(); ++k) made.normals[k] = basis_[k];
    return made;
  }
  /// Adds the vertex, with their parts of the force on it, to the sets.
  void share_out(int vertex, std::vector<HeldSet>& sets) const {
    Eigen::Matrix3d columns;  // the directions, and what is at right angles to them
    const Point beside =
        basis_.size() > 1 ? Point(basis_[0].cross(basis_[1])) : Point(basis_[0].unitOrthogonal());
    columns << direction_[0], beside, basis_[0].cross(beside);
    if (basis_.size() > 1) columns.col(1) = direction_[1], columns.col(2) = beside;
    if (basis_.size() > 2) columns.col(2) = direction_[2];
    const Eigen::Matrix3d sizes = columns.inverse();  // rows that give the parts of a force
    for (std::size_t k = 0; k < set_.size(); ++k) {
      HeldSet& to = sets[set_[k]];
      if (to.vertex.empty() || to.vertex.back() != vertex)
        to.vertex.push_back(vertex), to.share.emplace_back(Eigen::Matrix3d::Zero());
      to.share.back() += direction_[k] * sizes.row(static_cast<Eigen::Index>(k));
    }
  }

 private:
  std::vector<std::size_t> set_;
  std::vector<Point> direction_, basis_;  // directions as given, and made perpendicular
};

/// Supports in the making.
class SupportFinder {
 public:
  SupportFinder(const Body& body, const TetMesh& mesh, int level)
      : body_(body), mesh_(mesh), level_(level) {
    found_.constrained.assign(mesh.vertices.size(), 0);
    for (const std::string& name : held_names(body)) found_.sets.emplace_back().name = name;
  }

  Supports find() {
    std::vector<std::vector<int>> moved;
    for (std::size_t i = 0; i < body_.prescribed.size(); ++i) moved.push_back(prescribe(i));
    for (std::size_t i = 0; i < body_.fixed.size(); ++i) fix(i);
    for (std::size_t i = 0; i < moved.size(); ++i)
      for (const int v : moved[i])
        for (const Point& axis : all_axes) held_[v].add(body_.fixed.size() + i, axis);
    for (const auto& [v, directions] : held_) {
      directions.share_out(v, found_.sets);
      if (directions.hold_all())
        found_.constrained[static_cast<std::size_t>(v)] = 1;
      else
        found_.sliding.push_back(directions.sliding(v));
    }
    return std::move(found_);
  }

 private:
  const Body& body_;
  const TetMesh& mesh_;
  int level_;
  Supports found_;
  std::map<int, std::size_t> motion_of_;
  std::map<int, HoldingDirections> held_;

  static std::string motion_name(std::size_t i) { return "body.prescribed." + std::to_string(i); }

  InputError clash(int v, const std::string& option) const {
    return InputError(option + ": vertex " + std::to_string(v) + " of level " +
                      std::to_string(level_) + " is prescribed by " +
                      motion_name(motion_of_.at(v)) + " too; a vertex has one motion, or is fixed");
  }

  std::vector<int> prescribe(std::size_t i) {
    const std::string option = motion_name(i);
    std::vector<int> vertices = select_vertices(mesh_, body_.prescribed[i].where, {option, level_});
    for (const int v : vertices) {
      if (!motion_of_.emplace(v, i).second) throw clash(v, option);
      found_.prescribed_vertex.push_back(v),
          found_.prescribed_motion.push_back(static_cast<int>(i));
    }
    found_.sets[body_.fixed.size() + i].centre = box_centre_of(mesh_, vertices);
    return vertices;
  }

  void fix(std::size_t i) {
    const std::string option = "body.fixed." + std::to_string(i);
    std::vector<int> vertices;
    for (const auto& [v, directions] : held_directions(body_.fixed[i], mesh_, {option, level_})) {
      if (const auto motion = motion_of_.find(v); motion != motion_of_.end())
        expect_together(v, option, motion->second, directions);
      for (const Point& direction : directions) held_[v].add(i, direction);
      vertices.push_back(v);
    }
    found_.sets[i].centre = box_centre_of(mesh_, vertices);
  }

  /// Throws InputError where a vertex that follows a motion is held along a direction of it.
  void expect_together(int v, const std::string& option, std::size_t motion,
                       const std::vector<Point>& directions) const {
    if (directions.size() == 3) throw clash(v, option);
    for (const Point& direction : directions)
      if (leaves_plane(body_.prescribed[motion], direction))
        throw InputError(text(option, ": vertex ", v, " of level ", level_, " is held along ",
                              direction_text(direction), ", and ", motion_name(motion),
                              " moves it along that; expected a motion across it, or another "
                              "selection"));
  }
};

/// Returns the name of an entry. join_bodies() has replaced its selection by the group
/// "BODY/KEY.NUMBER".
std::string held_name(const Body& body, const std::string& key, std::size_t i,
                      const Selection& where) {
  const std::string alone = key + "_" + std::to_string(i);
  const auto* group = std::get_if<GroupSelection>(&where);
  if (body.parts.empty() || !group) return alone;
  const auto slash = group->name.rfind('/'), dot = group->name.rfind('.');
  if (slash == std::string::npos || dot == std::string::npos || dot < slash) return alone;
  return group->name.substr(0, slash) + "." + key + "_" + group->name.substr(dot + 1);
}

}  // namespace

std::vector<std::string> held_names(const Body& body) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < body.fixed.size(); ++i)
    names.push_back(held_name(body, "fixed", i, body.fixed[i].where));
  for (std::size_t i = 0; i < body.prescribed.size(); ++i)
    names.push_back(held_name(body, "prescribed", i, body.prescribed[i].where));
  return names;
}

Supports find_supports(const Body& body, const TetMesh& mesh, int level) {
  return SupportFinder(body, mesh, level).find();
}

}  // namespace plica
