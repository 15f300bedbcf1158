// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cctype>
#include <map>
#include <plica/meshes/files/deck_gather.hpp>
#include <plica/meshes/files/inp_elements.hpp>
#include <plica/meshes/files/list.hpp>
#include <plica/meshes/files/reading.hpp>
#include <set>

namespace plica {

namespace {

// Keywords that make nodes or elements in ways that are not read
constexpr std::string_view refused_keywords[] = {"INCLUDE", "NGEN",   "NFILL",  "NCOPY",   "NMAP",
                                                 "ELGEN",   "ELCOPY", "SYSTEM", "MANIFEST"};

// Keywords around a mesh, which have nothing to read
constexpr std::string_view deck_frame[] = {"HEADING", "PART", "ASSEMBLY", "INSTANCE"};

std::string upper_case(std::string_view word) {
  std::string text(word);
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

std::string_view without_blanks_around(std::string_view text) {
  constexpr std::string_view blank = " \t\r";
  text.remove_prefix(std::min(text.find_first_not_of(blank), text.size()));
  return text.substr(0, text.find_last_not_of(blank) + 1);
}

// Returns the name of a set without the name of an instance before it, and without quotes
std::string without_instance(std::string name) {
  std::erase(name, '"');
  if (const std::size_t dot = name.rfind('.'); dot != std::string::npos) name.erase(0, dot + 1);
  return name;
}

void add_all(const std::vector<std::int64_t>& more, std::vector<std::int64_t>& all) {
  all.insert(all.end(), more.begin(), more.end());
}

// A line of data: fields between commas. A comma at its end says that it goes on
struct DataLine {
  std::vector<std::string> fields;
  Place place;
};

DataLine data_line(std::string_view text, const Place& place) {
  DataLine line{{}, place};
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    line.fields.emplace_back(without_blanks_around(text.substr(begin, end - begin)));
    begin = end + 1;
  }
  while (!line.fields.empty() && line.fields.back().empty()) line.fields.pop_back();
  return line;
}

// Set of nodes or elements as the deck says it: numbers, ranges, and names of other sets
struct DeckSet {
  std::string name;
  struct Part {
    DataLine line;
    bool range;
    bool of_elements;  // an element set, whose nodes are meant
  };
  std::vector<Part> parts;
  std::vector<std::int64_t> own;  // elements and nodes that were defined with the set's name
  bool has_material = false, internal = false, resolving = false, resolved = false;
  std::vector<std::int64_t> numbers;  // members of the set, ascending
};

class DeckSets {
 public:
  // Returns the set of a name, in any case of letters; adds it if it is new
  DeckSet& operator[](const std::string& name) {
    const auto [found, is_new] = index_.try_emplace(upper_case(name), sets_.size());
    if (is_new) sets_.emplace_back().name = name;
    return sets_[found->second];
  }
  DeckSet* find(const std::string& name) {
    const auto found = index_.find(upper_case(name));
    return found == index_.end() ? nullptr : &sets_[found->second];
  }
  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const DeckSet& set : sets_) all.push_back(set.name);
    return all;
  }
  std::vector<DeckSet>& all() { return sets_; }

 private:
  std::vector<DeckSet> sets_;
  std::map<std::string, std::size_t> index_;
};

struct DeckSurface {
  std::string name;
  bool of_nodes = false, of_assembly = false;
  std::vector<DataLine> lines;
};

class InpParser {
 public:
  InpParser(const FileBytes& file, MeshReport& report)
      : lines_(file), file_(file.name), report_(report), gather_(file.name, report) {}

  ParsedMesh parse() {
    report_.format = "Abaqus .inp";
    more_ = next();
    if (!more_ || !is_keyword()) lines_.expected("a keyword like *NODE");
    while (more_) keyword();
    finish();
    return gather_.take();
  }

 private:
  using Parameters = std::map<std::string, std::string>;

  // Goes to the next line that is no comment
  bool next() {
    if (held_) return held_ = false, true;
    while (lines_.next())
      if (!lines_.text().starts_with("**")) return true;
    return false;
  }
  bool is_keyword() const { return lines_.text().starts_with('*'); }
  // Goes to the next line of data; false: the file ends or a keyword begins
  bool next_data() {
    more_ = next();
    return more_ && !is_keyword();
  }
  void keyword();
  void nodes(const Parameters& parameters);
  void elements(const Parameters& parameters);
  void set_lines(const Parameters& parameters, const char* key, DeckSets& sets);
  void surface(const Parameters& parameters);
  void add_surface(const DeckSurface& surface);
  void finish();
  const ElementKind& kind_of(const std::string& type) const;
  void add_range(const DataLine& line, const std::string& who,
                 const std::vector<std::int64_t>& defined, std::vector<std::int64_t>& all) const;
  void resolve(DeckSet& set, DeckSets& sets, const char* what,
               const std::vector<std::int64_t>& defined);

