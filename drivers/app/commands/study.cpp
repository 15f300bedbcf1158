// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <chrono>
#include <iostream>
#include <plica/drivers/app/commands/commands.hpp>
#include <plica/drivers/app/commands/interrupt.hpp>
#include <plica/drivers/app/commands/session.hpp>
#include <plica/drivers/app/output/study_files.hpp>
#include <plica/drivers/app/output/study_table.hpp>
#include <plica/drivers/app/output/terminal.hpp>
#include <plica/drivers/app/scene/reader.hpp>

namespace plica::app {
namespace {

StudyOptions options_of(const Scene& scene, const RunArguments& arguments,
                        const StudyArguments& more) {
  StudyOptions options = scene.study;
  options.duration = scene.duration, options.probes = scene.output.probes;
  options.growth = options.growth || more.growth;
  if (!arguments.precision.empty()) options.precision = {arguments.precision};
  if (!more.budget.empty())
    read_option("--budget", more.budget, Quantity{duration, positive}, options.budget.emplace());
  if (more.truth && !options.truth) options.truth.emplace();
  if (more.space && options.truth)
    throw InputError(
        "--space: the study is against the truth (study.truth), which has the error in space",
        place_of(scene.source, "study.truth"));
  if (more.space) options.finer = finer_mesh(scene);
  return options;
}

StudyResult run_study(const Scene& scene, const StudyOptions& options, const StudyFiles& files,
                      bool quiet, InterruptWatch& interrupts, bool replaces) {
  StudyResult before = files.read();
  if (before.rows.empty() && files.holds_another() && !replaces)
    throw InputError(
        fmt::format("{} holds a study of another scene, options, program or machine; expected "
                    "another folder, or --force to replace it",
                    files.folder().string()));
  if (!quiet && !before.rows.empty())
    message(fmt::format("going on with {}: {} there", files.folder().string(),
                        counted(static_cast<long>(before.rows.size()), "row")));
  std::vector<FileBytes> left;  // to be written after Ctrl-C
  std::string doing;
  const auto leaving =
      interrupts.on_leave(interrupts.hold(), [&] { leave_files(left, files.folder()); });
  const ProgressLine line(quiet);
  const StudyWatch watch = [&](const StudyProgress& p) {
    const bool has_news = p.new_reference || p.new_row;
    if (has_news || (p.doing != doing && !left.empty())) {
      const auto lock = interrupts.hold();
      if (p.new_reference) files.write_reference(p.so_far->reference);
      if (has_news) write_files(files.texts(*p.so_far, "unfinished"));
      left = files.texts(*p.so_far, "interrupted", p.doing);
      doing = p.doing;
    }
    line.update(fmt::format("{}/{}  {:3.0f} %  {}", p.done, p.of, 100 * p.part, p.doing));
    return !interrupts.noticed();
  };
  StudyResult result = plica::study(scene.problem, options, watch, std::move(before));
  interrupts.end_in_order();
  if (!result.reference.trajectory.u.empty())
    write_files(files.texts(result, result.stopped ? "interrupted" : "completed"));
  return result;
}

}  // namespace

ExitStatus study(const RunArguments& arguments, const StudyArguments& more) {
  InterruptWatch interrupts;
  SetUpProgress progress(arguments.quiet);
  const Scene scene = loaded(arguments, progress);
  const StudyOptions options = options_of(scene, arguments, more);
  const KokkosSession session(arguments.kokkos);
  try {
    check_study(scene.problem, options);
    progress.finish();
    const auto folder =
        arguments.folder.empty() ? "out" / arguments.scene.stem() : arguments.folder;
    make_folder(folder);
    const FolderLock alone(folder);
    const StudyFiles files(scene, options, folder);
    if (!arguments.quiet)
      message(fmt::format("{}: {:g} s, {} tetrahedra; {} on {}, {}", scene.name, scene.duration,
                          scene.problem.body.levels.front().tets.size(),
                          fmt::join(options.precision, " and "), files.machine().backend,
                          counted(files.machine().threads, "thread")));
    const auto start = std::chrono::steady_clock::now();
    const StudyResult result =
        run_study(scene, options, files, arguments.quiet, interrupts, arguments.force);
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
    if (!arguments.quiet && options.budget && taken.count() > 1.1 * *options.budget)
      message(
          fmt::format("the study took {}, more than its budget of {}: the reference and every "
                      "level alone are run "
                      "whatever they take",
                      in_units(taken.count(), "s"), in_units(*options.budget, "s")));
    if (!arguments.quiet) std::cout << study_text(scene, result, folder.string());
    return result.stopped ? ExitStatus::interrupted : ExitStatus::done;
  } catch (const InputError& error) {
    throw located(error, scene.source);
  }
}

}  // namespace plica::app
