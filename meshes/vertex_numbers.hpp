// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <plica/meshes/raw_mesh.hpp>
#include <string>
#include <unordered_map>

namespace plica {

/// From the numbers of vertices in a file to their positions in raw.vertices.
class VertexNumbers {
 public:
  /// InputError for a vertex that is defined twice or not finite.
  explicit VertexNumbers(const RawMesh& raw);

  /// InputError "WHO names node TAG, ..." for a number that the file does not define.
  int at(std::int64_t tag, const Place& place, const std::function<std::string()>& who) const;

 private:
  const RawMesh& raw_;
  std::unordered_map<std::int64_t, int> index_;
};

}  // namespace plica