  std::int64_t integer(const std::string& field, const std::string& what,
                       const Place& place) const {
    const auto value = integer_in(field);
    if (!value) refuse(file_, place, what + " is " + shown(field) + "; it must be an integer");
    return *value;
  }
  // Returns a number, which may have Fortran's exponent D; an empty field is 0
  double real(std::string field, const std::string& what) const {
    std::ranges::replace_if(
        field, [](char c) { return c == 'd' || c == 'D'; }, 'e');
    const auto value = number_in(field.empty() ? "0" : field);
    if (!value) lines_.fail(what + " is " + shown(field) + "; it must be a number");
    return *value;
  }

  TextLines lines_;
  std::string file_;
  MeshReport& report_;
  DeckGather gather_;
  bool more_ = false, held_ = false, in_assembly_ = false, in_instance_ = false;
  int depth_ = 0;
  DeckSets node_sets_, element_sets_;
  std::vector<DeckSurface> surfaces_;
  std::set<std::string> once_, skipped_;
};

void InpParser::keyword() {
  const Place place = lines_.place();
  std::string header(lines_.text());
  while (header.back() == ',' && next()) {
    held_ = is_keyword();
    if (held_) break;
    header += lines_.text();
  }
  const DataLine line = data_line(std::string_view(header).substr(1), place);
  const std::string name = line.fields.empty() ? "" : upper_case(line.fields.front());
  Parameters parameters;
  for (std::size_t k = 1; k < line.fields.size(); ++k) {
    const std::string& field = line.fields[k];
    const std::size_t equals = std::min(field.find('='), field.size());
    std::string value(
        without_blanks_around(std::string_view(field).substr(std::min(equals + 1, field.size()))));
    std::erase(value, '"');
    parameters[upper_case(without_blanks_around(std::string_view(field).substr(0, equals)))] =
        value;
  }
  if (std::ranges::find(refused_keywords, name) != std::end(refused_keywords))
    refuse(file_, place,
           "*" + name +
               " is not read; expected all nodes and elements in this file, by *NODE and "
               "*ELEMENT");
  if (parameters.contains("INPUT") && (name == "NODE" || name == "ELEMENT"))
    refuse(file_, place, "*" + name + ", INPUT is not read; expected its lines in this file");
  if ((name == "PART" || name == "INSTANCE") && !once_.insert(name).second)
    refuse(file_, place, "a second *" + name + "; supported is one");
  if (name == "ASSEMBLY" || name == "END ASSEMBLY") in_assembly_ = name == "ASSEMBLY";
  if (name == "INSTANCE" || name == "END INSTANCE") in_instance_ = name == "INSTANCE";
  // Nodes of an assembly are points of reference, with numbers of their own
  const bool of_mesh = !in_assembly_ || in_instance_ || parameters.contains("INSTANCE");
  if (name == "NODE" && of_mesh) return nodes(parameters);
  if (name == "ELEMENT" && of_mesh) return elements(parameters);
  if (name == "NSET" && of_mesh) return set_lines(parameters, "NSET", node_sets_);
  if (name == "ELSET" && of_mesh) return set_lines(parameters, "ELSET", element_sets_);
  if (name == "SURFACE") return surface(parameters);
  if (name == "SOLID SECTION" && parameters.contains("ELSET"))
    element_sets_[parameters.at("ELSET")].has_material = true;
  else if (!name.starts_with("END ") && std::ranges::find(deck_frame, name) == std::end(deck_frame))
    skipped_.insert("*" + name.substr(0, 60) + (of_mesh ? "" : " of the assembly"));
  while (next_data())
    if (name == "INSTANCE" && lines_.text().find_first_not_of("0., \t") != std::string_view::npos)
      skipped_.insert("the position of *INSTANCE");
}

void InpParser::nodes(const Parameters& parameters) {
  const auto system = parameters.find("SYSTEM");
  if (system != parameters.end() && upper_case(system->second) != "R")
    lines_.fail("*NODE, SYSTEM=" + system->second.substr(0, 20) +
                " is not read; expected rectangular coordinates");
  constexpr const char* what[] = {"coordinate x", "coordinate y", "coordinate z"};
  const auto set = parameters.find("NSET");
  while (next_data()) {
    const DataLine line = data_line(lines_.text(), lines_.place());
    if (line.fields.size() < 2) lines_.expected("a node: its number and three coordinates");
    const std::int64_t tag = integer(line.fields[0], "the number of a node", line.place);
    Point position = Point::Zero();
    for (std::size_t a = 0; a < 3 && a + 1 < line.fields.size(); ++a)
      position[static_cast<Eigen::Index>(a)] = real(line.fields[a + 1], what[a]);
    gather_.add_node(tag, position, line.place);
    if (set != parameters.end()) node_sets_[set->second].own.push_back(tag);
  }
}

