// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <plica/core/error.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/checked.hpp>
#include <plica/meshes/embedding.hpp>
#include <plica/meshes/refinement.hpp>
#include <unordered_map>
#include <unordered_set>

namespace plica {

namespace {

constexpr double as_short = 1e-9;    // relative difference of squared lengths
constexpr double same_place = 1e-6;  // relative to an edge
constexpr double same_volume = 1e-9;

std::uint64_t edge_key(int a, int b) {
  const auto [low, high] = std::minmax(a, b);
  return (static_cast<std::uint64_t>(low) << 32) | static_cast<std::uint64_t>(high);
}

// Middles of the edges of a tetrahedron: mij is between corners i and j
enum Middle : std::size_t { m01, m02, m03, m12, m13, m23 };
constexpr std::array<std::array<std::size_t, 2>, 6> ends = {
    {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};

// Diagonal of the octahedron, and the other four corners in right-handed order around it
struct Diagonal {
  Middle from, to;
  std::array<Middle, 4> ring;
};
constexpr std::array<Diagonal, 3> diagonals = {{{m01, m23, {m02, m03, m13, m12}},
                                                {m02, m13, {m03, m01, m12, m23}},
                                                {m03, m12, {m01, m02, m23, m13}}}};

// Returns what tetrahedra have, for the eight that replace each
template <class Value>
std::vector<Value> of_eight(const std::vector<Value>& of_tets) {
  std::vector<Value> all;
  all.reserve(8 * of_tets.size());
  for (const Value& value : of_tets) all.insert(all.end(), 8, value);
  return all;
}

class Refinement {
 public:
  explicit Refinement(const TetMesh& mesh) : mesh_(mesh), finer_(mesh) {
    checked_count("the number of tetrahedra", 8.0 * static_cast<double>(mesh.tets.size()));
    finer_.tets.clear();
    finer_.tets.reserve(8 * mesh.tets.size());
    middles_.reserve(mesh.tets.size() * 3 / 2);
  }

  TetMesh made() {
    for (const auto& tet : mesh_.tets) cut(tet);
    finer_.region = of_eight(mesh_.region), finer_.filled = of_eight(mesh_.filled);
    for (auto& [name, vectors] : finer_.tet_vectors) vectors = of_eight(vectors);
    add_middles_to_sets();
    cut_triangle_sets();
    return std::move(finer_);
  }

 private:
  const Point& at(int v) const { return finer_.vertices[static_cast<std::size_t>(v)]; }

  int middle(int a, int b) {
    const auto [entry, is_new] =
        middles_.try_emplace(edge_key(a, b), static_cast<int>(finer_.vertices.size()));
    if (is_new) finer_.vertices.push_back((at(a) + at(b)) / 2), edges_.push_back({a, b});
    return entry->second;
  }

  void cut(const std::array<int, 4>& v) {
    std::array<int, 6> m;
    for (std::size_t e = 0; e < 6; ++e) m[e] = middle(v[ends[e][0]], v[ends[e][1]]);
    finer_.tets.insert(finer_.tets.end(), {{v[0], m[m01], m[m02], m[m03]},
                                           {m[m01], v[1], m[m12], m[m13]},
                                           {m[m02], m[m12], v[2], m[m23]},
                                           {m[m03], m[m13], m[m23], v[3]}});
    const Diagonal& d = diagonals[chosen(v, m)];
    for (std::size_t i = 0; i < 4; ++i)
      finer_.tets.push_back({m[d.from], m[d.to], m[d.ring[i]], m[d.ring[(i + 1) % 4]]});
  }

  std::size_t chosen(const std::array<int, 4>& v, const std::array<int, 6>& m) const {
    Point longest = Point::Zero();
    for (const auto& [i, j] : ends) {
      const Point edge = at(v[j]) - at(v[i]);
      if (edge.squaredNorm() > longest.squaredNorm() * (1 + as_short)) longest = edge;
    }
    const auto along = [&](const Diagonal& d) -> Point { return at(m[d.to]) - at(m[d.from]); };
    std::size_t best = 0;
    for (std::size_t i = 1; i < 3; ++i) {
      const Point one = along(diagonals[i]), other = along(diagonals[best]);
      const double length = one.squaredNorm(), least = other.squaredNorm();
      const bool as_good = std::abs(length - least) <= as_short * least;
      if (as_good ? std::abs(one.dot(longest)) > std::abs(other.dot(longest)) * (1 + as_short)
                  : length < least)
        best = i;
    }
    return best;
  }

  void add_middles_to_sets() {
    if (finer_.vertex_sets.empty()) return;
    std::unordered_set<std::uint64_t> boundary_edges;
    std::vector<char> on_boundary(mesh_.vertices.size(), 0);
    for (const auto& triangle : boundary_triangles(mesh_))
      for (std::size_t k = 0; k < 3; ++k) {
        boundary_edges.insert(edge_key(triangle[k], triangle[(k + 1) % 3]));
        on_boundary[static_cast<std::size_t>(triangle[k])] = 1;
      }
    for (auto& [name, set] : finer_.vertex_sets) {
      std::vector<char> in(mesh_.vertices.size(), 0);
      for (const int v : set) in[static_cast<std::size_t>(v)] = 1;
      const bool surface = std::ranges::all_of(
          set, [&](int v) { return on_boundary[static_cast<std::size_t>(v)] != 0; });
      for (std::size_t e = 0; e < edges_.size(); ++e) {
        const auto [a, b] = edges_[e];
        if (in[static_cast<std::size_t>(a)] == 0 || in[static_cast<std::size_t>(b)] == 0) continue;
        if (!surface || boundary_edges.contains(edge_key(a, b)))
          set.push_back(static_cast<int>(mesh_.vertices.size() + e));
      }
    }
  }

  // Cuts each triangle of a set in four, as the tetrahedra beside it are cut. A triangle that is no
  // face has no middles, and is dropped.
  void cut_triangle_sets() {
    for (auto& [name, set] : finer_.triangle_sets) {
      std::vector<std::array<int, 3>> finer;
      for (const auto& [a, b, c] : set) {
        const auto ab = middles_.find(edge_key(a, b)), bc = middles_.find(edge_key(b, c)),
                   ca = middles_.find(edge_key(c, a));
        if (ab == middles_.end() || bc == middles_.end() || ca == middles_.end()) continue;
        const int i = ab->second, j = bc->second, k = ca->second;
        finer.insert(finer.end(), {{a, i, k}, {i, b, j}, {k, j, c}, {i, j, k}});
      }
      set = std::move(finer);
    }
  }

  const TetMesh& mesh_;
  TetMesh finer_;
  std::unordered_map<std::uint64_t, int> middles_;
  std::vector<std::array<int, 2>> edges_;  // ends of the edge of each middle
};

double volume(const TetMesh& mesh) {
  double sum = 0;
  for (int t = 0; t < static_cast<int>(mesh.tets.size()); ++t) {
    const auto x = corners_of(mesh, t);
    sum += tet_volume(x[0], x[1], x[2], x[3]);
  }
  return sum;
}

}  // namespace

TetMesh refined(const TetMesh& mesh) {
  if (!mesh.piece.empty())
    throw InputError("a mesh with a part that is finer cannot be made finer as a whole");
  return Refinement(mesh).made();
}

bool is_refinement_of(const TetMesh& fine, const TetMesh& coarse) {
  if (fine.tets.size() != 8 * coarse.tets.size()) return false;
  if (std::abs(volume(fine) - volume(coarse)) > same_volume * volume(coarse)) return false;
  const Embedding in = embed(coarse.vertices, fine, Outside::clamp);
  return std::ranges::all_of(
             in.weights, [](const Weights& w) { return std::ranges::max(w) > 1 - same_place; }) &&
         in.largest_distance_over_edge < same_place;
}

}  // namespace plica
