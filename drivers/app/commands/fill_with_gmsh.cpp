// SPDX-License-Identifier: BSD-3-Clause
#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <plica/core/error.hpp>
#include <plica/drivers/app/commands/fill_with_gmsh.hpp>
#include <plica/drivers/app/output/write_file.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/files/mesh_files.hpp>
#include <plica/meshes/mesh_quality.hpp>
#include <sstream>
#include <thread>

namespace plica::app {

namespace {

// maximum relative difference of the volumes of mesh and surface: edges of this size cut corners
constexpr double same_volume = 0.1;
// maximum size of Gmsh's messages [bytes]; Gmsh 4.8 splits a surface of four triangles without end
constexpr std::uintmax_t many_words = 10'000'000;

class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name =
        (std::filesystem::temp_directory_path() / ("plica-" + std::string(6, 'X'))).string();
    if (mkdtemp(name.data()) == nullptr)
      throw FileError("cannot make a folder for temporary files: " + name);
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::filesystem::path operator/(const char* name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

// Returns Gmsh's input. Gmsh splits the surface into patches at edges sharper than 40 degrees,
// meshes the patches again, and meshes the inside
std::string gmsh_script(const std::filesystem::path& surface, double size) {
  return fmt::format(
      "Merge \"{}\";\n"
      "ClassifySurfaces{{40 * Pi / 180, 1, 1, Pi}};\n"
      "CreateGeometry;\n"
      "Surface Loop(1) = Surface{{:}};\n"
      "Volume(1) = {{1}};\n"
      "Mesh.MeshSizeMax = {};\n"
      "Mesh.MeshSizeMin = {};\n"
      "Mesh.MeshSizeExtendFromBoundary = 0;\n",
      surface.string(), size, size / 2);
}

// Returns the lines in which Gmsh reports an error; if there are none, the last line
std::string errors_in(const std::filesystem::path& said) {
  std::ifstream file(said);
  std::string errors, last;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("Error")) errors += "\n  " + line;
    if (!line.empty()) last = line;
  }
  return errors.empty() ? "\n  " + last : errors;
}

// Returns why Gmsh, which has run since `start`, has to be stopped; empty: it may run on. Its
// messages are in the file `said`
std::string why_stopped(const std::filesystem::path& said,
                        std::chrono::steady_clock::time_point start, double time_limit) {
  std::error_code none_yet;
  if (const auto size = std::filesystem::file_size(said, none_yet); !none_yet && size > many_words)
    return "its messages did not end";
  if (std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() < time_limit)
    return "";
  return fmt::format(
      "it had made no mesh after {:.3g} s: give it longer (--time-limit), choose a larger --size, "
      "or mend "
      "the surface (it may meet itself)",
      time_limit);
}

// Runs Gmsh with its messages written to the file `said`. Returns its exit status; negative: it did
// not start or did not end by itself
int run_gmsh(const std::filesystem::path& script, const std::filesystem::path& mesh,
             const std::filesystem::path& said, double time_limit) {
  std::array<std::string, 8> words = {"gmsh", script.string(), "-3",      "-format", "msh22",
                                      "-o",   mesh.string(),   "-nopopup"};
  std::array<char*, words.size() + 1> pointers = {};
  for (std::size_t i = 0; i < words.size(); ++i) pointers[i] = words[i].data();
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, said.c_str(),
                                   O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_adddup2(&files, STDOUT_FILENO, STDERR_FILENO);
  pid_t id = 0;
  const int failure = posix_spawnp(&id, "gmsh", &files, nullptr, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&files);
  if (failure != 0) return -1;
  const auto start = std::chrono::steady_clock::now();
  int status = 0;
  while (waitpid(id, &status, WNOHANG) == 0) {
    if (const std::string why = why_stopped(said, start, time_limit); !why.empty()) {
      kill(id, SIGKILL);
      waitpid(id, &status, 0);
      throw InputError("Gmsh was stopped, since " + why + "; its last words:" + errors_in(said));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

bool has_gmsh() {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');)
    if (access((std::filesystem::path(folder) / "gmsh").c_str(), X_OK) == 0) return true;
  return false;
}

TetMesh fill_with_gmsh(const TriangleSurface& surface, double size, double time_limit) {
  const TemporaryFolder folder;
  const auto stl = folder / "surface.stl", geo = folder / "fill.geo", msh = folder / "mesh.msh",
             said = folder / "said";
  write_files(write_surface(stl, surface).files);
  write_file(geo, gmsh_script(stl, size));
  if (run_gmsh(geo, msh, said, time_limit) != 0 || !std::filesystem::exists(msh))
    throw InputError("Gmsh made no mesh that fits; it says:" + errors_in(said));
  TetMesh mesh = read_mesh(msh);
  mesh.region.clear(), mesh.region_names.clear(), mesh.vertex_sets.clear();
  const double volume = mesh_quality(mesh).volume, enclosed = enclosed_volume(surface);
  if (std::abs(volume - enclosed) > same_volume * enclosed)
    throw InputError(fmt::format(
        "Gmsh made a mesh of {:.4g} m^3 of a surface that encloses {:.4g} m^3; it says:{}", volume,
        enclosed, errors_in(said)));
  return mesh;
}

}  // namespace plica::app
