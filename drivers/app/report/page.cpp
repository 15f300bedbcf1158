// SPDX-License-Identifier: BSD-3-Clause
#include <map>
#include <plica/drivers/app/report/page.hpp>

namespace plica::app {

std::string filled_page(const PageFiles& files, const std::string& title, const std::string& json) {
  std::string data, heading;
  // escapes <, since </script> in the data would end the script
  for (const char letter : json) letter == '<' ? data += "\\u003c" : data += letter;
  for (const char letter : title)
    letter == '<' ? heading += "&lt;" : letter == '&' ? heading += "&amp;" : heading += letter;
  const std::map<std::string_view, std::string_view> parts = {
      {"title", heading}, {"style", files.style}, {"data", data}, {"script", files.script}};
  std::string page;
  std::string_view rest = files.html;
  for (std::size_t at = 0; (at = rest.find("{{")) != std::string_view::npos;) {
    page += rest.substr(0, at);
    const std::size_t end = rest.find("}}", at);
    page += parts.at(rest.substr(at + 2, end - at - 2));
    rest.remove_prefix(end + 2);
  }
  return page.append(rest);
}

}  // namespace plica::app
