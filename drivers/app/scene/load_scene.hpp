// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <plica/core/mesh.hpp>
#include <plica/drivers/app/scene/scene.hpp>
#include <plica/drivers/app/scene/tree.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/files/parsed_mesh.hpp>
#include <string>
#include <vector>

namespace plica::app {

/// Value that the command line sets.
struct Override {
  std::string assignment;  ///< "key.path=value"
  std::string label;       ///< the argument, for messages: "--set key.path=value"
};

/// Reads a scene, checks it and builds its meshes: its problem is ready for Simulation. Throws
/// InputError with file and line.
Scene load_scene(const std::filesystem::path& file, const std::vector<Override>& overrides = {});

/// Makes a scene from a tree, checks it and builds its meshes. Throws InputError with file and
/// line.
Scene load_scene(const Tree& tree);

/// Returns an error of the library with its location in the scene. The message begins with the name
/// of an option; the location is where the scene sets that option.
InputError located(const InputError& error, const Tree& source);

/// Reads the keys of a scene and checks each value against its range. Builds no meshes.
Scene read_scene(const Tree& tree);
/// Throws InputError for values of a scene that contradict each other.
void check_scene(const Scene& scene, const Tree& tree);
/// Returns about how much memory the set-up needs for the meshes that a scene generates [bytes].
double generated_bytes(const Scene& scene);
/// Returns level 0 with edges half as long. Throws InputError for a level from a file or a lattice.
TetMesh finer_mesh(const Scene& scene);
/// Builds the meshes and the embedded surface. Checks the names of groups and regions against them.
void build_meshes(Scene& scene, const Tree& tree);

/// Returns warnings about a mesh that was read: what was repaired, left out, or looks wrong. One
/// sentence each.
/// @param in_metres  true: lengths are metres, and a body of an unlikely size is doubted
std::vector<std::string> mesh_warnings(const TetMesh& mesh, const MeshReport& report,
                                       bool in_metres = true);
/// Returns warnings about a surface that was read: what was left out, or looks wrong. One sentence
/// each.
std::vector<std::string> surface_warnings(const SurfaceReport& report);

/// Returns why a surface has no inside, and where: "has no inside: ...".
std::string why_open(const SurfaceReport& report);

}  // namespace plica::app
