// SPDX-License-Identifier: BSD-3-Clause
#include <iostream>
#include <plica/drivers/app/commands/mesh_info.hpp>
#include <plica/drivers/app/commands/options.hpp>
#include <plica/drivers/app/commands/session.hpp>
#include <plica/drivers/app/output/mesh_description.hpp>
#include <plica/drivers/app/scene/describe.hpp>
#include <plica/drivers/app/scene/mesh_warnings.hpp>
#include <plica/drivers/solver/element_bound.hpp>

namespace plica::app {
namespace {

double bound_of(const TetMesh& mesh, int tet, const MaterialOptions& material) {
  TetMesh alone;
  for (const int v : mesh.tets[static_cast<std::size_t>(tet)])
    alone.vertices.push_back(mesh.vertices[static_cast<std::size_t>(v)]);
  alone.tets = {{0, 1, 2, 3}};
  return element_bound(alone, {lame_constants(material.young_modulus, material.poisson_ratio)}, {material.density});
}

// As a run of this mesh alone would find it
void find_steps(MeshDescription& m, const KokkosArguments& kokkos) {
  Problem problem;
  problem.body.levels = {m.read.mesh};
  problem.body.material = m.material;
  const KokkosSession session(kokkos);
  const Simulation<Backend<double, Kokkos::DefaultExecutionSpace>> simulation(problem);
  m.critical_step = simulation.levels().front().critical_step;
  m.element_bound = simulation.levels().front().element_bound;
  for (const TetShape& shape : m.quality.worst) m.worst_bounds.push_back(bound_of(m.read.mesh, shape.tet, m.material));
}

std::string info_of(ReadMesh& read, double scale, const MaterialOptions& material, const MeshInfoArguments& arguments) {
  for (Point& p : read.mesh.vertices) p *= scale;
  MeshDescription m;
  m.file = arguments.file.string(), m.read = std::move(read), m.material = material;
  m.quality = mesh_quality(m.read.mesh);
  m.warnings = mesh_warnings(m.read.mesh, m.read.report);
  find_steps(m, arguments.kokkos);
  return arguments.json ? mesh_json(m) : mesh_text(m);
}

std::string info_of(ReadSurface& read, double scale, const MaterialOptions&, const MeshInfoArguments& arguments) {
  if (!arguments.material.empty())
    throw InputError(
        option_of(arguments.material.begin()->first) + ": this file holds a surface, which has no material",
        {arguments.file});
  for (Point& p : read.surface.vertices) p *= scale;
  SurfaceDescription s = {arguments.file.string(), std::move(read), {}};
  s.warnings = surface_warnings(s.read.report);
  return arguments.json ? surface_json(s) : surface_text(s);
}

}  // namespace

ExitStatus mesh_info(const MeshInfoArguments& arguments) {
  double scale = 1;
  read_option("--scale", arguments.scale, Quantity{number, positive}, scale);
  MaterialOptions material;
  OptionReader reader(arguments.material);
  describe(reader, material);
  auto read = read_any(arguments.file);
  std::cout << std::visit([&](auto& one) { return info_of(one, scale, material, arguments); }, read);
  return ExitStatus::done;
}

}  // namespace plica::app
