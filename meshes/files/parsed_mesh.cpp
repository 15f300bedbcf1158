// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <plica/core/error.hpp>
#include <plica/core/text.hpp>
#include <plica/meshes/files/parsed_mesh.hpp>
#include <plica/meshes/files/validated_mesh.hpp>
#include <plica/meshes/mesh_quality.hpp>
#include <sstream>
#include <string>

namespace plica {

Point RawVectors::at(std::int64_t tag) const {
  if (place.empty()) return values[static_cast<std::size_t>(tag)];
  const auto found = place.find(tag);
  return found == place.end() ? Point(Point::Zero()) : values[found->second];
}

void RawNumbers::add(double value, const Place& where) {
  if (!wrong.empty()) return;
  constexpr double most = 9e18;  // an integer of 64 bits
  if (std::abs(value) <= most && value == std::floor(value))
    values.push_back(static_cast<std::int64_t>(value));
  else
    wrong = number(value), place = where;
}

VertexNumbers::VertexNumbers(const ParsedMesh& raw) : raw_(raw) {
  const std::string& file = raw.vertex_file.empty() ? raw.file : raw.vertex_file;
  index_.reserve(raw.vertices.size());
  for (std::size_t v = 0; v < raw.vertices.size(); ++v) {
    const RawVertex& vertex = raw.vertices[v];
    const auto who = [&] { return "node " + std::to_string(vertex.tag); };
    if (!vertex.position.allFinite()) {
      std::ostringstream where;
      where << vertex.position.transpose();
      refuse(file, vertex.place, who() + " is at " + where.str() + "; it must be finite");
    }
    const auto [first, is_new] = index_.try_emplace(vertex.tag, static_cast<int>(v));
    if (is_new) continue;
    const std::string before = to_text(raw.vertices[static_cast<std::size_t>(first->second)].place);
    refuse(file, vertex.place,
           who() + " is defined again" + (before.empty() ? "" : " (first " + before + ")"));
  }
}

int VertexNumbers::at(std::int64_t tag, const Place& place,
                      const std::function<std::string()>& who) const {
  const int found = find(tag);
  if (found < 0)
    refuse(raw_.file, place,
           who() + " names node " + std::to_string(tag) + ", which the file does not define");
  return found;
}

int VertexNumbers::find(std::int64_t tag) const {
  const auto found = index_.find(tag);
  return found == index_.end() ? -1 : found->second;
}

const ElementKind& taken_kind(std::span<const ElementKind> kinds, std::int64_t type,
                              const std::function<std::string()>& who, const std::string& file,
                              const Place& place) {
  const auto kind = std::find_if(kinds.begin(), kinds.end(),
                                 [&](const ElementKind& k) { return k.type == type; });
  if (kind != kinds.end() && kind->corners != not_taken) return *kind;
  refuse(file, place,
         who() + " has type " + std::to_string(type) +
             (kind != kinds.end() ? ", a " + std::string(kind->name) : "") +
             "; supported are tetrahedra, hexahedra, prisms, pyramids and elements of lower "
             "dimension");
}

void BadFaces::add(const Place& where, const std::string& what) {
  if (count++ == 0) place = where, message = what;
}

MeshGroups renumbered(const MeshGroups& groups, const std::vector<int>& renumbered) {
  MeshGroups result = groups;
  for (ElementGroup& group : result.sets) {
    const auto corners = static_cast<std::size_t>(group.dimension) + 1;
    std::erase_if(group.elements, [&](std::array<int, 3>& element) {
      for (std::size_t k = 0; k < corners; ++k) {
        element[k] = renumbered[static_cast<std::size_t>(element[k])];
        if (element[k] < 0 || std::count(element.begin(), element.begin() + k, element[k]) > 0)
          return true;
      }
      return false;
    });
  }
  return result;
}

namespace {

// Returns per vertex the one that replaces it: the lowest along a chain of duplicates
std::vector<std::int64_t> representatives(const TetMesh& mesh, double tolerance) {
  std::vector<std::int64_t> stands_for;
  for (const int twin : lower_twins(mesh.vertices, tolerance)) {
    const auto self = static_cast<std::int64_t>(stands_for.size());
    stands_for.push_back(twin < 0 ? self : stands_for[static_cast<std::size_t>(twin)]);
  }
  return stands_for;
}

}  // namespace

MergedMesh merge_duplicates(const TetMesh& mesh, double tolerance) {
  if (!std::isfinite(tolerance) || tolerance < 0.0)
    throw InputError("the tolerance for duplicate vertices is " + std::to_string(tolerance) +
                     "; it must be finite and not below zero");
  const std::vector<std::int64_t> stands_for = representatives(mesh, tolerance);
  const auto of = [&](int v) { return stands_for[static_cast<std::size_t>(v)]; };
  ParsedMesh raw;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    if (stands_for[v] == static_cast<std::int64_t>(v))
      raw.vertices.push_back({stands_for[v], mesh.vertices[v], {}});
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const auto& [a, b, c, d] = mesh.tets[t];
    raw.tets.push_back({static_cast<std::int64_t>(t),
                        {of(a), of(b), of(c), of(d)},
                        mesh.region.empty() ? 0 : mesh.region[t],
                        {}});
  }
  raw.region_names = mesh.region_names;
  for (const double part : mesh.filled) raw.filled.values.emplace_back(part, 0, 0);
  for (const auto& [name, vectors] : mesh.tet_vectors)
    raw.vectors.push_back({name, false, vectors});
  for (const auto& [name, vertices] : mesh.vertex_sets)
    for (auto& group = raw.groups.emplace_back(RawGroup{name, 0, 0, {}}); const int v : vertices)
      group.elements.push_back({0, {of(v), 0, 0}, 0, {}});
  for (const auto& [name, triangles] : mesh.triangle_sets)
    for (auto& group = raw.groups.emplace_back(RawGroup{name, 2, 0, {}});
         const auto& [a, b, c] : triangles)
      group.elements.push_back({0, {of(a), of(b), of(c)}, 0, {}});

