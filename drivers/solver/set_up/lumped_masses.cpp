// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/solver/set_up/lumped_masses.hpp>

namespace plica {

std::vector<double> region_densities(const Body& body, const TetMesh& mesh) {
  if (mesh.region.empty()) return {body.material.density};
  std::vector<double> density;
  for (const std::string& name : mesh.region_names) {
    const auto own = body.regions.find(name);
    density.push_back(own == body.regions.end() ? body.material.density
                                                : own->second.density.value_or(body.material.density));
  }
  return density;
}

std::vector<double> lumped_masses(const TetMesh& mesh, const std::vector<double>& density) {
  std::vector<double> mass(mesh.vertices.size(), 0);
  for (std::size_t e = 0; e < mesh.tets.size(); ++e) {
    const auto& t = mesh.tets[e];
    const auto x = [&](std::size_t k) -> const Point& { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
    const double of_tet = density[mesh.region.empty() ? 0 : static_cast<std::size_t>(mesh.region[e])];
    for (int v : t) mass[static_cast<std::size_t>(v)] += of_tet * tet_volume(x(0), x(1), x(2), x(3)) / 4;
  }
  return mass;
}

}  // namespace plica
