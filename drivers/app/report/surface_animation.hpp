// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <plica/drivers/app/report/read_files.hpp>
#include <string>
#include <vector>

namespace plica::app {

/// Animated surface of a body, as the page shows it. For tetrahedra it is their boundary. Numbers
/// are stored in 16 bits, as parts of their range over all times. So the resolution of a
/// displacement is 1/65535 of the largest motion along an axis.
class SurfaceAnimation {
 public:
  /// Starts the animation with the mesh of its first frame.
  /// @param level  level of the tetrahedra; -1: the surface that every run writes
  SurfaceAnimation(int level, const FrameFile& first);
  /// Throws InputError if a frame does not have the mesh and the arrays of the first one.
  void check(const FrameFile& frame) const;
  /// Adds a frame, which must have passed check().
  void add(const FrameFile& frame);
  /// Returns true if both have the same triangles and the same shape at rest.
  bool same_surface(const SurfaceAnimation& other) const;
  /// Returns the animation as a member of the page's data.
  nlohmann::ordered_json json() const;

 private:
  struct Field {
    bool of_cells = false, is_length = false;  // is_length: values are lengths of vectors
    std::vector<std::vector<float>> frames;
  };
  void take_boundary(const FrameFile& first);
  std::vector<float> values_of(const FrameArray& array) const;
  bool held() const;

  int level_;
  std::size_t points_ = 0, cells_ = 0;         // numbers of points and cells in the frames
  std::vector<int> vertices_, owners_;         // vertices of the surface; cell of each triangle
  std::vector<std::array<int, 3>> triangles_;  // [triangles][3] indices into vertices_
  std::vector<Point> rest_;                    // [vertices] positions at rest [m]
  std::vector<std::vector<float>> motion_;     // [frames][vertices][3] displacement [m]
  // [frames] nearest rigid motion: three rows of rotation and translation
  std::vector<std::array<double, 12>> fits_;
  std::map<std::string, Field> fields_;
};

}  // namespace plica::app
