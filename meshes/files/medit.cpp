// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <map>
#include <optional>
#include <plica/meshes/files/list.hpp>
#include <plica/meshes/files/reading.hpp>

namespace plica {

namespace {

constexpr NumberType integer = NumberType::int64, real = NumberType::float64;

// Keyword of a section; each row has the vertices of an element and its reference
struct Elements {
  const char* keyword;
  ElementKind kind;
};
constexpr Elements elements[] = {
    {"edges", {0, "line", 1, 2, 2}},
    {"triangles", {0, "triangle", 2, 3, 3}},
    {"trianglesp2", {0, "second-order triangle", 2, 6, 3}},
    {"quadrilaterals", {0, "quadrangle", 2, 4, 4}},
    {"tetrahedra", {0, "tetrahedron", 3, 4, 4}},
    {"tetrahedrap2", {0, "second-order tetrahedron", 3, 10, 4}},
    {"hexahedra", {0, "hexahedron", 3, 8, 8}},
    {"hexaedra", {0, "hexahedron", 3, 8, 8}},
    {"prisms", {0, "prism", 3, 6, 6}},
    {"pyramids", {0, "pyramid", 3, 5, 5}},
};

std::string name_of(std::int64_t reference) { return "reference_" + std::to_string(reference); }

class MeditParser {
 public:
  MeditParser(const FileBytes& file, MeshReport& report) : lines_(file, '#'), report_(report) {
    raw_.file = file.name;
  }

  ParsedMesh parse() {
    while (!ended_ && (pending_ || lines_.next())) section();
    if (dimension_ == 0 || raw_.vertices.empty())
      lines_.expected(dimension_ == 0 ? "Dimension 3" : "Vertices");
    for (auto& [key, group] : groups_) {
      group.name = name_of(key.second), group.dimension = key.first, group.tag = key.second;
      raw_.groups.push_back(std::move(group));
    }
    raw_.numbers.push_back({"reference", std::move(regions_), name_of, true, {}});
    return std::move(raw_);
  }

 private:
  // Reads a section: a keyword at the start of a line, then numbers on that line or the next ones
  void section() {
    pending_ = false;
    const std::string keyword = lower_case(lines_.words().front());
    if (report_.format.empty() && keyword != "meshversionformatted")
      lines_.expected("MeshVersionFormatted, the start of a Medit file");
    const std::string said(lines_.words().front());
    numbers_.emplace(lines_, std::size_t{1});
    if (keyword == "meshversionformatted") return version();
    if (keyword == "dimension") return dimension();
    if (keyword == "vertices") return vertices(said);
    for (const Elements& one : elements)
      if (keyword == one.keyword) return rows(one.kind, said);
    ended_ = keyword == "end";
    if (!ended_) skip(said);
  }

  void version() {
    numbers_->integer(integer, "the version");
    report_.format = "Medit .mesh";
  }

  void dimension() {
    dimension_ = numbers_->integer(integer, "the dimension");
    if (dimension_ != 3)
      numbers_->fail("the dimension is " + std::to_string(dimension_) + "; it must be 3");
  }

  void vertices(const std::string& keyword) {
    if (dimension_ == 0) lines_.expected("Dimension 3 before the vertices");
    if (!raw_.vertices.empty()) lines_.fail("a second section " + keyword);
    const std::int64_t count = numbers_->count(integer, "the number of vertices", integer, 4);
    constexpr const char* what[] = {"coordinate x", "coordinate y", "coordinate z"};
    for (std::int64_t i = 1; i <= count; ++i) {
      RawVertex vertex{i, {}, {}};
      for (int a = 0; a < 3; ++a) vertex.position[a] = numbers_->number(real, what[a]);
      vertex.place = numbers_->place();
      numbers_->integer(integer, "the reference of a vertex");
      raw_.vertices.push_back(vertex);
    }
    numbers_->end("the vertices");
  }

  void rows(const ElementKind& kind, const std::string& keyword) {
    const std::int64_t count =
        numbers_->count(integer, "the number of " + keyword, integer, kind.vertices + 1);
    std::vector<std::int64_t> row(static_cast<std::size_t>(kind.vertices));
    for (std::int64_t i = 1; i <= count; ++i) {
      for (std::int64_t& v : row) v = numbers_->integer(integer, "a vertex of an element");
      const Place place = numbers_->place();
      const std::int64_t reference = numbers_->integer(integer, "the reference of an element");
      regions_.insert(regions_.end(), add_element(kind, i, row, place, raw_, report_), reference);
      if (kind.dimension < 3 && reference != 0)
        add_to_group(kind, i, row, place, groups_[{kind.dimension, reference}]);
    }
    numbers_->end("the " + keyword);
  }

  // Skips a section, up to the next line that begins with a letter
  void skip(const std::string& keyword) {
    report_.skipped_sections.push_back(keyword.substr(0, 60));
    const auto is_keyword = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
    while (!pending_ && lines_.next()) pending_ = is_keyword(lines_.text().front());
  }

  TextLines lines_;
  MeshReport& report_;
  ParsedMesh raw_;
  std::optional<TextNumbers> numbers_;
  std::int64_t dimension_ = 0;
  // pending_: the current line has a keyword that has not been read yet
  bool ended_ = false, pending_ = false;
  std::vector<std::int64_t> regions_;  // per tetrahedron its reference
  std::map<std::pair<int, std::int64_t>, RawGroup> groups_;
};

}  // namespace

ParsedMesh parse_medit(const FileBytes& file, MeshReport& report) {
  return MeditParser(file, report).parse();
}

WrittenMesh write_medit(const std::filesystem::path& path, const TetMesh& mesh,
                        const MeshGroups& groups) {
  WrittenMesh written;
  leave_out_region_names(mesh, groups, "reference_", written);
  leave_out_filled(mesh, written);
  const std::vector<std::int64_t> regions = region_numbers(mesh, groups);
  const std::vector<ElementGroup> sets = groups_of(mesh, groups);
  TextOut out;
  out << "MeshVersionFormatted 2\nDimension 3\nVertices\n" << mesh.vertices.size() << "\n";
  for (const Point& p : mesh.vertices) out << p.x() << " " << p.y() << " " << p.z() << " 0\n";
  constexpr const char* keywords[] = {"", "Edges", "Triangles"};
  for (const std::size_t dimension : {1, 2}) {
    std::size_t count = 0;
    for (const ElementGroup& set : sets)
      if (static_cast<std::size_t>(set.dimension) == dimension) count += set.elements.size();
    if (count == 0) continue;
    out << keywords[dimension] << "\n" << count << "\n";
    for (const ElementGroup& set : sets)
      for (const auto& element : set.elements) {
        if (static_cast<std::size_t>(set.dimension) != dimension) break;
        for (std::size_t k = 0; k <= dimension; ++k) out << element[k] + 1 << " ";
        out << set.tag << "\n";
      }
  }
  out << "Tetrahedra\n" << mesh.tets.size() << "\n";
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    for (const int v : mesh.tets[t]) out << v + 1 << " ";
    out << (regions.empty() ? 0 : regions[t]) << "\n";
  }
  out << "End\n";
  for (const ElementGroup& set : sets) {
    const std::string now = name_of(set.tag);
    if (set.dimension == 0)
      written.left_out.push_back("the vertex set '" + set.name +
                                 "' is left out: this format has none of points");
    else if (set.name != now)
      written.left_out.push_back("the vertex set '" + set.name + "' is now '" + now +
                                 "', as this format numbers them");
  }
  written.files = {{path.string(), out.take()}};
  return written;
}

}  // namespace plica
