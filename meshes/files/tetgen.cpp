// SPDX-License-Identifier: BSD-3-Clause
#include <map>
#include <plica/meshes/files/file_bytes.hpp>
#include <plica/meshes/files/list.hpp>
#include <plica/meshes/files/reading.hpp>

namespace plica {

namespace {

constexpr NumberType integer = NumberType::int64, real = NumberType::float64;

std::int64_t between(std::int64_t value, std::int64_t least, std::int64_t most, const char* what,
                     const Numbers& numbers) {
  if (value < least || value > most)
    numbers.fail(std::string(what) + " is " + std::to_string(value) + "; it must be " +
                 std::to_string(least) + (least == most ? "" : " to " + std::to_string(most)));
  return value;
}

void check_end(TextLines& lines, std::int64_t count, const char* what) {
  if (lines.next())
    lines.expected("the end of the file after " + std::to_string(count) + " " + what);
}

void read_nodes(const FileBytes& file, ParsedMesh& raw) {
  TextLines lines(file, '#');
  TextNumbers numbers(lines);
  constexpr const char* heading =
      "the number of nodes, their dimension 3, their attributes and boundary markers";
  numbers.begin(heading, 0, 0);
  const std::int64_t count = numbers.count(integer, "the number of nodes", integer, 4);
  between(numbers.integer(integer, "the dimension"), 3, 3, "the dimension", numbers);
  const std::int64_t attributes = numbers.count(integer, "the number of attributes", integer, 1);
  const std::int64_t markers = between(numbers.integer(integer, "the number of markers"), 0, 1,
                                       "the number of boundary markers", numbers);
  numbers.end(heading);
  std::map<std::int64_t, RawGroup> groups;
  for (std::int64_t i = 1; i <= count; ++i) {
    numbers.begin("node", i, count);
    RawVertex vertex{numbers.integer(integer, "the number of a node"), {}, numbers.place()};
    constexpr const char* what[] = {"coordinate x", "coordinate y", "coordinate z"};
    for (int a = 0; a < 3; ++a) vertex.position[a] = numbers.number(real, what[a]);
    numbers.skip(attributes, real, "an attribute of a node");
    if (const std::int64_t marker =
            markers > 0 ? numbers.integer(integer, "the boundary marker of a node") : 0)
      groups[marker].elements.push_back({vertex.tag, {vertex.tag, 0, 0}, 0, vertex.place});
    numbers.end("a node");
    raw.vertices.push_back(vertex);
  }
  check_end(lines, count, "nodes");
  for (auto& [marker, group] : groups) {
    group.name = "marker_" + std::to_string(marker), group.tag = marker;
    raw.groups.push_back(std::move(group));
  }
}

void read_tets(const FileBytes& file, ParsedMesh& raw, MeshReport& report) {
  TextLines lines(file, '#');
  TextNumbers numbers(lines);
  constexpr const char* heading =
      "the number of tetrahedra, of nodes of each (4), and of their attributes";
  numbers.begin(heading, 0, 0);
  const std::int64_t count = numbers.count(integer, "the number of tetrahedra", integer, 5);
  const std::int64_t corners = numbers.integer(integer, "the number of nodes of a tetrahedron");
  if (corners != 10) between(corners, 4, 4, "the number of nodes of a tetrahedron", numbers);
  const ElementKind kind = {0, corners == 4 ? "tetrahedron" : "second-order tetrahedron", 3,
                            static_cast<int>(corners), 4};
  const std::int64_t attributes = numbers.count(integer, "the number of attributes", integer, 1);
  numbers.end(heading);
  std::vector<RawNumbers> columns(static_cast<std::size_t>(attributes));
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const std::string name = "attribute" + (k > 0 ? std::to_string(k + 1) : "");
    columns[k].name = name, columns[k].own = k == 0;
    columns[k].name_of = [name](std::int64_t value) { return name + "_" + std::to_string(value); };
  }
  for (std::int64_t i = 1; i <= count; ++i) {
    numbers.begin("tetrahedron", i, count);
    const std::int64_t tag = numbers.integer(integer, "the number of a tetrahedron");
    const Place place = numbers.place();
    std::vector<std::int64_t> vertices(static_cast<std::size_t>(corners));
    for (std::int64_t& v : vertices) v = numbers.integer(integer, "a node of a tetrahedron");
    for (RawNumbers& column : columns) {
      const double value = numbers.any_number(real, "an attribute of a tetrahedron");
      column.add(value, numbers.place());
    }
    numbers.end("a tetrahedron");
    add_element(kind, tag, vertices, place, raw, report);
  }
  check_end(lines, count, "tetrahedra");
  raw.numbers = std::move(columns);
}

}  // namespace

