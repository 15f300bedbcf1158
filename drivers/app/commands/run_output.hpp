// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/app/output/checkpoint.hpp>
#include <plica/drivers/app/output/probes.hpp>

namespace plica::app {

/// How far a run is, and how it ended.
struct RunEnd {
  std::string status = "completed";  ///< completed | interrupted | diverged
  long macro_steps = 0;              ///< that passed the checks
  double time = 0;                   ///< after them [s]
  double wall_time = 0;              ///< of the steps and their checks [s]
  std::optional<Diagnosis> diagnosis;
};

/// What a run writes while it goes on, each thing at its times: frames with history, probes, checkpoints.
template <class B>
class RunOutput {
 public:
  /// `checkpoint` says which run this is; its files are cut back to where it stands where the run is `resumed`.
  RunOutput(const Scene& scene, const Simulation<B>& simulation, const std::filesystem::path& folder,
            Checkpoint checkpoint, bool resumed)
      : simulation_(simulation),
        folder_(folder),
        checkpoint_(std::move(checkpoint)),
        recorded_(resumed ? checkpoint_.macro_steps : -1),
        files_(scene, folder, resumed ? std::optional(checkpoint_.files) : std::nullopt),
        frames_(checkpoint_.frame_every, simulation.macro_step()),
        probing_(scene.output.probe_every.value_or(Interval{0, 1}), simulation.macro_step()) {
    stages_before_ = checkpoint_.stages;
    if (!scene.output.probes.empty())
      probes_.emplace(scene, folder / "probes.csv",
                      resumed ? std::optional(checkpoint_.files.probe_bytes) : std::nullopt);
    if (checkpoint_.every != Interval{}) saving_.emplace(checkpoint_.every, simulation.macro_step());
  }

  /// After a macro step, and once before the first.
  void record(const RunEnd& now) {
    if (now.macro_steps <= recorded_) return;  // where the run goes on: it is on the disk
    recorded_ = now.macro_steps;
    if (frames_.due(now.macro_steps)) write_frame(now.time);
    if (probes_ && probing_.due(now.macro_steps)) probes_->write(simulation_, now.time);
    if (saving_ && saving_->due(now.macro_steps)) save(now);
  }

  /// After the last step. The last frame comes after the last checkpoint: a longer run has it at its own time, if at all.
  void finish(const RunEnd& end, double last_time) {
    if (saving_ && !end.diagnosis && saved_ != end.macro_steps) save(end);
    if (files_.last_time() < last_time) write_frame(last_time);
  }

  const RunFiles& files() const { return files_; }
  /// Wall time per stage since the first start [s].
  std::map<std::string, double> stages() const {
    std::map<std::string, double> all = stages_before_;
    for (const auto& [stage, seconds] : simulation_.stages()) all[stage] += seconds;
    return all;
  }

 private:
  void write_frame(double time) { files_.write(take_snapshot(simulation_, time, files_.volumes())); }

  void save(const RunEnd& now) {
    files_.sync();
    if (probes_) probes_->file().sync();
    checkpoint_.macro_steps = saved_ = now.macro_steps;
    checkpoint_.wall_time = now.wall_time;
    checkpoint_.stages = stages();
    checkpoint_.files = files_.mark();
    if (probes_) checkpoint_.files.probe_bytes = probes_->file().size();
    checkpoint_.state = simulation_.save();
    write_checkpoint(folder_, checkpoint_);
  }

  const Simulation<B>& simulation_;
  std::filesystem::path folder_;
  Checkpoint checkpoint_;
  std::map<std::string, double> stages_before_;
  long recorded_;
  RunFiles files_;
  std::optional<Probes<B>> probes_;
  Schedule frames_, probing_;
  std::optional<Schedule> saving_;
  long saved_ = -1;
};

}  // namespace plica::app
