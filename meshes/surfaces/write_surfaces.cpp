// SPDX-License-Identifier: BSD-3-Clause
#include <limits>
#include <plica/meshes/numbers_out.hpp>
#include <plica/meshes/surfaces/write_surfaces.hpp>

namespace plica {

namespace {

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

WrittenMesh write_obj(const std::filesystem::path& path, const TriangleSurface& surface) {
  TextOut out;
  for (const Point& p : surface.vertices) out << "v" << p << "\n";
  for (const auto& [a, b, c] : surface.triangles) out << "f " << a + 1 << " " << b + 1 << " " << c + 1 << "\n";
  return {{{path.string(), out.take()}}, {}};
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
  return {{{path.string(), out.take()}}, {"coordinates are rounded to seven digits: this format has no more"}};
}

}  // namespace plica
