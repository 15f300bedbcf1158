// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <plica/drivers/app/output/terminal.hpp>
#include <plica/drivers/app/scene/mesh_warnings.hpp>
#include <plica/meshes/mesh_quality.hpp>

namespace plica::app {
namespace {

constexpr double at_the_same_place = 1e-9;  // of the mean edge

// Gathers sentences about what there is any of
class Sentences {
 public:
  void add(int count, const std::string& noun, const std::string& rest) {
    if (count > 0) list_.push_back(counted(count, noun) + " " + rest);
  }
  void add(bool is_so, const std::string& sentence) {
    if (is_so) list_.push_back(sentence);
  }
  std::vector<std::string> take() { return std::move(list_); }

 private:
  std::vector<std::string> list_;
};

}  // namespace

std::vector<std::string> mesh_warnings(const TetMesh& mesh, const MeshReport& report) {
  Sentences sentences;
  sentences.add(report.flipped, "inverted element", "turned the right way round");
  sentences.add(report.unreferenced, "unused point", "dropped");
  sentences.add(count_duplicate_vertices(mesh, at_the_same_place * mean_edge_length(mesh)), "duplicate",
                "among the vertices: at the place of another one, where the mesh may come apart (merge them?)");
  const int parts = count_parts(mesh);
  sentences.add(parts > 1, fmt::format("the mesh is in {} parts that share no vertex", parts));
  for (const std::string& section : report.skipped_sections)
    sentences.add(true, "the section " + section + " is not read");
  return sentences.take();
}

std::vector<std::string> surface_warnings(const SurfaceReport& report) {
  Sentences sentences;
  sentences.add(report.unreferenced, "unused point", "dropped");
  sentences.add(report.collapsed, "collapsed triangle", "dropped: it names a vertex twice");
  sentences.add(report.repeated, "repeated triangle", "dropped");
  sentences.add(report.open_edges, "open edge", "of one triangle only: the surface is not closed");
  sentences.add(report.crowded_edges, "crowded edge", "of more than two triangles: the surface is no manifold");
  sentences.add(report.inconsistent_edges, "inconsistent edge", "of triangles that look to different sides");
  sentences.add(report.parts > 1, fmt::format("the surface is in {} parts that share no vertex", report.parts));
  sentences.add(report.turned, "the surface was inside out: all triangles turned");
  return sentences.take();
}

}  // namespace plica::app
