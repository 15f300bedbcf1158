// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iostream>
#include <iterator>
#include <plica/drivers/app/commands/commands.hpp>
#include <plica/drivers/app/commands/interrupt.hpp>
#include <plica/drivers/app/commands/session.hpp>
#include <plica/drivers/app/output/stability_table.hpp>
#include <plica/drivers/app/output/terminal.hpp>
#include <plica/drivers/app/output/write_file.hpp>
#include <plica/drivers/app/scene/reader.hpp>
#include <plica/drivers/study/study_case.hpp>

namespace plica::app {
namespace {

std::optional<double> budget_of(const StabilityArguments& more) {
  std::optional<double> budget;
  if (!more.budget.empty())
    read_option("--budget", more.budget, Quantity{duration, positive}, budget.emplace());
  return budget;
}

std::vector<FileBytes> files_of(const std::filesystem::path& folder, const StabilityTexts& texts) {
  return {{folder / "stability.json", texts.json}, {folder / "stability.csv", texts.csv}};
}

ExitStatus of_scene(const RunArguments& arguments, const StabilityArguments& more,
                    InterruptWatch& interrupts) {
  SetUpProgress progress(arguments.quiet);
  const Scene scene = loaded(arguments, progress);
  StudyOptions options = scene.study;
  options.duration = scene.duration, options.budget = budget_of(more);
  if (!arguments.precision.empty()) options.precision = {arguments.precision};
  const KokkosSession session(arguments.kokkos);
  try {
    check_study(scene.problem, options);
    progress.finish();
    const auto folder =
        arguments.folder.empty() ? "out" / arguments.scene.stem() : arguments.folder;
    make_folder(folder);
    const StudyMachine machine = this_machine();
    const auto texts = [&](const StabilityResult& result, const std::string& status) {
      return files_of(folder, stability_texts(scene, machine, result, status));
    };
    write_files(texts({}, "unfinished"));
    std::vector<FileBytes> left = texts({}, "interrupted");  // to be written after Ctrl-C
    const auto leaving = interrupts.on_leave(interrupts.hold(), [&] { leave_files(left, folder); });
    const ProgressLine line(arguments.quiet);
    const StabilityResult result =
        plica::stability(scene.problem, options, [&](const StabilityProgress& p) {
          if (p.new_row) {
            const auto lock = interrupts.hold();
            write_files(texts(*p.so_far, "unfinished"));
            left = texts(*p.so_far, "interrupted");
          }
          line.update(fmt::format("{}/{}  {}", p.done, p.of, p.doing));
          return !interrupts.noticed();
        });
    interrupts.end_in_order();
    write_files(texts(result, result.stopped ? "interrupted" : "completed"));
    line.clear();
    if (!arguments.quiet) std::cout << stability_text(scene, result, folder.string());
    return result.stopped ? ExitStatus::interrupted : ExitStatus::done;
  } catch (const InputError& error) {
    throw located(error, scene.source);
  }
}

ExitStatus of_matrix(const RunArguments& arguments, const StabilityArguments& more,
                     InterruptWatch& interrupts) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  const std::optional<double> budget = budget_of(more);
  const KokkosSession session(arguments.kokkos);
  const std::filesystem::path folder =
      arguments.folder.empty() ? "out/stability" : arguments.folder;
  make_folder(folder);
  const StudyMachine machine = this_machine();
  const auto texts = [&](const MatrixResult& result, const std::string& status) {
    return files_of(folder, stability_texts(machine, result, status));
  };
  write_files(texts({}, "unfinished"));
  std::vector<FileBytes> left = texts({}, "interrupted");  // to be written after Ctrl-C
  const auto leaving = interrupts.on_leave(interrupts.hold(), [&] { leave_files(left, folder); });
  const ProgressLine line(arguments.quiet);
  auto written = start;
  const MatrixWatch watch = [&](const MatrixResult& result, std::size_t of) {
    const auto now = Clock::now();
    if (std::chrono::duration<double>(now - written).count() > 1) {
      const auto lock = interrupts.hold();
      write_files(texts(result, "unfinished"));
      left = texts(result, "interrupted"), written = now;
    }
    line.update(fmt::format("{}/{}  {}, {}", result.rows.size(), of, result.rows.back().name,
                            result.rows.back().method));
    return !interrupts.noticed() &&
           !(budget && std::chrono::duration<double>(now - start).count() > *budget);
  };
  std::vector<std::function<MatrixRow()>> others = invariance_cases();
  std::ranges::move(organ_cases(), std::back_inserter(others));
  const MatrixResult result = run_matrix(stability_matrix(), others, watch);
  interrupts.end_in_order();
  write_files(texts(result, interrupted() ? "interrupted" : "completed"));
  line.clear();
  if (!arguments.quiet) std::cout << stability_text(result, folder.string());
  return interrupted() ? ExitStatus::interrupted : status_of(result);
}

}  // namespace

ExitStatus status_of(const MatrixResult& result) {
  return result.ok() ? ExitStatus::done : ExitStatus::failed;
}

ExitStatus stability(const RunArguments& arguments, const StabilityArguments& more) {
  InterruptWatch interrupts;
  return more.matrix ? of_matrix(arguments, more, interrupts)
                     : of_scene(arguments, more, interrupts);
}

}  // namespace plica::app
