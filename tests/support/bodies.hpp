// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/problem.hpp>
#include <plica/drivers/methods/methods.hpp>
#include <plica/drivers/run/registry.hpp>
#include <plica/drivers/run/validate.hpp>
#include <plica/drivers/study/sample_bodies.hpp>
#include <string>

// Meshes, fields and problems that many tests start from.
namespace plica::test {

/// Divides a mesh into two regions at a plane x = at.
inline TetMesh with_regions(TetMesh mesh, double at, const std::string& below,
                            const std::string& above) {
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
inline Problem body_of(std::vector<TetMesh> levels,
                       const std::string& material = "st_venant_kirchhoff") {
  Problem p;
  p.body.levels = std::move(levels);
  p.body.element = {"linear"};
  p.body.material = complete({material, 20e3, 0.35, 1000});
  return p;
}

/// Makes some tetrahedra very flat: of every thirtieth, a vertex inside the box goes next to the
/// face across from it, where no element around it turns inside out.
inline TetMesh with_slivers(TetMesh mesh, double height = 0.04) {
  const Box box = bounding_box(mesh.vertices);
  const auto volume = [&](const std::array<int, 4>& t) {
    const auto x = [&](std::size_t k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
    return tet_volume(x(0), x(1), x(2), x(3));
  };
  for (std::size_t e = 0; e < mesh.tets.size(); e += 30)
    for (std::size_t c = 0; c < 4; ++c) {
      const int moved = mesh.tets[e][c];
      Point& p = mesh.vertices[static_cast<std::size_t>(moved)];
      if (on_boundary(box, p)) continue;
      const Point before = p;
      Point face = Point::Zero();
      for (std::size_t k = 0; k < 4; ++k)
        if (k != c) face += mesh.vertices[static_cast<std::size_t>(mesh.tets[e][k])] / 3;
      const double least = 0.5 * height * volume(mesh.tets[e]);
      p = face + height * (p - face);
      bool sound = true;
      for (const auto& t : mesh.tets)
        if (std::find(t.begin(), t.end(), moved) != t.end()) sound = sound && volume(t) > least;
      if (sound) break;
      p = before;
    }
  return mesh;
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
  for (int i = 0; i < levels; ++i)
    meshes.push_back(jittered_box(decimetre, {finest - i, finest - i, finest - i}));
  Problem p = body_of(std::move(meshes));
  p.integration.cycle = cycle;
  return p;
}

/// The cycles in which the levels share the macro step, level 0 alone included.
inline std::vector<std::string> sharing_cycles() {
  std::vector<std::string> list = names(cycles());
  std::erase_if(list, [](const std::string& cycle) {
    return cycle != "single" && !integrates_coarse_levels(cycle);
  });
  return list;
}

/// doubts() but for those of elements, which small meshes of linear ones always have.
inline std::vector<std::string> other_doubts(const Problem& problem) {
  std::vector<std::string> sentences = problem_warnings(problem);
  std::erase_if(sentences,
                [](const std::string& sentence) { return sentence.starts_with("body.element:"); });
  return sentences;
}

/// The vertices of the face x = 0.
inline Selection left_face() { return Box{{0, -1e3, -1e3}, {0, 1e3, 1e3}}; }

}  // namespace plica::test
