// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/drivers/app/report/frames_of_cuts.hpp>

namespace plica::app {

namespace {

/// Returns the places of a frame's points at rest [m].
std::vector<Point> places_at_rest(const FrameFile& frame) {
  std::vector<Point> rest = frame.points;
  if (const FrameArray* moved = frame.find("displacement");
      moved != nullptr && moved->components == 3)
    for (std::size_t i = 0; i < rest.size(); ++i) rest[i] -= Point(&moved->values[3 * i]);
  return rest;
}

}  // namespace

void take_mesh_of_last(FrameFile& frame, const FrameFile& last) {
  const std::size_t own = frame.points.size(), cells = frame.triangles.size() + frame.tets.size();
  if (own == 0 || own >= last.points.size()) return;
  const std::vector<Point> rest = places_at_rest(frame), to = places_at_rest(last);
  for (std::size_t v = own; v < to.size(); ++v) {
    const auto nearer = [&](const Point& a, const Point& b) {
      return (a - to[v]).squaredNorm() < (b - to[v]).squaredNorm();
    };
    const auto from =
        static_cast<std::size_t>(std::min_element(rest.begin(), rest.end(), nearer) - rest.begin());
    frame.points.push_back(to[v] + frame.points[from] - rest[from]);
    for (FrameArray& array : frame.arrays)
      for (int k = 0; k < array.components && !array.of_cells; ++k)
        array.values.push_back(array.values[static_cast<std::size_t>(array.components) * from +
                                            static_cast<std::size_t>(k)]);
  }
  frame.triangles = last.triangles, frame.tets = last.tets;
  const std::size_t now = frame.triangles.size() + frame.tets.size();
  for (FrameArray& array : frame.arrays)
    if (array.of_cells && now > cells)
      array.values.resize(static_cast<std::size_t>(array.components) * now, 0.0);
}

}  // namespace plica::app
