// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <iostream>
#include <plica/drivers/app/commands/commands.hpp>
#include <plica/drivers/app/output/terminal.hpp>
#include <plica/drivers/app/output/write_file.hpp>
#include <plica/drivers/app/report/report.hpp>

namespace plica::app {

ExitStatus report(const ReportArguments& arguments) {
  const Report made = make_report(arguments.folder, static_cast<std::size_t>(arguments.frames));
  for (const std::string& warning : made.warnings)
    message(coloured("warning: ", Colour::yellow) + warning);
  const auto file = arguments.folder / "report.html";
  write_file(file, made.html);
  const std::string there = counted(static_cast<long>(made.frames_there), "frame");
  const std::string frames = made.frames_there == 0 ? ""
                             : made.frames < made.frames_there
                                 ? fmt::format("{} of {}, ", made.frames, there)
                                 : there + ", ";
  if (!arguments.quiet)
    std::cout << fmt::format("{} ({}{})\n", file.string(), frames, in_bytes(made.html.size()));
  return ExitStatus::done;
}

}  // namespace plica::app
