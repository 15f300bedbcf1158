// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>
#include <plica/drivers/app/commands/mesh_info.hpp>
#include <plica/drivers/app/output/terminal.hpp>
#include <plica/meshes/mesh_quality.hpp>
#include <plica/meshes/read_mesh.hpp>

namespace plica::app {
namespace {

using Json = nlohmann::ordered_json;
using Rows = std::vector<std::vector<std::string>>;

struct Mesh {
  TetMesh mesh;
  MeshReport report;
  MeshQuality quality;
};

std::string spread(const Range& range) {
  return fmt::format("{:.3g} / {:.3g} / {:.3g}", range.min, range.mean, range.max);
}

std::string facts_text(const Mesh& m) {
  const MeshQuality& q = m.quality;
  const Box& box = q.box;
  Rows rows = {{"format", m.report.format},
               {"vertices", std::to_string(q.vertices)},
               {"tetrahedra", std::to_string(q.tets)},
               {"boundary", fmt::format("{} triangles, {:.4g} m^2", q.boundary_triangles, q.boundary_area)},
               {"volume", fmt::format("{:.4g} m^3 in {}", q.volume, counted(q.parts, "connected part"))},
               {"from", fmt::format("[{:.4g}, {:.4g}, {:.4g}] m", box.min.x(), box.min.y(), box.min.z())},
               {"to", fmt::format("[{:.4g}, {:.4g}, {:.4g}] m", box.max.x(), box.max.y(), box.max.z())},
               {"mended", fmt::format("{} tetrahedra turned the right way round, {} unused vertices dropped",
                                      m.report.flipped, m.report.unreferenced)}};
  if (q.duplicate_vertices > 0)
    rows.push_back({"warning", fmt::format("{} vertices lie at the place of another: is the mesh torn there?",
                                           q.duplicate_vertices)});
  for (const auto& [kind, count] : m.report.other_elements)
    rows.push_back({"not used", fmt::format("{} {}", count, kind)});
  for (const std::string& section : m.report.skipped_sections) rows.push_back({"not read", section});
  return text_table(rows, "<<");
}

std::string groups_text(const Mesh& m) {
  Rows rows;
  for (const RegionSize& region : m.quality.regions)
    if (!region.name.empty())
      rows.push_back(
          {region.name, "region", fmt::format("{} tetrahedra", region.tets), fmt::format("{:.4g} m^3", region.volume)});
  for (const auto& [name, vertices] : m.mesh.vertex_sets)
    rows.push_back({name, "vertices", fmt::format("{} vertices", vertices.size()), ""});
  return rows.empty() ? "" : "\nGroups, by the names that a scene uses\n" + text_table(rows, "<<>>");
}

std::string shapes_text(const MeshQuality& q) {
  Rows worst = {{"tetrahedron", "longest edge / height", "angles", "at"}};
  for (const TetShape& shape : q.worst) {
    if (worst.size() > 3) break;
    worst.push_back(
        {std::to_string(shape.tet), fmt::format("{:.3g}", shape.height_ratio),
         fmt::format("{:.1f} - {:.1f} deg", shape.smallest_angle, shape.largest_angle),
         fmt::format("[{:.4g}, {:.4g}, {:.4g}]", shape.centroid.x(), shape.centroid.y(), shape.centroid.z())});
  }
  return "\nShape, smallest / mean / largest\n" +
         text_table({{"edges", spread(q.edges) + " m"},
                     {"longest edge / smallest height", spread(q.height_ratios) + " (best: 1.22)"},
                     {"angles between faces", spread(q.dihedral_angles) + " deg (best: 70.5)"}},
                    "<<") +
         "\nThe worst, counted from 0\n" + text_table(worst, ">>><");
}

std::string histogram_text(const std::string& title, const Histogram& histogram) {
  const int largest = *std::max_element(histogram.counts.begin(), histogram.counts.end());
  Rows rows;
  for (std::size_t i = 0; i < histogram.counts.size(); ++i) {
    if (histogram.counts[i] == 0) continue;
    const auto length = static_cast<std::size_t>(40.0 * histogram.counts[i] / largest + 0.999);
    rows.push_back({fmt::format("{:g}", histogram.bounds[i]), fmt::format("{:g}", histogram.bounds[i + 1]),
                    std::to_string(histogram.counts[i]), std::string(length, '#')});
  }
  return rows.empty() ? "" : "\n" + title + ", from and to\n" + text_table(rows, ">>><");
}

Json range_json(const Range& range) { return {{"min", range.min}, {"mean", range.mean}, {"max", range.max}}; }

Json histogram_json(const Histogram& histogram) { return {{"bounds", histogram.bounds}, {"counts", histogram.counts}}; }

Json json_of(const Mesh& m, const std::string& file) {
  const MeshQuality& q = m.quality;
  const auto point = [](const Point& p) { return Json{p.x(), p.y(), p.z()}; };
  Json regions = Json::array(), sets = Json::object(), worst = Json::array();
  for (const RegionSize& region : q.regions)
    regions.push_back({{"name", region.name}, {"tets", region.tets}, {"volume", region.volume}});
  for (const auto& [name, vertices] : m.mesh.vertex_sets) sets[name] = vertices.size();
  for (const TetShape& s : q.worst)
    worst.push_back({{"tet", s.tet},
                     {"volume", s.volume},
                     {"height_ratio", s.height_ratio},
                     {"smallest_angle", s.smallest_angle},
                     {"largest_angle", s.largest_angle},
                     {"centroid", point(s.centroid)}});
  return {{"file", file},
          {"format", m.report.format},
          {"vertices", q.vertices},
          {"tets", q.tets},
          {"boundary_triangles", q.boundary_triangles},
          {"boundary_area", q.boundary_area},
          {"volume", q.volume},
          {"parts", q.parts},
          {"duplicate_vertices", q.duplicate_vertices},
          {"box", {{"min", point(q.box.min)}, {"max", point(q.box.max)}}},
          {"flipped", m.report.flipped},
          {"unreferenced", m.report.unreferenced},
          {"other_elements", m.report.other_elements},
          {"skipped_sections", m.report.skipped_sections},
          {"regions", regions},
          {"vertex_sets", sets},
          {"edges", range_json(q.edges)},
          {"height_ratios", range_json(q.height_ratios)},
          {"dihedral_angles", range_json(q.dihedral_angles)},
          {"height_ratio_counts", histogram_json(q.height_ratio_counts)},
          {"dihedral_angle_counts", histogram_json(q.dihedral_angle_counts)},
          {"worst", worst}};
}

}  // namespace

ExitStatus mesh_info(const std::filesystem::path& file, bool json) {
  Mesh m;
  m.mesh = read_mesh(file, &m.report);
  m.quality = mesh_quality(m.mesh);
  if (json)
    std::cout << json_of(m, file.string()).dump(2) << "\n";
  else
    std::cout << file.string() << "\n"
              << facts_text(m) << groups_text(m) << shapes_text(m.quality)
              << histogram_text("Longest edge / smallest height", m.quality.height_ratio_counts)
              << histogram_text("Angles between faces [deg]", m.quality.dihedral_angle_counts);
  return ExitStatus::done;
}

}  // namespace plica::app
