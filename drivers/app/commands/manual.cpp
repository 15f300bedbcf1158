// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <plica/drivers/app/commands/commands.hpp>

namespace plica::app {
namespace {

constexpr const char* run_manual =
    R"(SCENE says what is simulated; `plica list keys` prints all that it can say. Numbers are SI, or text with a
unit: 20 kPa, 17 ms, 4 cm, 1000 kg/m^3.

Files in the folder, SI units throughout; a killed run leaves whole ones:
  summary.json     how it went: status, times [s], levels, counters, diagnosis; written at the end
  history.csv      level 0: energies [J], centre of mass [m], speeds [m/s]; a row per frame. Obstacles: force [N] and
                   torque [N m]; with friction its work so far [J] and the part of what touches that slips
  frames.pvd       for ParaView: the surface's displacement [m] and velocity [m/s] (frames/surface_*.vtu)
  volume.pvd       where output.volume asks: the tetrahedra of level 0, with mass [kg], von Mises stress [Pa],
                   volume ratio J and region; volume_levelN.pvd of level N
  probes.csv       where output.probes asks: positions [m] and velocities [m/s] of named points
  checkpoint.bin   where --checkpoint asks: at the start, at each interval, at the end, and at Ctrl-C after a macro step

`plica report FOLDER` makes a page of them. A folder that holds a run already is refused; --force replaces that run.
Set-up that takes more than 2 s says what it is doing, on the standard error.

--resume goes on from checkpoint.bin with the same bits as a run that never stopped. The scene, --set and
--precision are the run's own; given again they must say the same. Only --duration may change.

Examples:
  plica run ball.yaml -o out/ball
  plica run ball.yaml --set integration.macro_step=1ms --set body.material.young_modulus="20 kPa"
  plica run ball.yaml --checkpoint every=100      # macro steps; or every=0.1s of simulated time
  plica run --resume out/ball
  plica run --resume out/ball --duration 10s

Exit status: 0 done, 1 a file cannot be written, 2 bad input, 3 diverged (the last good state is written),
130 interrupted (Ctrl-C: after the macro step, or within it where that takes longer than half a second; the files are
complete; a second Ctrl-C ends at once))";

constexpr const char* study_manual =
    R"(Runs the scene with many methods and macro steps and measures each one's error against its run time. Methods:
  single/INTEGRATOR   the finest level alone
  coarse/LEVEL        a coarser level alone, interpolated to the finest
  cycle/NAME          the levels together, with each distribution of the macro step, or cycle/NAME/DISTRIBUTION
  cycle/...+VARIANT   the same with the settings that study.variants.VARIANT puts over those of `integration`
`cycle` alone means all of them; a variant that changes nothing that a cycle uses is not run for it. Left out of the scene's section `study`, all but some integrators are run. Errors are relative, over all vertices of the
finest level and all sampling times, against that level alone at a small step, which is itself checked at half of it.
Times are of the steps alone: the median of at least three runs after one to warm up. States between two steps are
interpolated by the cubic through the four nearest. `work` counts tetrahedra's force evaluations (an iteration of a
linear solve as one), to those of the finest level alone at 0.9 of its limit. `error_probes` are errors of the points in
output.probes. Where nothing but gravity does work, `energy_drift` is the change of energy, relative, and `phase` how
far [s] the motion is behind the reference on the mean. With --growth, `spectral_radius` is the factor per macro step by
which small motions about rest grow in the long run, `growth_per_second` its logarithm per simulated second.

Files in the folder, SI units throughout; rows are written as they finish:
  study.json       machine, reference, choices (what to take for each error class: plica run SCENE --study FOLDER),
                   rows (one per method and macro step; diverged and refused ones too), what was left out
  study.csv        the rows
  reference.bin    what errors are measured against
The same command goes on with what it finds there. `plica report FOLDER` makes a page of it,
drivers/plots/study.py FOLDER a picture, study.png.

