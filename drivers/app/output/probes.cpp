// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <plica/drivers/app/output/probes.hpp>

namespace plica::app {

std::vector<std::string> names_of(const std::map<std::string, Point>& probes) {
  std::vector<std::string> names;
  for (const auto& [name, point] : probes) names.push_back(name);
  return names;
}

std::vector<Point> points_of(const std::map<std::string, Point>& probes) {
  std::vector<Point> points;
  for (const auto& [name, point] : probes) points.push_back(point);
  return points;
}

std::string probe_head(const std::vector<std::string>& names) {
  std::string head = "time";
  for (const std::string& name : names)
    for (const char* column : {"x", "y", "z", "vx", "vy", "vz"}) head += "," + name + "_" + column;
  return head + "\n";
}

std::string probe_row(double time, const std::vector<Point>& positions, const std::vector<Point>& velocities) {
  std::string row = fmt::format("{:.9g}", time);
  for (std::size_t i = 0; i < positions.size(); ++i)
    for (const Point* p : {&positions[i], &velocities[i]})
      row += fmt::format(",{:.9g},{:.9g},{:.9g}", p->x(), p->y(), p->z());
  return row + "\n";
}

}  // namespace plica::app
