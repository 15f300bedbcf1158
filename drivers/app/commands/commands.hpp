// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <plica/drivers/app/scene/load_scene.hpp>
#include <string>
#include <vector>

namespace CLI {
class App;
}
/// The commands of the program, with the arguments each takes from the command line.
namespace plica {
struct MatrixResult;
}

namespace plica::app {

/// What the program tells its caller.
enum class ExitStatus {
  done = 0,
  failed = 1,         ///< a file or folder could not be read or written
  bad_input = 2,      ///< arguments, scenes, meshes; steps and combinations that are refused
  diverged = 3,       ///< the run was stopped; its last good state is on disk
  interrupted = 130,  ///< Ctrl-C; the files are complete up to there
};

/// What the command line says about Kokkos.
struct KokkosArguments {
  int threads = 0;                        ///< 0: as Kokkos finds
  std::vector<std::string> pass_through;  ///< --kokkos-*
};

/// What every command that takes a scene knows.
struct SceneArguments {
  std::filesystem::path scene;
  std::vector<Override> overrides;
  std::string precision;  ///< float or double; empty: double, or a checkpoint's
  bool json = false;
  KokkosArguments kokkos;
};

struct RunArguments : SceneArguments {
  std::filesystem::path folder;  ///< empty: out/SCENE
  std::filesystem::path resume;  ///< the folder of the run to go on with; empty: a new run
  /// "every=100", "every=0.1s"; empty: none, or as the run to go on with
  std::string checkpoint;
  bool force = false;  ///< a run that is in the folder is replaced
  bool quiet = false;
  bool time_stages = false;        ///< also where that slows the run
  std::vector<std::string> words;  ///< the command line as it was given
};

struct StudyArguments {
  std::string budget;   ///< wall time, "60s"; empty: as long as it takes
  bool space = false;   ///< a second reference on a finer mesh
  bool growth = false;  ///< of the linearised cycles too
  bool truth = false;   ///< errors against it
};

struct StabilityArguments {
  std::string budget;   ///< as of a study
  bool matrix = false;  ///< of stiff and extreme cases, instead of a scene
};

struct VerifyArguments {
  std::vector<std::string> problems;  ///< empty: all
  bool small = false;
};

struct ReportArguments {
  std::filesystem::path folder;  ///< of a run or a study
  int frames = 200;              ///< at most
  bool quiet = false;
};

struct ViewArguments {
  int port = 8642;      ///< of the page's address; 0: any free one
  bool browser = true;  ///< one is opened, where there is a screen
};

struct MeshInfoArguments {
  std::filesystem::path file;
  bool json = false;
  std::string scale = "1";  ///< metres per unit of the file, as text
  /// keys of a scene's body.material, as text; the rest has its defaults
  std::map<std::string, std::string> material;
  KokkosArguments kokkos;
};

struct ConvertArguments {
  std::filesystem::path in, out;
  std::string format;  ///< of those the extension has; empty: the first
  bool binary = false;
  std::string scale = "1";                      ///< metres per unit of the file, as text
  std::optional<std::string> merge_duplicates;  ///< a length, as text
};

/// Of the commands that make a mesh of another one or of a surface.
struct MakeMeshArguments {
  std::filesystem::path in, out;
  std::string scale = "1";  ///< metres per unit of the file, as text
  std::string size;         ///< of the cells of a lattice, as text
  int vertices = 0;         ///< of a coarser mesh, at most
  /// what fills a surface: gmsh or lattice; empty: Gmsh where it is installed and able
  std::string with;
  std::string time_limit = "10 min";  ///< of Gmsh, as text
};

/// plica run: simulates the scene and writes its files. A folder that holds a run already is
/// refused, unless the arguments say `force` or `resume`.
ExitStatus run(const RunArguments& arguments);

/// plica explain: what a run of the scene would do, level by level and part by part.
ExitStatus explain(const SceneArguments& arguments);

/// plica check: sets the scene up, says so, runs nothing.
ExitStatus check(const SceneArguments& arguments);

/// plica study: measures methods on a scene, keeps study.json and study.csv up to date row by row,
/// and says what came out. Goes on with the study that it finds in the folder, where that is of the
/// same scene, program and machine.
ExitStatus study(const RunArguments& arguments, const StudyArguments& more);

/// plica stability: searches the largest stable macro steps of a scene's methods, or runs the
/// matrix of stiff and extreme cases; keeps stability.json and stability.csv up to date, and says
/// what came out.
ExitStatus stability(const RunArguments& arguments, const StabilityArguments& more);

/// Of the matrix: failed where a row is wrong.
ExitStatus status_of(const MatrixResult& result);

/// plica verify: solves problems with known answers, writes the table, and says which rows are not
/// ok.
ExitStatus verify(const RunArguments& arguments, const VerifyArguments& more);

/// plica doctor: what this program is and runs on, what the machine can do, and whether a short run
/// gives the stored answer; `failed` where it does not.
ExitStatus doctor(bool json, const KokkosArguments& kokkos);

/// The problems' names, each with what it is, for the manual.
std::string verify_problems_text();

/// plica report: writes report.html, a page that shows what a run or a study left in its folder.
ExitStatus report(const ReportArguments& arguments);

/// plica view: lets the scene run and serves a page that shows it and reaches into it, until
/// Ctrl-C.
ExitStatus view(const SceneArguments& arguments, const ViewArguments& more);

/// plica mesh info: what a mesh or surface file holds, what was repaired in it, how well its
/// tetrahedra are shaped, and which explicit step they allow.
ExitStatus mesh_info(const MeshInfoArguments& arguments);

/// plica mesh convert: writes a mesh or surface in another format. The file OUT may be IN, and is
/// replaced as a whole.
ExitStatus mesh_convert(const ConvertArguments& arguments);

/// plica mesh repair: writes a mesh with its duplicates merged, loose parts dropped and slivers
/// shaped better; says what changed.
ExitStatus mesh_repair(const MakeMeshArguments& arguments);

/// plica mesh fill: writes a mesh that fits a closed surface, by Gmsh, or a lattice of cubes over
/// it, cut into tetrahedra.
ExitStatus mesh_fill(const MakeMeshArguments& arguments);

/// plica mesh coarsen: writes such a lattice over a mesh, with at most so many vertices.
ExitStatus mesh_coarsen(const MakeMeshArguments& arguments);

/// The formats that are written, a line each.
std::string written_formats_text();

/// plica list: the members of a family, or all keys of a scene. InputError for an unknown family.
ExitStatus list(const std::string& family, bool json);

/// plica list without a family: what can be listed.
ExitStatus list_families(bool json);

/// The same, one line each, and the names alone.
std::string families_text();
std::vector<std::string> list_names();

/// plica completion: a script for `bash` or `zsh` that completes commands, options, and the names
/// that arguments choose from. InputError for another shell.
std::string completion_script(const CLI::App& app, const std::string& shell);

/// What `plica COMMAND --help` says beneath the options: what the command does with its input,
/// files, examples, exit statuses.
std::string manual_of(const std::string& command);

}  // namespace plica::app
