// SPDX-License-Identifier: BSD-3-Clause
#include <nlohmann/json.hpp>
#include <plica/drivers/app/output/obstacles_json.hpp>
#include <plica/kernels/contact/shapes.hpp>

namespace plica::app {

using Json = nlohmann::ordered_json;

namespace {

Json point(const Point& p) { return {p.x(), p.y(), p.z()}; }
Json json_of(const Point& p) { return point(p); }
template <class T>
Json json_of(const T& value) {
  return value;
}

// Walks the table of a shape and writes its values
struct ValueWriter {
  Json values = Json::object();
  template <class T, class Kind>
  void operator()(const char* key, const T& member, const Kind&, const char*) {
    values[key] = json_of(member);
  }
  template <class T, class Kind>
  void required(const char* key, const T& member, const Kind&, const char*) {
    values[key] = json_of(member);
  }
};

template <class Options>
Json shape_json(Options o) {
  ValueWriter writer;
  describe(writer, o);
  return writer.values;
}
Json shape_json(const SurfaceOptions& o) {
  const Box box = bounding_box(o.surface.vertices);
  return {{"triangles", o.surface.triangles.size()}, {"min", point(box.min)}, {"max", point(box.max)}};
}

struct AddMotion {
  Json& entry;
  void operator()(const SteadyMotion& o) const { entry["velocity"] = point(o.velocity); }
  void operator()(const SineMotion& o) const {
    entry["sine"] = {{"amplitude", point(o.amplitude)}, {"frequency", o.frequency}, {"phase", o.phase}};
  }
  void operator()(const PathMotion& o) const {
    entry["path"] = Json::array();
    for (const auto& knot : o.knots)
      entry["path"].push_back({{"time", knot.time}, {"displacement", point(knot.displacement)}});
  }
};

}  // namespace

Json obstacles_json(const std::vector<ObstacleOptions>& obstacles) {
  Json list = Json::array();
  for (const ObstacleOptions& obstacle : obstacles) {
    Json entry;
    visit_shape(obstacle.shape, [&](auto shape, const auto& o) { entry[decltype(shape)::name] = shape_json(o); });
    entry["friction"] = obstacle.friction.value_or(0);
    std::visit(AddMotion{entry}, obstacle.motion);
    list.push_back(entry);
  }
  return list;
}

}  // namespace plica::app
