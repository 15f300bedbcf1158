// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <numeric>
#include <plica/core/error.hpp>
#include <plica/drivers/app/report/surface_animation.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/files/base64.hpp>

namespace plica::app {

using Json = nlohmann::ordered_json;

namespace {

struct Range {
  float low = 0, high = 0;
};

// Returns the range of every `stride`th value of all frames, starting with value `first`
Range range_of(const std::vector<std::vector<float>>& frames, std::size_t first,
               std::size_t stride) {
  Range range{frames.front()[first], frames.front()[first]};
  for (const auto& frame : frames)
    for (std::size_t i = first; i < frame.size(); i += stride)
      range = {std::min(range.low, frame[i]), std::max(range.high, frame[i])};
  return range;
}

// Returns the values as 16-bit parts of the ranges, in base64. Value i has range i modulo the
// number of ranges, since the components alternate
std::string quantised(const std::vector<std::vector<float>>& frames,
                      const std::vector<Range>& ranges) {
  std::vector<std::uint16_t> values;
  values.reserve(frames.size() * frames.front().size());
  for (const auto& frame : frames)
    for (std::size_t i = 0; i < frame.size(); ++i) {
      const auto [low, high] = ranges[i % ranges.size()];
      const double part = high > low ? (double{frame[i]} - low) / (double{high} - low) : 0.0;
      values.push_back(static_cast<std::uint16_t>(std::lround(65535 * part)));
    }
  return base64(values);
}

std::array<double, 12> rigid_fit(const std::vector<Point>& rest, const std::vector<Point>& now) {
  const auto count = static_cast<Eigen::Index>(rest.size());
  const Eigen::Map<const Eigen::Matrix3Xd> from(rest.front().data(), 3, count),
      to(now.front().data(), 3, count);
  const Eigen::Matrix4d fit = Eigen::umeyama(from, to, false);
  std::array<double, 12> rows{};
  for (int i = 0; i < 12; ++i) rows[static_cast<std::size_t>(i)] = fit(i / 4, i % 4);
  return rows;
}

// Returns true for arrays that do not colour the surface: displacement, mass, number and the
// stress tensor. Mass and number are equal in all frames
bool left_out(const std::string& name) {
  return name == "displacement" || name == "mass" || name == "number" || name == "stress";
}

// Name of the array of which only the first number is shown
constexpr const char* stretch_field = "principal_stretches";

std::string unit_of(const std::string& name) {
  if (name.ends_with("velocity")) return "m/s";
  if (name.ends_with("force")) return "N";
  return name == "von_mises" || name.ends_with("pressure") || name.ends_with("stress") ? "Pa" : "";
}

std::string label_of(const std::string& name, bool is_length) {
  if (name == "velocity") return "speed";
  if (name == "von_mises") return "von Mises stress";
  if (name == "J") return "volume ratio J";
  if (name == stretch_field) return "largest stretch";
  std::string words = is_length ? "size of " + name : name;
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

}  // namespace

SurfaceAnimation::SurfaceAnimation(int level, const FrameFile& first) : level_(level) {
  points_ = first.points.size(), cells_ = first.triangles.size() + first.tets.size();
  if (points_ == 0 || cells_ == 0) throw InputError("there is no surface in it");
  take_boundary(first);
  const FrameArray* moved = first.find("displacement");
  for (const int v : vertices_) {
    const auto i = static_cast<std::size_t>(v);
    rest_.push_back(first.points[i]);
    if (moved != nullptr && moved->components == 3) rest_.back() -= Point(&moved->values[3 * i]);
  }
  for (const FrameArray& array : first.arrays)
    if (!left_out(array.name))
      fields_[array.name] = {
          array.of_cells, array.components > 1 && array.name != stretch_field, {}};
}

void SurfaceAnimation::take_boundary(const FrameFile& first) {
  if (first.tets.empty()) {
    triangles_ = first.triangles;
    vertices_.resize(points_), owners_.resize(cells_);
    std::iota(vertices_.begin(), vertices_.end(), 0);
    std::iota(owners_.begin(), owners_.end(), 0);
    return;
  }
  const BoundarySurface boundary = boundary_surface({first.points, first.tets, {}, {}, {}});
  triangles_ = boundary.surface.triangles, vertices_ = boundary.mesh_vertex;
  std::map<std::array<int, 3>, int> owner;
  for (std::size_t t = 0; t < first.tets.size(); ++t)
    for (std::size_t skipped = 0; skipped < 4; ++skipped) {
      std::array<int, 3> face{};
      for (std::size_t k = 0, at = 0; k < 4; ++k)
        if (k != skipped) face[at++] = first.tets[t][k];
      std::sort(face.begin(), face.end());
      owner[face] = static_cast<int>(t);
    }
  for (std::array<int, 3> face : triangles_) {
    for (int& v : face) v = vertices_[static_cast<std::size_t>(v)];
    std::sort(face.begin(), face.end());
    owners_.push_back(owner.at(face));
  }
}

std::vector<float> SurfaceAnimation::values_of(const FrameArray& array) const {
  const auto components = static_cast<std::size_t>(array.components);
  std::vector<float> values;
  for (const int i : array.of_cells ? owners_ : vertices_) {
    const double* at = &array.values[components * static_cast<std::size_t>(i)];
    const double size = std::sqrt(std::inner_product(at, at + components, at, 0.0));
    values.push_back(
        static_cast<float>(components > 1 && array.name != stretch_field ? size : *at));
  }
  return values;
}

void SurfaceAnimation::check(const FrameFile& frame) const {
  if (frame.points.size() != points_ || frame.triangles.size() + frame.tets.size() != cells_)
    throw InputError("it has another mesh than the first frame");
  for (const auto& [name, field] : fields_)
    if (const FrameArray* array = frame.find(name);
        array == nullptr || array->of_cells != field.of_cells)
      throw InputError("it has no array '" + name + "', as the first frame has");
}

bool SurfaceAnimation::same_surface(const SurfaceAnimation& other) const {
  return triangles_ == other.triangles_ && rest_ == other.rest_;
}

void SurfaceAnimation::add(const FrameFile& frame) {
  std::vector<Point> now;
  std::vector<float> motion;
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    now.push_back(frame.points[static_cast<std::size_t>(vertices_[i])]);
    for (int k = 0; k < 3; ++k) motion.push_back(static_cast<float>(now[i][k] - rest_[i][k]));
  }
  motion_.push_back(std::move(motion));
  fits_.push_back(rigid_fit(rest_, now));
  for (auto& [name, field] : fields_) field.frames.push_back(values_of(*frame.find(name)));
}

// Returns true if some vertex never moves
bool SurfaceAnimation::held() const {
  Point low = rest_.front(), high = rest_.front();
  for (const Point& p : rest_) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const double still = 1e-6 * (high - low).maxCoeff();
  for (std::size_t i = 0; i < rest_.size(); ++i)
    if (std::ranges::all_of(motion_, [&](const std::vector<float>& frame) {
          return std::hypot(frame[3 * i], frame[3 * i + 1], frame[3 * i + 2]) < still;
        }))
      return true;
  return false;
}

Json SurfaceAnimation::json() const {
  std::vector<float> rest;
  for (const Point& p : rest_) rest.insert(rest.end(), {float(p.x()), float(p.y()), float(p.z())});
  std::vector<std::uint32_t> corners;
  for (const auto& triangle : triangles_)
    corners.insert(corners.end(), triangle.begin(), triangle.end());
  const std::vector<Range> ranges = {range_of(motion_, 0, 3), range_of(motion_, 1, 3),
                                     range_of(motion_, 2, 3)};
  Json json = {{"level", level_ < 0 ? Json() : Json(level_)},
               {"vertices", rest_.size()},
               {"held", held()},
               {"rest", base64(rest)},
               {"triangles", base64(corners)},
               {"low", {ranges[0].low, ranges[1].low, ranges[2].low}},
               {"high", {ranges[0].high, ranges[1].high, ranges[2].high}},
               {"motion", quantised(motion_, ranges)},
               {"fits", fits_},
               {"fields", Json::array()}};
  for (const auto& [name, field] : fields_) {
    const Range range = range_of(field.frames, 0, 1);
    const bool still =
        std::ranges::all_of(field.frames, [&](const auto& f) { return f == field.frames.front(); });
    if (still && range.low == range.high) continue;  // one colour only
    const auto end = still ? field.frames.begin() + 1 : field.frames.end();
    json["fields"].push_back({{"name", name},
                              {"label", label_of(name, field.is_length)},
                              {"unit", unit_of(name)},
                              {"of_triangles", field.of_cells},
                              {"still", still},
                              {"low", range.low},
                              {"high", range.high},
                              {"values", quantised({field.frames.begin(), end}, {range})}});
  }
  return json;
}

}  // namespace plica::app
