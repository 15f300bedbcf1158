// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <plica/core/backend.hpp>
#include <plica/core/error.hpp>
#include <plica/drivers/app/output/columns.hpp>
#include <plica/drivers/app/reference/reference.hpp>
#include <plica/drivers/app/scene/load_scene.hpp>
#include <plica/drivers/app/scene/older_keys.hpp>
#include <plica/drivers/methods/integrators.hpp>
#include <plica/drivers/methods/methods.hpp>
#include <plica/drivers/run/registry.hpp>
#include <plica/drivers/run/simulation.hpp>
#include <plica/drivers/study/choose_cycle.hpp>
#include <regex>

namespace plica::app {

namespace {

constexpr const char* support_head = R"(# What works with what

```sh
build/bin/plica check SCENE      # does this scene work? if not, why
build/bin/plica explain SCENE    # what a run of it would do
```

Each cell is a scene that was set up: a small box on two meshes, of linear elements where the column says no other.
✓ works; a number is refused, for [the reason](#reasons) of that number.

)";

/// Returns the keys of a box on two meshes, whose lower face is at a height.
std::string box_at(const std::string& height) {
  const auto level = [&](const char* cells) {
    return fmt::format("{{box: {{size: [20 cm, 10 cm, 10 cm], cells: {}, origin: [0, 0, {}]}}}}",
                       cells, height);
  };
  return fmt::format(
      "{{element: linear, levels: [{}, {}], fixed: [{{half_space: {{normal: [1, 0, 0]}}}}], "
      "surface: {{boundary: true}}}}",
      level("[4, 2, 2]"), level("[2, 1, 1]"));
}

const std::string one_body = "duration: 1 s\nbody: " + box_at("0") + "\n";
const std::string two_bodies =
    "duration: 1 s\nbodies: {below: " + box_at("0") + ", above: " + box_at("101 mm") + "}\n";

constexpr const char* sphere_above = "sphere: {centre: [10 cm, 5 cm, 125 mm], radius: 2 cm}";
constexpr const char* end_face = "half_space: {point: [199 mm, 0, 0], normal: [-1, 0, 0]}";

/// Row or column of a table: the values that it gives to the scene.
struct Setting {
  std::string name;
  std::vector<std::string> values;  ///< "key.path=value"
  std::string scene = one_body;
};

Setting loaded_by(const std::string& load) {
  return {as_code(load.substr(0, load.find(':'))),
          {fmt::format("body.loads=[{{{}, {}}}]", end_face, load)}};
}

Setting touched_by(const std::string& name, const std::string& more) {
  return {name, {fmt::format("contact.obstacles=[{{{}{}}}]", sphere_above, more)}};
}

std::vector<Setting> body_settings() {
  return {{"linear elements", {"body.element=linear"}},
          {"nodal elements", {"body.element=nodal"}},
          {"smoothed volumes", {"body.element=nodal", "body.volumetric_smoothing=smoothed"}},
          {"`coarsen`",
           {"body.levels=[{box: {size: [20 cm, 10 cm, 10 cm], cells: [8, 4, 4]}}, {coarsen: "
            "auto}]"}},
          {"one mesh", {"body.levels=[{box: {size: [20 cm, 10 cm, 10 cm], cells: [4, 2, 2]}}]"}},
          {"`prony`", {"body.material.prony=[{alpha: 0.3, tau: 1 s}]"}}};
}

std::vector<Setting> contact_settings() {
  Setting whole = touched_by("`whole_surface`", "");
  whole.values.emplace_back("contact.whole_surface=always");
  return {touched_by("obstacle", ""),
          whole,
          touched_by("with `mass`", ", mass: 0.1 kg"),
          touched_by("`grasp`", ", grasp: {from: 0, reach: 6 mm}"),
          {"`self`", {"contact.self=true"}},
          {"`bodies`", {}, two_bodies},
          {"`attachments`",
           {"contact.bodies=false", "attachments=[{body: above, to: below, reach: 2 mm}]"},
           two_bodies}};
}

std::vector<Setting> load_settings() {
  return {loaded_by("traction: [0, 0, 1 kPa]"),
          loaded_by("force: [0, 0, 1 N]"),
          loaded_by("follower_pressure: 1 kPa"),
          {"`enclosed_volume`",
           {"body.levels=[{tube: {radius: 2 cm, wall: 1 cm, length: 6 cm, around: 8, across: 1, "
            "along: 4}}, {tube: {radius: 2 cm, wall: 1 cm, length: 6 cm, around: 6, across: 1, "
            "along: 2}}]",
            "body.fixed=[{half_space: {point: [0, 0, 1 mm]}}, {half_space: {point: [0, 0, 59 mm], "
            "normal: [0, 0, -1]}}]",
            "body.loads=[{box: {min: [-20.1 mm, -20.1 mm, -1 mm], max: [20.1 mm, 20.1 mm, 61 "
            "mm]}, enclosed_volume: {ratio: 1.1, bulk_modulus: 1 kPa}}]"}},
          {"`fixed`, `along` or `slide`",
           {"body.fixed=[{half_space: {normal: [1, 0, 0]}, along: [x]}, {half_space: {normal: [0, "
            "1, 0]}, slide: normal}]"}},
          {"`prescribed`",
           {fmt::format("body.prescribed=[{{{}, velocity: [1 mm/s, 0, 0]}}]", end_face)}},
          {"`prescribed`, `rotate`",
           {fmt::format("body.prescribed=[{{{}, rotate: {{axis: [1, 0, 0], angular_velocity: 1 "
                        "rad/s}}}}]",
                        end_face)}},
          {"damping, `mass`", {"body.damping.mass=1 1/s"}},
          {"damping, `stiffness`", {"body.damping.stiffness=1 us"}}};
}

/// Returns settings of implicit steps with each linear solver.
std::vector<Setting> solver_settings(const std::string& before = {}) {
  std::vector<Setting> all;
  for (const Choice& one : linear_solvers())
    all.push_back({before + as_code(one.name),
                   {"integration.integrator=implicit_euler", "integration.macro_step=1 ms",
                    "integration.implicit.solver=" + one.name}});
  return all;
}

std::vector<Setting> cycle_settings() {
  std::vector<Setting> all;
  for (const Choice& one : cycle_choices())
    all.push_back({as_code(one.name), {"integration.cycle=" + one.name}});
  all.back().values.emplace_back("integration.macro_step=auto");  // auto chooses it
  return all;
}

std::vector<Setting> stepper_settings() {
  std::vector<Setting> all = cycle_settings();
  std::ranges::move(solver_settings("implicit with "), std::back_inserter(all));
  all.push_back({as_code(VCycleEuler::name),
                 {std::string("integration.integrator=") + VCycleEuler::name,
                  "integration.macro_step=1 ms"}});
  return all;
}

std::vector<Setting> integrator_settings() {
  std::vector<Setting> all;
  for (const Choice& one : integrators()) {
    // undamped, some explicit ones are stable at no step; implicit ones have no step by themselves
    all.push_back(
        {as_code(one.name),
         {"integration.integrator=" + one.name,
          is_explicit(one.name) ? "body.damping.mass=100 1/s" : "integration.macro_step=1 ms"}});
  }
  return all;
}

std::vector<Setting> step_settings() {
  return {{"`macro_step`", {"integration.macro_step=0.1 ms"}},
          {"`distribution`", {"integration.distribution=equal"}},
          {"`shift_to_coarsest`", {"integration.shift_to_coarsest=0.1"}},
          {"`substeps`", {"integration.substeps=2"}},
          {"`outside`", {"integration.outside=extrapolate"}},
          {"`halvings`", {"integration.on_failure.halvings=2"}},
          {"`allow_unstable`", {"integration.allow_unstable=true"}}};
}

std::vector<Setting> solve_settings() {
  std::vector<Setting> all;
  for (const Choice& one : preconditioners())
    all.push_back({as_code(one.name), {"integration.implicit.preconditioner=" + one.name}});
  all.push_back({"`matrix: free`", {"integration.implicit.matrix=free"}});
  all.push_back({"`matrix: assembled`", {"integration.implicit.matrix=assembled"}});
  all.push_back({"`iterations`", {"integration.implicit.iterations=5"}});
  all.push_back({"`tangent: positive`", {"integration.implicit.tangent=positive"}});
  return all;
}

/// Returns why a scene with the values of both settings is refused; empty: it works.
std::string refusal(const Setting& row, const Setting& column) {
  using B = Backend<double, Kokkos::DefaultExecutionSpace>;
  const std::string file = "scene";
  Tree tree = parse_tree(column.scene, file);
  try {
    for (const Setting* one : {&row, &column})
      for (const std::string& value : one->values) set_value(tree, value, file);
    const Problem problem = level_0_alone(load_scene(tree).problem);
    const Simulation<B> simulation(problem, {}, Validation::done);
  } catch (const InputError& error) {
    return std::regex_replace(std::string(error.what()), std::regex("^scene(:[0-9]+)?: "), "");
  }
  return {};
}

/// Tables of settings by settings that number the reasons of what is refused.
class SupportTables {
 public:
  std::string table(const std::string& head, const std::vector<Setting>& rows,
                    const std::vector<Setting>& columns);
  std::string reasons() const;

