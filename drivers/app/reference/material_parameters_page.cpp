// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <plica/core/keys.hpp>
#include <plica/drivers/app/output/columns.hpp>
#include <plica/drivers/app/reference/reference.hpp>
#include <plica/drivers/elastic/materials.hpp>

namespace plica::app {

namespace {

constexpr const char* materials_head = R"(# Parameters of the materials

```sh
build/bin/plica list materials
build/bin/plica run SCENE --set body.material="{model: mooney_rivlin, c10: 2 kPa, c01: 1 kPa, bulk_modulus: 60 kPa}"
```

A law is `body.material.model`; its parameters are keys beside it. A region has its own as `body.regions.<name>.KEY`.
What is left out has its default. Energies and advice are in [materials](materials.md). `density` and the other keys
of a material are in the [keys](keys.md#bodymaterial).

)";

std::string yes_where(bool it_is) { return it_is ? "yes" : "–"; }

std::string choice_table(const std::string& key, const std::vector<Choice>& choices) {
  Lines rows{{as_code(key), "meaning"}};
  for (const Choice& one : choices) rows.push_back({as_code(one.name), markdown(one.summary)});
  return markdown_table(rows) + "\n";
}

}  // namespace

std::string material_parameters_page() {
  std::string text = written_by + std::string(materials_head);
  Lines laws{{"law", "fibres", "`prony`", "smoothed volumes", "inverted elements",
              "`allow_inversion` left out"}};
  for (const MaterialInfo& one : material_list()) {
    laws.push_back({fmt::format("[{0}](#{0})", one.name), yes_where(one.has_fibres),
                    yes_where(one.with_shape != nullptr), yes_where(one.smooths_dilatation),
                    one.recovers ? "are pushed back" : "may stay so",
                    one.allows_inversion ? "true" : "false"});
  }
  text += markdown_table(laws) + "\n";
  for (const MaterialInfo& one : material_list()) {
    text += fmt::format("## {}\n\n{}\n\n", one.name, sentence(std::string(one.summary)));
    Lines rows{{"key", "value", "default", "meaning"}};
    for (const MaterialParameter& p : one.parameters)
      rows.push_back({as_code(p.name), markdown(p.kind.type_text()),
                      as_code(p.kind.to_text(p.standard)), markdown(p.help)});
    text += markdown_table(rows) + "\n";
  }
  text += "## Volume\n\nU(J) of laws of tissue.\n\n" + choice_table("volume", volumes());
  text += "## Convention\n\nOf `terms`, where the law is `ogden`.\n\n" +
          choice_table("convention", ogden_conventions());
  text += "## Tissues\n\nMaterials with all their values.\n\n" + choice_table("tissue", tissues());
  text.pop_back();
  return text;
}

}  // namespace plica::app
