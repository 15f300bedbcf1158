// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <string>
#include <string_view>

namespace plica::app {

/// Files of a page, which the build has put into the program. The HTML has the placeholders
/// {{title}}, {{style}}, {{data}} and {{script}}.
struct PageFiles {
  std::string_view html, style, script;
};
/// Returns the files of the page of `plica report`, from drivers/app/report.
PageFiles report_files();
/// Returns the files of the page of `plica view`, from drivers/app/view and drivers/app/report.
PageFiles live_files();

/// Returns the page with a title and its data in JSON.
std::string filled_page(const PageFiles& files, const std::string& title, const std::string& json);

}  // namespace plica::app
