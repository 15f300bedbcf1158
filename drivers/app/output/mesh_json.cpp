// SPDX-License-Identifier: BSD-3-Clause
#include <nlohmann/json.hpp>
#include <plica/drivers/app/output/mesh_description.hpp>
#include <plica/meshes/boundary_triangles.hpp>

namespace plica::app {
namespace {

using Json = nlohmann::ordered_json;

Json range_json(const Range& range) { return {{"min", range.min}, {"mean", range.mean}, {"max", range.max}}; }

Json histogram_json(const Histogram& histogram) { return {{"bounds", histogram.bounds}, {"counts", histogram.counts}}; }

Json point_json(const Point& p) { return Json{p.x(), p.y(), p.z()}; }

Json box_json(const Box& box) { return {{"min", point_json(box.min)}, {"max", point_json(box.max)}}; }

Json worst_json(const MeshDescription& m) {
  Json worst = Json::array();
  for (std::size_t i = 0; i < m.quality.worst.size(); ++i) {
    const TetShape& s = m.quality.worst[i];
    const auto tet = static_cast<std::size_t>(s.tet);
    const auto& mesh = m.read.mesh;
    worst.push_back(
        {{"tet", s.tet},
         {"number", m.read.report.tet_tags[tet]},
         {"region", mesh.region.empty() ? "" : mesh.region_names[static_cast<std::size_t>(mesh.region[tet])]},
         {"volume", s.volume},
         {"height_ratio", s.height_ratio},
         {"smallest_angle", s.smallest_angle},
         {"largest_angle", s.largest_angle},
         {"critical_step", m.worst_bounds[i]},
         {"centroid", point_json(s.centroid)}});
  }
  return worst;
}

}  // namespace

std::string mesh_json(const MeshDescription& m) {
  const MeshQuality& q = m.quality;
  const MeshReport& report = m.read.report;
  Json regions = Json::array(), sets = Json::object();
  for (const RegionSize& region : q.regions)
    regions.push_back({{"name", region.name}, {"tets", region.tets}, {"volume", region.volume}});
  for (const auto& [name, vertices] : m.read.mesh.vertex_sets) sets[name] = vertices.size();
  const Json json = {{"file", m.file},
                     {"format", report.format},
                     {"vertices", q.vertices},
                     {"tets", q.tets},
                     {"boundary_triangles", q.boundary_triangles},
                     {"boundary_area", q.boundary_area},
                     {"volume", q.volume},
                     {"parts", q.parts},
                     {"duplicate_vertices", q.duplicate_vertices},
                     {"box", box_json(q.box)},
                     {"flipped", report.flipped},
                     {"unreferenced", report.unreferenced},
                     {"other_elements", report.other_elements},
                     {"skipped_sections", report.skipped_sections},
                     {"warnings", m.warnings},
                     {"regions", regions},
                     {"vertex_sets", sets},
                     {"material",
                      {{"model", m.material.model},
                       {"young_modulus", m.material.young_modulus},
                       {"poisson_ratio", m.material.poisson_ratio},
                       {"density", m.material.density}}},
                     {"critical_step", m.critical_step},
                     {"element_bound", m.element_bound},
                     {"edges", range_json(q.edges)},
                     {"height_ratios", range_json(q.height_ratios)},
                     {"dihedral_angles", range_json(q.dihedral_angles)},
                     {"height_ratio_counts", histogram_json(q.height_ratio_counts)},
                     {"dihedral_angle_counts", histogram_json(q.dihedral_angle_counts)},
                     {"worst", worst_json(m)}};
  return json.dump(2) + "\n";
}

std::string surface_json(const SurfaceDescription& s) {
  const TriangleSurface& surface = s.read.surface;
  const SurfaceReport& report = s.read.report;
  const Json json = {{"file", s.file},
                     {"format", report.format},
                     {"vertices", surface.vertices.size()},
                     {"triangles", surface.triangles.size()},
                     {"closed", report.closed()},
                     {"area", surface_area(surface)},
                     {"volume", report.closed() ? Json(enclosed_volume(surface)) : Json()},
                     {"parts", report.parts},
                     {"box", box_json(bounding_box(surface.vertices))},
                     {"edges", range_json(edge_range(surface))},
                     {"open_edges", report.open_edges},
                     {"crowded_edges", report.crowded_edges},
                     {"inconsistent_edges", report.inconsistent_edges},
                     {"unreferenced", report.unreferenced},
                     {"collapsed", report.collapsed},
                     {"repeated", report.repeated},
                     {"turned", report.turned},
                     {"warnings", s.warnings}};
  return json.dump(2) + "\n";
}

}  // namespace plica::app
