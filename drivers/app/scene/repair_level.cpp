// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <cmath>
#include <plica/drivers/app/output/terminal.hpp>
#include <plica/drivers/app/scene/repair_level.hpp>
#include <plica/drivers/elastic/element_bound.hpp>
#include <plica/drivers/elastic/materials.hpp>
#include <plica/meshes/reordering.hpp>
#include <plica/meshes/repair_mesh.hpp>

namespace plica::app {

namespace {

double step_of(TetMesh mesh, const MaterialOptions& material) {
  mesh.region.clear(), mesh.region_names.clear();
  const MaterialInfo& info = *find_material(material.model);
  return element_bound(mesh, {info.small_strains(parameter_values(info, material, {}))},
                       {material.density});
}

std::string shape_text(double ratio) {
  return std::isfinite(ratio) ? fmt::format("{:.3g}", ratio) : "without volume";
}

}  // namespace

TetMesh repaired(const TetMesh& mesh, MeshReport& report, const MaterialOptions& material,
                 std::vector<std::string>& changes) {
  MeshRepair repair = repair_mesh(mesh);
  const auto say = [&](int count, const std::string& noun, const std::string& rest) {
    if (count > 0) changes.push_back("repaired: " + counted(count, noun) + " " + rest);
  };
  say(report.collapsed, "tetrahedron", "that named a vertex twice dropped");
  say(report.repeated, "tetrahedron", "that repeated another dropped");
  say(repair.merged, "duplicate vertex", "merged");
  say(repair.parts, "loose part",
      fmt::format("dropped, of {}", counted(repair.loose_tets, "tetrahedron")));
  say(repair.peeled, "sliver", "on the boundary dropped");
  say(repair.moved, "move", "of inner vertices, to shape slivers better");
  say(repair.collapsed, "edge", "of slivers collapsed");
  say(repair.flat, "tetrahedron", "without volume dropped");
  const bool sliver = !std::isfinite(repair.worst_before);
  if (repair.changed())
    changes.push_back(
        fmt::format("repaired: worst longest edge / smallest height {} before, {} after; step of "
                    "the worst element alone {} "
                    "before, {} after",
                    shape_text(repair.worst_before), shape_text(repair.worst_after),
                    in_units(sliver ? 0.0 : step_of(mesh, material), "s"),
                    in_units(step_of(repair.mesh, material), "s")));
  report.vertex_tags = permuted(report.vertex_tags, repair.original_vertex);
  report.tet_tags = permuted(report.tet_tags, repair.original_tet);
  report.groups = renumbered(report.groups, repair.vertex);
  return std::move(repair.mesh);
}

}  // namespace plica::app
