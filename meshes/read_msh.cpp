// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdlib>
#include <limits>
#include <plica/meshes/msh_elements.hpp>
#include <plica/meshes/read_msh.hpp>
#include <plica/meshes/sound_mesh.hpp>
#include <plica/meshes/text_lines.hpp>
#include <set>
#include <utility>

namespace plica {

namespace {

using Group = std::pair<int, std::int64_t>;  // dimension, physical tag

class MshReader {
 public:
  explicit MshReader(const std::filesystem::path& path) : lines_(path) { raw_.file = path.string(); }
  TetMesh read(MeshReport& report);

 private:
  void format();
  void section();
  void physical_names();
  void nodes();
  void elements();
  void element();
  void skip(const std::string& name);
  template <typename Record>
  void records(const std::string& section, const std::string& kind, std::size_t fewest_bytes, Record record);
  std::string name_of(const Group& group) const;
  void name_groups();

  TextLines lines_;
  RawMesh raw_;
  MeshReport report_;
  std::set<std::string> seen_;
  std::map<Group, std::string> names_;
  std::vector<std::int64_t> tet_groups_;             // per tetrahedron its physical tag
  std::map<Group, std::vector<RawMention>> groups_;  // of lower dimension
};

void MshReader::format() {
  if (!lines_.next() || lines_.text() != "$MeshFormat") lines_.expected("$MeshFormat, the start of a Gmsh file");
  if (!lines_.next() || lines_.words().size() != 3)
    lines_.expected("the version, file type and data size, like 2.2 0 8");
  const std::string supported = "; supported is MSH 2.2 ASCII: gmsh IN -save -format msh22 -o OUT.msh";
  if (lines_.words()[0] != "2.2") lines_.fail("the MSH version is " + shown(lines_.words()[0]) + supported);
  if (lines_.words()[1] != "0") lines_.fail("the file type is " + shown(lines_.words()[1]) + ", binary" + supported);
  if (lines_.words()[2] != "8") lines_.fail("the data size is " + shown(lines_.words()[2]) + "; expected 8");
  if (!lines_.next() || lines_.text() != "$EndMeshFormat") lines_.expected("$EndMeshFormat");
}

void MshReader::section() {
  using Read = void (MshReader::*)();
  static const std::map<std::string, Read> known = {{"$PhysicalNames", &MshReader::physical_names},
                                                    {"$Nodes", &MshReader::nodes},
                                                    {"$Elements", &MshReader::elements}};
  const std::string name(lines_.text());
  if (name.front() != '$' || name.starts_with("$End")) lines_.expected("the start of a section, like $Nodes");
  if (name == "$ParametricNodes") lines_.fail("$ParametricNodes is not supported: save without parametric coordinates");
  const auto read = known.find(name);
  if (read == known.end()) return skip(name);
  if (!seen_.insert(name).second) lines_.fail("a second section " + name);
  (this->*read->second)();
}

void MshReader::skip(const std::string& name) {
  report_.skipped_sections.push_back(name.substr(0, 60));
  const std::string end = "$End" + name.substr(1);
  while (lines_.next())
    if (lines_.text() == end) return;
  lines_.expected(shown(end));
}

// A count, that many lines, and the end of the section. What the rest of the file cannot hold is refused unread.
template <typename Record>
void MshReader::records(const std::string& section, const std::string& kind, std::size_t fewest_bytes, Record record) {
  if (!lines_.next() || lines_.words().size() != 1) lines_.expected("the number of " + kind + "s");
  const std::int64_t count = lines_.integer(0, "the number of " + kind + "s");
  const std::int64_t room = static_cast<std::int64_t>(lines_.bytes_left() / fewest_bytes);
  if (count < 0 || count > std::min<std::int64_t>(room, std::numeric_limits<int>::max()))
    lines_.fail("the number of " + kind + "s is " + std::to_string(count) + ", but the rest of the file has room for " +
                std::to_string(room) + " at most");
  for (std::int64_t i = 1; i <= count; ++i) {
    if (!lines_.next() || lines_.text().front() == '$')
      lines_.expected(kind + " " + std::to_string(i) + " of " + std::to_string(count));
    record();
  }
  if (!lines_.next() || lines_.text() != "$End" + section)
    lines_.expected("$End" + section + " after " + std::to_string(count) + " " + kind + "s");
}

void MshReader::physical_names() {
  records("PhysicalNames", "physical name", 8, [&] {
    const std::int64_t dimension = lines_.integer(0, "the dimension of a physical group");
    if (dimension < 0 || dimension > 3)
      lines_.fail("the dimension of a physical group is " + std::to_string(dimension) + "; it must be 0 to 3");
    const Group group(static_cast<int>(dimension), lines_.integer(1, "the tag of a physical group"));
    const std::string_view text = lines_.text();
    const std::size_t open = text.find('"'), close = text.rfind('"');
    if (lines_.words().size() < 3 || lines_.words()[2].front() != '"' || close <= open + 1 || close + 1 != text.size())
      lines_.expected("a dimension, a tag and a name in quotes");
    const std::string name(text.substr(open + 1, close - open - 1));
    for (const auto& [other, taken] : names_)
      if (other == group || (group.first == 3 && other.first == 3 && taken == name))
        lines_.fail("physical group " + std::to_string(group.second) + " " + shown(name) + ": group " +
                    std::to_string(other.second) + " of dimension " + std::to_string(other.first) + " is " +
                    shown(taken) + " already");
    names_[group] = name;
  });
}

void MshReader::nodes() {
  records("Nodes", "node", 8, [&] {
    if (lines_.words().size() != 4) lines_.expected("a node: its tag and three coordinates");
    RawVertex vertex;
    vertex.tag = lines_.integer(0, "the tag of a node");
    if (vertex.tag < 1) lines_.fail("the tag of a node is " + std::to_string(vertex.tag) + "; it must be 1 or more");
    const char* const what[] = {"coordinate x", "coordinate y", "coordinate z"};
    for (std::size_t a = 0; a < 3; ++a) vertex.position[static_cast<Eigen::Index>(a)] = lines_.number(a + 1, what[a]);
    vertex.line = lines_.line();
    raw_.vertices.push_back(vertex);
  });
}

void MshReader::elements() {
  records("Elements", "element", 9, [&] { element(); });
}

void MshReader::element() {
  const std::int64_t tag = lines_.integer(0, "the tag of an element");
  const std::int64_t type = lines_.integer(1, "the type of an element");
  const MshElement* kind = find_msh_element(type);
  const std::string who = "element " + std::to_string(tag);
  if (kind == nullptr || !kind->taken)
    lines_.fail(who + " has type " + std::to_string(type) + (kind ? ", a " + std::string(kind->name) : "") +
                "; supported are points, lines, triangles, quadrangles and tetrahedra of first order");
  const std::int64_t tags = lines_.integer(2, "the number of tags of an element");
  const std::size_t words = lines_.words().size(), vertices = static_cast<std::size_t>(kind->vertices);
  if (tags < 0 || words < 3 + vertices || static_cast<std::uint64_t>(tags) != words - 3 - vertices)
    lines_.fail(who + ", a " + kind->name + " with " + std::to_string(tags) + " tags, has " + std::to_string(words) +
                " numbers on its line; expected are its tag, type, number of tags, the tags and " +
                std::to_string(vertices) + " nodes");
  for (std::size_t t = 1; t < static_cast<std::size_t>(tags); ++t) lines_.integer(3 + t, "a tag of an element");
  // A minus sign says that the element is turned round against the group
  const std::int64_t physical = tags > 0 ? lines_.integer(3, "the physical group of an element") : 0;
  if (std::max(physical, -1 - physical) > std::numeric_limits<int>::max())
    lines_.fail("the physical group of " + who + " is " + std::to_string(physical) + "; it must fit 32 bits");

  std::array<std::int64_t, 4> nodes = {};
  for (std::size_t k = 0; k < vertices; ++k) nodes[k] = lines_.integer(words - vertices + k, "a node of an element");
  if (kind->dimension == 3) {
    raw_.tets.push_back({tag, nodes, 0, lines_.line()});
    tet_groups_.push_back(std::abs(physical));
    return;
  }
  ++report_.other_elements[kind->name];
  auto& mentions = physical != 0 ? groups_[{kind->dimension, std::abs(physical)}] : raw_.others;
  for (std::size_t k = 0; k < vertices; ++k) mentions.push_back({nodes[k], lines_.line()});
}

std::string MshReader::name_of(const Group& group) const {
  const auto found = names_.find(group);
  return found != names_.end() ? found->second : "physical_" + std::to_string(group.second);
}

void MshReader::name_groups() {
  const std::set<std::int64_t> used(tet_groups_.begin(), tet_groups_.end());
  if (used.size() > 1 || !used.contains(0)) {
    std::map<std::int64_t, int> region;
    for (const std::int64_t tag : used) {
      auto& names = raw_.region_names;
      const auto found = std::find(names.begin(), names.end(), name_of({3, tag}));  // "physical_3" may be given, too
      region[tag] = static_cast<int>(found - names.begin());
      if (found == names.end()) names.push_back(name_of({3, tag}));
    }
    for (std::size_t t = 0; t < raw_.tets.size(); ++t) raw_.tets[t].region = region.at(tet_groups_[t]);
  }
  for (const auto& [group, mentions] : groups_) {
    auto& set = raw_.vertex_sets[name_of(group)];
    set.insert(set.end(), mentions.begin(), mentions.end());
  }
}

TetMesh MshReader::read(MeshReport& report) {
  report_.format = "Gmsh MSH 2.2 ASCII";
  format();
  while (lines_.next()) section();
  std::string skipped;
  for (const std::string& name : report_.skipped_sections) skipped += (skipped.empty() ? " besides " : ", ") + name;
  for (const char* name : {"$Nodes", "$Elements"})
    if (!seen_.contains(name)) lines_.expected(std::string("a section ") + name + skipped);
  name_groups();
  TetMesh mesh = sound_mesh(raw_, report_);
  report = std::move(report_);
  return mesh;
}

}  // namespace

TetMesh read_msh(const std::filesystem::path& path, MeshReport* report) {
  MeshReport unused;
  return MshReader(path).read(report ? *report : unused);
}

}  // namespace plica
