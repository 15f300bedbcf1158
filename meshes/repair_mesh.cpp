// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <plica/core/error.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/mesh_quality.hpp>
#include <plica/meshes/repair_mesh.hpp>
#include <set>

namespace plica {

namespace {

// Drops the tetrahedra for which keep(t) is false, with all that they have, and their numbers
template <class Keep>
void filter(TetMesh& mesh, std::vector<int>& numbers, const Keep& keep) {
  std::vector<std::size_t> kept;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    if (keep(t)) kept.push_back(t);
  const auto pick = [&kept](auto& values) {
    if (values.empty()) return;
    for (std::size_t k = 0; k < kept.size(); ++k) values[k] = values[kept[k]];
    values.resize(kept.size());
  };
  pick(mesh.tets), pick(mesh.region), pick(mesh.filled), pick(numbers);
  for (auto& [name, vectors] : mesh.tet_vectors) pick(vectors);
}

constexpr double sliver = 8;  // elements with a height ratio above this are improved
constexpr int rounds = 8;
constexpr double gain = 0.95;  // a step must multiply the worst ratio around it by less than this
constexpr std::array<double, 4> fractions = {1, 0.5, 0.25, 0.1};  // tried fractions of a step

class Improver {
 public:
  explicit Improver(TetMesh& mesh)
      : mesh_(mesh), star_(mesh.vertices.size()), stays_(mesh.vertices.size(), false) {
    for (std::size_t t = 0; t < mesh.tets.size(); ++t)
      for (const int v : mesh.tets[t]) star(v).push_back(static_cast<int>(t));
    alive.assign(mesh.tets.size(), true);
    done.vertex.resize(mesh.vertices.size());
    std::iota(done.vertex.begin(), done.vertex.end(), 0);
    hold();
  }

  // Tries to improve each sliver once; returns whether any became better
  bool round() {
    bool any = false;
    for (std::size_t t = 0; t < mesh_.tets.size(); ++t)
      if (alive[t] && height_ratio(mesh_, mesh_.tets[t]) > sliver) any = improve(t) || any;
    return any;
  }

  std::vector<char> alive;  // per tetrahedron, 0: dropped by a collapse
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
      if (!stays_[static_cast<std::size_t>(v)] &&
          (move(v, mean_of_neighbours(v)) || move(v, away(v, corners))))
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

