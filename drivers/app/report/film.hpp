// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <plica/drivers/app/report/read_files.hpp>
#include <string>
#include <vector>

namespace plica::app {

/// The surface of a body in time, as the page shows it: of tetrahedra their boundary. Numbers are
/// kept in 16 bits, as parts of the range that they have over all times: steps of a displacement
/// are 1/65535 of the largest motion along an axis.
class Film {
 public:
  /// `level`: of the tetrahedra; -1: the film is of the surface that a run always writes.
  Film(int level, const FrameFile& first);
  /// InputError where a frame is not of the same mesh as the first one.
  void check(const FrameFile& frame) const;
  /// A checked one.
  void add(const FrameFile& frame);
  /// Whether it has the triangles and the shape at rest of the other one.
  bool same_surface(const Film& other) const;
  /// The member of the page's data that is this film.
  nlohmann::ordered_json json() const;

 private:
  struct Field {
    bool of_cells = false, is_length = false;  // is_length: of a vector
    std::vector<std::vector<float>> frames;
  };
  void take_boundary(const FrameFile& first);
  std::vector<float> values_of(const FrameArray& array) const;
  bool held() const;

  int level_;
  std::size_t points_ = 0, cells_ = 0;         // of the frames
  std::vector<int> vertices_, owners_;         // that are kept; per triangle its cell
  std::vector<std::array<int, 3>> triangles_;  // of kept vertices
  std::vector<Point> rest_;                    // [m]
  std::vector<std::vector<float>> motion_;     // per frame and vertex [m]
  std::vector<std::array<double, 12>>
      fits_;  // per frame the rigid motion nearest to it: rows of rotation and translation
  std::map<std::string, Field> fields_;
};

/// The bytes in base64 (RFC 4648).
std::string base64(const void* data, std::size_t size);

}  // namespace plica::app
