// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <chrono>
#include <deque>
#include <plica/drivers/app/commands/commands.hpp>
#include <plica/drivers/app/commands/interrupt.hpp>
#include <plica/drivers/app/output/border_contact.hpp>
#include <plica/drivers/app/output/checkpoint.hpp>
#include <plica/drivers/app/output/contact_depth.hpp>
#include <plica/drivers/app/output/inside_out.hpp>
#include <plica/drivers/app/output/run_files.hpp>
#include <plica/drivers/app/output/summary.hpp>
#include <plica/drivers/app/output/terminal.hpp>
#include <plica/drivers/body/initial_state.hpp>
#include <plica/drivers/run/energy_meter.hpp>
#include <plica/drivers/run/material_points.hpp>
#include <plica/drivers/run/obstacles_inside.hpp>
#include <set>

namespace plica::app {

/// Returns the scene of the run to resume: the checkpoint's scene, or an equal scene that is given.
/// Only the duration may differ. Throws InputError that names any other difference.
Scene scene_to_resume(const RunArguments& arguments, const Checkpoint& from);

/// Reads the interval of checkpoints: "every=100" or "every=100 steps" (macro steps), or
/// "every=0.1s" (simulated time). Throws InputError for other text.
Interval checkpoint_interval(const std::string& text);

/// Progress of a run, and how it ended.
struct RunEnd {
  std::string status = "completed";  ///< completed | interrupted | diverged
  long macro_steps = 0;              ///< number of macro steps that passed the checks
  double time = 0;                   ///< simulated time after these steps [s]
  double wall_time = 0;              ///< wall time of the steps and their checks [s]
  std::optional<Diagnosis> diagnosis;
};

/// Writer of probes.csv: positions [m] and velocities [m/s] of the scene's probes, by name.
template <class B>
class Probes {
 public:
  /// Starts the file, or continues it after its first `kept` bytes.
  Probes(const Scene& scene, const std::filesystem::path& file,
         std::optional<std::uint64_t> kept = {})
      : asked_(points_of(scene.output.probes)),
        points_(scene.problem.body.levels.front(), asked_),
        placement_(placement_of(scene.problem.body)),
        file_(kept ? GrowingFile(file, *kept)
                   : GrowingFile(file, probe_head(names_of(scene.output.probes)))) {}

  void write(const Simulation<B>& simulation, double time) {
    if (const long changes = simulation.mesh_changes(); changes != changes_)
      points_ = MaterialPoints<B>(simulation.mesh(), asked_), changes_ = changes;
    auto [positions, velocities] =
        points_.sample({}, simulation.displacement(), simulation.velocity());
    for (std::size_t i = 0; i < positions.size(); ++i)
      positions[i] += points_.rest()[i] + placement_;
    file_.add(probe_row(time, positions, velocities));
  }
  GrowingFile& file() { return file_; }
  const GrowingFile& file() const { return file_; }

 private:
  std::vector<Point> asked_;
  MaterialPoints<B> points_;
  long changes_ = 0;  // number of changes of the mesh before points_ was made
  Point placement_;
  GrowingFile file_;
};

/// Writer of the files of a run while it goes on. It writes frames with history, probes and
/// checkpoints, each at its own times.
template <class B>
class RunOutput {
 public:
  /// Opens the files of the run that `checkpoint` describes. If the run is `resumed`, the files are
  /// cut back to the time of the checkpoint.
  RunOutput(const Scene& scene, const Simulation<B>& simulation,
            const std::filesystem::path& folder, Checkpoint checkpoint, bool resumed)
      : simulation_(simulation),
        problem_(scene.problem),
        folder_(folder),
        checkpoint_(std::move(checkpoint)),
        recorded_(resumed ? checkpoint_.macro_steps : -1),
        saved_(recorded_),
        files_(scene, folder, resumed ? std::optional(checkpoint_.files) : std::nullopt),
        frames_(checkpoint_.frame_every, simulation.macro_step()),
        probing_(scene.output.probe_every.value_or(Interval{0, 1}), simulation.macro_step()),
        energy_(simulation, scene.problem),
        watches_energy_(EnergyBudget::knows(scene.problem)),
        inside_out_(scene.problem.body.material),
        depth_(scene.problem.contact, simulation.levels()[0].mean_edge,
               scene.problem.body.surface.value_or(TriangleSurface{}), has_pairs(scene.problem)),
        border_(scene.problem.body.levels.front(),
                scene.problem.body.surface.value_or(TriangleSurface{})),
        work_(simulation, scene.problem) {
    stages_before_ = checkpoint_.stages;
    if (resumed) restore_saved();
    if (!scene.output.probes.empty())
      probes_.emplace(scene, folder / "probes.csv",
                      resumed ? std::optional(checkpoint_.files.probe_bytes) : std::nullopt);
    if (checkpoint_.every != Interval{})
      saving_.emplace(checkpoint_.every, simulation.macro_step());
    marks_.push_back(mark());
  }

