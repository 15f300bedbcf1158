// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <optional>
#include <plica/meshes/files/list.hpp>
#include <plica/meshes/files/reading.hpp>

namespace plica {

namespace {

struct PlyType {
  const char* name;
  NumberType type;
};
constexpr PlyType ply_types[] = {
    {"char", NumberType::int8},      {"int8", NumberType::int8},
    {"uchar", NumberType::uint8},    {"uint8", NumberType::uint8},
    {"short", NumberType::int16},    {"int16", NumberType::int16},
    {"ushort", NumberType::uint16},  {"uint16", NumberType::uint16},
    {"int", NumberType::int32},      {"int32", NumberType::int32},
    {"uint", NumberType::uint32},    {"uint32", NumberType::uint32},
    {"float", NumberType::float32},  {"float32", NumberType::float32},
    {"double", NumberType::float64}, {"float64", NumberType::float64},
};

struct Property {
  std::string name;
  NumberType type = NumberType::float32;
  std::optional<NumberType> count;  // type of the length of a list; none: no list
};

struct Element {
  std::string name;
  std::int64_t count = 0;
  std::vector<Property> properties;
};

class PlyParser {
 public:
  PlyParser(const FileBytes& file, MeshReport& report) : lines_(file), report_(report) {
    raw_.file = file.name;
  }

  ParsedMesh parse() {
    header();
    form_.after(lines_, [&](Numbers& numbers) {
      for (const Element& element : elements_) read(element, numbers);
      return 0;
    });
    return std::move(raw_);
  }

 private:
  void header();
  void format();
  void property();
  NumberType type(std::size_t word) const;
  void read(const Element& element, Numbers& numbers);
  void read_vertices(const Element& element, Numbers& numbers);
  void read_faces(const Element& element, Numbers& numbers);
  void skip(const Property& property, Numbers& numbers) const;

