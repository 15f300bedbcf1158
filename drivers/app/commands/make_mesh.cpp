// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <iostream>
#include <plica/drivers/app/commands/commands.hpp>
#include <plica/drivers/app/commands/fill_with_gmsh.hpp>
#include <plica/drivers/app/commands/mesh_output.hpp>
#include <plica/drivers/app/output/terminal.hpp>
#include <plica/drivers/app/scene/reader.hpp>
#include <plica/drivers/app/scene/repair_level.hpp>
#include <plica/meshes/files/list.hpp>
#include <plica/meshes/files/mesh_files.hpp>
#include <plica/meshes/lattice.hpp>

namespace plica::app {

namespace {

double scale_of(const MakeMeshArguments& arguments) {
  double scale = 1;
  read_option("--scale", arguments.scale, Quantity{plain, positive}, scale);
  return scale;
}

// Calls make() and adds the name of the file to an InputError that it throws
template <class Make>
auto placed(const std::filesystem::path& file, const Make& make) {
  try {
    return make();
  } catch (const InputError& error) {
    throw InputError(error.what(), {file.string()});
  }
}

TetMesh read_scaled(const MakeMeshArguments& arguments, MeshReport& report, Flaws flaws) {
  const double scale = scale_of(arguments);
  TetMesh mesh = read_mesh(arguments.in, &report, {.flaws = flaws});
  for (Point& p : mesh.vertices) p *= scale;
  return mesh;
}

ExitStatus write_new(const MakeMeshArguments& arguments, const TetMesh& mesh,
                     const MeshGroups& groups = {}) {
  write(arguments.out, write_mesh(arguments.out, mesh, "", false, groups));
  std::cout << fmt::format("{} vertices, {} tetrahedra\n", mesh.vertices.size(), mesh.tets.size());
  return ExitStatus::done;
}

// Returns a mesh of the inside of the surface, made by Gmsh. Falls back to a lattice if Gmsh is not
// installed or makes no mesh, unless the user has asked for one of the two
TetMesh filled(const TriangleSurface& surface, double size, const MakeMeshArguments& arguments) {
  check_cell_size(surface.vertices, size);
  double time_limit = 0;
  read_option("--time-limit", arguments.time_limit, Quantity{duration, positive}, time_limit);
  if (arguments.with == "lattice") return lattice_mesh(surface, size);
  std::string why = "there is no gmsh on PATH";
  if (has_gmsh()) {
    try {
      return fill_with_gmsh(surface, size, time_limit);
    } catch (const InputError& error) {
      why = error.what();
    }
  }
  if (arguments.with == "gmsh")
    throw InputError("--with gmsh: " + why + "; expected --with lattice");
  std::cout << why << "\na lattice of cubes instead, which does not fit the surface\n";
  return lattice_mesh(surface, size);
}

}  // namespace

ExitStatus mesh_repair(const MakeMeshArguments& arguments) {
  format_of(arguments.out, mesh_writers, "mesh");
  MeshReport report;
  std::vector<std::string> changes;
  const TetMesh mesh = read_scaled(arguments, report, Flaws::kept);
  const TetMesh result = placed(arguments.in, [&] { return repaired(mesh, report, {}, changes); });
  for (const std::string& change : changes) std::cout << change << "\n";
  if (changes.empty()) std::cout << "nothing to repair\n";
  warn(arguments.in, mesh_warnings(result, report));
  return write_new(arguments, result, report.groups);
}

ExitStatus mesh_fill(const MakeMeshArguments& arguments) {
  format_of(arguments.out, mesh_writers, "mesh");
  double size = 0;
  read_option("--size", arguments.size, Quantity{length, positive}, size);
  const double scale = scale_of(arguments);
  SurfaceReport report;
  TriangleSurface surface = read_surface(arguments.in, &report);
  if (!report.closed())
    throw InputError("the surface " + why_open(report), {arguments.in.string()});
  for (Point& p : surface.vertices) p *= scale;
  warn(arguments.in, surface_warnings(report));
  return write_new(arguments,
                   placed(arguments.in, [&] { return filled(surface, size, arguments); }));
}

ExitStatus mesh_coarsen(const MakeMeshArguments& arguments) {
  format_of(arguments.out, mesh_writers, "mesh");
  MeshReport report;
  const TetMesh mesh = read_scaled(arguments, report, Flaws::refused);
  warn(arguments.in, mesh_warnings(mesh, report));
  if (!mesh.vertex_sets.empty())
    warn(arguments.in, {counted(static_cast<long>(mesh.vertex_sets.size()), "vertex set") +
                        " left out: select by shape on this mesh"});
  return write_new(arguments,
                   placed(arguments.in, [&] { return coarse_lattice(mesh, arguments.vertices); }));
}

}  // namespace plica::app
