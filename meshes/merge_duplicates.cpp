// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <plica/core/error.hpp>
#include <plica/meshes/connectivity.hpp>
#include <plica/meshes/merge_duplicates.hpp>
#include <plica/meshes/sound_mesh.hpp>
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
  for (const auto& [name, vertices] : mesh.vertex_sets)
    for (auto& mentions = raw.vertex_sets[name]; const int v : vertices) mentions.push_back({of(v), {}});

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
  return result;
}

}  // namespace plica