ParsedMesh parse_tetgen(const FileBytes& elements, const FileBytes& nodes, MeshReport& report) {
  report.format = "TetGen .node and .ele";
  ParsedMesh raw;
  raw.file = elements.name, raw.vertex_file = nodes.name;
  read_nodes(nodes, raw);
  read_tets(elements, raw, report);
  return raw;
}

ParsedMesh parse_tetgen(const FileBytes& file, MeshReport& report) {
  const bool is_nodes = extension_of(file.name) == "node";
  const FileBytes other =
      load_file(std::filesystem::path(file.name).replace_extension(is_nodes ? "ele" : "node"));
  return is_nodes ? parse_tetgen(other, file, report) : parse_tetgen(file, other, report);
}

namespace {

// Returns per vertex the number of the first set that has it; 0: none
std::vector<std::int64_t> markers_of(const TetMesh& mesh, WrittenMesh& written) {
  std::vector<std::int64_t> markers(mesh.vertices.size(), 0);
  std::vector<std::string> names;
  for (const auto& [name, vertices] : mesh.vertex_sets) names.push_back(name);
  const std::vector<std::int64_t> numbers = numbers_of(names);
  for (std::size_t s = 0; s < names.size(); ++s) {
    int taken = 0;
    for (const int v : mesh.vertex_sets.at(names[s])) {
      std::int64_t& marker = markers[static_cast<std::size_t>(v)];
      if (marker == 0)
        marker = numbers[s];
      else
        ++taken;
    }
    if (const std::string now = "marker_" + std::to_string(numbers[s]); names[s] != now)
      written.left_out.push_back("the vertex set '" + names[s] + "' is now '" + now +
                                 "', as this format numbers them");
    if (taken > 0)
      written.left_out.push_back("the vertex set '" + names[s] + "' loses " +
                                 std::to_string(taken) +
                                 " vertices to others: this format has one per vertex");
  }
  return markers;
}

}  // namespace

WrittenMesh write_tetgen(const std::filesystem::path& path, const TetMesh& mesh,
                         const MeshGroups& groups) {
  WrittenMesh written;
  leave_out_region_names(mesh, groups, "attribute_", written);
  leave_out_filled(mesh, written);
  const std::vector<std::int64_t> markers = markers_of(mesh, written),
                                  regions = region_numbers(mesh, groups);
  const bool marked = !mesh.vertex_sets.empty();
  TextOut nodes, tets;
  nodes << mesh.vertices.size() << " 3 0 " << (marked ? "1\n" : "0\n");
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    nodes << v + 1 << mesh.vertices[v];
    if (marked) nodes << " " << markers[v];
    nodes << "\n";
  }
  tets << mesh.tets.size() << " 4 " << (regions.empty() ? "0\n" : "1\n");
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    tets << t + 1;
    for (const int v : mesh.tets[t]) tets << " " << v + 1;
    if (!regions.empty()) tets << " " << regions[t];
    tets << "\n";
  }
  std::filesystem::path beside = path;
  written.files.push_back({beside.replace_extension("node").string(), nodes.take()});
  written.files.push_back({beside.replace_extension("ele").string(), tets.take()});
  return written;
}

}  // namespace plica
