// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/core/error.hpp>
#include <plica/drivers/solver/set_up/validate_mesh.hpp>

namespace plica {

void validate_mesh(const TetMesh& mesh, int level) {
  const auto refuse = [level](const std::string& what) {
    throw InputError("body.levels: level " + std::to_string(level) + what);
  };
  const int vertices = static_cast<int>(mesh.vertices.size()), regions = static_cast<int>(mesh.region_names.size());
  if (mesh.tets.empty()) refuse(" has no tetrahedron");
  for (int v = 0; v < vertices; ++v)
    if (!mesh.vertices[static_cast<std::size_t>(v)].allFinite())
      refuse(": vertex " + std::to_string(v) + " is not at a finite place");
  std::vector<char> used(mesh.vertices.size(), 0);
  for (std::size_t e = 0; e < mesh.tets.size(); ++e) {
    const auto& t = mesh.tets[e];
    for (int v : t) {
      if (v < 0 || v >= vertices)
        refuse(": tetrahedron " + std::to_string(e) + " has vertex " + std::to_string(v) + " of " +
               std::to_string(vertices));
      used[static_cast<std::size_t>(v)] = 1;
    }
    const auto x = [&](std::size_t k) -> const Point& { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
    if (!(tet_volume(x(0), x(1), x(2), x(3)) > 0))
      refuse(": tetrahedron " + std::to_string(e) + " is flat or inside out; expected a positive volume");
  }
  if (const auto unused = std::find(used.begin(), used.end(), 0); unused != used.end())
    refuse(": no tetrahedron has vertex " + std::to_string(unused - used.begin()));
  if (!mesh.region.empty() && mesh.region.size() != mesh.tets.size())
    refuse(" has regions for " + std::to_string(mesh.region.size()) + " of " + std::to_string(mesh.tets.size()) +
           " tetrahedra; expected all or none");
  for (std::size_t e = 0; e < mesh.region.size(); ++e)
    if (mesh.region[e] < 0 || mesh.region[e] >= regions)
      refuse(": tetrahedron " + std::to_string(e) + " is in region " + std::to_string(mesh.region[e]) + " of " +
             std::to_string(regions));
}

}  // namespace plica
