// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <plica/drivers/app/output/columns.hpp>
#include <plica/drivers/app/reference/reference.hpp>
#include <plica/drivers/app/scene/key_list.hpp>

namespace plica::app {

namespace {

constexpr const char* keys_head = R"(# Keys of a scene

```sh
build/bin/plica list keys                                                  # the same in a terminal
build/bin/plica run SCENE --set body.material.young_modulus="20 kPa"       # another value for one run
build/bin/plica check SCENE                                                # are all keys right?
```

A scene is one YAML document. `body.levels[]` is an entry of a list, counted from 0 in messages and in `--set`;
`<name>` is a name of your own. A number is in SI units; a text gives its unit: `20 kPa`, `17 ms`, `30 deg`.
Unknown keys are refused. A key that is left out has its default. [Files](files.md#scenes) tells how an editor
completes keys.

)";

/// Keys that stand in one map, by the path of the map.
struct KeySection {
  std::vector<std::string> paths;  ///< several where maps in different places have the same keys
  std::vector<const KeyInfo*> keys;
};

std::string key_of(const KeyInfo& info) { return info.path.substr(info.path.rfind('.') + 1); }

/// Returns the path of the map that a key is in: "body.levels[]" of "body.levels[].box".
std::string map_of(const std::string& path) {
  const std::size_t dot = path.rfind('.');
  return dot == std::string::npos ? "" : path.substr(0, dot);
}

bool same_keys(const KeySection& a, const KeySection& b) {
  return std::ranges::equal(a.keys, b.keys, [](const KeyInfo* one, const KeyInfo* other) {
    return key_of(*one) == key_of(*other) && one->type_text == other->type_text &&
           one->otherwise == other->otherwise && one->help == other->help;
  });
}

std::vector<KeySection> key_sections() {
  std::vector<KeySection> all;
  for (const KeyInfo& info : scene_keys()) {
    const std::string map = map_of(info.path);
    const auto found =
        std::ranges::find_if(all, [&](const KeySection& one) { return one.paths.front() == map; });
    (found == all.end() ? all.emplace_back(KeySection{{map}, {}}) : *found).keys.push_back(&info);
  }
  std::vector<KeySection> apart;
  for (const KeySection& one : all) {
    const auto same =
        std::ranges::find_if(apart, [&](const KeySection& other) { return same_keys(one, other); });
    if (same == apart.end())
      apart.push_back(one);
    else
      same->paths.push_back(one.paths.front());
  }
  for (KeySection& one : apart)  // the shortest path is the heading
    std::ranges::stable_sort(one.paths, {}, &std::string::size);
  return apart;
}

/// Returns the anchor that GitHub gives a heading.
std::string anchor(const std::string& path) {
  std::string text;
  for (const char letter : path)
    if (std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '_') text += letter;
  return path.empty() ? "top-level" : text;
}

/// Returns the heading of the map below a key: "body.levels[]" of body.levels. Empty: none.
std::string map_below(const std::vector<KeySection>& sections, const std::string& path) {
  for (const KeySection& one : sections)
    for (const std::string& map : one.paths)
      if (map == path || map == path + "[]" || map == path + ".<name>") return one.paths.front();
  return {};
}

std::string key_table(const KeySection& section, const std::vector<KeySection>& all) {
  Lines rows{{"key", "value", "meaning"}};
  for (const KeyInfo* info : section.keys) {
    const std::string below = map_below(all, info->path);
    std::string value = values_in_words(info->type_text);
    if (!below.empty()) value = fmt::format("[{}](#{})", value, anchor(below));
    const bool is_word = info->otherwise == "required" || info->otherwise.ends_with("of these");
    if (!info->otherwise.empty())
      value += is_word ? "; **" + info->otherwise + "**" : "; default " + as_code(info->otherwise);
    rows.push_back({as_code(key_of(*info)), value, markdown(info->help)});
  }
  return markdown_table(rows);
}

}  // namespace

std::string keys_page() {
  const std::vector<KeySection> sections = key_sections();
  std::string text = written_by + std::string(keys_head);
  for (const KeySection& one : sections) {
    const std::string& path = one.paths.front();
    const bool is_deep = path.find('.') != std::string::npos;
    text += fmt::format("{} {}\n\n", is_deep ? "###" : "##",
                        path.empty() ? "Top level" : as_code(path));
    if (one.paths.size() > 1) {
      std::string others;
      for (std::size_t i = 1; i < one.paths.size(); ++i)
        others += (i > 1 ? ", " : "") + as_code(one.paths[i]);
      text += "The same keys: " + others + ".\n\n";
    }
    text += key_table(one, sections) + "\n";
  }
  text.pop_back();
  return text;
}

}  // namespace plica::app
