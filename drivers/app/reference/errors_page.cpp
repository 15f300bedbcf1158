// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <plica/core/error.hpp>
#include <plica/drivers/app/commands/commands.hpp>
#include <plica/drivers/app/output/columns.hpp>
#include <plica/drivers/app/reference/reference.hpp>
#include <plica/drivers/app/scene/load_scene.hpp>
#include <plica/drivers/run/registry.hpp>

namespace plica::app {

namespace {

constexpr const char* errors_head = R"(# Errors

```sh
build/bin/plica check SCENE            # is it sound? if not, why
build/bin/plica check SCENE --json     # {"sound": false, "error": "ball.yaml:18: ..."}
```

)";

constexpr const char* sound_scene = R"(duration: 1 s
body:
  levels:
    - {box: {size: [10 cm, 10 cm, 10 cm], cells: [4, 4, 4]}}
    - {box: {size: [10 cm, 10 cm, 10 cm], cells: [2, 2, 2]}}
  material: {model: neo_hookean, young_modulus: 50 kPa}
integration: {cycle: him}
)";

/// A fault, and the words of the scene that are replaced to make it.
struct Fault {
  const char *what, *before, *after;
};
constexpr Fault faults[] = {
    {"a value out of range", "young_modulus: 50 kPa", "young_modulus: -50 kPa"},
    {"another quantity", "young_modulus: 50 kPa", "young_modulus: 50 mm"},
    {"an unknown unit", "50 kPa", "50 kpa"},
    {"an unknown name", "cycle: him", "cycle: hmi"},
    {"an unknown key", "young_modulus", "youngs_modulus"},
    {"a key in another section", "duration: 1 s", "duration: 1 s\ndensity: 1000"},
    {"a key that is missing", "duration: 1 s", "gravity: [0, 0, 0]"},
    {"two of what excludes each other", "cells: [2, 2, 2]}", "cells: [2, 2, 2]}, file: a.msh"},
    {"methods that do not go together", "cycle: him", "cycle: him, integrator: rk4"},
    {"not YAML", "{cycle: him}", "{cycle: him"},
};

std::string message_about(const Fault& fault) {
  std::string text = sound_scene;
  const std::string before = fault.before;
  text.replace(text.find(before), before.size(), fault.after);
  try {
    load_scene(parse_tree(text, "scene.yaml"));
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

struct Status {
  ExitStatus status;
  const char* meaning;
};
constexpr Status statuses[] = {
    {ExitStatus::done, "done"},
    {ExitStatus::failed,
     "a file could not be read or written, or memory ran out; of `verify`, `doctor` and "
     "`stability --matrix`: a check failed"},
    {ExitStatus::bad_input,
     "bad arguments, scene or mesh, or a step or combination that is refused; nothing was run"},
    {ExitStatus::diverged, "the run was stopped; its last good state is on disk"},
    {ExitStatus::no_mpi,
     "`mpirun` started several processes of a program that was built without MPI"},
    {ExitStatus::interrupted, "stopped by Ctrl-C; the files are complete up to there"},
};

}  // namespace

std::string errors_page() {
  std::string text = written_by + std::string(errors_head) + "## Exit status\n\n";
  Lines rows{{"status", "meaning"}};
  for (const Status& one : statuses)
    rows.push_back({std::to_string(static_cast<int>(one.status)), one.meaning});
  text += markdown_table(rows);
  text += fmt::format(
      "\n## Messages about input\n\n"
      "`FILE:LINE: KEY: what is wrong`, with the value, what was expected and the nearest name. "
      "Bad input is found before the run.\nOf this scene:\n\n```yaml\n{}```\n\n",
      sound_scene);
  for (const Fault& fault : faults)
    text += fmt::format("* **{}**, `{}`:\n\n  ```text\n  {}\n  ```\n", fault.what,
                        std::string(fault.after).substr(std::string(fault.after).find('\n') + 1),
                        message_about(fault));
  text +=
      "\n## Why a run stops\n\n`diagnosis.kind` in `summary.json`, and `Diagnosis.kind` in Python; "
      "exit status 3. [A run that diverges](../how-to/diverges.md) says what to do.\n\n";
  rows = {{"kind", "meaning"}};
  for (const Choice& one : diagnosis_kinds()) rows.push_back({as_code(one.name), one.summary});
  return text + markdown_table(rows);
}

}  // namespace plica::app
