// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <plica/drivers/app/output/columns.hpp>
#include <plica/drivers/app/output/json_parts.hpp>
#include <plica/drivers/app/output/mesh_description.hpp>
#include <plica/drivers/app/output/terminal.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/mesh_quality.hpp>

namespace plica::app {

namespace {

using Json = nlohmann::ordered_json;

Json range_json(const Range& range) {
  return {{"min", range.min}, {"mean", range.mean}, {"max", range.max}};
}

Json histogram_json(const Histogram& histogram) {
  return {{"bounds", histogram.bounds}, {"counts", histogram.counts}};
}

Json point_json(const Point& p) { return Json{p.x(), p.y(), p.z()}; }

Json box_json(const Box& box) {
  return {{"min", point_json(box.min)}, {"max", point_json(box.max)}};
}

std::string at(const Point& p) {
  return fmt::format("[{:.4g}, {:.4g}, {:.4g}] m", p.x(), p.y(), p.z());
}

// Badly shaped tetrahedron
struct WorstTet : TetShape {
  std::int64_t file_number = 0;
  std::string region;
  double critical_step = 0;  // critical step of the element alone [s]
};

std::vector<WorstTet> worst_of(const MeshDescription& m) {
  std::vector<WorstTet> worst;
  const TetMesh& mesh = m.read.mesh;
  for (std::size_t i = 0; i < m.quality.worst.size(); ++i) {
    const auto tet = static_cast<std::size_t>(m.quality.worst[i].tet);
    worst.push_back(
        {m.quality.worst[i], m.read.report.tet_tags[tet],
         mesh.region.empty() ? "" : mesh.region_names[static_cast<std::size_t>(mesh.region[tet])],
         m.worst_bounds[i]});
  }
  return worst;
}

Table<WorstTet> worst_columns(bool regions) {
  return {{"tet", &WorstTet::tet},
          {"number", &WorstTet::file_number, {"tetrahedron", "{}"}},
          {"region", &WorstTet::region, regions ? Shown{"region"} : Shown{}},
          {"volume", &WorstTet::volume},
          {"height_ratio", &WorstTet::height_ratio, {"edge / height", "{:.3g}"}},
          {"smallest_angle", &WorstTet::smallest_angle},
          {"largest_angle", &WorstTet::largest_angle},
          {"",
           [](const WorstTet& t) {
             return fmt::format("{:.1f} - {:.1f} deg", t.smallest_angle, t.largest_angle);
           },
           {"angles between faces", "{}"}},
          {"critical_step", &WorstTet::critical_step, {"step alone", "s"}},
          {"centroid", [](const WorstTet& t) { return point_json(t.centroid); }},
          {"", [](const WorstTet& t) { return at(t.centroid); }, {"at"}}};
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
                     {"material", material_json(*find_material(m.material.model), m.material)},
                     {"critical_step", m.critical_step},
                     {"element_bound", m.element_bound},
                     {"edges", range_json(q.edges)},
                     {"height_ratios", range_json(q.height_ratios)},
                     {"dihedral_angles", range_json(q.dihedral_angles)},
                     {"height_ratio_counts", histogram_json(q.height_ratio_counts)},
                     {"dihedral_angle_counts", histogram_json(q.dihedral_angle_counts)},
                     {"worst", worst_columns(true).json(worst_of(m))}};
  return json_text(json);
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
  return json_text(json);
}

namespace {

using Rows = std::vector<std::vector<std::string>>;

std::string spread(const Range& range) {
  return fmt::format("{:.3g} / {:.3g} / {:.3g}", range.min, range.mean, range.max);
}

std::string lengths(const Range& range) {
  return in_units(range.min, "m") + " / " + in_units(range.mean, "m") + " / " +
         in_units(range.max, "m");
}

void add_box(const Box& box, Rows& rows) {
  const Point size = box.max - box.min;
  rows.push_back({"box", at(box.min) + " to " + at(box.max)});
  rows.push_back({"", fmt::format("{} x {} x {}", in_units(size.x(), "m"), in_units(size.y(), "m"),
                                  in_units(size.z(), "m"))});
}

std::string warnings_text(const std::vector<std::string>& warnings) {
  std::string text;
  for (const std::string& warning : warnings) text += "  " + warning + "\n";
  return text.empty() ? "" : "\nWarnings\n" + text;
}

std::string facts_text(const MeshDescription& m) {
  const MeshQuality& q = m.quality;
  Rows rows = {
      {"format", m.read.report.format},
      {"vertices", std::to_string(q.vertices)},
      {"tetrahedra", std::to_string(q.tets)},
      {"boundary", fmt::format("{} triangles, {:.4g} m^2", q.boundary_triangles, q.boundary_area)},
      {"volume", fmt::format("{:.4g} m^3 in {}", q.volume, counted(q.parts, "connected part"))}};
  add_box(q.box, rows);
  for (const auto& [kind, count] : m.read.report.other_elements)
    rows.push_back({"not used", counted(count, kind)});
  return text_table(rows, "<<");
}

std::string groups_text(const MeshDescription& m) {
  Rows rows;
  for (const RegionSize& region : m.quality.regions)
    if (!region.name.empty())
      rows.push_back({region.name, "region", fmt::format("{} tetrahedra", region.tets),
                      fmt::format("{:.4g} m^3", region.volume)});
  for (const auto& [name, vertices] : m.read.mesh.vertex_sets)
    rows.push_back(
        {name, "vertices",
         fmt::format("{} {}", vertices.size(), vertices.size() == 1 ? "vertex" : "vertices"), ""});
  return rows.empty() ? ""
                      : "\nGroups, by the names that a scene uses\n" + text_table(rows, "<<>>");
}

std::string steps_text(const MeshDescription& m) {
  return "\nLargest stable explicit step (symplectic_euler, without contact)\n" +
         text_table({{"material", material_text(*find_material(m.material.model), m.material)},
                     {"critical step", in_units(m.critical_step, "s")},
                     {"worst element alone", in_units(m.element_bound, "s") + ", a lower bound"}},
                    "<<");
}

std::string shapes_text(const MeshDescription& m) {
  const MeshQuality& q = m.quality;
  return "\nShape, smallest / mean / largest\n" +
         text_table({{"edges", lengths(q.edges)},
                     {"longest edge / smallest height", spread(q.height_ratios) + " (best: 1.22)"},
                     {"angles between faces", spread(q.dihedral_angles) + " deg (best: 70.5)"}},
                    "<<") +
         "\nThe worst, by their numbers in the file\n" +
         worst_columns(!m.read.mesh.region.empty()).text(worst_of(m));
}

std::string histogram_text(const std::string& title, const Histogram& histogram) {
  const int largest = *std::max_element(histogram.counts.begin(), histogram.counts.end());
  Rows rows;
  for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
    if (histogram.counts[i] == 0) continue;
    const auto length = static_cast<std::size_t>(40.0 * histogram.counts[i] / largest + 0.999);
    rows.push_back({fmt::format("{:g}", histogram.bounds[i]),
                    fmt::format("{:g}", histogram.bounds[i + 1]),
                    std::to_string(histogram.counts[i]), std::string(length, '#')});
  }
  return rows.empty() ? "" : "\n" + title + ", from and to\n" + text_table(rows, ">>><");
}

}  // namespace