  TextLines lines_;
  MeshReport& report_;
  ParsedMesh raw_;
  NumberForm form_;
  std::vector<Element> elements_;
};

void PlyParser::header() {
  if (!lines_.next() || lines_.text() != "ply") lines_.expected("ply, the start of a PLY file");
  format();
  while (true) {
    if (!lines_.next()) lines_.expected("end_header");
    const std::string_view key = lines_.words().front();
    if (key == "end_header") return;
    if (key == "comment" || key == "obj_info") continue;
    if (key == "property") {
      property();
    } else if (key == "element" && lines_.words().size() == 3) {
      elements_.push_back(
          {std::string(lines_.words()[1]), lines_.integer(2, "the number of elements"), {}});
    } else {
      lines_.expected("a line like element vertex 8, property float x, or end_header");
    }
  }
}

void PlyParser::format() {
  if (!lines_.next() || lines_.words().size() != 3 || lines_.words()[0] != "format")
    lines_.expected("a line like format ascii 1.0");
  const std::string_view name = lines_.words()[1];
  form_.binary = name != "ascii", form_.free = true;
  form_.order = name == "binary_big_endian" ? std::endian::big : std::endian::little;
  if (form_.binary && !name.starts_with("binary_"))
    lines_.expected("format ascii, binary_little_endian or binary_big_endian");
  report_.format = form_.binary ? "PLY binary" : "PLY ASCII";
}

NumberType PlyParser::type(std::size_t word) const {
  std::vector<std::string> choices;
  for (const PlyType& known : ply_types) {
    if (lines_.words()[word] == known.name) return known.type;
    choices.emplace_back(known.name);
  }
  lines_.fail(unknown_name("type of numbers", printable(lines_.words()[word]), choices));
}

void PlyParser::property() {
  const std::size_t words = lines_.words().size();
  const bool list = words > 1 && lines_.words()[1] == "list";
  if (elements_.empty() || words != (list ? 5u : 3u))
    lines_.expected("a line like property float x, or property list uchar int vertex_indices");
  Property one{std::string(lines_.words().back()), type(words - 2), {}};
  if (list) one.count = type(2);
  elements_.back().properties.push_back(one);
}

void PlyParser::read(const Element& element, Numbers& numbers) {
  if (element.properties.empty()) return;
  // The smallest possible record has one byte per property
  numbers.checked_count(element.count, "the number of elements " + shown(element.name),
                        NumberType::int8, static_cast<std::int64_t>(element.properties.size()));
  if (element.name == "vertex") return read_vertices(element, numbers);
  if (element.name == "face") return read_faces(element, numbers);
  for (std::int64_t i = 0; i < element.count; ++i)
    for (const Property& one : element.properties) skip(one, numbers);
  ++report_.other_elements[element.name.substr(0, 60)];
}

void PlyParser::skip(const Property& property, Numbers& numbers) const {
  const std::int64_t count =
      property.count ? numbers.count(*property.count, "the length of a list", property.type, 1) : 1;
  numbers.skip(count, property.type, "a property");
}

void PlyParser::read_vertices(const Element& element, Numbers& numbers) {
  constexpr const char* axes[] = {"x", "y", "z"};
  constexpr const char* what[] = {"coordinate x", "coordinate y", "coordinate z"};
  const auto is = [&](const Property& one, const char* name) {
    return !one.count && one.name == name;
  };
  for (const char* axis : axes)
    if (std::ranges::count_if(element.properties,
                              [&](const Property& one) { return is(one, axis); }) != 1)
      refuse(raw_.file, {}, "the vertices have not one property " + std::string(axis));
  if (!raw_.vertices.empty()) refuse(raw_.file, {}, "a second element vertex");
  for (std::int64_t i = 0; i < element.count; ++i) {
    RawVertex vertex{i, {}, {}};
    for (const Property& one : element.properties) {
      const auto axis = std::ranges::find_if(axes, [&](const char* name) { return is(one, name); });
      if (axis == std::end(axes)) {
        skip(one, numbers);
        continue;
      }
      const auto a = axis - std::begin(axes);
      vertex.position[a] = numbers.number(one.type, what[a]);
      vertex.place = numbers.place();
    }
    raw_.vertices.push_back(vertex);
  }
}

void PlyParser::read_faces(const Element& element, Numbers& numbers) {
  const auto is_corners = [](const Property& one) {
    return one.count && (one.name == "vertex_indices" || one.name == "vertex_index");
  };
  if (std::ranges::count_if(element.properties, is_corners) != 1)
    refuse(raw_.file, {}, "the faces have not one list vertex_indices");
  std::vector<std::int64_t> corners;
  for (std::int64_t i = 0; i < element.count; ++i)
    for (const Property& one : element.properties) {
      if (!is_corners(one)) {
        skip(one, numbers);
        continue;
      }
      const std::int64_t count =
          numbers.count(*one.count, "the number of corners of a face", one.type, 1);
      const Place place = numbers.place();
      corners.clear();
      for (std::int64_t k = 0; k < count; ++k)
        corners.push_back(numbers.integer(one.type, "a corner of a face"));
      if (count < 3)
        raw_.bad_faces.add(place, "face " + std::to_string(i) + " has " + std::to_string(count) +
                                      " corners; expected 3 or more");
      else
        add_face(i, corners, place, raw_);
    }
}

}  // namespace

ParsedMesh parse_ply(const FileBytes& file, MeshReport& report) {
  return PlyParser(file, report).parse();
}

WrittenMesh write_ply(const std::filesystem::path& path, const TriangleSurface& surface) {
  NumbersOut out(true, std::endian::little);
  out.text("ply\nformat binary_little_endian 1.0\nelement vertex " +
           std::to_string(surface.vertices.size()) +
           "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
           std::to_string(surface.triangles.size()) +
           "\nproperty list uchar int vertex_indices\nend_header\n");
  for (const Point& p : surface.vertices) out.real64(p);
  for (const auto& [a, b, c] : surface.triangles) out.text("\x03").int32(a).int32(b).int32(c);
  return {{{path.string(), out.take()}}, {}};
}

}  // namespace plica
