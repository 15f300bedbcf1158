// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <chrono>
#include <iostream>
#include <plica/drivers/app/commands/interrupt.hpp>
#include <plica/drivers/app/commands/options.hpp>
#include <plica/drivers/app/commands/session.hpp>
#include <plica/drivers/app/commands/stability.hpp>
#include <plica/drivers/app/output/progress_line.hpp>
#include <plica/drivers/app/output/stability_json.hpp>
#include <plica/drivers/app/output/stability_text.hpp>
#include <plica/drivers/app/output/write_file.hpp>
#include <plica/drivers/study/study_methods.hpp>

namespace plica::app {
namespace {

std::optional<double> budget_of(const StabilityArguments& more) {
  std::optional<double> budget;
  if (!more.budget.empty()) read_option("--budget", more.budget, Quantity{duration, positive}, budget.emplace());
  return budget;
}

void write(const std::filesystem::path& folder, const StabilityTexts& texts) {
  write_file(folder / "stability.json", texts.json);
  write_file(folder / "stability.csv", texts.csv);
}

ExitStatus of_scene(const RunArguments& arguments, const StabilityArguments& more) {
  const Scene scene = load_scene(arguments.scene, arguments.overrides);
  warn(scene);
  StudyOptions options = scene.study;
  options.duration = scene.duration, options.budget = budget_of(more);
  if (!arguments.precision.empty()) options.precision = {arguments.precision};
  const KokkosSession session(arguments.kokkos);
  try {
    check_study(scene.problem, options);
    const auto folder = arguments.folder.empty() ? "out" / arguments.scene.stem() : arguments.folder;
    make_folder(folder);
    const StudyMachine machine = this_machine();
    const ProgressLine line(arguments.quiet);
    const StabilityResult result = plica::stability(scene.problem, options, [&](const StabilityProgress& p) {
      if (p.new_row) write(folder, stability_texts(scene, machine, *p.so_far, "unfinished"));
      line.update(fmt::format("{}/{}  {}", p.done, p.of, p.doing));
      return !interrupted();
    });
    write(folder, stability_texts(scene, machine, result, result.stopped ? "interrupted" : "completed"));
    line.clear();
    if (!arguments.quiet) std::cout << stability_text(scene, result, folder.string());
    return result.stopped ? ExitStatus::interrupted : ExitStatus::done;
  } catch (const InputError& error) {
    throw located(error, scene.source);
  }
}

ExitStatus of_matrix(const RunArguments& arguments, const StabilityArguments& more) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  const std::optional<double> budget = budget_of(more);
  const KokkosSession session(arguments.kokkos);
  const std::filesystem::path folder = arguments.folder.empty() ? "out/stability" : arguments.folder;
  make_folder(folder);
  const StudyMachine machine = this_machine();
  const ProgressLine line(arguments.quiet);
  auto written = start;
  const MatrixWatch watch = [&](const MatrixResult& result, std::size_t of) {
    const auto now = Clock::now();
    if (std::chrono::duration<double>(now - written).count() > 1)
      write(folder, stability_texts(machine, result, "unfinished")), written = now;
    line.update(
        fmt::format("{}/{}  {}, {}", result.rows.size(), of, result.rows.back().name, result.rows.back().method));
    return !interrupted() && !(budget && std::chrono::duration<double>(now - start).count() > *budget);
  };
  const MatrixResult result = run_matrix(stability_matrix(), invariance_cases(), watch);
  write(folder, stability_texts(machine, result, interrupted() ? "interrupted" : "completed"));
  line.clear();
  if (!arguments.quiet) std::cout << stability_text(result, folder.string());
  return interrupted() ? ExitStatus::interrupted : status_of(result);
}

}  // namespace

ExitStatus status_of(const MatrixResult& result) { return result.ok() ? ExitStatus::done : ExitStatus::failed; }

ExitStatus stability(const RunArguments& arguments, const StabilityArguments& more) {
  catch_interrupts();
  return more.matrix ? of_matrix(arguments, more) : of_scene(arguments, more);
}

}  // namespace plica::app
