// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <plica/core/error.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/improve_shapes.hpp>
#include <plica/meshes/mesh_quality.hpp>
#include <plica/meshes/peel_slivers.hpp>
#include <plica/meshes/repair_mesh.hpp>
#include <set>

namespace plica {

namespace {

constexpr double same_place = 1e-6;  // of the mean edge
constexpr double loose_part = 0.01;  // of the volume
constexpr double flat_ratio = 1e8;   // height ratio that counts as no volume

double tet_volume_of(const TetMesh& mesh, const std::array<int, 4>& tet) {
  const auto at = [&](std::size_t k) -> const Point& { return mesh.vertices[static_cast<std::size_t>(tet[k])]; };
  return tet_volume(at(0), at(1), at(2), at(3));
}

std::array<int, 4> sorted(std::array<int, 4> tet) {
  std::sort(tet.begin(), tet.end());
  return tet;
}

// Keeps the tetrahedra that `keep` says, with their regions and numbers
template <class Keep>
void filter(TetMesh& mesh, std::vector<int>& original, const Keep& keep) {
  std::size_t kept = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (!keep(t)) continue;
    mesh.tets[kept] = mesh.tets[t], original[kept] = original[t];
    if (!mesh.region.empty()) mesh.region[kept] = mesh.region[t];
    for (auto& [name, vectors] : mesh.tet_vectors) vectors[kept] = vectors[t];
    ++kept;
  }
  mesh.tets.resize(kept), original.resize(kept);
  if (!mesh.region.empty()) mesh.region.resize(kept);
  for (auto& [name, vectors] : mesh.tet_vectors) vectors.resize(kept);
}

// Tetrahedra name the first of the vertices at a place; those that lose a corner by that, or repeat another, are dropped
void merge(MeshRepair& repair) {
  TetMesh& mesh = repair.mesh;
  const std::vector<int> twins = lower_twins(mesh.vertices, same_place * mean_edge_length(mesh));
  for (std::size_t v = 0; v < twins.size(); ++v)
    if (twins[v] >= 0) repair.vertex[v] = repair.vertex[static_cast<std::size_t>(twins[v])], ++repair.merged;
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
    volume[static_cast<std::size_t>(part[static_cast<std::size_t>(tet[0])])] += tet_volume_of(mesh, tet);
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

// Vertices of no tetrahedron go, from the sets too; a set gets the vertices that its own became
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
  filter(repair.mesh, repair.original_tet,
         [&](std::size_t t) { return height_ratio(repair.mesh, repair.mesh.tets[t]) < flat_ratio; });
  repair.flat = static_cast<int>(before - repair.mesh.tets.size());
  if (repair.mesh.tets.empty()) throw InputError("nothing is left of the mesh: no tetrahedron has a volume");
  renumber(repair);
  repair.worst_after = worst_of(repair.mesh);
  return repair;
}

}  // namespace plica
