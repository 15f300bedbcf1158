// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/meshes/files/list.hpp>
#include <plica/meshes/files/msh_bodies.hpp>
#include <set>

namespace plica {

namespace {

class MshParser {
 public:
  MshParser(const FileBytes& file, MeshReport& report)
      : lines_(file), report_(report), gather_(file.name, report) {}
  ParsedMesh parse();

 private:
  using Section = void (MshParser::*)();

  void format();
  void check_byte_order();
  void section();
  void physical_names();
  void entities();
  void partitioned_entities();
  void nodes();
  void elements();
  void data();
  template <class Read>
  auto data_heading(const std::string& kind, const Read& read);
  void skip(const std::string& name);
  std::int64_t count_of(const std::string& kind, std::int64_t fewest);
  void end_of(const std::string& section, const std::string& after = "");
  template <typename Read>
  auto body(const Read& read) {
    return form_.after(lines_, read);
  }
  const FileBytes& file() const { return lines_.file(); }

  TextLines lines_;
  MeshReport& report_;
  MshGather gather_;
  Msh4Bodies bodies4_;
  int version_ = 2;
  NumberForm form_;
  std::set<std::string> seen_;
};

// Reads the heading of the file; version 1 has none
void MshParser::format() {
  if (!lines_.next() || (lines_.text() != "$MeshFormat" && lines_.text() != "$NOD"))
    lines_.expected("$MeshFormat, the start of a Gmsh file");
  if (lines_.text() == "$NOD") {
    version_ = 1, report_.format = "Gmsh MSH 1 ASCII";
    return section();
  }
  if (!lines_.next() || lines_.words().size() != 3)
    lines_.expected("the version, file type and data size, like 4.1 0 8");
  const std::string_view version = lines_.words()[0], type = lines_.words()[1],
                         size = lines_.words()[2];
  constexpr std::string_view versions_2[] = {"2", "2.0", "2.1", "2.2"};
  version_ = version == "4.1" ? 4 : 2;
  if (version_ == 2 && std::ranges::find(versions_2, version) == std::end(versions_2))
    lines_.fail("the MSH version is " + shown(version) +
                "; supported are 1, 2.0 to 2.2 and 4.1: gmsh IN -save -format msh41 -o OUT.msh");
  form_.binary = type == "1";
  if (!form_.binary && type != "0")
    lines_.fail("the file type is " + shown(type) + "; expected 0 (text) or 1 (binary)");
  if (size != "8") lines_.fail("the data size is " + shown(size) + "; expected 8");
  report_.format = "Gmsh MSH " + std::string(version) + (form_.binary ? " binary" : " ASCII");
  if (form_.binary) check_byte_order();
  end_of("MeshFormat");
}

// Reads the integer 1, which tells the byte order of a binary file
void MshParser::check_byte_order() {
  constexpr auto other =
      std::endian::native == std::endian::little ? std::endian::big : std::endian::little;
  const auto flag = [](Numbers& numbers) {
    return numbers.integer(NumberType::int32, "the integer 1");
  };
  const std::size_t start = lines_.next_byte();
  const std::int64_t one = body(flag);
  if (one == 1) return;
  form_.order = other;
  lines_.resume_at(start);
  if (body(flag) == 1) return;
  refuse(file().name, {0, static_cast<std::int64_t>(start)},
         "the integer that tells the order of bytes is " + std::to_string(one) +
             "; it must be 1 in one of the two orders");
}

void MshParser::end_of(const std::string& section, const std::string& after) {
  const std::string end = (version_ == 1 ? "$END" : "$End") + section;
  if (!lines_.next() || lines_.text() != end)
    lines_.expected(end + (after.empty() ? "" : " after " + after));
}

void MshParser::section() {
  static const std::map<std::string, Section> known = {
      {"$PhysicalNames", &MshParser::physical_names},
      {"$Entities", &MshParser::entities},
      {"$PartitionedEntities", &MshParser::partitioned_entities},
      {"$Nodes", &MshParser::nodes},
      {"$NOD", &MshParser::nodes},
      {"$ELM", &MshParser::elements},
      {"$NodeData", &MshParser::data},
      {"$ElementData", &MshParser::data},
      {"$Elements", &MshParser::elements}};
  const std::string name(lines_.text());
  if (name.front() != '$' || name.starts_with("$End") || name.starts_with("$END"))
    lines_.expected("the start of a section, like $Nodes");
  if (name == "$ParametricNodes")
    lines_.fail("$ParametricNodes is not supported: save without parametric coordinates");
  const auto found = known.find(name);
  if (found == known.end()) return skip(name);
  if (found->second != &MshParser::data && !seen_.insert(name).second)
    lines_.fail("a second section " + name);
  (this->*found->second)();
}

// Skips a section that is not used. Binary data may hold line feeds, but hardly ever the end mark
// of the section. Some writers end their data without a line feed.
void MshParser::skip(const std::string& name) {
  report_.skipped_sections.push_back(name.substr(0, 60));
  const std::string end = (version_ == 1 ? "$END" : "$End") + name.substr(1);
  if (form_.binary) lines_.resume_at(file().bytes.find(end, lines_.next_byte() - 1));
  while (lines_.next())
    if (lines_.text() == end) return;
  lines_.expected(shown(end));
}

// Reads a count on a line of its own, which is text in binary files, too
std::int64_t MshParser::count_of(const std::string& kind, std::int64_t fewest) {
  if (!lines_.next() || lines_.words().size() != 1) lines_.expected("the number of " + kind);
  const std::int64_t count = lines_.integer(0, "the number of " + kind);
  return body([&](Numbers& rest) {
    return rest.checked_count(count, "the number of " + kind, NumberType::int32, fewest);
  });
}

void MshParser::physical_names() {
  if (!lines_.next() || lines_.words().size() != 1) lines_.expected("the number of physical names");
  const std::int64_t count =
      TextNumbers(lines_).checked_count(lines_.integer(0, "the number of physical names"),
                                        "the number of physical names", NumberType::int32, 3);
  for (std::int64_t i = 1; i <= count; ++i) {
    if (!lines_.next() || lines_.text().front() == '$')
      lines_.expected("physical name " + std::to_string(i) + " of " + std::to_string(count));
    gather_.add_name(lines_);
  }
  end_of("PhysicalNames", std::to_string(count) + " physical names");
}

void MshParser::entities() {
  if (version_ != 4) return skip("$Entities");
  if (seen_.contains("$Elements")) lines_.fail("$Entities must come before $Elements");
  body([&](Numbers& numbers) { return bodies4_.entities(numbers), 0; });
  end_of("Entities");
}

void MshParser::partitioned_entities() {
  if (version_ != 4) return skip("$PartitionedEntities");
  if (seen_.contains("$Elements")) lines_.fail("$PartitionedEntities must come before $Elements");
  body([&](Numbers& numbers) { return bodies4_.partitioned_entities(numbers), 0; });
  end_of("PartitionedEntities");
}

void MshParser::nodes() {
  const std::int64_t count = version_ == 4 ? 0 : count_of("nodes", 4);
  const std::string what = body([&](Numbers& numbers) {
    if (version_ == 4) return bodies4_.nodes(numbers, gather_);
    msh2_nodes(count, numbers, gather_);
    return std::to_string(count) + " nodes";
  });
  end_of(version_ == 1 ? "NOD" : "Nodes", what);
}

void MshParser::elements() {
  const std::int64_t count = version_ == 4 ? 0 : count_of("elements", 2);
  const std::string what = body([&](Numbers& numbers) {
    if (version_ == 4) return bodies4_.elements(numbers, gather_);
    if (version_ == 1)
      msh1_elements(count, numbers, gather_);
    else
      msh2_elements(count, form_.binary, numbers, gather_);
    return std::to_string(count) + " elements";
  });
  end_of(version_ == 1 ? "ELM" : "Elements", what);
}

/// Returns what read() makes of each line of a heading of a data section; the line before them
/// counts them.
template <class Read>
auto MshParser::data_heading(const std::string& kind, const Read& read) {
  if (!lines_.next() || lines_.words().size() != 1)
    lines_.expected("the number of " + kind + " tags");
  const std::int64_t count =
      TextNumbers(lines_).checked_count(lines_.integer(0, "the number of " + kind + " tags"),
                                        "the number of " + kind + " tags", NumberType::int8, 1);
  std::vector<decltype(read(kind))> all;
  for (std::int64_t i = 1; i <= count; ++i) {
    const std::string what = kind + " tag " + std::to_string(i) + " of " + std::to_string(count);
    if (!lines_.next()) lines_.expected(what);
    all.push_back(read(what));
  }
  return all;
}

// Reads a data section with three components and a name; others are skipped as unknown sections are
void MshParser::data() {
  const std::string section(lines_.text());
  const auto line = [&](const std::string&) { return std::string(lines_.text()); };
  const std::vector<std::string> texts = data_heading("string", line),
                                 reals = data_heading("real", line);
  const Place before = lines_.place();
  const std::vector<std::int64_t> whole =  // time step, components, count
      data_heading("integer", [&](const std::string& what) { return lines_.integer(0, what); });
  if (whole.size() < 3)
    refuse(file().name, before,
           section + " has " + std::to_string(whole.size()) +
               " integer tags; expected 3 or more: time step, components, count");
  std::string name = texts.empty() ? "" : texts.front();
  std::erase(name, '"');
  if (whole[1] == 1 && name == filled_name && section == "$ElementData") {
    body([&](Numbers& numbers) {
      return gather_.add_filled(
                 numbers.checked_count(whole[2], "the number of parts", NumberType::int32, 2),
                 numbers),
             0;
    });
    return end_of("ElementData", std::to_string(whole[2]) + " parts");
  }
  if (whole[1] != 3 || name.empty()) return skip(section);
  body([&](Numbers& numbers) {
    const std::int64_t count =
        numbers.checked_count(whole[2], "the number of vectors", NumberType::int32, 4);
    return gather_.add_vectors(name, section == "$NodeData", count, numbers), 0;
  });
  end_of(section.substr(1), std::to_string(whole[2]) + " vectors");
}

ParsedMesh MshParser::parse() {
  format();
  while (lines_.next()) section();
  std::string skipped;
  for (const std::string& name : report_.skipped_sections)
    skipped += (skipped.empty() ? " besides " : ", ") + name;
  for (const char* name : {version_ == 1 ? "$NOD" : "$Nodes", version_ == 1 ? "$ELM" : "$Elements"})
    if (!seen_.contains(name)) lines_.expected(std::string("a section ") + name + skipped);
  return gather_.take();
}

}  // namespace

ParsedMesh parse_msh(const FileBytes& file, MeshReport& report) {
  return MshParser(file, report).parse();
}

}  // namespace plica
