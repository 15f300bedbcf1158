// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/problem.hpp>
#include <plica/drivers/solver/registry.hpp>
#include <plica/drivers/solver/set_up/validate.hpp>
#include <plica/drivers/study/sample_bodies.hpp>
#include <string>

// Meshes, fields and problems that many tests start from.
namespace plica::test {

/// Divides a mesh into two regions at a plane x = at.
inline TetMesh with_regions(TetMesh mesh, double at, const std::string& below, const std::string& above) {
  mesh.region_names = {below, above};
  mesh.region.clear();
  for (const auto& t : mesh.tets) {
    double x = 0;
    for (int v : t) x += mesh.vertices[static_cast<std::size_t>(v)][0] / 4;
    mesh.region.push_back(x < at ? 0 : 1);
  }
  return mesh;
}

/// A soft body without loads, of the given resolutions.
inline Problem body_of(std::vector<TetMesh> levels, const std::string& material = "st_venant_kirchhoff") {
  Problem p;
  p.body.levels = std::move(levels);
  p.body.element = {"linear"};
  p.body.material = {material, 20e3, 0.35, 1000};
  return p;
}

const Box unit_box{{0, 0, 0}, {1, 1, 1}};
const Box decimetre{{0, 0, 0}, {0.1, 0.1, 0.1}};
const Box beam_box{{0, 0, 0}, {0.4, 0.1, 0.1}};

inline Problem small_cube(const std::string& material = "st_venant_kirchhoff", int cells = 3) {
  return body_of({jittered_box(decimetre, {cells, cells, cells})}, material);
}

/// Two or more levels of one cube, coarser by one cell each.
inline Problem cube_levels(int levels, int finest, const std::string& cycle) {
  std::vector<TetMesh> meshes;
  for (int i = 0; i < levels; ++i) meshes.push_back(jittered_box(decimetre, {finest - i, finest - i, finest - i}));
  Problem p = body_of(std::move(meshes));
  p.integration.cycle = cycle;
  return p;
}

/// The cycles in which the levels share the macro step, level 0 alone included.
inline std::vector<std::string> sharing_cycles() {
  std::vector<std::string> list = names(cycles());
  std::erase_if(list, [](const std::string& cycle) { return cycle != "single" && !integrates_coarse_levels(cycle); });
  return list;
}

/// doubts() but for those of elements, which small meshes of linear ones always have.
inline std::vector<std::string> other_doubts(const Problem& problem) {
  std::vector<std::string> sentences = doubts(problem);
  std::erase_if(sentences, [](const std::string& sentence) { return sentence.starts_with("body.element:"); });
  return sentences;
}

/// The vertices of the face x = 0.
inline Selection left_face() { return Box{{0, -1e3, -1e3}, {0, 1e3, 1e3}}; }

}  // namespace plica::test
