// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <plica/core/ranks.hpp>
#include <plica/drivers/app/scene/load_scene.hpp>
#include <string>
#include <vector>

namespace CLI {
class App;
}
/// Commands of the program, with the arguments that each takes from the command line.
namespace plica {
struct MatrixResult;
}

namespace plica::app {

/// Exit status of the program.
enum class ExitStatus {
  done = 0,
  /// a file could not be read or written, or memory ran out; verify, doctor, stability --matrix: a
  /// check failed
  failed = 1,
  bad_input = 2,      ///< bad arguments, scene or mesh, or a refused step or combination
  diverged = 3,       ///< the run was stopped; its last good state is on disk
  no_mpi = 4,         ///< several processes were started, of a program built without MPI
  interrupted = 130,  ///< stopped by Ctrl-C; the files are complete up to the stop
};

/// Options of the command line for Kokkos.
struct KokkosArguments {
  int threads = 0;                        ///< number of threads; 0: Kokkos chooses
  std::vector<std::string> pass_through;  ///< the arguments --kokkos-*
};

/// Arguments of every command that takes a scene.
struct SceneArguments {
  std::filesystem::path scene;  ///< the YAML file
  std::vector<Override> overrides;
  std::string precision;  ///< float or double; empty: double, or a checkpoint's
  bool json = false;
  int ranks_planned = 0;  ///< number of ranks that `plica explain` plans for; 0: none
  KokkosArguments kokkos;
};

/// Arguments of `plica run`; `plica study`, `stability` and `verify` use some of them.
struct RunArguments : SceneArguments {
  std::filesystem::path folder;  ///< folder of the files; empty: out/SCENE
  std::filesystem::path resume;  ///< folder of the run to resume; empty: a new run
  /// interval of checkpoints, "every=100" or "every=0.1s"; empty: none, or that of the resumed run
  std::string checkpoint;
  bool force = false;  ///< true: replaces a run that is in the folder
  bool quiet = false;
  bool time_stages = false;        ///< true: times each stage on a GPU too, which slows the run
  std::vector<std::string> words;  ///< the command line as it was given
  Ranks* ranks = nullptr;          ///< ranks that run the scene together; null: one process
};

/// Arguments of `plica study`, besides those of a run.
struct StudyArguments {
  std::string budget;   ///< wall time, "60s"; empty: no limit
  bool space = false;   ///< true: makes a second reference on a finer mesh
  bool growth = false;  ///< true: finds the growth of small motions by the linearised cycles
  bool truth = false;   ///< true: measures errors against the limit of refined meshes
};

/// Arguments of `plica stability`, besides those of a run.
struct StabilityArguments {
  std::string budget;   ///< wall time, "60s"; empty: no limit
  bool matrix = false;  ///< true: runs the stiff and extreme cases instead of a scene
};

/// Arguments of `plica verify`, besides those of a run.
struct VerifyArguments {
  std::vector<std::string> problems;  ///< names of the problems; empty: all
  bool small = false;                 ///< true: coarser meshes, in seconds
};

/// Arguments of `plica report`.
struct ReportArguments {
  std::filesystem::path folder;  ///< folder of a run or a study
  int frames = 200;              ///< maximum number of frames on the page
  bool quiet = false;
};

/// Arguments of `plica view`, besides those of a scene.
struct ViewArguments {
  int port = 8642;      ///< port of the page's address; 0: any free port
  bool browser = true;  ///< true: opens the page in a browser, where there is a screen
};

/// Choices about a mesh or surface file, as text; empty: not given.
struct ReadArguments {
  std::string regions;    ///< array of cells that numbers the regions, or none
  std::string leave_out;  ///< names or numbers of regions or labels, between commas
  std::string order;      ///< treatment of second-order tetrahedra
  std::string weld;       ///< distance on open edges, as a part of the box's diagonal
};

/// Arguments of `plica mesh info`.
struct MeshInfoArguments {
  std::filesystem::path file;
  ReadArguments read;
  bool json = false;
  std::string scale = "1";  ///< metres per unit of the file, as text
  /// values of body.material as text, by key; a key that is not given has its default
  std::map<std::string, std::string> material;
  KokkosArguments kokkos;
};

/// Arguments of `plica mesh convert`.
struct ConvertArguments {
  std::filesystem::path in, out;
  ReadArguments read;
  std::string format;       ///< one of the formats of the extension; empty: the first one
  bool binary = false;      ///< true: writes the binary form of the format
  std::string scale = "1";  ///< metres per unit of the file, as text
  /// vertices this close become one: a length, as text
  std::optional<std::string> merge_duplicates;
};

/// Arguments of the commands `plica mesh repair`, `fill` and `coarsen`.
struct MakeMeshArguments {
  std::filesystem::path in, out;
  ReadArguments read;
  std::string scale;  ///< metres per unit of the file, as text; empty: 1, or as an image says
  std::string size;   ///< fill: length of the edges or lattice cells, as text
  int vertices = 0;   ///< coarsen: maximum number of vertices
  /// fill: the mesh generator, gmsh or lattice; empty: Gmsh if it is installed and makes a mesh
  std::string with;
  std::string time_limit = "10 min";  ///< fill: maximum time of Gmsh, as text
};

/// Runs `plica run`: simulates the scene and writes its files. Refuses a folder that already holds
/// a run, unless the arguments say `force` or `resume`.
ExitStatus run(const RunArguments& arguments);

/// Runs `plica explain`: prints what a run of the scene would do, for each level and each part.
ExitStatus explain(const SceneArguments& arguments);

/// Runs `plica check`: sets the scene up, prints that it is sound, and simulates nothing.
ExitStatus check(const SceneArguments& arguments);

/// Runs `plica study`: measures methods on a scene and prints the results. Updates study.json and
/// study.csv after each row. Continues the study that is in the folder, if that is of the same
/// scene, program and machine.
ExitStatus study(const RunArguments& arguments, const StudyArguments& more);

/// Runs `plica stability`: searches the largest stable macro steps of a scene's methods. With
/// `matrix` it runs the stiff and extreme cases instead. Updates stability.json and stability.csv
/// after each row, and prints the results.
ExitStatus stability(const RunArguments& arguments, const StabilityArguments& more);

/// Returns the exit status of a matrix of cases: `failed` if a row is wrong.
ExitStatus status_of(const MatrixResult& result);

/// Runs `plica verify`: solves problems with known solutions, writes the table, and prints which
/// rows are not ok.
ExitStatus verify(const RunArguments& arguments, const VerifyArguments& more);

/// Runs `plica doctor`: prints the program's version, the machine and its measured limits. Returns
/// `failed` if a short simulation does not give the stored values.
ExitStatus doctor(bool json, const KokkosArguments& kokkos);

/// Returns the names of the problems of `plica verify` with a summary each, for the manual.
std::string verify_problems_text();

/// Runs `plica report`: writes report.html, a page that shows the run or study in a folder.
ExitStatus report(const ReportArguments& arguments);

/// Runs `plica view`: simulates the scene until Ctrl-C. Serves a page that shows the body and
/// through which a user can pull and push it.
ExitStatus view(const SceneArguments& arguments, const ViewArguments& more);

/// Runs `plica mesh info`: prints what a mesh or surface file holds and what was repaired in it.
/// For a mesh it prints how well the tetrahedra are shaped and which explicit step they allow.
ExitStatus mesh_info(const MeshInfoArguments& arguments);

/// Runs `plica mesh convert`: writes a mesh or surface in another format. The file OUT may be the
/// file IN; it is replaced as a whole.
ExitStatus mesh_convert(const ConvertArguments& arguments);

/// Runs `plica mesh repair`: writes a mesh with duplicates merged, loose parts dropped and slivers
/// shaped better. Prints what changed.
ExitStatus mesh_repair(const MakeMeshArguments& arguments);

/// Runs `plica mesh fill`: writes a tetrahedral mesh of the inside of a closed surface. The mesh is
/// made by Gmsh and fits the surface, or it is a lattice of cubes over it, cut into tetrahedra.
ExitStatus mesh_fill(const MakeMeshArguments& arguments);

/// Runs `plica mesh coarsen`: writes a lattice of cubes over a mesh, cut into tetrahedra, with at
/// most `vertices` vertices.
ExitStatus mesh_coarsen(const MakeMeshArguments& arguments);

/// Returns the file formats that can be written, one line each.
std::string written_formats_text();

/// Runs `plica list FAMILY`: prints the members of a family, or all keys of a scene. Throws
/// InputError for an unknown family.
ExitStatus list(const std::string& family, bool json);

/// Runs `plica list` without a family: prints which families can be listed.
ExitStatus list_families(bool json);

/// Returns the families that can be listed, with a summary each, one line each.
std::string families_text();
/// Returns the names of the families that can be listed.
std::vector<std::string> list_names();

/// Returns the script of `plica completion` for `bash` or `zsh`. It completes commands, options,
/// and the names that arguments choose from. Throws InputError for another shell.
std::string completion_script(const CLI::App& app, const std::string& shell);

/// Returns the text that `plica COMMAND --help` prints after the options. It says what the command
/// does with its input, and lists its files, examples and exit statuses.
std::string manual_of(const std::string& command);

}  // namespace plica::app
