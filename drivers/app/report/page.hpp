// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <string>
#include <string_view>

namespace plica::app {

/// What a page is made of, as the build has put it into the program. In the HTML {{title}},
/// {{style}}, {{data}} and {{script}} stand for what belongs there.
struct PageFiles {
  std::string_view html, style, script;
};
/// Of `plica report`: the files of this folder.
PageFiles report_files();
/// Of `plica view`: those of drivers/app/view, with some of these.
PageFiles live_files();

/// The page with these data, in JSON.
std::string filled_page(const PageFiles& files, const std::string& title, const std::string& json);

}  // namespace plica::app
