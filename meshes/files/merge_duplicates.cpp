// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <plica/core/error.hpp>
#include <plica/meshes/files/raw_mesh.hpp>
#include <plica/meshes/files/sound_mesh.hpp>
#include <plica/meshes/mesh_quality.hpp>
#include <sstream>

namespace plica {

namespace {

// Per vertex the one that stands for it
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
  RawMesh raw;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    if (stands_for[v] == static_cast<std::int64_t>(v)) raw.vertices.push_back({stands_for[v], mesh.vertices[v], {}});
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const auto& [a, b, c, d] = mesh.tets[t];
    raw.tets.push_back(
        {static_cast<std::int64_t>(t), {of(a), of(b), of(c), of(d)}, mesh.region.empty() ? 0 : mesh.region[t], {}});
  }
  raw.region_names = mesh.region_names;
  for (const auto& [name, vectors] : mesh.tet_vectors) raw.vectors.push_back({name, false, vectors});
  for (const auto& [name, vertices] : mesh.vertex_sets)
    for (auto& group = raw.groups.emplace_back(RawGroup{name, 0, 0, {}}); const int v : vertices)
      group.elements.push_back({0, {of(v), 0, 0}, 0, {}});

  MergedMesh result;
  MeshReport report;
  try {
    result.mesh = sound_mesh(raw, report);
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
  for (const std::int64_t one : stands_for) result.vertex.push_back(place[static_cast<std::size_t>(one)]);
  return result;
}

}  // namespace plica
