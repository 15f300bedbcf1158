// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <charconv>
#include <plica/meshes/files/list.hpp>
#include <plica/meshes/files/reading.hpp>

namespace plica {

namespace {

constexpr std::string_view left_out[] = {"vn", "vt", "g", "o", "s", "usemtl", "mtllib", "l", "p"};

struct Face {
  std::vector<std::int64_t> corners;
  Place place;
};

class ObjParser {
 public:
  explicit ObjParser(const MemoryFile& file) : lines_(file, '#') { raw_.file = file.name; }

  RawMesh parse() {
    while (lines_.next()) line();
    for (const Face& face : faces_) cut(face);
    return std::move(raw_);
  }

 private:
  void line();
  void vertex();
  void face();
  std::int64_t corner(std::size_t word) const;
  void cut(const Face& face);

  TextLines lines_;
  RawMesh raw_;
  std::vector<Face> faces_;
};

void ObjParser::line() {
  const std::string_view key = lines_.words().front();
  if (lines_.text().back() == '\\') lines_.fail("lines that go on after '\\' are not supported");
  if (key == "v") return vertex();
  if (key == "f") return face();
  if (std::find(std::begin(left_out), std::end(left_out), key) == std::end(left_out))
    lines_.fail("unknown or unsupported element " + shown(key) + "; supported are polygons: v and f");
}

// A weight may follow, or a colour
void ObjParser::vertex() {
  const std::size_t words = lines_.words().size();
  if (words != 4 && words != 5 && words != 7) lines_.expected("a vertex with three coordinates");
  constexpr const char* what[] = {"coordinate x", "coordinate y", "coordinate z"};
  RawVertex vertex{static_cast<std::int64_t>(raw_.vertices.size() + 1), {}, lines_.place()};
  for (int a = 0; a < 3; ++a) vertex.position[a] = lines_.number(static_cast<std::size_t>(a) + 1, what[a]);
  for (std::size_t w = 4; w < words; ++w)
    if (const double extra = lines_.number(w, "a weight or colour"); words == 5 && extra != 1.0)
      lines_.fail("the weight of a vertex is " + shown(lines_.words()[w]) + "; supported is 1");
  raw_.vertices.push_back(vertex);
}

// A vertex, and perhaps a texture and a normal: 3, 3/1, 3//2 or 3/1/2
std::int64_t ObjParser::corner(std::size_t word) const {
  const std::string_view text = lines_.words()[word];
  const std::string_view number = text.substr(0, text.find('/'));
  std::int64_t corner = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), corner);
  if (error != std::errc() || end != number.data() + number.size() || corner == 0)
    lines_.fail("a corner of a face is " + shown(text) + "; it must be the number of a vertex, from 1 or to -1");
  const std::int64_t vertices = static_cast<std::int64_t>(raw_.vertices.size());
  if (corner < -vertices)
    lines_.fail("a corner of a face is " + shown(text) + ", but there are only " + std::to_string(vertices) +
                " vertices before it");
  return corner < 0 ? vertices + 1 + corner : corner;
}

void ObjParser::face() {
  if (lines_.words().size() < 4) lines_.expected("a face with three corners or more");
  Face face{{}, lines_.place()};
  for (std::size_t w = 1; w < lines_.words().size(); ++w) face.corners.push_back(corner(w));
  faces_.push_back(std::move(face));
}

void ObjParser::cut(const Face& face) {
  std::vector<Point> at;
  for (const std::int64_t corner : face.corners) {
    if (corner > static_cast<std::int64_t>(raw_.vertices.size()))
      refuse(
          raw_.file, face.place,
          "a face names vertex " + std::to_string(corner) + ", but there are " + std::to_string(raw_.vertices.size()));
    at.push_back(raw_.vertices[static_cast<std::size_t>(corner) - 1].position);
  }
  const auto area = [&](std::size_t k) -> Point { return (at[k] - at[0]).cross(at[k + 1] - at[0]); };
  Point sum = Point::Zero();
  for (std::size_t k = 1; k + 1 < at.size(); ++k) sum += area(k);
  for (std::size_t k = 1; k + 1 < at.size(); ++k) {
    if (at.size() > 3 && !(area(k).dot(sum) > 0.0))
      refuse(
          raw_.file, face.place,
          "a face with " + std::to_string(at.size()) + " corners cannot be cut into triangles from its first corner");
    const std::int64_t tag = static_cast<std::int64_t>(raw_.triangles.size() + 1);
    raw_.triangles.push_back({tag, {face.corners[0], face.corners[k], face.corners[k + 1]}, 0, face.place});
  }
}

}  // namespace

RawMesh parse_obj(const MemoryFile& file, MeshReport& report) {
  report.format = "OBJ";
  return ObjParser(file).parse();
}

WrittenMesh write_obj(const std::filesystem::path& path, const TriangleSurface& surface) {
  TextOut out;
  for (const Point& p : surface.vertices) out << "v" << p << "\n";
  for (const auto& [a, b, c] : surface.triangles) out << "f " << a + 1 << " " << b + 1 << " " << c + 1 << "\n";
  return {{{path.string(), out.take()}}, {}};
}

}  // namespace plica