const ElementKind& InpParser::kind_of(const std::string& type) const {
  const std::string name = upper_case(type);
  std::vector<std::string> choices;
  for (const NamedKind& known : inp_kinds) {
    choices.emplace_back(known.name);
    if (!name.starts_with(known.name)) continue;
    const std::string rest = name.substr(known.name.size());
    if (rest.empty() || std::isalpha(static_cast<unsigned char>(rest.front()))) return known.kind;
  }
  lines_.fail(unknown_name("type of elements", printable(type), choices));
}

void InpParser::elements(const Parameters& parameters) {
  const auto type = parameters.find("TYPE"), set = parameters.find("ELSET");
  if (type == parameters.end()) lines_.expected("*ELEMENT, TYPE=C3D4 or another type");
  const ElementKind& kind = kind_of(type->second);
  const auto needed = static_cast<std::size_t>(kind.vertices) + 1;
  while (next_data()) {
    DataLine line = data_line(lines_.text(), lines_.place());
    DeckElement element{
        &kind,
        integer(line.fields.empty() ? "" : line.fields[0], "the number of an element", line.place),
        {},
        line.place};
    std::size_t found = line.fields.size();
    const auto take = [&](std::size_t first) {
      for (std::size_t k = first; k < line.fields.size(); ++k)
        element.nodes.push_back(integer(line.fields[k], "a node of an element", line.place));
    };
    take(1);
    while (found < needed && next_data()) {
      line = data_line(lines_.text(), lines_.place());
      found += line.fields.size();
      take(0);
    }
    if (found != needed)
      refuse(file_, element.place,
             "element " + std::to_string(element.tag) + ", a " + kind.name + ", has " +
                 std::to_string(element.nodes.size()) + " nodes; expected " +
                 std::to_string(kind.vertices));
    if (set != parameters.end()) element_sets_[set->second].own.push_back(element.tag);
    gather_.add_element(std::move(element));
  }
}

void InpParser::set_lines(const Parameters& parameters, const char* key, DeckSets& sets) {
  const auto name = parameters.find(key);
  if (name == parameters.end() || name->second.empty())
    lines_.expected(std::string("*") + key + ", " + key + "=NAME");
  DeckSet& set = sets[name->second];
  set.internal |= parameters.contains("INTERNAL");  // part of a surface
  if (key == std::string_view("NSET") && parameters.contains("ELSET"))
    set.parts.push_back({{{parameters.at("ELSET")}, lines_.place()}, false, true});
  while (next_data())
    set.parts.push_back(
        {data_line(lines_.text(), lines_.place()), parameters.contains("GENERATE"), false});
}

void InpParser::surface(const Parameters& parameters) {
  const auto name = parameters.find("NAME"), type = parameters.find("TYPE");
  if (name == parameters.end() || name->second.empty()) lines_.expected("*SURFACE, NAME=NAME");
  const std::string kind = type == parameters.end() ? "ELEMENT" : upper_case(type->second);
  DeckSurface surface{name->second, kind == "NODE", in_assembly_, {}};
  while (next_data()) surface.lines.push_back(data_line(lines_.text(), lines_.place()));
  if (kind == "NODE" || kind == "ELEMENT")
    surfaces_.push_back(std::move(surface));
  else
    skipped_.insert("*SURFACE, TYPE=" + kind.substr(0, 20));
}

// Adds the numbers of the set's range "first, last, increment", as far as they are defined
void InpParser::add_range(const DataLine& line, const std::string& who,
                          const std::vector<std::int64_t>& defined,
                          std::vector<std::int64_t>& all) const {
  const auto& [fields, place] = line;
  if (fields.size() < 2 || fields.size() > 3)
    refuse(file_, place,
           who + " has a range with " + std::to_string(fields.size()) +
               " numbers; expected first, last and increment");
  const std::int64_t first = integer(fields[0], "the first number", place),
                     last = integer(fields[1], "the last number", place),
                     step = fields.size() == 3 ? integer(fields[2], "the increment", place) : 1;
  if (step < 1)
    refuse(file_, place, who + " has the increment " + fields[2] + "; expected 1 or more");
  for (auto at = std::ranges::lower_bound(defined, first); at != defined.end() && *at <= last; ++at)
    if ((static_cast<std::uint64_t>(*at) - static_cast<std::uint64_t>(first)) %
            static_cast<std::uint64_t>(step) ==
        0)
      all.push_back(*at);
}

