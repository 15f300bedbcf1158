// SPDX-License-Identifier: BSD-3-Clause
#include <bit>
#include <limits>
#include <plica/meshes/files/list.hpp>
#include <plica/meshes/files/reading.hpp>
#include <unordered_map>

namespace plica {

namespace {

constexpr const char* coordinates[] = {"coordinate x", "coordinate y", "coordinate z"};
constexpr std::size_t title = 80, head = title + 4, facet_bytes = 50;  // bytes

struct Exactly {
  std::size_t operator()(const Point& p) const {
    std::uint64_t hash = 0;
    for (const double x : p)
      hash = (hash ^ std::bit_cast<std::uint64_t>(x)) * 0x9E3779B97F4A7C15u, hash ^= hash >> 32;
    return static_cast<std::size_t>(hash);
  }
};

class StlGather {
 public:
  explicit StlGather(ParsedMesh& raw) : raw_(raw) {}

  void corner(std::size_t k, Point point, const Place& place) {
    point.array() += 0.0;  // makes -0 to 0: both must have one hash
    const auto [found, is_new] =
        index_.try_emplace(point, static_cast<std::int64_t>(index_.size()));
    if (is_new) raw_.vertices.push_back({found->second, point, place});
    triangle_.vertices[k] = found->second;
    if (k == 0) triangle_.place = place;
    if (k < 2) return;
    ++triangle_.tag;
    raw_.triangles.push_back(triangle_);
  }
  std::int64_t triangles() const { return triangle_.tag; }

 private:
  ParsedMesh& raw_;
  RawTriangle triangle_;
  std::unordered_map<Point, std::int64_t, Exactly> index_;
};

bool is(const TextLines& lines, std::size_t word, const char* expected) {
  return word < lines.words().size() && lower_case(lines.words()[word]) == expected;
}

void expect_line(TextLines& lines, const char* first, const char* second, const std::string& what) {
  if (!lines.next() || !is(lines, 0, first) || (second && !is(lines, 1, second)))
    lines.expected(what);
}

void read_facet(TextLines& lines, StlGather& gather) {
  if (!is(lines, 1, "normal")) lines.expected("facet normal ..., or endsolid");
  expect_line(lines, "outer", "loop", "outer loop");
  for (std::size_t k = 0; k < 3; ++k) {
    expect_line(lines, "vertex", nullptr, "vertex " + std::to_string(k + 1) + " of 3");
    if (lines.words().size() != 4) lines.expected("a vertex with three coordinates");
    Point point;
    for (int a = 0; a < 3; ++a)
      point[a] = lines.number(static_cast<std::size_t>(a) + 1, coordinates[a]);
    gather.corner(k, point, lines.place());
  }
  expect_line(lines, "endloop", nullptr, "endloop after three vertices");
  expect_line(lines, "endfacet", nullptr, "endfacet");
}

void read_text(const FileBytes& file, StlGather& gather) {
  TextLines lines(file);
  bool open = false;
  while (lines.next()) {
    const bool starts = is(lines, 0, "solid"),
               ends = is(lines, 0, "endsolid") || (is(lines, 0, "end") && is(lines, 1, "solid"));
    if (open ? !ends && !is(lines, 0, "facet") : !starts)
      lines.expected(open ? "facet or endsolid" : "solid");
    if (starts || ends)
      open = starts;
    else
      read_facet(lines, gather);
  }
  if (open) lines.expected("facet or endsolid");
}

std::uint32_t told_triangles(const FileBytes& file) {
  if (file.bytes.size() < head) return 0;
  ByteNumbers numbers(file.name, std::string_view(file.bytes).substr(title), std::endian::little,
                      {0, title});
  return static_cast<std::uint32_t>(numbers.integer(NumberType::uint32, "the number of triangles"));
}

void read_binary(const FileBytes& file, StlGather& gather) {
  ByteNumbers numbers(file.name, std::string_view(file.bytes).substr(head), std::endian::little,
                      {0, head});
  constexpr NumberType real = NumberType::float32;
  for (std::uint32_t left = told_triangles(file); left > 0; --left) {
    numbers.skip(3, real, "a normal");
    for (std::size_t k = 0; k < 3; ++k) {
      Point point;
      Place place;
      for (int a = 0; a < 3; ++a) {
        point[a] = numbers.number(real, coordinates[a]);
        if (a == 0) place = numbers.place();
      }
      gather.corner(k, point, place);
    }
    numbers.skip(1, NumberType::uint16, "an attribute");
  }
}

struct Facet {
  std::array<Point, 3> corners;
  Point normal;
};

Facet facet_of(const TriangleSurface& surface, const std::array<int, 3>& triangle) {
  const auto at = [&](std::size_t k) -> const Point& {
    return surface.vertices[static_cast<std::size_t>(triangle[k])];
  };
  return {{at(0), at(1), at(2)}, (at(1) - at(0)).cross(at(2) - at(0)).stableNormalized()};
}

}  // namespace

ParsedMesh parse_stl(const FileBytes& file, MeshReport& report) {
  ParsedMesh raw;
  raw.file = file.name;
  StlGather gather(raw);
  const std::size_t told = told_triangles(file), bytes = head + facet_bytes * told;
  const std::size_t start = file.bytes.find_first_not_of(" \t\r\n");
  if (file.bytes.size() >= head && file.bytes.size() == bytes) {
    report.format = "STL binary";
    read_binary(file, gather);
  } else if (start != std::string::npos &&
             lower_case(std::string_view(file.bytes).substr(start, 5)) == "solid") {
    report.format = "STL ASCII";
    read_text(file, gather);
  } else if (file.bytes.size() < head) {
    refuse(file.name, {},
           "is no STL file: it does not begin with 'solid', and has no " + std::to_string(head) +
               " bytes");
  } else {
    refuse(file.name, {0, title},
           "the number of triangles is " + std::to_string(told) +
               ", for which the file must have " + std::to_string(bytes) + " bytes, but it has " +
               std::to_string(file.bytes.size()));
  }
  return raw;
}

WrittenMesh write_stl(const std::filesystem::path& path, const TriangleSurface& surface) {
  TextOut out;
  out << "solid\n";
  for (const auto& triangle : surface.triangles) {
    const Facet facet = facet_of(surface, triangle);
    out << "facet normal" << facet.normal << "\nouter loop\n";
    for (const Point& corner : facet.corners) out << "vertex" << corner << "\n";
    out << "endloop\nendfacet\n";
  }
  out << "endsolid\n";
  return {{{path.string(), out.take()}}, {}};
}

WrittenMesh write_stl_binary(const std::filesystem::path& path, const TriangleSurface& surface) {
  NumbersOut out(true, std::endian::little);
  out.text(std::string(80, ' ')).int32(static_cast<std::int64_t>(surface.triangles.size()));
  for (const auto& triangle : surface.triangles) {
    const Facet facet = facet_of(surface, triangle);
    out.real32(facet.normal);
    for (const Point& corner : facet.corners) {
      if (corner.cwiseAbs().maxCoeff() > std::numeric_limits<float>::max())
        throw InputError("a coordinate is too large for binary STL", {path.string()});
      out.real32(corner);
    }
    out.text(std::string(2, '\0'));
  }
  return {{{path.string(), out.take()}},
          {"coordinates are rounded to seven digits: this format has no more"}};
}

}  // namespace plica
