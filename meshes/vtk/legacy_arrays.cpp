// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/meshes/vtk/legacy_arrays.hpp>

namespace plica {

namespace {

struct TypeName {
  const char* name;
  NumberType type;
};
constexpr TypeName type_names[] = {
    {"unsigned_char", NumberType::uint8},  {"char", NumberType::int8},           {"unsigned_short", NumberType::uint16},
    {"short", NumberType::int16},          {"unsigned_int", NumberType::uint32}, {"int", NumberType::int32},
    {"unsigned_long", NumberType::uint64}, {"long", NumberType::int64},          {"vtktypeuint64", NumberType::uint64},
    {"vtktypeint64", NumberType::int64},   {"vtkidtype", NumberType::int32},     {"float", NumberType::float32},
    {"double", NumberType::float64},       {"signed_char", NumberType::int8},
};

// Arrays with a heading "KEYWORD name type", but for those that tell their components
struct Attribute {
  const char* keyword;
  std::int64_t components;  // 0: a word of the heading
  std::size_t type_word, components_word;
};
constexpr Attribute attributes[] = {
    {"scalars", 0, 2, 3},    {"vectors", 3, 2, 0},    {"normals", 3, 2, 0},
    {"tensors", 9, 2, 0},    {"tensors6", 6, 2, 0},   {"texture_coordinates", 0, 3, 2},
    {"global_ids", 1, 2, 0}, {"edge_flags", 1, 2, 0}, {"pedigree_ids", 1, 2, 0},
};

constexpr std::int64_t most_components = 1'000'000;

std::int64_t read_components(std::size_t word, const TextLines& lines) {
  const std::int64_t components = lines.integer(word, "the number of components");
  if (components < 1 || components > most_components)
    lines.fail("the number of components is " + std::to_string(components) + "; it must be 1 to " +
               std::to_string(most_components));
  return components;
}

}  // namespace

NumberType legacy_vtk_type(std::size_t word, const TextLines& lines) {
  if (word >= lines.words().size()) lines.expected("a type of numbers");
  const std::string name = lower_case(lines.words()[word]);
  std::vector<std::string> choices;
  for (const TypeName& known : type_names) {
    if (name == known.name) return known.type;
    choices.emplace_back(known.name);
  }
  const std::string quoted = shown(name);
  lines.fail(unknown_name("type of numbers", quoted.substr(1, quoted.size() - 2), choices));
}

void skip_vtk_metadata(TextLines& lines) {
  while (lines.next_or_blank())
    if (lines.words().empty()) return;
}

void LegacyArrays::values(const std::string& name, std::int64_t tuples, std::int64_t components, NumberType type,
                          TextLines& lines) {
  form.after(lines, [&](Numbers& numbers) {
    numbers.checked_count(tuples, "the number of values of " + shown(name), type, components);
    if (of_cells_)
      grid_.read_cell_data(name, tuples, components, type, numbers);
    else
      numbers.skip(tuples * components, type, "a value");
    return numbers.end("the values of " + shown(name)), 0;
  });
}

void LegacyArrays::field(TextLines& lines) {
  const std::int64_t arrays = lines.integer(2, "the number of arrays");
  for (std::int64_t i = 1; i <= arrays; ++i) {
    bool found = lines.next();
    if (found && lower_case(lines.words()[0]) == "metadata") skip_vtk_metadata(lines), found = lines.next();
    if (!found || lines.words().size() != 4)
      lines.expected("array " + std::to_string(i) + " of " + std::to_string(arrays) + ", a line like region 1 8 int");
    const std::string name(lines.words()[0]);
    const std::int64_t components = read_components(1, lines);
    values(name, lines.integer(2, "the number of tuples"), components, legacy_vtk_type(3, lines), lines);
  }
}

bool LegacyArrays::attribute(const std::string& keyword, TextLines& lines) {
  if (!begun_) return false;
  const std::size_t words = lines.words().size();
  const std::string name = words > 1 ? std::string(lines.words()[1]) : "";
  // Colours are bytes in binary and fractions in text; a table of them stands apart from what it colours
  const NumberType colour = form.binary ? NumberType::uint8 : NumberType::float32;
  if (keyword == "color_scalars") return values(name, tuples_, read_components(2, lines), colour, lines), true;
  if (keyword == "lookup_table") return values("", lines.integer(2, "the size of a table"), 4, colour, lines), true;
  for (const Attribute& known : attributes) {
    if (keyword != known.keyword) continue;
    const bool told = known.components == 0 && known.components_word < words;
    const std::int64_t components = told ? read_components(known.components_word, lines) : known.components;
    const NumberType type = legacy_vtk_type(known.type_word, lines);
    if (keyword == "scalars" && (!lines.next() || lower_case(lines.words()[0]) != "lookup_table"))
      lines.expected("a line like LOOKUP_TABLE default");
    values(name, tuples_, std::max<std::int64_t>(components, 1), type, lines);
    return true;
  }
  return false;
}

}  // namespace plica
