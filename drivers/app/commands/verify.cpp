// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <chrono>
#include <iostream>
#include <plica/drivers/app/commands/commands.hpp>
#include <plica/drivers/app/commands/interrupt.hpp>
#include <plica/drivers/app/commands/session.hpp>
#include <plica/drivers/app/output/terminal.hpp>
#include <plica/drivers/app/output/verify_table.hpp>
#include <plica/drivers/app/output/write_file.hpp>

namespace plica::app {
namespace {

std::vector<FileBytes> verify_files(const std::filesystem::path& folder, VerifyHead head,
                                    const std::string& status, const VerifyResult& result) {
  head.status = status;
  return {{folder / "verify.json", verify_json(head, result)},
          {folder / "verify.csv", verify_csv(result)},
          {folder / "verify.md", verify_markdown(head, result)}};
}

}  // namespace

ExitStatus verify(const RunArguments& arguments, const VerifyArguments& more) {
  InterruptWatch interrupts;
  using Clock = std::chrono::steady_clock;
  check_problems(more.problems);
  const KokkosSession session(arguments.kokkos);
  const auto folder =
      arguments.folder.empty() ? std::filesystem::path("out/verify") : arguments.folder;
  make_folder(folder);
  const auto start = Clock::now();
  VerifyHead head{this_machine(), "", more.small, 0};
  std::vector<FileBytes> left;  // to be written after Ctrl-C
  const auto leaving = interrupts.on_leave(interrupts.hold(), [&] { leave_files(left, folder); });
  const ProgressLine line(arguments.quiet);
  const auto watch = [&](const VerifyProgress& p) {
    head.wall_time = std::chrono::duration<double>(Clock::now() - start).count();
    if (p.new_rows) {
      const auto lock = interrupts.hold();
      write_files(verify_files(folder, head, "unfinished", *p.so_far));
      left = verify_files(folder, head, "interrupted", *p.so_far);
    }
    line.update(fmt::format("{}/{}  {}", p.done, p.of, p.doing));
    return !interrupts.noticed();
  };
  const VerifyResult result = plica::verify({more.problems, more.small}, watch);
  line.clear();
  interrupts.end_in_order();
  write_files(verify_files(folder, head, result.stopped ? "interrupted" : "completed", result));
  if (!arguments.quiet) std::cout << verify_text(result, folder.string());
  if (result.stopped) return ExitStatus::interrupted;
  return result.ok() ? ExitStatus::done : ExitStatus::failed;
}

std::string verify_problems_text() {
  std::string text;
  for (const Choice& problem : verify_problems())
    text += fmt::format("  {:<22}{}\n", problem.name, problem.summary);
  return text;
}

}  // namespace plica::app