  /// Writes what is due. To be called before the first macro step and after each one.
  void record(const RunEnd& now) {
    add(now);
    if (saving_ && saved_ < now.macro_steps && (replaces_saved_ || saving_->due(now.macro_steps)))
      save(now);
  }

  /// Replaces what was written for this macro step and for all later ones. To be called after a
  /// macro step that is repeated. What was on disk when a run was resumed stays. A checkpoint of a
  /// replaced step is replaced at once.
  void record_again(const RunEnd& now) {
    if (now.macro_steps <= marks_.front().macro_steps) return;
    if (now.macro_steps <= recorded_) go_back(now.macro_steps - 1);
    add(now);
    if (saving_ && replaces_saved_) save(now);
  }

  /// Removes what was written after this number of macro steps.
  void go_back(long macro_steps) {
    while (marks_.size() > 1 && marks_.back().macro_steps > macro_steps) marks_.pop_back();
    const Mark& to = marks_.back();
    files_.cut_back(to.frames, to.history_bytes);
    if (probes_) probes_->file().cut_back(to.probe_bytes);
    energy_.restore(to.energy), inside_out_.restore(to.inside_out), restore_contact(to.depth);
    recorded_ = macro_steps;
    if (saved_ > macro_steps) saved_ = -1, replaces_saved_ = true;
  }

  /// Saves the last checkpoint. To be called before a final step that is shorter than the others: a
  /// run that is resumed with a longer duration must start before that step.
  void before_shorter_step(const RunEnd& now) {
    if (saving_ && saved_ != now.macro_steps) save(now);
    saving_.reset();
  }

  /// Writes the last checkpoint and the last frame. To be called after the last step. The frame
  /// comes after the checkpoint, since a run with a longer duration may have no frame at this time.
  void finish(const RunEnd& end, double last_time) {
    if (saving_ && (replaces_saved_ || (!end.diagnosis && saved_ != end.macro_steps))) save(end);
    if (files_.last_time() < last_time) write_frame(last_time);
  }

  const RunFiles& files() const { return files_; }
  const Penetrations& penetrations() const { return depth_.all(); }
  /// Returns what frames and the rows of history.csv have shown to be wrong, one sentence each.
  std::vector<std::string> warnings() const {
    std::vector<std::string> sentences = {energy_.warning(), inside_out_.warning(),
                                          depth_.warning(), border_.warning()};
    std::erase(sentences, "");
    return sentences;
  }
  /// Returns the wall time of each stage since the run was first started [s].
  std::map<std::string, double> stages() const {
    std::map<std::string, double> all = stages_before_;
    for (const auto& [stage, seconds] : simulation_.stages()) all[stage] += seconds;
    return all;
  }

 private:
  /// Sizes of the files after a macro step that wrote to them, and what the frames had shown.
  struct Mark {
    long macro_steps;
    std::size_t frames;
    std::uint64_t history_bytes, probe_bytes;
    std::vector<double> energy, inside_out, depth;
  };
  Mark mark() const {
    return {recorded_,
            files_.frames(),
            files_.history_bytes(),
            probes_ ? probes_->file().size() : 0,
            energy_.save(),
            inside_out_.save(),
            saved_contact()};
  }
  /// Returns what frames have shown of contact.
  std::vector<double> saved_contact() const {
    std::vector<double> saved = depth_.save();
    saved.push_back(border_.first());
    return saved;
  }
  void restore_contact(std::vector<double> saved) {
    if (saved.empty()) throw InputError("the saved state is damaged: it has no contact depths");
    border_.restore(saved.back()), saved.pop_back();
    depth_.restore(saved);
  }

  /// Restores what the checkpoint has of earlier frames. Throws InputError where values are
  /// missing.
  void restore_saved() {
    try {
      const std::vector<double>& energy = checkpoint_.energy;
      expect_saved("energy and work", energy.size(), 7);
      energy_.restore({energy.begin(), energy.begin() + 5});
      work_.restore(energy[5], energy[6] > 0);
      inside_out_.restore(checkpoint_.inside_out);
      restore_contact(checkpoint_.depth);
    } catch (const InputError& error) {
      throw InputError(error.what(), {(folder_ / "checkpoint.bin").string()});
    }
  }

  void add(const RunEnd& now) {
    if (now.macro_steps <= recorded_) return;  // a resumed run starts with a step that is on disk
    if (recorded_ >= 0 && watches_energy_) work_.step(simulation_);
    recorded_ = now.macro_steps;
    const bool frame = frames_.due(now.macro_steps),
               probe = probes_ && probing_.due(now.macro_steps);
    if (frame) write_frame(now.time);
    if (probe) probes_->write(simulation_, now.time);
    if (!frame && !probe) return;
    marks_.push_back(mark());
    while (marks_.size() > 1 && marks_[1].macro_steps <= simulation_.earliest_kept())
      marks_.pop_front();
  }