  MergedMesh result;
  MeshReport report;
  try {
    result.mesh = validated_mesh(raw, report);
  } catch (const InputError& error) {
    std::ostringstream text;
    text << "vertices at most " << tolerance << " m apart cannot be merged: " << error.what();
    throw InputError(text.str());
  }
  result.merged = static_cast<int>(mesh.vertices.size() - raw.vertices.size());
  result.original_vertex.assign(report.vertex_tags.begin(), report.vertex_tags.end());
  std::vector<int> place(mesh.vertices.size(), -1);
  for (std::size_t v = 0; v < result.original_vertex.size(); ++v)
    place[static_cast<std::size_t>(result.original_vertex[v])] = static_cast<int>(v);
  for (const std::int64_t one : stands_for)
    result.vertex.push_back(place[static_cast<std::size_t>(one)]);
  return result;
}

namespace {

using Quadrangle = std::array<int, 4>;  // corners, outward; a triangle has -1 at the end

// Returns the faces of a cell with a number of corners, as Gmsh, VTK and Medit number them
std::span<const Quadrangle> faces_of(int corners) {
  static constexpr Quadrangle
      pyramid[] = {{0, 3, 2, 1}, {0, 1, 4, -1}, {1, 2, 4, -1}, {2, 3, 4, -1}, {3, 0, 4, -1}},
      prism[] = {{0, 2, 1, -1}, {3, 4, 5, -1}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}},
      hexahedron[] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                      {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
  if (corners == 5) return pyramid;
  if (corners == 6) return prism;
  return hexahedron;
}

using NodeTriple = std::array<std::int64_t, 3>;

// Cuts a face into triangles from its corner with the lowest number
std::vector<NodeTriple> cut_face(const Quadrangle& face, std::span<const std::int64_t> cell) {
  std::vector<std::int64_t> corners;
  for (const int k : face)
    if (k >= 0) corners.push_back(cell[static_cast<std::size_t>(k)]);
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  std::vector<NodeTriple> triangles;
  for (std::size_t k = 1; k + 1 < corners.size(); ++k)
    triangles.push_back({corners[0], corners[k], corners[k + 1]});
  return triangles;
}

bool names_twice(const std::array<std::int64_t, 4>& v) {
  for (std::size_t k = 1; k < 4; ++k)
    if (std::count(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(k), v[k]) > 0) return true;
  return false;
}

// Cuts a cell into tetrahedra. A cell may name a vertex twice, as a prism written as a hexahedron
// does; tetrahedra that would name one twice are left out.
void cut_cell(const ElementKind& kind, std::int64_t tag, std::span<const std::int64_t> corners,
              const Place& place, ParsedMesh& raw) {
  const std::size_t begin = raw.tets.size();
  const std::int64_t lowest = *std::min_element(corners.begin(), corners.end());
  for (const Quadrangle& face : faces_of(static_cast<int>(corners.size())))
    for (const NodeTriple& t : cut_face(face, corners)) {
      const std::array<std::int64_t, 4> tet = {t[0], t[2], t[1], lowest};
      if (!names_twice(tet)) raw.tets.push_back({tag, tet, 0, place});
    }
  if (raw.tets.size() == begin)
    refuse(raw.file, place,
           std::string(kind.name) + " " + std::to_string(tag) + " names too few vertices");
  raw.cut.insert(raw.cut.end(), {begin, raw.tets.size()});
}

}  // namespace

