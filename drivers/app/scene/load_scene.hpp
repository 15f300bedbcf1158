// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <plica/core/mesh.hpp>
#include <plica/drivers/app/scene/scene.hpp>
#include <plica/drivers/app/scene/tree.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/files/raw_mesh.hpp>
#include <string>
#include <vector>

namespace plica::app {

/// "key.path=value", given on the command line as `label` shows.
struct Override {
  std::string assignment;
  std::string label;
};

/// A scene, read, checked, with its meshes built: ready for Simulation. InputError with file and
/// line otherwise.
Scene load_scene(const std::filesystem::path& file, const std::vector<Override>& overrides = {});

/// The same from a tree.
Scene load_scene(const Tree& tree);

/// An error of the library, which names options and knows no files, with the place where the scene
/// gives the option that the message begins with.
InputError located(const InputError& error, const Tree& source);

/// Its parts. What the keys say, each within its range:
Scene read_scene(const Tree& tree);
/// what they say together; InputError for contradictions.
void check_scene(const Scene& scene, const Tree& tree);
/// about what the meshes that it has generated will take of memory when it is set up [bytes];
double generated_bytes(const Scene& scene);
/// level 0 twice as fine along every edge. InputError where it comes from a file;
TetMesh finer_mesh(const Scene& scene);
/// The meshes and the embedded surface, and the names of groups and regions checked against them.
void build_meshes(Scene& scene, const Tree& tree);

/// These three, of a scene with `body`; the whole problem is validated after that.
Scene load_body(const Tree& tree);
/// Whether the probes lie in level 0. One that is outside by less than an edge is a warning: it is
/// taken to the surface.
void check_probes(Scene& scene, const Tree& tree);

/// What a user should know about a mesh that was read, a sentence each: what was repaired, left
/// out, or looks wrong.
std::vector<std::string> mesh_warnings(const TetMesh& mesh, const MeshReport& report);
std::vector<std::string> surface_warnings(const SurfaceReport& report);

/// Why a surface has no inside, and where: "has no inside: ...".
std::string why_open(const SurfaceReport& report);

}  // namespace plica::app
