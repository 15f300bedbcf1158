// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <plica/drivers/run/simulation.hpp>
#include <plica/meshes/files/mesh_files.hpp>
#include <string>

#include "target.hpp"

namespace plica::fuzz {

using Host = Backend<double, Kokkos::DefaultHostExecutionSpace>;

// What is said of a failure, names of the mesh's regions in it
inline bool diagnosed(Simulation<Host>& simulation, const TetMesh& mesh) {
  const auto found = simulation.check();
  if (!found) return false;
  const std::string said = found->text();
  require(said.find(found->region) != std::string::npos, "a diagnosis without its region");
  if (!mesh.region.empty() && found->element >= 0)
    require(std::ranges::find(mesh.region_names, found->region) != mesh.region_names.end(),
            "a region that is none");
  return true;
}

// The mesh as a body whose options name its regions and groups: some steps, then all elements
// turned inside out
inline void step(const TetMesh& mesh) {
  Problem problem;
  problem.body.levels = {mesh};
  problem.body.material = {"neo_hookean", 1e5, 0.3, 1000};
  for (const std::string& name : mesh.region_names) problem.body.regions[name].density = 2000;
  if (!mesh.vertex_sets.empty())
    problem.body.fixed = {GroupSelection{mesh.vertex_sets.begin()->first}};
  problem.gravity = {0, 0, -9.81};
  Simulation<Host> simulation(problem);
  for (int n = 0; n < 3; ++n) {
    simulation.step();
    if (diagnosed(simulation, mesh)) return;
  }
  std::vector<Point> mirrored, still(mesh.vertices.size(), Point::Zero());
  for (const Point& p : mesh.vertices) mirrored.push_back({-2 * p.x(), 0, 0});
  simulation.set_state(mirrored, still);
  simulation.step();
  diagnosed(simulation, mesh);
}

// Bytes of a small mesh in MSH or, after a '#', VTK's legacy format
inline void run(std::string_view bytes) {
  if (!Kokkos::is_initialized()) Kokkos::initialize();  // the unit tests have
  try {
    const char* name = bytes.starts_with('#') ? "m.vtk" : "m.msh";
    const TetMesh mesh = read_mesh(FileBytes{name, std::string(bytes)});
    if (mesh.tets.size() <= 64) step(mesh);
  } catch (const InputError&) {
  }
}

inline constexpr Target run_targets[] = {{"run", run}};

}  // namespace plica::fuzz
