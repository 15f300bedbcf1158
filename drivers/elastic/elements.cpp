// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <plica/core/row_ranges.hpp>
#include <plica/drivers/elastic/elements.hpp>
#include <plica/drivers/elastic/materials.hpp>
#include <plica/meshes/boundary_triangles.hpp>

namespace plica {

std::vector<Choice> elements() {
  return {{"linear",
           "tetrahedra of constant strain: cheap to understand, too stiff in bending and near nu = "
           "0.5"},
          {"nodal",
           "a strain per vertex, averaged over its tetrahedra and stabilised: true at tissue's nu"},
          {"auto", "nodal"}};
}

std::vector<Choice> pressures() {
  return {{"auto", "smoothed where nu is above 0.49, else plain"},
          {"plain", "of each vertex's own volume"},
          {"smoothed", "of volumes averaged over neighbours, beyond lambda = 2 mu"}};
}

Element element_of(const Body& body, std::size_t level) {
  const std::string& name = body.element.size() == 1 ? body.element.front() : body.element[level];
  return name == "linear" ? Element::linear : Element::nodal;
}

const char* name_of(Element element) { return element == Element::linear ? "linear" : "nodal"; }

double poisson_ratio(const Lame<double>& lame) {
  return lame.lambda / (2 * (lame.lambda + lame.mu));
}

bool smooths_pressure(const Body& body, const std::vector<Lame<double>>& of_regions) {
  if (body.pressure != "auto") return body.pressure == "smoothed";
  const MaterialInfo* material = find_material(body.material.model);
  if (!material || !material->smooths_dilatation) return false;
  return std::ranges::any_of(of_regions,
                             [](const Lame<double>& lame) { return poisson_ratio(lame) > 0.49; });
}

double bending_ratio(Element element, double poisson_ratio, double across) {
  const double lambda_over_mu = 2 * poisson_ratio / (1 - 2 * poisson_ratio);
  const double c = element == Element::linear ? 3.5 + 0.7 * lambda_over_mu
                                              : 0.45 + 0.006 * std::min(lambda_over_mu, 50.0);
  return 1 / (1 + c / (across * across));
}

double elements_across(const TetMesh& mesh) {
  const BoundarySurface boundary = boundary_surface(mesh);
  const double surface = surface_area(boundary.surface);
  const double inside = 1 - static_cast<double>(boundary.mesh_vertex.size()) /
                                static_cast<double>(mesh.vertices.size());
  double volume = 0;
  const auto x = [&](int v) -> const Point& { return mesh.vertices[static_cast<std::size_t>(v)]; };
  for (const auto& t : mesh.tets) volume += tet_volume(x(t[0]), x(t[1]), x(t[2]), x(t[3]));
  const double by_volume =
      4 * volume / surface / std::cbrt(6 * volume / static_cast<double>(mesh.tets.size()));
  return std::max(by_volume, (1 + std::sqrt(inside)) / (1 - std::sqrt(inside)));
}

double part_one_across(const TetMesh& mesh) {
  constexpr int none = -1, on_surface = -2;
  std::vector<int> region_of(mesh.vertices.size(), none);
  for (const int v : boundary_surface(mesh).mesh_vertex) region_of[index_of(v)] = on_surface;
  for (std::size_t e = 0; e < mesh.tets.size(); ++e)
    for (const int v : mesh.tets[e]) {
      int& region = region_of[index_of(v)];
      const int own = mesh.region.empty() ? 0 : mesh.region[e];
      region = region == none || region == own ? own : on_surface;
    }
  double thin = 0, all = 0;
  for (const auto& t : mesh.tets) {
    const auto x = [&](std::size_t k) -> const Point& { return mesh.vertices[index_of(t[k])]; };
    const double volume = tet_volume(x(0), x(1), x(2), x(3));
    all += volume;
    if (std::ranges::all_of(t, [&](int v) { return region_of[index_of(v)] == on_surface; }))
      thin += volume;
  }
  return thin / all;
}

}  // namespace plica
