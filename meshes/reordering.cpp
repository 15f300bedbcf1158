// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <compare>
#include <cstdint>
#include <numeric>
#include <plica/meshes/reordering.hpp>

namespace plica {

namespace {

constexpr int bits = 21;  // per axis: 63 in all

// Returns the number on the Hilbert curve of a cell of the cube with 2^21 cells along an edge (J.
// Skilling: Programming the Hilbert curve. AIP Conf. Proc. 707, 2004)
std::uint64_t hilbert_number(std::array<std::uint32_t, 3> x) {
  for (std::uint32_t q = 1u << (bits - 1); q > 1; q >>= 1) {
    const std::uint32_t p = q - 1;
    for (std::uint32_t& xi : x) {
      if (xi & q) {
        x[0] ^= p;
        continue;
      }
      const std::uint32_t exchanged = (x[0] ^ xi) & p;
      x[0] ^= exchanged, xi ^= exchanged;
    }
  }
  x[1] ^= x[0], x[2] ^= x[1];
  std::uint32_t turn = 0;
  for (std::uint32_t q = 1u << (bits - 1); q > 1; q >>= 1)
    if (x[2] & q) turn ^= q - 1;
  std::uint64_t number = 0;
  for (int b = bits - 1; b >= 0; --b)
    for (const std::uint32_t xi : x) number = number << 1 | ((xi ^ turn) >> b & 1u);
  return number;
}

std::uint64_t key_of(const Point& p, const Box& box, double size) {
  std::array<std::uint32_t, 3> cell;
  for (int a = 0; a < 3; ++a) {
    const double at = size > 0.0 ? (p[a] - box.min[a]) / size : 0.0;
    cell[static_cast<std::size_t>(a)] =
        at > 0.0 ? static_cast<std::uint32_t>(std::min(at, 1.0) * ((1u << bits) - 1)) : 0u;
  }
  return hilbert_number(cell);
}

std::vector<int> inverse(const std::vector<int>& order) {
  std::vector<int> back(order.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    back[static_cast<std::size_t>(order[i])] = static_cast<int>(i);
  return back;
}

Followers renumbered(const Followers& followers, const std::vector<int>& new_number) {
  const auto number_of = [&](int v) { return new_number[static_cast<std::size_t>(v)]; };
  std::vector<std::size_t> place(followers.vertex.size());
  std::iota(place.begin(), place.end(), std::size_t{0});
  std::sort(place.begin(), place.end(), [&](std::size_t a, std::size_t b) {
    return number_of(followers.vertex[a]) < number_of(followers.vertex[b]);
  });
  Followers result;
  for (const std::size_t i : place) {
    result.vertex.push_back(number_of(followers.vertex[i]));
    result.weight.push_back(followers.weight[i]);
    auto& masters = result.of.emplace_back(followers.of[i]);
    for (int& v : masters) v = number_of(v);
  }
  return result;
}

}  // namespace

std::vector<int> tets_along_curve(const TetMesh& mesh) {
  const Box box = bounding_box(mesh.vertices);
  const double size = (box.max - box.min).maxCoeff();
  struct Place {
    std::uint64_t key;
    int tet;
    auto operator<=>(const Place&) const = default;
  };
  std::vector<Place> places;
  places.reserve(mesh.tets.size());
  for (const auto& tet : mesh.tets) {
    Point centroid = Point::Zero();
    for (const int v : tet) centroid += mesh.vertices[static_cast<std::size_t>(v)] / 4.0;
    places.push_back({key_of(centroid, box, size), static_cast<int>(places.size())});
  }
  if (!std::ranges::is_sorted(places)) std::ranges::sort(places);
  std::vector<int> tets;
  tets.reserve(places.size());
  for (const Place& place : places) tets.push_back(place.tet);
  return tets;
}

Reordering locality_order(const TetMesh& mesh) {
  Reordering order;
  order.tets = tets_along_curve(mesh);
  std::vector<bool> taken(mesh.vertices.size(), false);
  const auto take = [&](int v) {
    if (!taken[static_cast<std::size_t>(v)]) order.vertices.push_back(v);
    taken[static_cast<std::size_t>(v)] = true;
  };
  for (const int t : order.tets)
    for (const int v : mesh.tets[static_cast<std::size_t>(t)]) take(v);
  // vertices of no tetrahedron come last
  for (std::size_t v = 0; v < taken.size(); ++v) take(static_cast<int>(v));
  return order;
}

Reordering inverse(const Reordering& order) {
  return {inverse(order.vertices), inverse(order.tets)};
}

TetMesh reordered(const TetMesh& mesh, const Reordering& order) {
  const std::vector<int> new_number = inverse(order.vertices);
  TetMesh result;
  result.vertices = permuted(mesh.vertices, order.vertices);
  result.tets = permuted(mesh.tets, order.tets);
  result.region = permuted(mesh.region, order.tets);
  result.filled = permuted(mesh.filled, order.tets);
  result.region_names = mesh.region_names;
  for (const auto& [name, vectors] : mesh.tet_vectors)
    result.tet_vectors[name] = permuted(vectors, order.tets);
  result.vertex_sets = mesh.vertex_sets;
  for (auto& tet : result.tets)
    for (int& v : tet) v = new_number[static_cast<std::size_t>(v)];
  for (auto& [name, set] : result.vertex_sets) {
    for (int& v : set) v = new_number[static_cast<std::size_t>(v)];
    std::sort(set.begin(), set.end());
  }
  result.triangle_sets = mesh.triangle_sets;
  for (auto& [name, set] : result.triangle_sets)
    for (auto& triangle : set)
      for (int& v : triangle) v = new_number[static_cast<std::size_t>(v)];
  result.piece = permuted(mesh.piece, order.tets);
  result.inner_faces = mesh.inner_faces;
  for (auto& face : result.inner_faces) {
    for (int& v : face) v = new_number[static_cast<std::size_t>(v)];
    std::sort(face.begin(), face.end());
  }
  std::sort(result.inner_faces.begin(), result.inner_faces.end());
  result.followers = renumbered(mesh.followers, new_number);
  return result;
}

double mean_vertex_span(const TetMesh& mesh) {
  double sum = 0.0;
  for (const auto& tet : mesh.tets) {
    const auto [least, most] = std::minmax_element(tet.begin(), tet.end());
    sum += *most - *least;
  }
  return mesh.tets.empty() ? 0.0 : sum / static_cast<double>(mesh.tets.size());
}

}  // namespace plica
