// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <string_view>

namespace plica::app {

/// The files of this folder that make up a report's page, as the build has put them into the program. In page.html {{title}},
/// {{style}}, {{data}} and {{script}} stand for what belongs there.
std::string_view page_html();
/// page.css.
std::string_view page_style();
/// The scripts, one after the other.
std::string_view page_script();

}  // namespace plica::app
