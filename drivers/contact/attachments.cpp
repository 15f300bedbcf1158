// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <plica/core/error.hpp>
#include <plica/core/small.hpp>
#include <plica/core/text.hpp>
#include <plica/drivers/body/body_parts.hpp>
#include <plica/drivers/body/selection.hpp>
#include <plica/drivers/contact/attachments.hpp>
#include <plica/kernels/contact/on_triangle.hpp>

namespace plica {

namespace {

/// Triangles of one body, searched for the place nearest to a point.
class PartTriangles {
 public:
  PartTriangles(const TriangleSurface& surface, const std::vector<int>& part, int body)
      : surface_(surface) {
    for (std::size_t t = 0; t < surface.triangles.size(); ++t)
      if (part[static_cast<std::size_t>(surface.triangles[t][0])] == body)
        own_.push_back(static_cast<int>(t));
  }

  /// Returns the distance from a point to the nearest place on the triangles [m].
  /// That place goes to `place`. Triangles further away than `within` [m] are skipped: where all
  /// are, the result is `within` and `place` stays.
  double nearest(const Point& x, double within, AttachedPoint& place) const {
    double least = within;
    for (const int t : own_) {
      std::array<Point, 3> corner;
      for (std::size_t c = 0; c < 3; ++c)
        corner[c] = surface_.vertices[static_cast<std::size_t>(
            surface_.triangles[static_cast<std::size_t>(t)][c])];
      const Point low = corner[0].cwiseMin(corner[1]).cwiseMin(corner[2]),
                  high = corner[0].cwiseMax(corner[1]).cwiseMax(corner[2]);
      if ((low - x).cwiseMax(x - high).cwiseMax(0.0).norm() > least) continue;
      const Vec3<double> w =
          nearest_on_triangle(vec3(x), vec3(corner[0]), vec3(corner[1]), vec3(corner[2]));
      const double distance = (w[0] * corner[0] + w[1] * corner[1] + w[2] * corner[2] - x).norm();
      if (distance > least || (place.triangle >= 0 && distance == least)) continue;
      least = distance, place.triangle = t, place.weight = {w[0], w[1], w[2]};
    }
    return least;
  }

 private:
  const TriangleSurface& surface_;
  std::vector<int> own_;

  static Vec3<double> vec3(const Point& x) { return {x[0], x[1], x[2]}; }
};

int part_named(const std::vector<BodyPart>& parts, const std::string& name) {
  return static_cast<int>(
      std::ranges::find_if(parts, [&](const BodyPart& part) { return part.name == name; }) -
      parts.begin());
}

std::vector<int> chosen_points(const TriangleSurface& surface, const std::vector<int>& part,
                               int body, const std::optional<Selection>& where,
                               const std::string& path) {
  std::vector<int> points;
  std::vector<Point> places;
  for (std::size_t p = 0; p < part.size(); ++p)
    if (part[p] == body)
      points.push_back(static_cast<int>(p)), places.push_back(surface.vertices[p]);
  if (!where) return points;
  std::vector<int> chosen;
  for (const int i : select_points(places, *where, path + ".where"))
    chosen.push_back(points[static_cast<std::size_t>(i)]);
  return chosen;
}

}  // namespace

std::vector<AttachedPoint> attached_points(const std::vector<AttachmentOptions>& attachments,
                                           const TriangleSurface& surface,
                                           const std::vector<BodyPart>& parts) {
  const std::vector<int> part = parts_of_points(parts);
  std::vector<int> holder(part.size(), -1);
  std::vector<AttachedPoint> all;
  for (std::size_t i = 0; i < attachments.size(); ++i) {
    const AttachmentOptions& o = attachments[i];
    const std::string path = "attachments." + std::to_string(i);
    const PartTriangles other(surface, part, part_named(parts, o.to));
    const std::vector<int> chosen =
        chosen_points(surface, part, part_named(parts, o.body), o.where, path);
    const std::size_t before = all.size();
    const double reach = o.reach + same_place(bounding_box(surface.vertices));
    for (const int p : chosen) {
      AttachedPoint place{p, static_cast<int>(i), -1, {}};
      other.nearest(surface.vertices[static_cast<std::size_t>(p)], reach, place);
      if (place.triangle < 0) continue;
      int& held = holder[static_cast<std::size_t>(p)];
      if (held >= 0)
        throw InputError(path + " holds a point of bodies." + o.body + " that attachments." +
                         std::to_string(held) + " holds too; expected one attachment for a point");
      held = static_cast<int>(i);
      all.push_back(place);
    }
    if (all.size() > before) continue;
    double least = std::numeric_limits<double>::infinity();
    for (const int p : chosen) {
      AttachedPoint place{p, 0, -1, {}};
      least = std::min(least,
                       other.nearest(surface.vertices[static_cast<std::size_t>(p)], least, place));
    }
    throw InputError(path + ".reach: no point that it chooses of bodies." + o.body + " is within " +
                     number(o.reach, 3) + " m of bodies." + o.to + "; the nearest is " +
                     number(least, 3) + " m away; move the bodies closer, or increase reach");
  }
  return all;
}

}  // namespace plica