  // Returns the position of v moved normally to the face across. Its height is then sqrt(2 area) /
  // 2, about half the mean edge of that face.
  Point away(int v, const std::array<int, 4>& corners) {
    std::vector<Point> face;
    for (const int other : corners)
      if (other != v) face.push_back(at(other));
    const Point normal = (face[1] - face[0]).cross(face[2] - face[0]);
    const double length = normal.norm(),
                 height = length > 0 ? (at(v) - face[0]).dot(normal) / length : 0;
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

  // Merges vertex v into `to` if all elements around it become better; returns whether it did. The
  // elements around an inner vertex fill an unchanged space from any point that sees all of their
  // outer faces.
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
  const auto at = [&](std::size_t k) -> const Point& {
    return mesh.vertices[static_cast<std::size_t>(tet[k])];
  };
  const double volume = tet_volume(at(0), at(1), at(2), at(3));
  if (!(volume > 0)) return std::numeric_limits<double>::infinity();
  double longest = 0, largest = 0;  // longest edge, and twice the area of the largest face
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
  filter(mesh, numbers, [&](std::size_t t) { return improver.alive[t]; });
  for (int& v : improver.done.vertex)
    while (improver.done.vertex[static_cast<std::size_t>(v)] != v)
      v = improver.done.vertex[static_cast<std::size_t>(v)];
  return improver.done;
}

namespace {

constexpr double thin = 20;  // slivers with a height ratio above this are peeled off
constexpr int most_rounds = 10;

using Edge = std::array<int, 2>;

Edge edge(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

template <std::size_t n>
std::array<int, n> sorted(std::array<int, n> corners) {
  std::sort(corners.begin(), corners.end());
  return corners;
}

class Peeler {
 public:
  explicit Peeler(const TetMesh& mesh) : mesh_(mesh), touched_(mesh.vertices.size(), false) {
    for (const auto& triangle : boundary_triangles(mesh)) {
      faces_.push_back(sorted(triangle));
      for (std::size_t k = 0; k < 3; ++k)
        edges_.push_back(edge(triangle[k], triangle[(k + 1) % 3]));
    }
    std::sort(faces_.begin(), faces_.end()), std::sort(edges_.begin(), edges_.end());
  }

  // Returns whether the sliver is to be dropped. The neighbours of a dropped sliver wait for the
  // next round, which has the new boundary.
  bool peels(const std::array<int, 4>& tet) {
    if (!(height_ratio(mesh_, tet) > thin)) return false;
    std::vector<int> ends;  // corners whose faces across are on the boundary
    for (std::size_t k = 0; k < 4; ++k) {
      const std::array<int, 3> face =
          sorted<3>({tet[(k + 1) % 4], tet[(k + 2) % 4], tet[(k + 3) % 4]});
      if (std::binary_search(faces_.begin(), faces_.end(), face)) ends.push_back(tet[k]);
    }
    if (ends.size() != 2 ||
        std::binary_search(edges_.begin(), edges_.end(), edge(ends[0], ends[1])))
      return false;
    for (const int v : tet)
      if (touched_[static_cast<std::size_t>(v)]) return false;
    for (const int v : tet) touched_[static_cast<std::size_t>(v)] = true;
    return true;
  }

 private:
  const TetMesh& mesh_;
  std::vector<std::array<int, 3>> faces_;
  std::vector<Edge> edges_;
  std::vector<char> touched_;
};

}  // namespace

int peel_slivers(TetMesh& mesh, std::vector<int>& numbers) {
  const std::size_t before = mesh.tets.size();
  for (int round = 0; round < most_rounds; ++round) {
    Peeler peeler(mesh);
    const std::size_t count = mesh.tets.size();
    filter(mesh, numbers, [&](std::size_t t) { return !peeler.peels(mesh.tets[t]); });
    if (mesh.tets.size() == count) break;
  }
  return static_cast<int>(before - mesh.tets.size());
}

namespace {

constexpr double same_place = 1e-6;  // relative to the mean edge
constexpr double loose_part = 0.01;  // relative to the volume of the mesh
constexpr double flat_ratio = 1e8;   // height ratio that counts as no volume

double tet_volume_of(const TetMesh& mesh, const std::array<int, 4>& tet) {
  const auto at = [&](std::size_t k) -> const Point& {
    return mesh.vertices[static_cast<std::size_t>(tet[k])];
  };
  return tet_volume(at(0), at(1), at(2), at(3));
}

// Replaces vertices at one place by the first of them. Tetrahedra that thus lose a corner, or
// repeat another one, are dropped.
void merge(MeshRepair& repair) {
  TetMesh& mesh = repair.mesh;
  const std::vector<int> twins = lower_twins(mesh.vertices, same_place * mean_edge_length(mesh));
  for (std::size_t v = 0; v < twins.size(); ++v)
    if (twins[v] >= 0)
      repair.vertex[v] = repair.vertex[static_cast<std::size_t>(twins[v])], ++repair.merged;
  if (repair.merged == 0) return;
  std::set<std::array<int, 4>> seen;
  for (auto& tet : mesh.tets)
    for (int& v : tet) v = repair.vertex[static_cast<std::size_t>(v)];
  filter(mesh, repair.original_tet, [&](std::size_t t) {
    const std::array<int, 4> key = sorted(mesh.tets[t]);
    return std::adjacent_find(key.begin(), key.end()) == key.end() && seen.insert(key).second;
  });
}

void drop_loose_parts(MeshRepair& repair) {
  TetMesh& mesh = repair.mesh;
  const std::vector<int> part = parts_of(mesh);
  std::vector<double> volume(mesh.vertices.size(), 0);
  for (const auto& tet : mesh.tets)
    volume[static_cast<std::size_t>(part[static_cast<std::size_t>(tet[0])])] +=
        tet_volume_of(mesh, tet);
  const double least = loose_part * std::accumulate(volume.begin(), volume.end(), 0.0);
  std::set<int> dropped;
  const auto keep = [&](std::size_t t) {
    const int p = part[static_cast<std::size_t>(mesh.tets[t][0])];
    if (volume[static_cast<std::size_t>(p)] >= least) return true;
    dropped.insert(p);
    return false;
  };
  const std::size_t before = mesh.tets.size();
  filter(mesh, repair.original_tet, keep);
  repair.parts = static_cast<int>(dropped.size());
  repair.loose_tets = static_cast<int>(before - mesh.tets.size());
}

double worst_of(const TetMesh& mesh) {
  double worst = 0;
  for (const auto& tet : mesh.tets) worst = std::max(worst, height_ratio(mesh, tet));
  return worst;
}

// Drops vertices of no tetrahedron, also from the sets, and renumbers the rest. A set gets the
// vertices that its old vertices were merged into.
void renumber(MeshRepair& repair) {
  TetMesh& mesh = repair.mesh;
  std::vector<int> number(mesh.vertices.size(), -1);
  for (const auto& tet : mesh.tets)
    for (const int v : tet) number[static_cast<std::size_t>(v)] = 0;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] < 0) continue;
    number[v] = static_cast<int>(repair.original_vertex.size());
    mesh.vertices[repair.original_vertex.size()] = mesh.vertices[v];
    repair.original_vertex.push_back(static_cast<int>(v));
  }
  mesh.vertices.resize(repair.original_vertex.size());
  for (auto& tet : mesh.tets)
    for (int& v : tet) v = number[static_cast<std::size_t>(v)];
  for (int& v : repair.vertex) v = number[static_cast<std::size_t>(v)];
  for (auto& [name, set] : mesh.vertex_sets) {
    for (int& v : set) v = repair.vertex[static_cast<std::size_t>(v)];
    std::sort(set.begin(), set.end());
    set.erase(std::unique(set.begin(), set.end()), set.end());
    std::erase(set, -1);
  }
  for (auto& [name, set] : mesh.triangle_sets)
    std::erase_if(set, [&](std::array<int, 3>& triangle) {
      for (int& v : triangle) v = repair.vertex[static_cast<std::size_t>(v)];
      const auto& [a, b, c] = triangle;
      return std::min({a, b, c}) < 0 || a == b || b == c || c == a;
    });
}

}  // namespace

MeshRepair repair_mesh(const TetMesh& mesh) {
  MeshRepair repair;
  repair.mesh = mesh;
  repair.vertex.resize(mesh.vertices.size());
  std::iota(repair.vertex.begin(), repair.vertex.end(), 0);
  repair.original_tet.resize(mesh.tets.size());
  std::iota(repair.original_tet.begin(), repair.original_tet.end(), 0);
  repair.worst_before = worst_of(mesh);
  merge(repair);
  drop_loose_parts(repair);
  repair.peeled = peel_slivers(repair.mesh, repair.original_tet);
  const Improvement improved = improve_shapes(repair.mesh, repair.original_tet);
  repair.moved = improved.moved, repair.collapsed = improved.collapsed;
  for (int& v : repair.vertex) v = improved.vertex[static_cast<std::size_t>(v)];
  const std::size_t before = repair.mesh.tets.size();
  filter(repair.mesh, repair.original_tet, [&](std::size_t t) {
    return height_ratio(repair.mesh, repair.mesh.tets[t]) < flat_ratio;
  });
  repair.flat = static_cast<int>(before - repair.mesh.tets.size());
  if (repair.mesh.tets.empty())
    throw InputError("nothing is left of the mesh: no tetrahedron has a volume");
  renumber(repair);
  repair.worst_after = worst_of(repair.mesh);
  return repair;
}

}  // namespace plica