std::string mesh_text(const MeshDescription& m) {
  return m.file + "\n" + facts_text(m) + warnings_text(m.warnings) + groups_text(m) +
         steps_text(m) + shapes_text(m) +
         histogram_text("Longest edge / smallest height", m.quality.height_ratio_counts) +
         histogram_text("Angles between faces [deg]", m.quality.dihedral_angle_counts);
}

std::string surface_text(const SurfaceDescription& s) {
  const TriangleSurface& surface = s.read.surface;
  const SurfaceReport& report = s.read.report;
  Rows rows = {{"format", report.format},
               {"vertices", std::to_string(surface.vertices.size())},
               {"triangles", std::to_string(surface.triangles.size())},
               {"closed", report.closed() ? "yes" : "no"},
               {"area", fmt::format("{:.4g} m^2 in {}", surface_area(surface),
                                    counted(report.parts, "connected part"))}};
  if (report.closed())
    rows.push_back({"volume", fmt::format("{:.4g} m^3", enclosed_volume(surface))});
  add_box(bounding_box(surface.vertices), rows);
  rows.push_back({"edges", lengths(edge_range(surface)) + " (smallest / mean / largest)"});
  return s.file + "\n" + text_table(rows, "<<") + warnings_text(s.warnings);
}

}  // namespace plica::app
