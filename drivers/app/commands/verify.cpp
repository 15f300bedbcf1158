// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <iostream>
#include <plica/drivers/app/commands/interrupt.hpp>
#include <plica/drivers/app/commands/session.hpp>
#include <plica/drivers/app/commands/verify.hpp>
#include <plica/drivers/app/output/progress_line.hpp>
#include <plica/drivers/app/output/verify_json.hpp>
#include <plica/drivers/app/output/verify_text.hpp>
#include <plica/drivers/app/output/write_file.hpp>

namespace plica::app {
namespace {

void write_table(const std::filesystem::path& folder, const VerifyHead& head, const VerifyResult& result) {
  write_files({{folder / "verify.json", verify_json(head, result)},
               {folder / "verify.csv", verify_csv(result)},
               {folder / "verify.md", verify_markdown(head, result)}});
}

}  // namespace

ExitStatus verify(const RunArguments& arguments, const VerifyArguments& more) {
  catch_interrupts();
  check_problems(more.problems);
  const KokkosSession session(arguments.kokkos);
  const auto folder = arguments.folder.empty() ? std::filesystem::path("out/verify") : arguments.folder;
  make_folder(folder);
  const auto start = Clock::now();
  VerifyHead head{this_machine(), "unfinished", more.small, 0};
  const ProgressLine line(arguments.quiet);
  const auto watch = [&](const VerifyProgress& p) {
    head.wall_time = std::chrono::duration<double>(Clock::now() - start).count();
    if (p.new_rows) write_table(folder, head, *p.so_far);
    line.update(fmt::format("{}/{}  {}", p.done, p.of, p.doing));
    return !interrupted();
  };
  const VerifyResult result = plica::verify({more.problems, more.small}, watch);
  line.clear();
  head.status = result.stopped ? "interrupted" : "completed";
  write_table(folder, head, result);
  if (!arguments.quiet) std::cout << verify_text(result, folder.string());
  if (result.stopped) return ExitStatus::interrupted;
  return result.ok() ? ExitStatus::done : ExitStatus::failed;
}

std::string verify_problems_text() {
  std::string text;
  for (const Choice& problem : verify_problems()) text += fmt::format("  {:<22}{}\n", problem.name, problem.summary);
  return text;
}

}  // namespace plica::app