// Finds what a set comes to, after the sets that it names
void InpParser::resolve(DeckSet& set, DeckSets& sets, const char* what,
                        const std::vector<std::int64_t>& defined) {
  if (set.resolved) return;
  set.resolving = true;
  std::vector<std::int64_t> all = set.own;
  const std::string who = std::string("the ") + what + " set " + shown(set.name);
  if (++depth_ > 100) refuse(file_, {}, who + " is the hundredth of sets that name each other");
  for (const auto& [line, range, of_elements] : set.parts) {
    if (range) {
      add_range(line, who, defined, all);
      continue;
    }
    for (const std::string& field : line.fields) {
      const std::string name = without_instance(field);
      if (const auto number = integer_in(name)) {
        all.push_back(*number);
        continue;
      }
      DeckSets& from = of_elements ? element_sets_ : sets;
      DeckSet* other = from.find(name);
      if (!other || (other->resolving && !other->resolved))
        refuse(file_, line.place, who + ": " + unknown_name("set", printable(name), from.names()));
      if (!of_elements) resolve(*other, sets, what, defined);
      for (const std::int64_t tag : other->numbers)
        if (of_elements)
          add_all(gather_.elements()[gather_.element(tag, who, line.place)].nodes, all);
        else
          all.push_back(tag);
    }
  }
  std::ranges::sort(all);
  all.erase(std::unique(all.begin(), all.end()), all.end());
  set.numbers = std::move(all);
  set.resolved = true;
  --depth_;
}

void InpParser::add_surface(const DeckSurface& surface) {
  const std::string who = "the surface " + shown(surface.name);
  for (const auto& [fields, place] : surface.lines) {
    if (fields.empty()) continue;
    DeckSets& sets = surface.of_nodes ? node_sets_ : element_sets_;
    const std::string name = without_instance(fields[0]);
    std::vector<std::int64_t> members;
    if (const auto number = integer_in(name))
      members = {*number};
    else if (const DeckSet* set = sets.find(name))
      members = set->numbers;
    else if (surface.of_assembly)  // set of a point of reference
      skipped_.insert("*SURFACE " + printable(surface.name));
    else
      refuse(file_, place, who + ": " + unknown_name("set", printable(name), sets.names()));
    if (surface.of_nodes) {
      gather_.add_nodes(surface.name, members, place);
      continue;
    }
    const std::string label = fields.size() > 1 ? upper_case(fields[1]) : "";
    for (const std::int64_t tag : members) {
      const DeckElement& element = gather_.elements()[gather_.element(tag, who, place)];
      const ElementKind& kind = *element.kind;
      std::vector<std::int64_t> corners;
      if (kind.dimension == 2) {
        corners.assign(element.nodes.begin(), element.nodes.begin() + kind.corners);
      } else if (kind.dimension == 3) {
        const auto faces = inp_faces(kind);
        const auto number = label.starts_with('S') ? integer_in(label.substr(1)) : std::nullopt;
        if (!number || *number < 1 || *number > static_cast<std::int64_t>(faces.size()))
          refuse(file_, place,
                 who + " has the face " + shown(label) + " of element " + std::to_string(tag) +
                     ", a " + kind.name + "; expected S1 to S" + std::to_string(faces.size()));
        for (const int k : faces[static_cast<std::size_t>(*number - 1)])
          if (k >= 0) corners.push_back(element.nodes[static_cast<std::size_t>(k)]);
      }
      if (!corners.empty()) gather_.add_face(surface.name, corners, place);
    }
  }
}

// Resolves the sets after all nodes and elements are known
void InpParser::finish() {
  std::vector<std::int64_t> nodes, elements;
  for (const RawVertex& node : gather_.nodes()) nodes.push_back(node.tag);
  for (const DeckElement& element : gather_.elements()) elements.push_back(element.tag);
  std::ranges::sort(nodes), std::ranges::sort(elements);
  for (DeckSet& set : element_sets_.all()) {
    resolve(set, element_sets_, "element", elements);
    const Place place = set.parts.empty() ? Place{} : set.parts.front().line.place;
    std::vector<std::size_t> members;
    for (const std::int64_t tag : set.numbers)
      members.push_back(gather_.element(tag, "the element set " + shown(set.name), place));
    if (!set.internal) gather_.add_elements(set.name, std::move(members), set.has_material);
  }
  for (DeckSet& set : node_sets_.all()) {
    resolve(set, node_sets_, "node", nodes);
    gather_.add_nodes(set.name, set.numbers,
                      set.parts.empty() ? Place{} : set.parts.front().line.place);
  }
  for (const DeckSurface& one : surfaces_) add_surface(one);
  std::string names;
  for (const std::string& name : skipped_) names += (names.empty() ? "" : ", ") + name;
  if (!names.empty()) report_.notes.push_back("only the mesh is read, not " + names.substr(0, 200));
}

}  // namespace

ParsedMesh parse_inp(const FileBytes& file, MeshReport& report) {
  return InpParser(file, report).parse();
}

}  // namespace plica
