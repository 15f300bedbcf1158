// SPDX-License-Identifier: BSD-3-Clause
#include <plica/meshes/files/list.hpp>
#include <plica/meshes/files/reading.hpp>

namespace plica {

namespace {

// Returns whether a word is OFF with any prefixes ST, C and N in this order. They announce
// textures, colours and normals after the coordinates of a vertex. These are left out, as is
// everything after the corners of a face.
bool is_heading(std::string_view word) {
  if (!word.ends_with("OFF")) return false;
  word.remove_suffix(3);
  for (const std::string_view prefix : {"ST", "C", "N"})
    if (word.starts_with(prefix)) word.remove_prefix(prefix.size());
  return word.empty();
}

void read_vertex(std::int64_t i, std::int64_t count, TextLines& lines, ParsedMesh& raw) {
  if (!lines.next())
    lines.expected("vertex " + std::to_string(i + 1) + " of " + std::to_string(count));
  constexpr const char* what[] = {"coordinate x", "coordinate y", "coordinate z"};
  RawVertex vertex{i, {}, lines.place()};
  for (int a = 0; a < 3; ++a)
    vertex.position[a] = lines.number(static_cast<std::size_t>(a), what[a]);
  raw.vertices.push_back(vertex);
}

void read_face(std::int64_t i, std::int64_t count, TextLines& lines, ParsedMesh& raw) {
  if (!lines.next())
    lines.expected("face " + std::to_string(i + 1) + " of " + std::to_string(count));
  const Place place = lines.place();
  // Corners may continue on the next line, as some programs write them
  TextNumbers numbers(lines, std::size_t{0});
  const std::int64_t corners =
      numbers.count(NumberType::int32, "the number of corners of a face", NumberType::int32, 1);
  if (corners < 3)
    return raw.bad_faces.add(
        place, "a face has " + std::to_string(corners) + " corners; expected 3 or more");
  std::vector<std::int64_t> tags;
  for (std::int64_t k = 0; k < corners; ++k)
    tags.push_back(numbers.integer(NumberType::int32, "a corner of a face"));
  add_face(i, tags, place, raw);
}

}  // namespace

ParsedMesh parse_off(const FileBytes& file, MeshReport& report) {
  ParsedMesh raw;
  raw.file = file.name;
  report.format = "OFF";
  TextLines lines(file, '#');
  if (!lines.next() || !is_heading(lines.words().front()))
    lines.expected("OFF, the start of an OFF file");
  if (lines.words().size() > 1 && lines.words()[1] == "BINARY")
    lines.fail("binary OFF files are not supported");
  std::size_t word = 1;  // the counts may follow OFF on its line
  if (lines.words().size() == 1) word = 0, lines.next();
  TextNumbers rest(lines);
  const std::int64_t vertices =
                         rest.checked_count(lines.integer(word, "the number of vertices"),
                                            "the number of vertices", NumberType::float64, 3),
                     faces = rest.checked_count(lines.integer(word + 1, "the number of faces"),
                                                "the number of faces", NumberType::int32, 1);
  for (std::int64_t i = 0; i < vertices; ++i) read_vertex(i, vertices, lines, raw);
  for (std::int64_t i = 0; i < faces; ++i) read_face(i, faces, lines, raw);
  return raw;
}

WrittenMesh write_off(const std::filesystem::path& path, const TriangleSurface& surface) {
  TextOut out;
  out << "OFF\n" << surface.vertices.size() << " " << surface.triangles.size() << " 0\n";
  for (const Point& p : surface.vertices) out << p.x() << " " << p.y() << " " << p.z() << "\n";
  for (const auto& [a, b, c] : surface.triangles) out << "3 " << a << " " << b << " " << c << "\n";
  return {{{path.string(), out.take()}}, {}};
}

}  // namespace plica
