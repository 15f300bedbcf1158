// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <limits>
#include <plica/core/error.hpp>
#include <plica/core/text.hpp>
#include <plica/drivers/body/body_parts.hpp>
#include <plica/meshes/mesh_quality.hpp>
#include <plica/meshes/signed_distance.hpp>

namespace plica {

namespace {

constexpr double bearable_overlap = 0.05;  // part of an edge

/// Returns the part of each region of the mesh.
std::vector<std::size_t> parts_of_regions(const TetMesh& mesh, const std::vector<BodyPart>& parts) {
  std::vector<std::size_t> list;
  for (const std::string& region : mesh.region_names) {
    const auto of = std::find_if(parts.begin(), parts.end(), [&](const BodyPart& part) {
      return region == part.name || region.compare(0, part.name.size() + 1, part.name + "/") == 0;
    });
    list.push_back(static_cast<std::size_t>(of - parts.begin()));
  }
  return list;
}

std::size_t part_of_tet(const TetMesh& mesh, const std::vector<std::size_t>& of_region,
                        std::size_t e) {
  return of_region[static_cast<std::size_t>(mesh.region[e])];
}

/// Returns the triangles of one part; its points are numbered from its first.
TriangleSurface surface_of_part(const TriangleSurface& surface, int first, int points) {
  TriangleSurface one;
  one.vertices.assign(surface.vertices.begin() + first, surface.vertices.begin() + first + points);
  for (const auto& t : surface.triangles)
    if (t[0] >= first && t[0] < first + points)
      one.triangles.push_back({t[0] - first, t[1] - first, t[2] - first});
  return one;
}

}  // namespace

std::vector<int> parts_of_vertices(const TetMesh& mesh, const std::vector<BodyPart>& parts) {
  if (parts.empty()) return {};
  const std::vector<std::size_t> of_region = parts_of_regions(mesh, parts);
  std::vector<int> part(mesh.vertices.size(), 0);
  for (std::size_t e = 0; e < mesh.tets.size(); ++e)
    for (const int v : mesh.tets[e])
      part[static_cast<std::size_t>(v)] = static_cast<int>(part_of_tet(mesh, of_region, e));
  return part;
}

std::vector<int> parts_of_points(const std::vector<BodyPart>& parts) {
  std::vector<int> part;
  for (std::size_t i = 0; i < parts.size(); ++i)
    part.insert(part.end(), static_cast<std::size_t>(parts[i].points), static_cast<int>(i));
  return part;
}

BodyLocator::BodyLocator(const TetMesh& mesh, const std::vector<BodyPart>& parts) {
  if (parts.empty()) {
    parts_.push_back({nullptr, {}, std::make_unique<TetLocator>(mesh)});
    return;
  }
  const std::vector<std::size_t> of_region = parts_of_regions(mesh, parts);
  std::vector<int> number(mesh.vertices.size(), -1);
  for (std::size_t i = 0; i < parts.size(); ++i)
    parts_.push_back({std::make_unique<TetMesh>(), {}, nullptr});
  for (std::size_t e = 0; e < mesh.tets.size(); ++e) {
    One& one = parts_[part_of_tet(mesh, of_region, e)];
    auto tet = mesh.tets[e];
    for (int& v : tet) {
      const auto a = static_cast<std::size_t>(v);
      if (number[a] < 0) {
        number[a] = static_cast<int>(one.vertex.size());
        one.vertex.push_back(v), one.mesh->vertices.push_back(mesh.vertices[a]);
      }
      v = number[a];
    }
    one.mesh->tets.push_back(tet);
    if (!mesh.piece.empty()) one.mesh->piece.push_back(mesh.piece[e]);
  }
  for (One& one : parts_) one.locator = std::make_unique<TetLocator>(*one.mesh);
}

Embedding BodyLocator::embed(const std::vector<Point>& points, const std::vector<int>& part,
                             Outside outside) const {
  if (part.empty()) return plica::embed(points, *parts_.front().locator, outside);
  Embedding all;
  all.vertices.resize(points.size()), all.weights.resize(points.size()),
      all.outside.resize(points.size());
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    std::vector<Point> own;
    std::vector<std::size_t> place;
    for (std::size_t p = 0; p < points.size(); ++p)
      if (part[p] == static_cast<int>(i)) own.push_back(points[p]), place.push_back(p);
    const Embedding one = plica::embed(own, *parts_[i].locator, outside);
    for (std::size_t p = 0; p < place.size(); ++p) {
      for (std::size_t c = 0; c < 4; ++c)
        all.vertices[place[p]][c] = parts_[i].vertex[static_cast<std::size_t>(one.vertices[p][c])];
      all.weights[place[p]] = one.weights[p], all.outside[place[p]] = one.outside[p];
    }
    all.misses += one.misses, all.held += one.held;
    all.largest_distance_over_edge =
        std::max(all.largest_distance_over_edge, one.largest_distance_over_edge);
  }
  return all;
}

double BodyLocator::distance(const Point& point) const {
  double least = std::numeric_limits<double>::infinity();
  for (const One& one : parts_) least = std::min(least, one.locator->locate(point).distance);
  return least;
}

double BodyLocator::mean_edge(std::size_t part) const {
  return mean_edge_length(parts_[part].locator->mesh());
}

void expect_apart(const TriangleSurface& surface, const std::vector<BodyPart>& parts, double edge) {
  const std::vector<int> part = parts_of_points(parts);
  std::vector<Point> below(surface.vertices.size(), Point::Zero());
  for (const auto& [a, b, c] : surface.triangles) {
    const auto x = [&](int p) -> const Point& {
      return surface.vertices[static_cast<std::size_t>(p)];
    };
    for (const int p : {a, b, c})
      below[static_cast<std::size_t>(p)] += (x(b) - x(a)).cross(x(c) - x(a));
  }
  for (Point& n : below) n *= 2 * bearable_overlap * edge / std::max(n.norm(), 1e-300);
  int first = 0;
  for (std::size_t i = 0; i < parts.size(); first += parts[i].points, ++i) {
    const TriangleSurface one = surface_of_part(surface, first, parts[i].points);
    const Box box = bounding_box(one.vertices);
    const SignedDistance distance(one);
    // The depth of a point, or of one a little below it: where two bodies are in the same place,
    // all points of one are on the surface of the other.
    const auto depth_at = [&](std::size_t p) {
      return std::max(-distance(surface.vertices[p]), -distance(surface.vertices[p] - below[p]));
    };
    double deepest = bearable_overlap * edge;
    std::size_t where = part.size();
    for (std::size_t p = 0; p < part.size(); ++p) {
      const Point& x = surface.vertices[p];
      if (part[p] == static_cast<int>(i) || (x.array() < box.min.array()).any() ||
          (x.array() > box.max.array()).any())
        continue;
      if (const double depth = depth_at(p); depth > deepest) deepest = depth, where = p;
    }
    if (where == part.size()) continue;
    const Point& x = surface.vertices[where];
    throw InputError(text("bodies.", parts[static_cast<std::size_t>(part[where])].name,
                          " overlaps bodies.", parts[i].name, " at the start: [", number(x[0], 4),
                          ", ", number(x[1], 4), ", ", number(x[2], 4), "] m of its surface is ",
                          number(deepest, 3),
                          " m inside; expected bodies apart, or contact.bodies: false"));
  }
}

}  // namespace plica
