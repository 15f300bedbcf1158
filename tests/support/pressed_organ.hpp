// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cmath>
#include <plica/core/problem.hpp>
#include <plica/kernels/contact/shapes/sphere.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/files/mesh_files.hpp>
#include <plica/meshes/jitter.hpp>
#include <plica/meshes/organs.hpp>
#include <string>

#include "support/bodies.hpp"

namespace plica::test {

inline TetMesh liver() { return read_mesh(PLICA_SOURCE_DIR "/meshes/data/organs/liver.vtk"); }

/// A small lump of two regions; with 12 cells across it has 5 blocks of vertices, with 8 it has 2.
inline TetMesh lump(int cells = 12) { return jittered(blob_mesh(Point::Zero(), 0.1, cells), 0.2); }

/// An organ that is held at one end, moved at the other and pulled. A ball with friction is pressed
/// into its upper side from the start on.
inline Problem pressed_organ(const TetMesh& mesh, const std::string& element) {
  Problem p = body_of({mesh}, "neo_hookean");
  p.body.element = {element};
  const Box box = bounding_box(mesh.vertices);
  const Point size = box.max - box.min;
  const auto part = [&](double from, double to) {
    Box chosen{box.min - size, box.max + size};
    chosen.min[0] = box.min[0] + from * size[0], chosen.max[0] = box.min[0] + to * size[0];
    return chosen;
  };
  p.gravity = {1.3, 0.4, -9.7};
  p.body.initial.velocity = {0.1, -0.2, 0.05};
  p.body.damping = {2, 0};
  p.body.fixed = {part(-1, 0.1)};
  PrescribedMotion given{part(0.9, 2), SineMotion{0.02 * size, 20, 0.3}, {}};
  p.body.prescribed = {given};
  p.body.loads = {{part(0.4, 0.6), TotalForce{{0.5, 0.2, 0.1}}, {}}};
  Point top = box.min;  // of the middle part
  for (const Point& x : mesh.vertices)
    if (std::abs(x[0] - (box.min + box.max)[0] / 2) < 0.2 * size[0] && x[2] > top[2]) top = x;
  const double radius = 0.3 * size[2];
  ObstacleOptions ball{SphereOptions{top + Point(0, 0, radius - 0.005 * size[2]), radius}, 0.1,
                       SteadyMotion(Point(0.8, 0, -1))};
  p.contact.obstacles = {ball};
  p.contact.whole_surface = "never";
  p.body.surface = boundary_surface(mesh).surface;
  return p;
}

}  // namespace plica::test