  void write_frame(double time) {
    const Snapshot now = take_snapshot(simulation_, time, files_.volumes(), files_.output());
    if (watches_energy_ && work_.known()) energy_.look(time, now.energies, work_.done());
    if (inside_out_.looks()) inside_out_.look(time, simulation_.element_fields());
    if (depth_.looks()) {
      const std::vector<double> depths = simulation_.contact_depths();
      depth_.look(time, depths, obstacles_inside(simulation_, problem_, depths),
                  simulation_.pair_depth());
      if (border_.looks()) border_.look(time, simulation_.contact_pressure());
    }
    files_.follow_mesh(simulation_);
    files_.write(now);
    for (const std::string& name : empty_handed(problem_.contact, now, simulation_.macro_step()))
      if (warned_.insert(name).second)
        message(coloured("warning: ", Colour::yellow) + name +
                " has closed and holds no point; expected the surface to touch it by then, or a "
                "longer grasp.reach");
  }

  void save(const RunEnd& now) {
    files_.sync();
    if (probes_) probes_->file().sync();
    checkpoint_.macro_steps = saved_ = now.macro_steps, replaces_saved_ = false;
    checkpoint_.wall_time = now.wall_time;
    checkpoint_.stages = stages();
    checkpoint_.energy = energy_.save();
    checkpoint_.energy.insert(checkpoint_.energy.end(), {work_.done(), work_.known() ? 1.0 : 0.0});
    checkpoint_.inside_out = inside_out_.save();
    checkpoint_.depth = saved_contact();
    checkpoint_.files = files_.mark();
    if (probes_) checkpoint_.files.probe_bytes = probes_->file().size();
    checkpoint_.state = simulation_.save();
    write_checkpoint(folder_, checkpoint_);
  }

  const Simulation<B>& simulation_;
  const Problem& problem_;
  std::set<std::string> warned_;  // names of obstacles that closed and grasped nothing
  std::filesystem::path folder_;
  Checkpoint checkpoint_;
  std::map<std::string, double> stages_before_;
  long recorded_, saved_;  // the last macro step written to files, to a checkpoint; -1: none
  RunFiles files_;
  std::optional<Probes<B>> probes_;
  Schedule frames_, probing_;
  EnergyBudget energy_;
  bool watches_energy_;
  InsideOut inside_out_;
  ContactDepth depth_;
  BorderContact border_;
  ObstacleWork<B> work_;
  std::optional<Schedule> saving_;
  bool replaces_saved_ = false;  // true: the last checkpoint is of a step that was taken back
  std::deque<Mark> marks_;       // from the earliest state that the run may go back to
};

/// Takes macro steps to the end of the scene, or until Ctrl-C or divergence. Keeps the files on
/// disk up to date. An automatic macro step is shortened at the end of the scene. A macro step of a
/// given size is not shortened, so the last one may reach beyond the duration.
///
/// Calls reached(end) after the start, after every frame, and after macro steps at most ten times a
/// second. It keeps the data that `watch` writes if a macro step takes too long after Ctrl-C.
template <class B, class Reached>
RunEnd run_loop(Simulation<B>& simulation, const Scene& scene, RunEnd end, RunOutput<B>& output,
                Progress& progress, InterruptWatch& watch, const Reached& reached) {
  using Clock = std::chrono::steady_clock;
  const long steps = steps_to_cover(scene.duration, simulation.macro_step());
  const bool automatic = !scene.problem.integration.macro_step;
  if (automatic) simulation.end_at(scene.duration);
  Clock::time_point told{};
  std::size_t frames = 0;
  const auto tell = [&](const RunEnd& state) {
    const auto now = Clock::now();
    if (frames == output.files().frames() && now - told < std::chrono::milliseconds(100)) return;
    told = now, frames = output.files().frames();
    reached(state);
  };
  const auto record = [&] {
    const auto lock = watch.hold();
    output.record(end);
    tell(end);
  };
  bool replaced = false;  // some files of the present macro step were replaced
  simulation.on_repeated_step([&] {
    const auto lock = watch.hold();
    RunEnd now = end;
    now.time = simulation.time(), now.macro_steps = simulation.macro_steps();
    output.record_again(now);
    tell(now);
    replaced = true;
  });
  record();
  while (end.macro_steps < steps && !interrupted()) {
    if (automatic && end.macro_steps + 1 == steps) output.before_shorter_step(end);
    const auto start = Clock::now();
    replaced = false;
    end.diagnosis = simulation.step_checked();
    end.wall_time += std::chrono::duration<double>(Clock::now() - start).count();
    if (end.diagnosis) break;
    ++end.macro_steps;
    end.time = simulation.time();
    record();
    progress.update(end.time, end.macro_steps, [&] { return halvings_of(simulation); });
  }
  watch.end_in_order();
  double last = end.time;
  if (end.diagnosis) {
    simulation.return_to_last_good();
    last = simulation.time();
    if (replaced) output.go_back(simulation.macro_steps());
  }
  simulation.on_repeated_step({});
  if (end.diagnosis || end.macro_steps < steps)
    end.status = end.diagnosis ? "diverged" : "interrupted";
  output.finish(end, last);
  return end;
}

}  // namespace plica::app
