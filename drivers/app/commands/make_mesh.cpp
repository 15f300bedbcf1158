// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <plica/drivers/app/commands/commands.hpp>
#include <plica/drivers/app/commands/fill_with_gmsh.hpp>
#include <plica/drivers/app/commands/mesh_output.hpp>
#include <plica/drivers/app/output/terminal.hpp>
#include <plica/drivers/app/scene/reader.hpp>
#include <plica/drivers/app/scene/repair_level.hpp>
#include <plica/meshes/files/label_files.hpp>
#include <plica/meshes/files/list.hpp>
#include <plica/meshes/files/mesh_files.hpp>
#include <plica/meshes/label_mesh.hpp>
#include <plica/meshes/lattice.hpp>
#include <set>

namespace plica::app {

namespace {

constexpr double noticed_volume = 0.1;  // relative error of a label's volume that is said

double scale_of(const MakeMeshArguments& arguments) {
  double scale = 1;
  if (!arguments.scale.empty())
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
  TetMesh mesh = read_mesh(arguments.in, &report, read_options_of(arguments.read, flaws));
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

// Unit of the lengths of an image
struct ImageUnit {
  double metres;
  const char* why;
};

ImageUnit unit_of_image(const LabelFile& read, const MakeMeshArguments& arguments) {
  if (!arguments.scale.empty()) return {scale_of(arguments), ""};
  if (read.unit > 0)
    return {read.unit,
            read.unit_is_said ? ", as the file says" : ", as is usual; --scale gives others"};
  const LabelImage& image = read.image;
  constexpr double largest_in_metres = 3;
  double extent = 0;
  for (int k = 0; k < 3; ++k)
    extent = std::max(extent, image.axes.col(k).norm() * image.size[static_cast<std::size_t>(k)]);
  return {extent > largest_in_metres ? 0.001 : 1,
          ", by the size of the image; --scale gives others"};
}

// Makes the labels 0 that are left out, by number or name
void leave_out(LabelImage& image, const MakeMeshArguments& arguments) {
  std::map<std::string, int> known;
  for (const int label : std::set<int>(image.labels.begin(), image.labels.end()))
    known[std::to_string(label)] = label;
  std::vector<std::string> choices;
  for (const auto& [number, label] : known) choices.push_back(number);
  for (const auto& [label, name] : image.names) known.try_emplace(name, label);
  std::set<int> out;
  for (const std::string& word : left_out_by(arguments.read)) {
    const auto found = known.find(word);
    if (found == known.end())
      throw InputError("--leave-out: " + unknown_name("label", word, choices),
                       {arguments.in.string()});
    out.insert(found->second);
  }
  for (int& label : image.labels)
    if (out.contains(label)) label = 0;
}

ExitStatus fill_image(const MakeMeshArguments& arguments, const FileBytes& file, double size) {
  refuse_options({{"--with", arguments.with}, {"--weld", arguments.read.weld}},
                 "is for surfaces; images are filled by a lattice of tetrahedra", arguments.in);
  LabelFile read = read_labels(file);
  LabelImage& image = read.image;
  const ImageUnit unit = unit_of_image(read, arguments);
  image.origin *= unit.metres, image.axes *= unit.metres;
  leave_out(image, arguments);
  const LabelMesh made = placed(arguments.in, [&] { return fill_labels(image, size); });
  std::cout << fmt::format("{}, {} x {} x {} voxels, lengths in units of {:g} mm{}\n", read.format,
                           image.size[0], image.size[1], image.size[2], 1000 * unit.metres,
                           unit.why);
  MeshReport report;
  report.groups.region_tags.assign(made.labels.begin(), made.labels.end());
  std::vector<std::string> warnings = mesh_warnings(made.mesh, report);
  for (const auto& [label, part] : made.filled_part)
    if (part == 0)
      warnings.push_back(fmt::format(
          "the label {} is lost: it is thinner than the tetrahedra; a smaller --size keeps it",
          label));
    else if (std::abs(part - 1) > noticed_volume)
      warnings.push_back(
          fmt::format("the label {} has {:.0f} % of the volume of its voxels; a "
                      "smaller --size comes closer",
                      label, 100 * part));
  warn(arguments.in, warnings);
  return write_new(arguments, made.mesh, report.groups);
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
  if (const FileBytes file = load_file(arguments.in); is_image(file))
    return fill_image(arguments, file, size);
  refuse_options({{"--leave-out", arguments.read.leave_out}}, "is for images of labels",
                 arguments.in);
  SurfaceReport report;
  TriangleSurface surface =
      read_surface(arguments.in, &report, read_options_of(arguments.read).weld);
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
