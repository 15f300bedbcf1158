// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/meshes/checked.hpp>
#include <plica/meshes/edge_lengths.hpp>
#include <plica/meshes/embedding.hpp>

namespace plica {

namespace {

constexpr double lowest_weight = -0.5;

// Of a point inside: what rounding left below zero is cut off, the rest made to sum to 1 again
Weights cut(Weights weights) {
  double sum = 0.0;
  for (double& w : weights) sum += w = std::max(w, 0.0);
  for (double& w : weights) w /= sum;
  return weights;
}

// Pulled towards the centroid (weights 1/4) until no weight is below the bound: all linear in the pull
bool hold(Weights& weights) {
  const double least = *std::min_element(weights.begin(), weights.end());
  if (least >= lowest_weight) return false;
  const double share = (0.25 - lowest_weight) / (0.25 - least);
  for (double& w : weights) w = 0.25 + share * (w - 0.25);
  return true;
}

}  // namespace

Embedding embed(const std::vector<Point>& points, const TetLocator& locator, Outside outside) {
  const TetMesh& mesh = locator.mesh();
  Embedding result;
  result.vertices.reserve(points.size());
  result.weights.reserve(points.size());
  result.outside.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite()) checked_point("point " + std::to_string(i), points[i]);
    const Located at = locator.locate(points[i]);
    const bool miss = at.distance > 0.0;
    Weights weights = at.weights;
    if (outside == Outside::clamp) weights = miss ? nearest_inside(points[i], corners_of(mesh, at.tet)) : cut(weights);
    if (outside == Outside::extrapolate && hold(weights)) ++result.held;
    if (outside == Outside::keep && miss) weights = {};
    if (miss) {
      ++result.misses;
      result.largest_distance_over_edge =
          std::max(result.largest_distance_over_edge, at.distance / mean_edge_length(mesh, at.tet));
    }
    result.vertices.push_back(mesh.tets[static_cast<std::size_t>(at.tet)]);
    result.weights.push_back(weights);
    result.outside.push_back(miss ? 1 : 0);
  }
  return result;
}

Embedding embed(const std::vector<Point>& points, const TetMesh& mesh, Outside outside) {
  return embed(points, TetLocator(mesh), outside);
}

}  // namespace plica
