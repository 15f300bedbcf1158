// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/problem.hpp>
#include <plica/drivers/elastic/materials.hpp>
#include <plica/meshes/generators.hpp>
#include <random>
#include <string>
#include <vector>

// Bodies for tests and for problems with known solutions.
namespace plica {

/// Returns random vectors whose components are uniformly distributed over [-size, size].
inline std::vector<Point> random_field(std::size_t count, double size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> within(-size, size);
  std::vector<Point> field(count);
  for (Point& p : field) p = {within(random), within(random), within(random)};
  return field;
}

/// Returns whether a vertex lies on one of the box's faces.
inline bool on_boundary(const Box& box, const Point& p) {
  const double slack = 1e-9 * (box.max - box.min).norm();
  return ((p - box.min).array() < slack).any() || ((box.max - p).array() < slack).any();
}

/// Returns a box whose inner vertices are moved at random by up to `amount` of a cell. No two
/// elements are alike.
inline TetMesh jittered_box(const Box& box, const std::array<int, 3>& cells, double amount = 0.15,
                            unsigned seed = 7) {
  TetMesh mesh = box_mesh(box, cells);
  const auto moves = random_field(mesh.vertices.size(), amount, seed);
  for (std::size_t a = 0; a < moves.size(); ++a)
    if (!on_boundary(box, mesh.vertices[a]))
      for (int k = 0; k < 3; ++k)
        mesh.vertices[a][k] += moves[a][k] * (box.max - box.min)[k] / cells[std::size_t(k)];
  return mesh;
}

/// Returns the material with examples of the data that a law of tissue needs: skew fibres, terms.
inline MaterialOptions complete(MaterialOptions material) {
  const MaterialInfo* info = find_material(material.model);
  if (info && info->has_fibres) material.fibres = FibreOptions{{2, 2, 1}, Point(-2, 1, 2)};
  if (info && info->has_terms)
    material.convention = "mu_over_alpha2", material.terms = {{9600, 4}, {4000, -2}};
  return material;
}

/// Returns a problem of one body with one level, without loads.
inline Problem verify_body(TetMesh mesh, const MaterialOptions& material) {
  Problem p;
  p.body.levels = {std::move(mesh)};
  p.body.element = {"linear"};
  p.body.material = complete(material);
  return p;
}

/// Returns a soft cube of 0.1 m, in which no two elements are alike.
inline Problem irregular_cube(const std::string& material, int cells) {
  return verify_body(jittered_box({{0, 0, 0}, {0.1, 0.1, 0.1}}, {cells, cells, cells}),
                     {material, 20e3, 0.35, 1000});
}

/// Returns the displacement F X + shift - X of each vertex [m].
inline std::vector<Point> affine_field(const TetMesh& mesh, const Eigen::Matrix3d& F,
                                       const Point& shift) {
  std::vector<Point> u;
  for (const Point& X : mesh.vertices) u.push_back(F * X + shift - X);
  return u;
}

/// Returns the mean first Piola-Kirchhoff stress P times the volume V: V P = - sum f X^T [J]. The
/// forces f must be in balance except on the boundary.
inline Eigen::Matrix3d virial(const std::vector<Point>& force, const TetMesh& mesh) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t a = 0; a < force.size(); ++a) sum -= force[a] * mesh.vertices[a].transpose();
  return sum;
}

/// Returns the weighted distance sqrt(sum w |a - b|^2).
inline double distance(const std::vector<Point>& a, const std::vector<Point>& b,
                       const std::vector<double>& weight) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += weight[i] * (a[i] - b[i]).squaredNorm();
  return std::sqrt(sum);
}

/// Returns the largest length of a vector; NaN where a vector is.
inline double largest_length(const std::vector<Point>& field) {
  double most = 0;
  for (const Point& p : field) most = p.norm() <= most ? most : p.norm();
  return most;
}

/// Returns the index of the vertex nearest to a point.
inline std::size_t vertex_at(const TetMesh& mesh, const Point& x) {
  std::size_t best = 0;
  for (std::size_t a = 1; a < mesh.vertices.size(); ++a)
    if ((mesh.vertices[a] - x).norm() < (mesh.vertices[best] - x).norm()) best = a;
  return best;
}

}  // namespace plica
