// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <charconv>
#include <optional>
#include <plica/meshes/files/list.hpp>
#include <plica/meshes/files/reading.hpp>

namespace plica {

namespace {

constexpr std::string_view left_out[] = {"vn", "g", "o", "s", "usemtl", "mtllib", "l", "p"};

class ObjParser {
 public:
  explicit ObjParser(const FileBytes& file) : lines_(file, '#') { raw_.file = file.name; }

  ParsedMesh parse() {
    while (lines_.next()) line();
    if (raw_.texture.empty()) raw_.triangle_texture.clear();
    return std::move(raw_);
  }

 private:
  void line();
  void vertex();
  void texture();
  void face();
  int texture_of(std::string_view corner) const;
  std::optional<std::int64_t> corner(std::size_t word);

  TextLines lines_;
  ParsedMesh raw_;
};

void ObjParser::line() {
  const std::string_view key = lines_.words().front();
  if (lines_.text().back() == '\\') lines_.fail("lines that go on after '\\' are not supported");
  if (key == "v") return vertex();
  if (key == "vt") return texture();
  if (key == "f") return face();
  if (std::find(std::begin(left_out), std::end(left_out), key) == std::end(left_out))
    lines_.fail("unknown or unsupported element " + shown(key) +
                "; supported are polygons: v and f");
}

// Reads a vertex; a weight may follow its coordinates, or a colour
void ObjParser::vertex() {
  const std::size_t words = lines_.words().size();
  if (words != 4 && words != 5 && words != 7) lines_.expected("a vertex with three coordinates");
  constexpr const char* what[] = {"coordinate x", "coordinate y", "coordinate z"};
  RawVertex vertex{static_cast<std::int64_t>(raw_.vertices.size() + 1), {}, lines_.place()};
  for (int a = 0; a < 3; ++a)
    vertex.position[a] = lines_.number(static_cast<std::size_t>(a) + 1, what[a]);
  for (std::size_t w = 4; w < words; ++w)
    if (const double extra = lines_.number(w, "a weight or colour"); words == 5 && extra != 1.0)
      lines_.fail("the weight of a vertex is " + shown(lines_.words()[w]) + "; supported is 1");
  raw_.vertices.push_back(vertex);
}

// Reads texture coordinates: u, v and w, of which v and w may be left out; w is not used
void ObjParser::texture() {
  if (lines_.words().size() > 4) lines_.expected("texture coordinates u and v");
  const double u = lines_.number(1, "texture coordinate u");
  raw_.texture.push_back(
      {u, lines_.words().size() > 2 ? lines_.number(2, "texture coordinate v") : 0.0});
}

// Returns the index of a corner's texture coordinates, which may stand further down in the file;
// -1: the corner has none
int ObjParser::texture_of(std::string_view corner) const {
  const std::size_t slash = corner.find('/');
  if (slash == corner.npos) return -1;
  const std::string_view rest = corner.substr(slash + 1), text = rest.substr(0, rest.find('/'));
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || number == 0) return -1;
  const std::int64_t before = static_cast<std::int64_t>(raw_.texture.size());
  return number > 0 ? number - 1 : static_cast<int>(std::max<std::int64_t>(before + number, -1));
}

// Returns the vertex of a corner; a texture and a normal may follow it: 3, 3/1, 3//2 or 3/1/2.
// Returns nothing for a bad corner, which is counted.
std::optional<std::int64_t> ObjParser::corner(std::size_t word) {
  const std::string_view text = lines_.words()[word];
  const std::string_view number = text.substr(0, text.find('/'));
  std::int64_t corner = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), corner);
  const std::int64_t vertices = static_cast<std::int64_t>(raw_.vertices.size());
  const auto bad = [&](const std::string& rest) -> std::optional<std::int64_t> {
    raw_.bad_faces.add(lines_.place(), "a corner of a face is " + shown(text) + rest);
    return {};
  };
  if (error != std::errc() || end != number.data() + number.size() || corner == 0)
    return bad("; it must be the number of a vertex, from 1 or to -1");
  if (corner < -vertices)
    return bad(", but there are only " + std::to_string(vertices) + " vertices before it");
  return corner < 0 ? vertices + 1 + corner : corner;
}

void ObjParser::face() {
  std::vector<std::int64_t> corners;
  std::vector<int> texture;
  for (std::size_t w = 1; w < lines_.words().size(); ++w) {
    const auto one = corner(w);
    if (!one) return;
    corners.push_back(*one), texture.push_back(texture_of(lines_.words()[w]));
  }
  if (corners.size() < 3)
    return raw_.bad_faces.add(lines_.place(), "expected a face with three corners or more, found " +
                                                  shown(lines_.text()));
  add_face(static_cast<std::int64_t>(raw_.triangles.size() + raw_.polygons.size() + 1), corners,
           lines_.place(), raw_);
  if (corners.size() == 3)
    raw_.triangle_texture.push_back({texture[0], texture[1], texture[2]});
  else
    raw_.polygons.back().texture = std::move(texture);
}

}  // namespace

ParsedMesh parse_obj(const FileBytes& file, MeshReport& report) {
  report.format = "OBJ";
  return ObjParser(file).parse();
}

WrittenMesh write_obj(const std::filesystem::path& path, const TriangleSurface& surface) {
  TextOut out;
  for (const Point& p : surface.vertices) out << "v" << p << "\n";
  for (const CornerTexture& corners : surface.texture)
    for (const auto& [u, v] : corners) out << "vt " << u << " " << v << "\n";
  const bool textured = !surface.texture.empty();
  int corner = 0;
  for (const auto& triangle : surface.triangles) {
    out << "f";
    for (const int v : triangle) {
      out << " " << v + 1;
      if (textured) out << "/" << ++corner;
    }
    out << "\n";
  }
  return {{{path.string(), out.take()}}, {}};
}

}  // namespace plica
