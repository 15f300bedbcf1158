// SPDX-License-Identifier: BSD-3-Clause
#include <plica/meshes/tetgen/write_tetgen.hpp>

namespace plica {

namespace {

// Per vertex the number of the first set that has it, 0: none
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
      written.left_out.push_back("the vertex set '" + names[s] + "' is now '" + now + "', as this format numbers them");
    if (taken > 0)
      written.left_out.push_back("the vertex set '" + names[s] + "' loses " + std::to_string(taken) +
                                 " vertices to others: this format has one per vertex");
  }
  return markers;
}

}  // namespace

WrittenMesh write_tetgen(const std::filesystem::path& path, const TetMesh& mesh) {
  WrittenMesh written;
  leave_out_region_names(mesh, "attribute_", written);
  const std::vector<std::int64_t> markers = markers_of(mesh, written), regions = region_numbers(mesh);
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
