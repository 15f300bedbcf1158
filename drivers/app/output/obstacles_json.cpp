// SPDX-License-Identifier: BSD-3-Clause
#include <nlohmann/json.hpp>
#include <plica/drivers/app/output/obstacles_json.hpp>

namespace plica::app {

using Json = nlohmann::ordered_json;

namespace {

Json point(const Point& p) { return {p.x(), p.y(), p.z()}; }

struct ShapeJson {
  Json operator()(const PlaneOptions& o) const {
    return {{"plane", {{"point", point(o.point)}, {"normal", point(o.normal)}}}};
  }
  Json operator()(const SphereOptions& o) const {
    return {{"sphere", {{"centre", point(o.centre)}, {"radius", o.radius}}}};
  }
  Json operator()(const BowlOptions& o) const {
    return {{"bowl", {{"centre", point(o.centre)}, {"radius", o.radius}, {"rim", o.rim > 0 ? o.rim : o.radius}}}};
  }
  Json operator()(const CapsuleOptions& o) const {
    return {{"capsule", {{"from", point(o.from)}, {"to", point(o.to)}, {"radius", o.radius}}}};
  }
  Json operator()(const BlockOptions& o) const {
    return {{"box", {{"centre", point(o.centre)}, {"size", point(o.size)}, {"rotation", point(o.rotation)}}}};
  }
  Json operator()(const CylinderOptions& o) const {
    return {{"cylinder", {{"from", point(o.from)}, {"to", point(o.to)}, {"radius", o.radius}}}};
  }
  Json operator()(const SurfaceOptions& o) const {
    const Box box = bounding_box(o.surface.vertices);
    return {{"surface", {{"triangles", o.surface.triangles.size()}, {"min", point(box.min)}, {"max", point(box.max)}}}};
  }
};

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
    Json entry = std::visit(ShapeJson{}, obstacle.shape);
    entry["friction"] = obstacle.friction.value_or(0);
    std::visit(AddMotion{entry}, obstacle.motion);
    list.push_back(entry);
  }
  return list;
}

}  // namespace plica::app
