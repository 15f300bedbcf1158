// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <plica/core/mesh.hpp>
#include <string_view>
#include <vector>

/// Readers on arbitrary bytes: they refuse them with an InputError, or what they return is sound.
namespace plica::fuzz {

struct Target {
  std::string_view name;  ///< of its folders in corpus/ and findings/, too
  void (*run)(std::string_view bytes);
};

inline void require(bool sound, const char* what) {
  if (sound) return;
  std::fprintf(stderr, "unsound: %s\n", what);
  std::abort();
}

inline void check(const TetMesh& mesh) {
  std::vector<bool> used(mesh.vertices.size(), false);
  for (const auto& tet : mesh.tets) {
    for (const int v : tet) used.at(static_cast<std::size_t>(v)) = true;
    const auto at = [&](std::size_t k) { return mesh.vertices[static_cast<std::size_t>(tet[k])]; };
    require(tet_volume(at(0), at(1), at(2), at(3)) > 0.0, "a tetrahedron without volume");
  }
  require(!mesh.tets.empty() && std::find(used.begin(), used.end(), false) == used.end(),
          "a vertex that is not used");
  require(mesh.region.empty() == mesh.region_names.empty(), "regions without names");
  for (const int region : mesh.region)
    require(region >= 0 && static_cast<std::size_t>(region) < mesh.region_names.size(),
            "a region out of range");
  for (const auto& [name, set] : mesh.vertex_sets) {
    require(std::is_sorted(set.begin(), set.end()), "a set that is not ascending");
    for (const int v : set)
      require(v >= 0 && static_cast<std::size_t>(v) < used.size(), "a vertex out of range");
  }
}

}  // namespace plica::fuzz
