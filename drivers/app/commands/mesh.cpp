// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <iostream>
#include <plica/drivers/app/commands/commands.hpp>
#include <plica/drivers/app/commands/mesh_output.hpp>
#include <plica/drivers/app/commands/session.hpp>
#include <plica/drivers/app/output/mesh_description.hpp>
#include <plica/drivers/app/output/terminal.hpp>
#include <plica/drivers/app/output/write_file.hpp>
#include <plica/drivers/app/scene/describe.hpp>
#include <plica/drivers/app/scene/load_scene.hpp>
#include <plica/drivers/app/scene/reader.hpp>
#include <plica/drivers/elastic/element_bound.hpp>
#include <plica/drivers/elastic/materials.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/files/file_bytes.hpp>
#include <plica/meshes/files/list.hpp>
#include <plica/meshes/files/mesh_files.hpp>
#include <plica/meshes/files/validated_mesh.hpp>
#include <sstream>

namespace plica::app {

namespace {

double bound_of(const TetMesh& mesh, int tet, const MaterialOptions& material) {
  TetMesh alone;
  for (const int v : mesh.tets[static_cast<std::size_t>(tet)])
    alone.vertices.push_back(mesh.vertices[static_cast<std::size_t>(v)]);
  alone.tets = {{0, 1, 2, 3}};
  const MaterialInfo& info = *find_material(material.model);
  return element_bound(alone, {info.small_strains(parameter_values(info, material, {}))},
                       {material.density});
}

// Finds the critical step and the element bounds, as a run of this mesh alone would
void find_steps(MeshDescription& m, const KokkosArguments& kokkos) {
  Problem problem;
  problem.body.levels = {m.read.mesh};
  problem.body.material = m.material;
  const KokkosSession session(kokkos);
  const Simulation<Backend<double, Kokkos::DefaultExecutionSpace>> simulation(problem);
  m.critical_step = simulation.levels().front().critical_step;
  m.element_bound = simulation.levels().front().element_bound;
  for (const TetShape& shape : m.quality.worst)
    m.worst_bounds.push_back(bound_of(m.read.mesh, shape.tet, m.material));
}

std::string info_of(ReadMesh& read, double scale, const MaterialOptions& material,
                    const MeshInfoArguments& arguments) {
  for (Point& p : read.mesh.vertices) p *= scale;
  MeshDescription m;
  m.file = arguments.file.string(), m.read = std::move(read), m.material = material;
  m.quality = mesh_quality(m.read.mesh);
  m.warnings = mesh_warnings(m.read.mesh, m.read.report);
  find_steps(m, arguments.kokkos);
  return arguments.json ? mesh_json(m) : mesh_text(m);
}

std::string info_of(ReadSurface& read, double scale, const MaterialOptions&,
                    const MeshInfoArguments& arguments) {
  if (!arguments.material.empty())
    throw InputError(option_of(arguments.material.begin()->first) +
                         ": this file holds a surface, which has no material",
                     {arguments.file});
  for (Point& p : read.surface.vertices) p *= scale;
  SurfaceDescription s = {arguments.file.string(), std::move(read), {}};
  s.warnings = surface_warnings(s.read.report);
  return arguments.json ? surface_json(s) : surface_text(s);
}

}  // namespace

ReadOptions read_options_of(const ReadArguments& arguments, Flaws flaws) {
  ReadOptions options{.flaws = flaws, .regions = arguments.regions};
  options.leave_out = left_out_by(arguments);
  if (!arguments.order.empty()) {
    std::string order;
    read_option("--order", arguments.order, Name{"order", second_orders}, order);
    options.order = second_order_named(order);
  }
  if (!arguments.weld.empty())
    read_option("--weld", arguments.weld, Quantity{plain, not_negative}, options.weld);
  return options;
}

std::vector<std::string> left_out_by(const ReadArguments& arguments) {
  std::vector<std::string> names;
  std::istringstream list(arguments.leave_out);
  for (std::string name; std::getline(list, name, ',');) {
    name.erase(0, name.find_first_not_of(' '));
    name.erase(name.find_last_not_of(' ') + 1);
    if (name.empty())
      throw InputError("--leave-out: expected names or numbers between commas, got '" +
                       arguments.leave_out + "'");
    names.push_back(name);
  }
  return names;
}

void refuse_options(const std::vector<std::pair<std::string, std::string>>& given,
                    const std::string& why, const std::filesystem::path& file) {
  for (const auto& [option, value] : given)
    if (!value.empty()) throw InputError(option + " " + why, {file.string()});
}

namespace {

// Refuses options that do not belong to what the file holds
std::variant<ReadMesh, ReadSurface> read_chosen(const std::filesystem::path& file,
                                                const ReadArguments& arguments) {
  auto read = read_any(file, read_options_of(arguments));
  if (std::holds_alternative<ReadMesh>(read))
    refuse_options({{"--weld", arguments.weld}}, "is for surfaces of triangles", file);
  else
    refuse_options({{"--regions", arguments.regions},
                    {"--leave-out", arguments.leave_out},
                    {"--order", arguments.order}},
                   "is for meshes of tetrahedra", file);
  return read;
}

}  // namespace

ExitStatus mesh_info(const MeshInfoArguments& arguments) {
  double scale = 1;
  read_option("--scale", arguments.scale, Quantity{plain, positive}, scale);
  MaterialOptions material;
  read_options(arguments.material, material);
  auto read = read_chosen(arguments.file, arguments.read);
  std::cout << std::visit([&](auto& one) { return info_of(one, scale, material, arguments); },
                          read);
  return ExitStatus::done;
}

namespace {

struct ConvertNumbers {
  double scale = 1;
  std::optional<double> merge_duplicates;
};

ConvertNumbers numbers_of(const ConvertArguments& arguments) {
  ConvertNumbers numbers;
  read_option("--scale", arguments.scale, Quantity{plain, positive}, numbers.scale);
  if (arguments.merge_duplicates)
    read_option("--merge-duplicates", *arguments.merge_duplicates, Quantity{length, not_negative},
                numbers.merge_duplicates.emplace());
  return numbers;
}

bool is_surface_file(const std::filesystem::path& file) {
  return std::ranges::any_of(surface_writers,
                             [&](const auto& one) { return extension_of(file) == one.extension; });
}

void check_extension(const std::filesystem::path& file) {
  struct Known {
    const char* extension;
  };
  std::vector<Known> known;
  for (const auto& writer : mesh_writers) known.push_back({writer.extension});
  for (const auto& writer : surface_writers) known.push_back({writer.extension});
  format_of(file, known, "mesh or surface");
}

WrittenMesh converted(ReadMesh& read, const ConvertArguments& arguments,
                      const ConvertNumbers& numbers) {
  for (Point& p : read.mesh.vertices) p *= numbers.scale;
  if (numbers.merge_duplicates) {
    MergedMesh merged = merge_duplicates(read.mesh, *numbers.merge_duplicates);
    message(fmt::format("{}: merged {} duplicate vertices", arguments.in.string(), merged.merged));
    read.mesh = std::move(merged.mesh);
    read.report.groups = renumbered(read.report.groups, merged.vertex);
  }
  // A scale that is given may make other units than metres
  warn(arguments.in, mesh_warnings(read.mesh, read.report, numbers.scale == 1));
  for (const auto& [kind, count] : read.report.other_elements)
    if (kind != "point")
      warn(arguments.in, {counted(count, kind) + " left out, but for their groups"});
  if (!is_surface_file(arguments.out))
    return write_mesh(arguments.out, read.mesh, arguments.format, arguments.binary,
                      read.report.groups);
  WrittenMesh written = write_surface(arguments.out, boundary_surface(read.mesh).surface,
                                      arguments.format, arguments.binary);
  written.left_out.push_back(
      "this format holds triangles only, so the boundary of the mesh was written");
  return written;
}

WrittenMesh converted(ReadSurface& read, const ConvertArguments& arguments,
                      const ConvertNumbers& numbers) {
  if (numbers.merge_duplicates)
    throw InputError("--merge-duplicates is for meshes of tetrahedra", {arguments.in});
  for (Point& p : read.surface.vertices) p *= numbers.scale;
  warn(arguments.in, surface_warnings(read.report));
  return write_surface(arguments.out, read.surface, arguments.format, arguments.binary);
}

}  // namespace

ExitStatus mesh_convert(const ConvertArguments& arguments) {
  check_extension(arguments.out);
  const ConvertNumbers numbers = numbers_of(arguments);
  auto read = read_chosen(arguments.in, arguments.read);
  std::error_code none;
  if (std::holds_alternative<ReadMesh>(read) &&
      std::filesystem::equivalent(arguments.in, arguments.out, none))
    throw InputError(
        "this is the file that is read, and what it has beside its tetrahedra would be lost; "
        "expected another OUT",
        {arguments.out.string()});
  const WrittenMesh written =
      std::visit([&](auto& mesh) { return converted(mesh, arguments, numbers); }, read);
  write(arguments.out, written);
  return ExitStatus::done;
}

void warn(const std::filesystem::path& file, const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings)
    message(coloured("warning: ", Colour::yellow) + file.string() + ": " + warning);
}

void write(const std::filesystem::path& out, const WrittenMesh& written) {
  write_files(written.files);
  warn(out, written.left_out);
  for (const FileBytes& file : written.files)
    std::cout << fmt::format("{}: {}\n", file.name, in_bytes(file.bytes.size()));
}

std::string written_formats_text() {
  std::vector<std::vector<std::string>> rows;
  const auto add = [&](const auto& writers) {
    for (const auto& writer : writers) {
      const bool has_text = !rows.empty() && rows.back()[1] == writer.name;
      rows.push_back({"." + std::string(writer.extension), writer.name,
                      writer.binary && has_text ? "--binary" : "", writer.description});
    }
  };
  add(mesh_writers), add(surface_writers);
  return text_table(rows, "<<<<");
}

}  // namespace plica::app