void add_face(std::int64_t tag, std::span<const std::int64_t> corners, const Place& place,
              ParsedMesh& raw) {
  if (corners.size() == 3)
    raw.triangles.push_back({tag, {corners[0], corners[1], corners[2]}, 0, place});
  else
    raw.polygons.push_back({tag, {corners.begin(), corners.end()}, place});
}

std::size_t add_element(const ElementKind& kind, std::int64_t tag,
                        std::span<const std::int64_t> vertices, const Place& place, ParsedMesh& raw,
                        MeshReport& report) {
  const auto corners =
      vertices.first(kind.corners > 0 ? static_cast<std::size_t>(kind.corners) : vertices.size());
  if (corners.size() < vertices.size()) ++report.linearised[kind.name];
  for (const std::int64_t v : vertices.subspan(corners.size())) raw.middles.push_back({v, place});
  if (kind.dimension < 3) {
    ++report.other_elements[kind.name];
    if (kind.dimension == 2)
      add_face(tag, corners, place, raw);
    else
      for (const std::int64_t v : corners) raw.others.push_back({v, place});
    return 0;
  }
  const std::size_t before = raw.tets.size();
  if (corners.size() == 4) {
    if (vertices.size() == 10 && kind.name != std::string_view("Bezier tetrahedron"))
      std::copy_n(
          vertices.begin() + 4, 6,
          raw.second_order.emplace_back(before, std::array<std::int64_t, 6>{}).second.begin());
    raw.tets.push_back({tag, {corners[0], corners[1], corners[2], corners[3]}, 0, place});
  } else {
    ++report.cut[kind.name];
    cut_cell(kind, tag, corners, place, raw);
  }
  return raw.tets.size() - before;
}

void add_to_group(const ElementKind& kind, std::int64_t tag, std::span<const std::int64_t> vertices,
                  const Place& place, RawGroup& group) {
  std::vector<std::int64_t> v(vertices.begin(), vertices.begin() + kind.corners);
  if (kind.dimension < 2) {
    group.elements.push_back({tag, {v.front(), v.back(), v.back()}, 0, place});
    return;
  }
  std::rotate(v.begin(), std::min_element(v.begin(), v.end()), v.end());
  for (std::size_t k = 1; k + 1 < v.size(); ++k)
    group.elements.push_back({tag, {v[0], v[k], v[k + 1]}, 0, place});
}

}  // namespace plica
