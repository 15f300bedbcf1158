// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/core/error.hpp>
#include <plica/core/text.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/jitter.hpp>
#include <plica/meshes/mesh_quality.hpp>
#include <random>
#include <set>

namespace plica {

namespace {

constexpr double least_volume = 0.1;     // relative to a tetrahedron's volume before
constexpr double same_direction = 1e-6;  // distance of unit vectors
constexpr int most_halvings = 20;

std::vector<double> shortest_edges(const TetMesh& mesh) {
  std::vector<double> shortest(mesh.vertices.size(), std::numeric_limits<double>::infinity());
  for (const auto& [a, b] : mesh_edges(mesh)) {
    const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
    const double length = (mesh.vertices[i] - mesh.vertices[j]).norm();
    shortest[i] = std::min(shortest[i], length), shortest[j] = std::min(shortest[j], length);
  }
  return shortest;
}

// Returns the faces that must keep their planes: the boundaries of the body and of its regions
std::vector<std::array<int, 3>> kept_faces(const TetMesh& mesh) {
  std::vector<std::array<int, 3>> faces = boundary_triangles(mesh);
  const std::set<int> regions(mesh.region.begin(), mesh.region.end());
  for (const int region : regions) {
    TetMesh part;
    part.vertices = mesh.vertices;
    for (std::size_t t = 0; t < mesh.tets.size(); ++t)
      if (mesh.region[t] == region) part.tets.push_back(mesh.tets[t]);
    const auto more = boundary_triangles(part);
    faces.insert(faces.end(), more.begin(), more.end());
  }
  return faces;
}

// Directions in which a vertex may move: those orthogonal to the normals of its kept faces
class Freedom {
 public:
  void keep(const Point& normal) {
    const Point rest = normal - fixed_ * (fixed_.transpose() * normal);
    if (count_ == 3 || rest.norm() < same_direction) return;
    fixed_.col(count_++) = rest.normalized();
  }
  Point of(const Point& move) const {
    return count_ == 3 ? Point::Zero() : Point(move - fixed_ * (fixed_.transpose() * move));
  }

 private:
  Eigen::Matrix3d fixed_ = Eigen::Matrix3d::Zero();
  int count_ = 0;
};

std::vector<Freedom> freedoms(const TetMesh& mesh) {
  std::vector<Freedom> free(mesh.vertices.size());
  const auto x = [&](int v) -> const Point& { return mesh.vertices[static_cast<std::size_t>(v)]; };
  for (const auto& [a, b, c] : kept_faces(mesh)) {
    const Point normal = (x(b) - x(a)).cross(x(c) - x(a)).normalized();
    for (const int v : {a, b, c}) free[static_cast<std::size_t>(v)].keep(normal);
  }
  return free;
}

std::vector<Point> moves_of(const TetMesh& mesh, double amount, unsigned seed) {
  // The C++ standard fixes the numbers of this generator, but not those of its distributions
  std::mt19937 random(seed);
  const auto within = [&random] {
    return 2.0 * static_cast<double>(random()) / static_cast<double>(std::mt19937::max()) - 1.0;
  };
  const std::vector<double> shortest = shortest_edges(mesh);
  const std::vector<Freedom> free = freedoms(mesh);
  std::vector<Point> moves(mesh.vertices.size());
  for (std::size_t v = 0; v < moves.size(); ++v) {
    const double x = within(), y = within(), z = within();
    moves[v] = amount * shortest[v] * free[v].of({x, y, z});
  }
  return moves;
}

}  // namespace

TetMesh jittered(TetMesh mesh, double amount, unsigned seed) {
  if (!(amount >= 0 && amount < 0.5))
    throw InputError(text("jitter is ", number(amount), "; expected in [0, 0.5)"));
  std::vector<Point> moves = moves_of(mesh, amount, seed);
  const std::vector<Point> rest = mesh.vertices;
  const auto volume = [&mesh](const std::vector<Point>& x, std::size_t t) {
    const auto at = [&](std::size_t k) -> const Point& {
      return x[static_cast<std::size_t>(mesh.tets[t][k])];
    };
    return tet_volume(at(0), at(1), at(2), at(3));
  };
  for (int halvings = 0;; ++halvings) {
    for (std::size_t v = 0; v < moves.size(); ++v) mesh.vertices[v] = rest[v] + moves[v];
    std::vector<char> too_far(moves.size(), 0);
    for (std::size_t t = 0; t < mesh.tets.size(); ++t)
      if (volume(mesh.vertices, t) < least_volume * volume(rest, t))
        for (const int v : mesh.tets[t]) too_far[static_cast<std::size_t>(v)] = 1;
    if (std::ranges::count(too_far, 1) == 0) return mesh;
    for (std::size_t v = 0; v < moves.size(); ++v)
      if (too_far[v] != 0)
        moves[v] = halvings < most_halvings ? Point(moves[v] / 2) : Point::Zero();
  }
}

}  // namespace plica
