// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <plica/core/text.hpp>
#include <plica/meshes/compare_levels.hpp>

namespace plica {

namespace {

struct Limits {
  double length, volume;  // ratios
  double shift;           // shift of the centroid over the extent
};
constexpr Limits doubtful = {1.05, 1.25, 0.03}, wrong = {2, 4, 0.25};

// Returns the ratio of the larger to the smaller number, 1 or more
double factor(double a, double b) { return a > 0 && b > 0 ? std::max(a / b, b / a) : 1; }

Point extent(const MeshSize& size) { return size.box.max - size.box.min; }

double largest_factor(const MeshSize& a, const MeshSize& b) {
  if (a.around || b.around) return 1;
  double largest = 1;
  for (int k = 0; k < 3; ++k) largest = std::max(largest, factor(extent(a)[k], extent(b)[k]));
  return largest;
}

double relative_shift(const MeshSize& finest, const MeshSize& coarse) {
  return ((coarse.centroid - finest.centroid).array() / extent(finest).array()).abs().maxCoeff();
}

bool beyond(const Limits& limits, const MeshSize& finest, const MeshSize& coarse) {
  return largest_factor(finest, coarse) > limits.length ||
         factor(finest.volume, coarse.volume) > limits.volume ||
         factor(finest.mass, coarse.mass) > limits.volume ||
         relative_shift(finest, coarse) > limits.shift;
}

std::string measures(const MeshSize& size) {
  const Point e = extent(size), &c = size.centroid;
  return text(number(e[0], 4), " x ", number(e[1], 4), " x ", number(e[2], 4), " m, ",
              number(size.volume, 4), " m^3, ", number(size.mass, 4), " kg, centroid [",
              number(c[0], 4), ", ", number(c[1], 4), ", ", number(c[2], 4), "]");
}

// Returns the end of the sentence where a file is in cm or mm and has no scale: the ratio of the
// lengths is about 100 or 1000. Empty: it is not.
std::string other_unit(const MeshSize& finest, const MeshSize& coarse, std::size_t level) {
  const double ratio = extent(coarse).norm() / extent(finest).norm();
  const auto said = [](std::size_t of, double scale, const char* unit) {
    return text("; is the file of level ", of, " in ", unit, "? Then its scale is ", number(scale));
  };
  const struct {
    double scale;
    const char* unit;
  } units[] = {{0.001, "mm"}, {0.01, "cm"}};
  for (const auto& [scale, unit] : units) {
    if (factor(ratio * scale, 1) < 1.5) return said(level, scale, unit);
    if (factor(ratio / scale, 1) < 1.5) return said(0, scale, unit);
  }
  return {};
}

std::string likely_cause(const MeshSize& finest, const MeshSize& coarse, std::size_t level) {
  if (std::string unit = other_unit(finest, coarse, level); !unit.empty()) return unit;
  if (largest_factor(finest, coarse) < wrong.length && relative_shift(finest, coarse) > wrong.shift)
    return "; the levels must lie at the same place";
  return "; expected meshes of one body, in metres";
}

}  // namespace

MeshSize mesh_size(const TetMesh& mesh, const std::vector<double>& density) {
  MeshSize size;
  size.box = bounding_box(mesh.vertices);
  size.around = !mesh.filled.empty();
  for (std::size_t e = 0; e < mesh.tets.size(); ++e) {
    const auto at = [&](std::size_t k) -> const Point& {
      return mesh.vertices[static_cast<std::size_t>(mesh.tets[e][k])];
    };
    const double volume = mesh.part(e) * tet_volume(at(0), at(1), at(2), at(3));
    size.volume += volume;
    size.mass +=
        volume * density[mesh.region.empty() ? 0 : static_cast<std::size_t>(mesh.region[e])];
    size.centroid += volume / 4 * (at(0) + at(1) + at(2) + at(3));
  }
  if (size.volume > 0) size.centroid /= size.volume;
  size.edge = std::cbrt(6 * std::sqrt(2.) * size.volume / static_cast<double>(mesh.tets.size()));
  return size;
}

bool covers_part(const MeshSize& part, const MeshSize& whole) {
  const auto reach_out = [](const Box& a, const Box& b) {
    return std::max({0.0, (b.min - a.min).maxCoeff(), (a.max - b.max).maxCoeff()});
  };
  const double edge = std::max(part.edge, whole.edge), out = reach_out(whole.box, part.box),
               more = whole.volume / part.volume;
  if (reach_out(part.box, whole.box) > out / 2) return false;
  return (out > 1.5 * edge && more > 1.1) || (out > 0.5 * edge && more > doubtful.volume);
}

LevelComparison compare_levels(const MeshSize& finest, const MeshSize& coarse, std::size_t level) {
  const bool no = beyond(wrong, finest, coarse), lacks = covers_part(finest, coarse),
             part = lacks || covers_part(coarse, finest);
  if (part && other_unit(finest, coarse, level).empty())
    return {
        SameBody::no,
        text("level ", lacks ? 0 : level, " covers a part of level ", lacks ? level : 0, ": ",
             measures(lacks ? finest : coarse), " of ", measures(lacks ? coarse : finest),
             "; expected levels of the whole body, or the key covers of the level that does not")};
  if (!beyond(doubtful, finest, coarse)) return {};
  return {no ? SameBody::no : SameBody::doubtful,
          text("level ", level,
               no ? " is not the body of level 0: " : " differs from level 0: ", measures(coarse),
               " instead of ", measures(finest), no ? likely_cause(finest, coarse, level) : "")};
}

}  // namespace plica
