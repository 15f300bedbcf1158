// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <optional>
#include <plica/meshes/files/deck_gather.hpp>
#include <plica/meshes/files/list.hpp>
#include <plica/meshes/files/reading.hpp>
#include <pugixml.hpp>

namespace plica {

namespace {

constexpr NamedKind feb_kinds[] = {
    {"tet4", {0, "tetrahedron", 3, 4, 4}},
    {"tet10", {0, "second-order tetrahedron", 3, 10, 4}},
    {"tet15", {0, "second-order tetrahedron of 15 nodes", 3, 15, 4}},
    {"tet20", {0, "third-order tetrahedron", 3, 20, 4}},
    {"pyra5", {0, "pyramid", 3, 5, 5}},
    {"pyra13", {0, "second-order pyramid", 3, 13, 5}},
    {"penta6", {0, "prism", 3, 6, 6}},
    {"penta15", {0, "second-order prism", 3, 15, 6}},
    {"hex8", {0, "hexahedron", 3, 8, 8}},
    {"hex20", {0, "second-order hexahedron", 3, 20, 8}},
    {"hex27", {0, "second-order hexahedron", 3, 27, 8}},
    {"tri3", {0, "triangle", 2, 3, 3}},
    {"tri6", {0, "second-order triangle", 2, 6, 3}},
    {"tri7", {0, "second-order triangle", 2, 7, 3}},
    {"quad4", {0, "quadrangle", 2, 4, 4}},
    {"quad8", {0, "second-order quadrangle", 2, 8, 4}},
    {"quad9", {0, "second-order quadrangle", 2, 9, 4}},
    {"line2", {0, "line", 1, 2, 2}},
    {"line3", {0, "second-order line", 1, 3, 2}},
};

constexpr std::string_view separators = ", \t\r\n";

class FebParser {
 public:
  FebParser(const FileBytes& file, MeshReport& report)
      : file_(file), lines_(file.bytes), report_(report), gather_(file.name, report) {}

  ParsedMesh parse() {
    load();
    const pugi::xml_node root = document_.child("febio_spec");
    if (!root) refuse(file_.name, {1}, "expected <febio_spec>, the root of a FEBio file");
    const std::string_view version = root.attribute("version").value();
    if (version.empty() || std::string_view("234").find(version.front()) == std::string_view::npos)
      fail(root, "the version is " + shown(version) + "; supported are 2.0 to 4.0");
    report_.format = "FEBio " + printable(version);
    const pugi::xml_node mesh = root.child(version.front() == '2' ? "Geometry" : "Mesh");
    if (!mesh)
      fail(root,
           std::string("there is no <") + (version.front() == '2' ? "Geometry" : "Mesh") + ">");
    if (mesh.attribute("from")) fail(mesh, "a mesh from another file is not read: give that file");
    // Sets name nodes and elements that may come after them
    for (const bool sets : {false, true})
      for (const pugi::xml_node& part : mesh.children())
        if (part.type() == pugi::node_element) section(part, sets);
    return gather_.take();
  }

 private:
  void load();
  void section(const pugi::xml_node& part, bool sets);
  void nodes(const pugi::xml_node& part);
  void elements(const pugi::xml_node& part);
  void faces(const pugi::xml_node& part, int dimension);

  Place place(const pugi::xml_node& node) {
    return {lines_.of(static_cast<std::size_t>(std::max<std::ptrdiff_t>(node.offset_debug(), 0)))};
  }
  [[noreturn]] void fail(const pugi::xml_node& node, const std::string& message) {
    refuse(file_.name, place(node), message);
  }
  std::string name_of(const pugi::xml_node& part) {
    const std::string name = part.attribute("name").value();
    if (name.empty()) fail(part, "<" + printable(part.name()) + "> has no name");
    return name;
  }
  const ElementKind& kind_of(const pugi::xml_node& part, std::string_view type);
  template <class Value>
  void split(const pugi::xml_node& node, const char* what, std::vector<Value>& values);
  std::int64_t id_of(const pugi::xml_node& node);
  std::vector<std::int64_t> members(const pugi::xml_node& part);

