// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/improve_shapes.hpp>

namespace plica {

namespace {

constexpr double sliver = 8;  // height ratio
constexpr int rounds = 8;
constexpr double gain = 0.95;  // a step must make the worst element around it better by that
constexpr std::array<double, 4> fractions = {1, 0.5, 0.25, 0.1};  // of a step that are tried

class Improver {
 public:
  explicit Improver(TetMesh& mesh) : mesh_(mesh), star_(mesh.vertices.size()), stays_(mesh.vertices.size(), false) {
    for (std::size_t t = 0; t < mesh.tets.size(); ++t)
      for (const int v : mesh.tets[t]) star(v).push_back(static_cast<int>(t));
    alive.assign(mesh.tets.size(), true);
    done.vertex.resize(mesh.vertices.size());
    std::iota(done.vertex.begin(), done.vertex.end(), 0);
    hold();
  }

  // Whether anything became better
  bool round() {
    bool any = false;
    for (std::size_t t = 0; t < mesh_.tets.size(); ++t)
      if (alive[t] && height_ratio(mesh_, mesh_.tets[t]) > sliver) any = improve(t) || any;
    return any;
  }

  std::vector<char> alive;  // per tetrahedron
  Improvement done;

 private:
  std::vector<int>& star(int v) { return star_[static_cast<std::size_t>(v)]; }
  std::array<int, 4>& tet(int t) { return mesh_.tets[static_cast<std::size_t>(t)]; }
  Point& at(int v) { return mesh_.vertices[static_cast<std::size_t>(v)]; }
  void stay(int v) { stays_[static_cast<std::size_t>(v)] = true; }

  void hold() {
    for (const auto& triangle : boundary_triangles(mesh_))
      for (const int v : triangle) stay(v);
    for (const auto& [name, set] : mesh_.vertex_sets)
      for (const int v : set) stay(v);
    if (mesh_.region.empty()) return;
    const auto region = [&](int t) { return mesh_.region[static_cast<std::size_t>(t)]; };
    for (std::size_t v = 0; v < star_.size(); ++v)
      for (const int t : star_[v])
        if (region(t) != region(star_[v].front())) stay(static_cast<int>(v));
  }

  double worst_around(int v) {
    double worst = 0;
    for (const int t : star(v)) worst = std::max(worst, height_ratio(mesh_, tet(t)));
    return worst;
  }

  bool improve(std::size_t t) {
    const std::array<int, 4> corners = mesh_.tets[t];
    for (const int v : corners)
      if (!stays_[static_cast<std::size_t>(v)] && (move(v, mean_of_neighbours(v)) || move(v, away(v, corners))))
        return true;
    for (const int v : corners)
      for (const int to : corners)
        if (v != to && !stays_[static_cast<std::size_t>(v)] && collapse(v, to)) return true;
    return false;
  }

  Point mean_of_neighbours(int v) {
    Point sum = Point::Zero();
    int count = 0;
    for (const int t : star(v))
      for (const int other : tet(t))
        if (other != v) sum += at(other), ++count;
    return sum / count;
  }

  // To where the height over the face across is half the mean edge of that face
  Point away(int v, const std::array<int, 4>& corners) {
    std::vector<Point> face;
    for (const int other : corners)
      if (other != v) face.push_back(at(other));
    const Point normal = (face[1] - face[0]).cross(face[2] - face[0]);
    const double length = normal.norm(), height = length > 0 ? (at(v) - face[0]).dot(normal) / length : 0;
    if (!(length > 0)) return at(v);
    const double wanted = std::copysign(std::sqrt(length) / 2, height);
    return at(v) + (wanted - height) / length * normal;
  }

  bool move(int v, const Point& to) {
    const Point from = at(v);
    const double before = worst_around(v);
    for (const double fraction : fractions) {
      at(v) = from + fraction * (to - from);
      if (worst_around(v) < gain * before) return ++done.moved, true;
    }
    at(v) = from;
    return false;
  }

  // The elements around an inner vertex fill the same space from any point that sees all of their outer faces
  bool collapse(int v, int to) {
    const double before = worst_around(v);
    for (const int t : star(v)) {
      std::array<int, 4> now = tet(t);
      if (std::find(now.begin(), now.end(), to) != now.end()) continue;
      std::replace(now.begin(), now.end(), v, to);
      if (!(height_ratio(mesh_, now) < gain * before)) return false;
    }
    for (const int t : star(v)) {
      std::array<int, 4>& one = tet(t);
      if (std::find(one.begin(), one.end(), to) != one.end()) {
        alive[static_cast<std::size_t>(t)] = false;
        for (const int other : one)
          if (other != v) std::erase(star(other), t);
      } else {
        std::replace(one.begin(), one.end(), v, to);
        star(to).push_back(t);
      }
    }
    star(v).clear();
    done.vertex[static_cast<std::size_t>(v)] = to;
    ++done.collapsed;
    return true;
  }

  TetMesh& mesh_;
  std::vector<std::vector<int>> star_;  // per vertex its tetrahedra
  std::vector<char> stays_;
};

}  // namespace

double height_ratio(const TetMesh& mesh, const std::array<int, 4>& tet) {
  const auto at = [&](std::size_t k) -> const Point& { return mesh.vertices[static_cast<std::size_t>(tet[k])]; };
  const double volume = tet_volume(at(0), at(1), at(2), at(3));
  if (!(volume > 0)) return std::numeric_limits<double>::infinity();
  double longest = 0, largest = 0;  // edge and twice the area of a face
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t j = (i + 1) % 4, k = (i + 2) % 4;
    largest = std::max(largest, (at(j) - at(i)).cross(at(k) - at(i)).norm());
    for (std::size_t l = i + 1; l < 4; ++l) longest = std::max(longest, (at(l) - at(i)).norm());
  }
  return longest * largest / (6 * volume);
}

Improvement improve_shapes(TetMesh& mesh, std::vector<int>& numbers) {
  Improver improver(mesh);
  for (int i = 0; i < rounds && improver.round(); ++i) continue;
  std::size_t kept = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (!improver.alive[t]) continue;
    mesh.tets[kept] = mesh.tets[t], numbers[kept] = numbers[t];
    if (!mesh.region.empty()) mesh.region[kept] = mesh.region[t];
    for (auto& [name, vectors] : mesh.tet_vectors) vectors[kept] = vectors[t];
    ++kept;
  }
  mesh.tets.resize(kept), numbers.resize(kept);
  if (!mesh.region.empty()) mesh.region.resize(kept);
  for (auto& [name, vectors] : mesh.tet_vectors) vectors.resize(kept);
  for (int& v : improver.done.vertex)
    while (improver.done.vertex[static_cast<std::size_t>(v)] != v)
      v = improver.done.vertex[static_cast<std::size_t>(v)];
  return improver.done;
}

}  // namespace plica
