// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <csignal>
#include <iostream>
#include <plica/drivers/app/commands/run_output.hpp>
#include <plica/drivers/app/commands/session.hpp>
#include <plica/drivers/app/output/peak_memory.hpp>
#include <plica/drivers/app/output/summary.hpp>
#include <plica/drivers/app/output/terminal.hpp>
#include <plica/drivers/app/output/write_file.hpp>
#include <plica/drivers/app/scene/input_diagnosis.hpp>
#include <plica/drivers/app/scene/load_bodies.hpp>
#include <plica/drivers/app/scene/older_keys.hpp>
#include <plica/drivers/app/scene/tree.hpp>
#include <plica/drivers/cycles/him/advice.hpp>
#include <plica/drivers/run/busy_cores.hpp>
#include <plica/version.hpp>
#include <stdexcept>

namespace plica::app {
namespace {

template <class B>
void announce(const Scene& scene, const Simulation<B>& simulation, const Machine& machine,
              const RunEnd& start) {
  std::string tets;
  for (const LevelReport& level : simulation.levels())
    if (level.tets > 0) tets += (tets.empty() ? "" : " + ") + std::to_string(level.tets);
  message(fmt::format("{}: {} tetrahedra, {}, macro step {}; {} on {}, {}", scene.name, tets,
                      cycle_name(scene, machine.choice), in_units(simulation.macro_step(), "s"),
                      machine.precision, machine.backend, counted(machine.threads, "thread")));
  if (start.macro_steps > 0)
    message(fmt::format("resumed after {} at {:.5g} s", counted(start.macro_steps, "macro step"),
                        start.time));
}

void warn_of(const std::string& sentence) {
  message(coloured("warning: ", Colour::yellow) + sentence);
}

/// Returns advice about the macro step, one sentence each; it is known before the run starts.
template <class B>
std::vector<std::string> step_advice(const Scene& scene, const Simulation<B>& simulation,
                                     const Summary& summary) {
  std::vector<std::string> sentences;
  if (const auto him = simulation.him())
    sentences = him_advice(scene.problem, *him, summary.levels, summary.macro_step);
  if (!scene.problem.integration.macro_step && summary.macro_step > scene.duration)
    sentences.push_back(
        fmt::format("integration.macro_step: the step of {} that fits this body is longer than the "
                    "duration, {}: the run is one "
                    "shorter step; expected a longer duration, or the body's sizes in metres and "
                    "its young_modulus in Pa",
                    in_units(summary.macro_step, "s"), in_units(scene.duration, "s")));
  if (std::string many = many_steps_text(scene, summary); !many.empty())
    sentences.push_back(std::move(many));
  return sentences;
}

/// Returns warnings about what the run has shown. Without those about steps that were not solved if
/// there is a diagnosis: it names the cause.
template <class B>
std::vector<std::string> end_warnings(const Simulation<B>& simulation, const RunEnd& end,
                                      const RunOutput<B>& output) {
  std::vector<std::string> sentences = output.warnings();
  if (end.diagnosis) return sentences;
  for (std::string sentence : {unsolved_text(simulation.counters()),
                               mostly_explicit_text(simulation.counters(), end.macro_steps)})
    if (!sentence.empty()) sentences.push_back(std::move(sentence));
  return sentences;
}

template <class B>
Summary summary_of(const Scene& scene, const Simulation<B>& simulation, const Machine& machine,
                   const RunEnd& end, const RunOutput<B>& output) {
  Summary summary;
  summary.status = end.status;
  summary.simulated_time = end.time;
  summary.macro_step = simulation.macro_step();
  summary.macro_steps = end.macro_steps;
  summary.wall_time = end.wall_time;
  summary.peak_memory = peak_memory();
  summary.precision = machine.precision;
  summary.backend = machine.backend;
  summary.threads = machine.threads;
  summary.choice = machine.choice;
  summary.cycle = cycle_name(scene, summary.choice);
  summary.levels = in_input_numbers(simulation.levels(), scene);
  summary.ranks = simulation.ranks();
  summary.stages = output.stages();
  summary.frames = output.files().frames();
  summary.last_good_time = output.files().last_time();
  summary.counters = simulation.counters();
  summary.residual = simulation.worst_residual();
  summary.wrenches = simulation.wrenches();
  summary.reactions = simulation.reactions();
  summary.tools = simulation.tools();
  summary.held = simulation.held();
  summary.penetrations = output.penetrations();
  if (!scene.problem.cuts.empty()) summary.cuts = simulation.cuts();
  if (scene.problem.body.following) summary.followed = simulation.followed();
  summary.diagnosis = end.diagnosis;
  summary.warnings = scene.warnings;
  for (const std::string& sentence : step_advice(scene, simulation, summary))
    summary.warnings.push_back(sentence);
  for (const std::string& sentence : end_warnings(simulation, end, output))
    summary.warnings.push_back(sentence);
  return summary;
}

// Returns the positions [m] of the corners of the diagnosis' element, or of its vertex. Element and
// vertex are numbered as in the library, not as in the file
template <class B>
std::vector<Point> corners_of(const Diagnosis& diagnosis, const Scene& scene,
                              const Simulation<B>& simulation) {
  if (diagnosis.level < 0 || (diagnosis.element < 0 && diagnosis.vertex < 0)) return {};
  const std::vector<Point> positions = simulation.positions(diagnosis.level);
  if (diagnosis.element < 0) return {positions.at(static_cast<std::size_t>(diagnosis.vertex))};
  std::vector<Point> corners;
  const TetMesh& mesh = diagnosis.level == 0
                            ? simulation.mesh()
                            : scene.problem.body.levels[static_cast<std::size_t>(diagnosis.level)];
  for (const int v : mesh.tets[static_cast<std::size_t>(diagnosis.element)])
    corners.push_back(positions[static_cast<std::size_t>(v)]);
  return corners;
}

ExitStatus status_of_run(const RunEnd& end) {
  if (end.diagnosis) return ExitStatus::diverged;
  return end.status == "interrupted" ? ExitStatus::interrupted : ExitStatus::done;
}

// Returns a checkpoint with the data that identify this run
Checkpoint new_checkpoint(const Scene& scene, const RunArguments& arguments) {
  Checkpoint checkpoint;
  checkpoint.scene_file = scene.file;
  checkpoint.scene_path = std::filesystem::absolute(scene.file).string();
  checkpoint.scene = scene.source;
  checkpoint.meshes = mesh_digest(scene.problem.body);
  checkpoint.precision = arguments.precision.empty() ? "double" : arguments.precision;
  checkpoint.frame_every = scene.output.every.value_or(Interval{scene.duration / 60, 0});
  return checkpoint;
}

void take_over(Checkpoint& checkpoint, const Machine& machine) {
  const std::string program = version() + std::string(" ") + git_revision();
  const bool resumed = !checkpoint.program.empty();
  if (resumed && (checkpoint.program != program || checkpoint.backend != machine.backend))
    message(coloured("warning: ", Colour::yellow) +
            fmt::format("the checkpoint was written by plica {} on {}, this is {} on {}: the last "
                        "bits may differ",
                        checkpoint.program, checkpoint.backend, program, machine.backend));
  checkpoint.program = program, checkpoint.backend = machine.backend;
}

std::filesystem::path folder_of(const RunArguments& arguments) {
  if (!arguments.resume.empty()) return arguments.resume;
  return arguments.folder.empty() ? "out" / arguments.scene.stem() : arguments.folder;
}

// Throws InputError if the folder holds a run: a new run would delete it, so the user has to ask
void refuse_to_replace(const std::filesystem::path& folder) {
  const std::vector<std::string> found = former_run(folder);
  if (found.empty()) return;
  const std::string resume = found.front() == "checkpoint.bin"
                                 ? fmt::format(", --resume {} to go on with it", folder.string())
                                 : "";
  throw InputError(fmt::format(
      "the folder {} holds a run already ({}); expected --force to replace it{}, or another "
      "folder with -o",
      folder.string(), fmt::join(found, ", "), resume));
}

// Returns where the run starts: at the beginning, or at the checkpoint, whose state it restores
template <class B>
RunEnd start_of(Simulation<B>& simulation, const Checkpoint& checkpoint,
                const std::filesystem::path& folder) {
  RunEnd start;
  if (checkpoint.state.bytes.empty()) return start;
  try {
    simulation.restore(checkpoint.state);
  } catch (const InputError& error) {
    throw InputError(error.what(), {(folder / "checkpoint.bin").string()});
  }
  start.macro_steps = checkpoint.macro_steps, start.time = simulation.time(),
  start.wall_time = checkpoint.wall_time;
  return start;
}

// Writes the summary of the last complete macro step, after Ctrl-C within a step. The other files
// stay as they are
void leave_run(const Scene& scene, Summary summary, const RunArguments& arguments,
               const std::filesystem::path& folder) {
  summary.status = "interrupted";
  write_file(folder / "summary.json", summary_json(scene, summary, arguments.words));
  message(fmt::format("interrupted within a macro step; the files go up to {:.5g} s",
                      summary.last_good_time));
  if (!arguments.quiet) std::cout << summary_text(scene, summary, folder.string());
}

Interval interval_of(const RunArguments& arguments) {
  return arguments.checkpoint.empty() ? Interval{} : checkpoint_interval(arguments.checkpoint);
}

template <class B>
ExitStatus simulate(const Scene& scene, Simulation<B>& simulation, const Machine& machine,
                    double set_up_time, const RunArguments& arguments, Checkpoint checkpoint,
                    InterruptWatch& watch) {
  const std::filesystem::path folder = folder_of(arguments);
  // throws for too many steps, before the folder is made
  const long steps = steps_of(scene, simulation.macro_step());
  make_folder(folder);
  const FolderLock alone(folder);
  take_over(checkpoint, machine);
  const RunEnd start = start_of(simulation, checkpoint, folder);
  if (start.macro_steps > steps)
    throw InputError(fmt::format("the run is at {} already, beyond a duration of {}",
                                 in_units(start.time, "s"), in_units(scene.duration, "s")));
  auto lock = watch.hold();
  RunOutput<B> output(scene, simulation, folder, checkpoint, !arguments.resume.empty());
  const CoreWait wait;
  const auto summary_at = [&](const RunEnd& end) {
    Summary summary = summary_of(scene, simulation, machine, end, output);
    summary.setup_time = set_up_time;
    summary.wait_share = wait.share(machine.threads);
    return summary;
  };
  Summary latest = summary_at(start);
  const auto leaving = watch.on_leave(lock, [&] { leave_run(scene, latest, arguments, folder); });
  lock.unlock();
  if (!arguments.quiet) announce(scene, simulation, machine, start);
  for (const std::string& sentence : step_advice(scene, simulation, latest)) warn_of(sentence);
  simulation.share_cores();
  // free on a host: only a device has to wait between stages
  simulation.time_stages(B::on_host || arguments.time_stages);
  RunEnd end = [&] {
    Progress progress(scene.duration, arguments.quiet, start.time, start.macro_steps);
    return run_loop(simulation, scene, start, output, progress, watch,
                    [&](const RunEnd& now) { latest = summary_at(now); });
  }();
  std::vector<Point> diagnosed;
  if (end.diagnosis) {
    diagnosed = corners_of(*end.diagnosis, scene, simulation);
    end.diagnosis = in_input_numbers(*end.diagnosis, scene);
  }
  Summary summary = summary_at(end);
  summary.diagnosed = diagnosed;
  write_file(folder / "summary.json", summary_json(scene, summary, arguments.words));
  if (end.diagnosis) message(coloured("diverged: ", Colour::red) + end.diagnosis->text());
  if (!end.diagnosis)
    for (const std::string& sentence : end_warnings(simulation, end, output)) warn_of(sentence);
  if (!arguments.quiet) std::cout << summary_text(scene, summary, folder.string());
  return status_of_run(end);
}

[[noreturn]] void refuse_on_ranks(const std::string& what) {
  throw InputError(what + " needs one process; expected a run without it");
}

}  // namespace

Scene scene_to_resume(const RunArguments& arguments, const Checkpoint& from) {
  if (!arguments.precision.empty() && arguments.precision != from.precision)
    throw InputError("cannot resume in " + arguments.precision + ": the run is in " +
                     from.precision);
  Tree tree = arguments.scene.empty() ? from.scene : read_tree(arguments.scene);
  for (const Override& given : arguments.overrides) set_value(tree, given.assignment, given.label);
  use_present_keys(tree);
  tree = shared_integration(tree);  // the scene of the checkpoint has it too
  if (const std::string difference = first_difference(from.scene, tree, "duration");
      !difference.empty())
    throw InputError("cannot resume another scene: " + difference +
                     "; only the duration may change");
  Scene scene = load_scene(tree);
  if (mesh_digest(scene.problem.body) != from.meshes)
    throw InputError("cannot resume: the meshes are not those of the run; has a mesh file changed?",
                     {from.scene_file});
  scene.file = from.scene_file;
  return scene;
}

Interval checkpoint_interval(const std::string& text) {
  const std::string expected =
      "--checkpoint: expected every=N macro steps or every=TIME, such as every=100 or every=0.1s, "
      "got '" +
      text + "'";
  if (!text.starts_with("every=")) throw InputError(expected);
  const std::string interval = text.substr(6);
  const bool digits =
      !interval.empty() && interval.find_first_not_of("0123456789") == std::string::npos;
  try {
    return parse_interval(digits ? interval + " steps" : interval);
  } catch (const std::invalid_argument& problem) {
    throw InputError(expected + ", " + problem.what());
  }
}

namespace {

// Scene of a run, and the checkpoint that it goes on from or will write
struct ReadRun {
  Scene scene;
  Checkpoint checkpoint;
};

// Reads the scene, or the checkpoint of the run that is resumed. Throws InputError, also where the
// folder holds another run
ReadRun read_run(const RunArguments& arguments, bool writes) {
  const bool resumed = !arguments.resume.empty();
  const Interval every = interval_of(arguments);
  ReadRun read;
  if (resumed) read.checkpoint = read_checkpoint(arguments.resume);
  read.scene = resumed ? scene_to_resume(arguments, read.checkpoint)
                       : load_scene(arguments.scene, arguments.overrides);
  if (!resumed && writes && !arguments.force) refuse_to_replace(folder_of(arguments));
  if (!resumed) read.checkpoint = new_checkpoint(read.scene, arguments);
  read.checkpoint.scene = read.scene.source;  // with a new duration
  if (every != Interval{}) read.checkpoint.every = every;
  return read;
}

// Runs a scene on several ranks. All of them read it and set it up; rank 0 then does what a single
// process does, and the others follow
ExitStatus run_on_ranks(const RunArguments& arguments) {
  Ranks& ranks = *arguments.ranks;
  const bool leads = ranks.own() == 0;
  std::optional<InterruptWatch> watch;
  if (leads)
    watch.emplace();
  else
    std::signal(SIGINT, SIG_IGN);  // rank 0 ends the run
  SetUpProgress progress(arguments.quiet || !leads);
  progress.phase("reading the scene and its meshes");
  ReadRun read;
  ranks.together([&] {
    read = read_run(arguments, leads);
    if (!read.scene.output.probes.empty()) refuse_on_ranks("output.probes");
    if (!leads) read.checkpoint.state = {};  // rank 0 restores it for all
  });
  if (leads) warn(read.scene);
  const auto action = [&](const Scene& scene, auto& simulation, const Machine& machine,
                          double set_up_time) {
    if (!leads) return static_cast<ExitStatus>(simulation.follow());
    simulation.lead();
    const ExitStatus status =
        simulate(scene, simulation, machine, set_up_time, arguments, read.checkpoint, *watch);
    simulation.dismiss(static_cast<int>(status));
    return status;
  };
  return with_simulation(read.scene, read.checkpoint.precision, arguments.kokkos, progress, action,
                         {true, {}, &ranks});
}

}  // namespace

ExitStatus run(const RunArguments& arguments) {
  if (arguments.ranks) return run_on_ranks(arguments);
  InterruptWatch watch;
  SetUpProgress progress(arguments.quiet);
  progress.phase("reading the scene and its meshes");
  ReadRun read = read_run(arguments, true);
  warn(read.scene);
  Checkpoint& checkpoint = read.checkpoint;
  const CycleAuto made{true, checkpoint.choice};
  const auto action = [&](const Scene& scene, auto& simulation, const Machine& machine,
                          double set_up_time) {
    checkpoint.choice = machine.choice;
    return simulate(scene, simulation, machine, set_up_time, arguments, checkpoint, watch);
  };
  return with_simulation(read.scene, checkpoint.precision, arguments.kokkos, progress, action,
                         made);
}

}  // namespace plica::app