 private:
  std::string cell(const Setting& row, const Setting& column);
  std::vector<std::string> reasons_;
};

/// Returns a message with "…" in place of the names in code of its row and its column, and of the
/// key that has such a name, but for the one that the message begins with.
std::string without_names(std::string message, const std::string& settings) {
  static const std::regex code("`([a-z0-9_]+)`");
  for (auto at = std::sregex_iterator(settings.begin(), settings.end(), code);
       at != std::sregex_iterator(); ++at) {
    const std::string name = (*at)[1];
    message = std::regex_replace(message, std::regex("(is |cycle |solver )" + name + "\\b"), "$1…");
    message = std::regex_replace(
        message, std::regex("( (?:for|but) )[a-z0-9_.]*\\b" + name + "(: always)?"), "$1…");
  }
  return message;
}

std::string SupportTables::cell(const Setting& row, const Setting& column) {
  const std::string why = refusal(row, column);
  if (why.empty()) return "✓";
  const std::string reason = without_names(why, row.name + column.name);
  auto found = std::ranges::find(reasons_, reason);
  if (found == reasons_.end()) found = reasons_.insert(reasons_.end(), reason);
  return std::to_string(found - reasons_.begin() + 1);
}

std::string SupportTables::table(const std::string& head, const std::vector<Setting>& rows,
                                 const std::vector<Setting>& columns) {
  Lines text{{head}};
  for (const Setting& column : columns) text.front().push_back(column.name);
  for (const Setting& row : rows) {
    std::vector<std::string> cells{row.name};
    for (const Setting& column : columns) cells.push_back(cell(row, column));
    // rows with the same cells are one
    const auto same = std::find_if(text.begin() + 1, text.end(), [&](const auto& other) {
      return std::equal(other.begin() + 1, other.end(), cells.begin() + 1);
    });
    if (same == text.end())
      text.push_back(std::move(cells));
    else
      same->front() += ", " + cells.front();
  }
  return markdown_table(text) + "\n";
}

std::string SupportTables::reasons() const {
  std::string text = "… is the name in the row or column.\n\n";
  for (std::size_t i = 0; i < reasons_.size(); ++i)
    text += fmt::format("{}. {}\n", i + 1, markdown(reasons_[i]));
  return text;
}

}  // namespace

std::string support_page() {
  SupportTables tables;
  std::string text = written_by + std::string(support_head);
  const std::vector<Setting> steppers = stepper_settings();
  text +=
      "## Time steppers and the body\n\nRows are `integration.cycle` with the explicit "
      "`symplectic_euler`, then implicit steps of the finest level alone with a "
      "linear solver.\n\n" +
      tables.table("stepper", steppers, body_settings());
  text +=
      "## Time steppers and contact\n\n" + tables.table("stepper", steppers, contact_settings());
  text += "## Time steppers and loads\n\n" + tables.table("stepper", steppers, load_settings());
  text +=
      "## Integrators and cycles\n\n`integration.integrator` of all levels, "
      "`integration.cycle`.\n\n" +
      tables.table("integrator", integrator_settings(), cycle_settings());
  text += "## Cycles and the macro step\n\nKeys of `integration`.\n\n" +
          tables.table("cycle", cycle_settings(), step_settings());
  text +=
      "## Linear solvers\n\nOf implicit steps: `integration.implicit.solver`, and keys beside "
      "it.\n\n" +
      tables.table("solver", solver_settings(), solve_settings());
  return text + "## Reasons\n\n" + tables.reasons();
}

}  // namespace plica::app