  const FileBytes& file_;
  LineNumbers lines_;
  MeshReport& report_;
  DeckGather gather_;
  pugi::xml_document document_;
};

void FebParser::load() {
  const auto parsed =
      document_.load_buffer(file_.bytes.data(), file_.bytes.size(),
                            pugi::parse_minimal | pugi::parse_escapes, pugi::encoding_utf8);
  if (parsed) return;
  const auto at = std::min(static_cast<std::size_t>(parsed.offset), file_.bytes.size());
  const std::size_t tag = std::min(file_.bytes.rfind('<', at), at);
  refuse(file_.name, {lines_.of(tag)},
         "the XML is malformed: " + lower_case(parsed.description()) + " at " +
             shown(std::string_view(file_.bytes).substr(tag)));
}

const ElementKind& FebParser::kind_of(const pugi::xml_node& part, std::string_view type) {
  std::vector<std::string> choices;
  for (const NamedKind& known : feb_kinds) {
    if (known.name == lower_case(type)) return known.kind;
    choices.emplace_back(known.name);
  }
  fail(part, unknown_name("type of elements", printable(type), choices));
}

// Reads the numbers of a text, between commas or blanks
template <class Value>
void FebParser::split(const pugi::xml_node& node, const char* what, std::vector<Value>& values) {
  const std::string_view text = node.child_value();
  values.clear();
  for (std::size_t begin = text.find_first_not_of(separators); begin < text.size();) {
    const std::size_t end = std::min(text.find_first_of(separators, begin), text.size());
    const std::string_view word = text.substr(begin, end - begin);
    std::optional<Value> value;
    if constexpr (std::is_floating_point_v<Value>)
      value = number_in(word);
    else
      value = integer_in(word);
    if (!value)
      fail(node, std::string(what) + " is " + shown(word) + "; it must be " +
                     (std::is_floating_point_v<Value> ? "a number" : "an integer"));
    values.push_back(*value);
    begin = text.find_first_not_of(separators, end);
  }
}

std::int64_t FebParser::id_of(const pugi::xml_node& node) {
  const std::string_view text = node.attribute("id").value();
  const auto id = integer_in(text);
  if (!id)
    fail(node, "the id of <" + printable(node.name()) + "> is " + shown(text) +
                   "; it must be an integer");
  return *id;
}

// Returns the members of a set: a list of numbers, or elements with an id each
std::vector<std::int64_t> FebParser::members(const pugi::xml_node& part) {
  std::vector<std::int64_t> ids;
  split(part, "a member of a set", ids);
  for (const pugi::xml_node& member : part.children())
    if (member.type() == pugi::node_element) ids.push_back(id_of(member));
  return ids;
}

void FebParser::nodes(const pugi::xml_node& part) {
  std::vector<double> x;
  std::vector<std::int64_t> ids;
  for (const pugi::xml_node& node : part.children()) {
    if (node.type() != pugi::node_element) continue;
    ids.push_back(id_of(node));
    split(node, "a coordinate", x);
    if (x.size() != 3)
      fail(node, "node " + std::to_string(ids.back()) + " has " + std::to_string(x.size()) +
                     " coordinates; expected 3");
    gather_.add_node(ids.back(), {x[0], x[1], x[2]}, place(node));
  }
}

void FebParser::elements(const pugi::xml_node& part) {
  const ElementKind& kind = kind_of(part, part.attribute("type").value());
  std::vector<std::size_t> all;
  for (const pugi::xml_node& node : part.children()) {
    if (node.type() != pugi::node_element) continue;
    DeckElement element{&kind, id_of(node), {}, place(node)};
    split(node, "a node of an element", element.nodes);
    if (element.nodes.size() != static_cast<std::size_t>(kind.vertices))
      fail(node, "element " + std::to_string(element.tag) + ", a " + kind.name + ", has " +
                     std::to_string(element.nodes.size()) + " nodes; expected " +
                     std::to_string(kind.vertices));
    all.push_back(gather_.add_element(std::move(element)));
  }
  std::string name = part.attribute("name").value();
  if (name.empty()) name = part.attribute("elset").value();
  if (name.empty()) name = "material_" + std::string(part.attribute("mat").value());
  gather_.add_elements(name, std::move(all), true);
}

// Reads a surface or an edge; its parts name their kind
void FebParser::faces(const pugi::xml_node& part, int dimension) {
  const std::string name = name_of(part);
  std::vector<std::int64_t> corners;
  for (const pugi::xml_node& node : part.children()) {
    if (node.type() != pugi::node_element) continue;
    const ElementKind& kind = kind_of(node, node.name());
    split(node, "a node of a face", corners);
    if (kind.dimension != dimension || corners.size() != static_cast<std::size_t>(kind.vertices))
      fail(node, "<" + printable(node.name()) + "> of " + shown(name) + " has " +
                     std::to_string(corners.size()) + " nodes; expected " +
                     (kind.dimension == dimension ? std::to_string(kind.vertices)
                      : dimension == 2            ? "a face"
                                                  : "a line"));
    corners.resize(static_cast<std::size_t>(kind.corners));
    gather_.add_face(name, corners, place(node));
  }
}

void FebParser::section(const pugi::xml_node& part, bool sets) {
  const std::string_view name = part.name();
  if (name == "Part" || name == "Instance")
    fail(part, "<" + printable(name) + "> is not read; expected the nodes and elements themselves");
  if (!sets) {
    if (name == "Nodes") nodes(part);
    if (name == "Elements") elements(part);
    return;
  }
  if (name == "NodeSet") gather_.add_nodes(name_of(part), members(part), place(part));
  if (name == "Surface") faces(part, 2);
  if (name == "Edge") faces(part, 1);
  if (name == "ElementSet") {
    std::vector<std::size_t> all;
    for (const std::int64_t tag : members(part))
      all.push_back(gather_.element(tag, "the element set " + shown(name_of(part)), place(part)));
    std::ranges::sort(all);
    all.erase(std::unique(all.begin(), all.end()), all.end());
    gather_.add_elements(name_of(part), std::move(all), false);
  }
}

}  // namespace

ParsedMesh parse_feb(const FileBytes& file, MeshReport& report) {
  return FebParser(file, report).parse();
}

}  // namespace plica