Examples:
  plica study beam.yaml -o out/beam --budget 60s
  plica study beam.yaml --set study.methods="[single, coarse, cycle/rsv]" --set study.macro_steps="[1 ms, 2 ms, auto]"
  plica study beam.yaml --set study.variants="{hybrid: {integrator: [symplectic_euler, implicit_euler]}}" --growth
  plica study beam.yaml --space         # the finest mesh's own error too, against one twice as fine: takes 16 times as long

Exit status: 0 done, also with rows that diverged, 1 a file cannot be written, 2 bad input, 130 interrupted)";

constexpr const char* stability_manual =
    R"(Searches the largest stable macro step of each method by bisection on runs, beside the one predicted before running.
Methods are those of `plica study` (study.methods, study.variants); left out, all of them, and on coarser levels every
explicit integrator. Levels alone take one sub-step; cycles the shares and sub-steps of `integration`.
  predicted          of small motions about rest, linearised, without loads and contact: of a level alone 2/w and the like,
                     of cycle him 2/sqrt(lambda) of the inertia it has at its own macro step, of the other cycles where the
                     spectral radius of their map leaves 1. 0: growing at every step worth while; null: no limit
  measured           the largest macro step at which such motions, all modes excited alike, stay bounded for 400 steps (600 of
                     a cycle; 40 of an implicit level, at up to 1000 critical steps: stable_up_to)
  growth_per_second  of small motions by a cycle, at growth_step
  scene_measured     where the material is not linear, or something is touched: the largest macro step with which the scene
                     itself comes to its end, and beside it how and where it ended one step further (scene_kind, scene_J ...)

--matrix runs stiff and extreme cases instead (stiffness, density, size, gravity, steps, slivers, inverted and random starts,
impacts, one element, many levels ...), each with the outcome it must have, and bodies that are turned, moved, renumbered or
given in millimetres, which must move alike.

Files in the folder, SI units throughout, kept up to date:
  stability.json     machine, rows
  stability.csv      the rows
drivers/plots/stability.py FOLDER draws stability.png of a scene.

Examples:
  plica stability beam.yaml -o out/beam --budget 60s
  plica stability beam.yaml --set study.methods="[single, cycle/rsv/equal, cycle/him]" --set body.material.model=linear
  plica stability --matrix

Exit status: 0 done, 1 a row of the matrix is wrong or a file cannot be written, 2 bad input, 130 interrupted)";

constexpr const char* verify_manual =
    R"(Solves problems whose answers are known, each on several meshes, and sets what comes out beside the accepted value and its
source, with the observed order of convergence. A row is `ok`, `not ok`, or `shown` for information. PROBLEM is any of
{}
Files in the folder, SI units throughout; each is replaced as a whole after every problem:
  verify.json      machine, and the rows: problem, quantity, accepted, source, ours (mesh, size, value), limit, order,
                   judged, tolerance, outcome, ok, note
  verify.csv       a line per row and mesh
  verify.md        the table

Examples:
  plica verify
  plica verify cantilever cook_membrane -o out/bending
  plica verify --small                # coarser meshes: some seconds

Exit status: 0 all rows came out as they must, 1 one did not, or a file cannot be written, 2 bad input, 130 interrupted)";

constexpr const char* report_manual =
    R"(Writes FOLDER/report.html: one file that opens in a browser by double click, without a network, and can be sent to
others as it is. Of what `plica run` wrote it shows
  the body in time    the embedded surface, or level 0's; with output.volume also the boundaries of the levels. Coloured by
                      displacement, deformation, speed, von Mises stress, volume ratio J and what else the frames hold;
                      with the obstacles, up against gravity
  charts              energies, contact forces on obstacles, probes, wall time by stage; a click goes to that time
  the diagnosis       of a run that diverged, with its element marked in the last frame
and of what `plica study` wrote the errors against run times, with the front; point at a mark for its numbers. A run that goes
on, or was killed, is shown as far as it has come. Numbers of frames are kept in 16 bits, so a page takes about 8 bytes for each
vertex and frame, and 3 for each value that colours it.

Examples:
  plica report out/ball
  plica report out/ball --frames 40     # a smaller file

Exit status: 0 done, 1 the page cannot be written, 2 the folder holds no run and no study, or a damaged one)";

constexpr const char* view_manual =
    R"(Lets the scene run and serves a page, to browsers on this machine alone, that shows it while it does:
  drag the body    pull it by a patch around that place, as with forceps, by springs
  a ball           is dragged likewise and pushes the body (a penalty on the vertices inside)
  sliders          speed, gravity, the springs' stiffness, the ball's radius
  shown            real-time factor, and what would be possible; the method, and the error class that cycle auto chose it for;
                   forces; colours by displacement, speed, von Mises stress or volume ratio J
It runs on beyond the scene's duration, and rests while no page is open. A state that diverges is shown as it last was good, with
the reason; "start" goes back to the beginning. On explicit levels springs and ball are as stiff as the step bears, if that is less
than asked for. From another machine: ssh -L 8642:localhost:8642 HOST, and the same address.

Examples:
  plica view drivers/scenes/press.yaml
  plica view liver.yaml --set integration.cycle=auto --port 9000 --no-browser

Exit status: 0 ended by Ctrl-C, 1 failure, 2 bad input, or the port is in use, 130 interrupted while it was set up)";

constexpr const char* explain_manual =
    R"(Prints levels with critical steps [s], shares and sub-steps, and each part that is in or out, why, and its bytes.

Examples:
  plica explain ball.yaml
  plica explain ball.yaml --set integration.cycle=single --json

Exit status: 0 done, 2 bad input)";

constexpr const char* check_manual =
    R"(Reads the scene and its meshes and sets the simulation up, as a run would, and stops there. Writes no file.
Of cycle auto it sets up level 0 alone, tries nothing, and says what a run would try.

Examples:
  plica check ball.yaml
  plica check ball.yaml --json      # {"sound": false, "error": "ball.yaml:18: ..."}

Exit status: 0 sound, 2 not)";

constexpr const char* schema_manual =
    R"(Editors complete and check a scene by it. With the YAML language server, as in VS Code's YAML extension:
  plica schema > plica.schema.json
and as the scene's first line, with the path from the scene to that file:
  # yaml-language-server: $schema=plica.schema.json

Exit status: 0)";

constexpr const char* doctor_manual =
    R"(Says what this program is and what it runs on, measures what the machine can do (memory, cache, arithmetic: some
seconds), then lets a soft ball fall into a bowl and compares where it is and its energies with stored values. These
hold for every processor and number of threads. For a report of a fault, send what it prints.

Examples:
  plica doctor
  plica doctor --json

Exit status: 0 all as stored, 1 another answer)";

constexpr const char* completion_manual = R"(Examples:
  source <(plica completion bash)       # in ~/.bashrc
  source <(plica completion zsh)        # in ~/.zshrc, after compinit

Exit status: 0 done, 2 another shell)";

}  // namespace

std::string manual_of(const std::string& command) {
  if (command == "run") return run_manual;
  if (command == "study") return study_manual;
  if (command == "stability") return stability_manual;
  if (command == "verify") return fmt::format(fmt::runtime(verify_manual), verify_problems_text());
  if (command == "report") return report_manual;
  if (command == "view") return view_manual;
  if (command == "explain") return explain_manual;
  if (command == "check") return check_manual;
  if (command == "schema") return schema_manual;
  if (command == "doctor") return doctor_manual;
  if (command == "completion") return completion_manual;
  if (command == "list")
    return "FAMILY is one of\n" + families_text() +
           "\nExamples:\n  plica list keys\n  plica list materials --json\n  plica list reference "
           "-o FOLDER\n\n" +
           "Exit status: 0 done, 2 bad input";
  return {};
}

}  // namespace plica::app
