// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <vector>

// Part that one rank has of a level whose vertices several ranks share. Ranks own ranges of
// vertices, whole blocks of them, and ranges of the runs of tetrahedra along the mesh's curve.
// Local numbers ascend as those of the whole mesh do:
//
//   vertices  | copies, ghosts | owned | copies, ghosts |
//   partial   | rows of own patches | rows of rank 0 | rows of rank 3 |
//
// A copy is a vertex of an own patch that another rank owns: it is updated here too, by the same
// additions as there. The values of a ghost are received before they are read.
namespace plica {

/// Vertices and tetrahedra of one rank, by their numbers in the whole mesh.
struct RankPart {
  std::vector<int> vertex;  ///< [local vertices] ascending
  std::vector<int> owner;   ///< [local vertices] rank that owns the vertex
  /// [ranks + 1] vertices that ranks own: rank r has those from first[r] to before first[r + 1]
  std::vector<int> first;
  int first_owned = 0;   ///< first local vertex that the rank owns
  int last_owned = 0;    ///< local vertex behind the last one that it owns
  std::vector<int> tet;  ///< [local tetrahedra] ascending

  /// Returns the number of vertices that the rank owns.
  int owned() const { return last_owned - first_owned; }
  /// Returns whether the rank owns a local vertex.
  bool owns(int v) const { return v >= first_owned && v < last_owned; }
  /// Returns the values of own vertices, of those of all local ones.
  template <class T>
  std::vector<T> of_owned(const std::vector<T>& local) const {
    return {local.begin() + first_owned, local.begin() + last_owned};
  }
  /// Returns the values of local vertices, of those of the whole mesh.
  template <class T>
  std::vector<T> local(const std::vector<T>& whole) const {
    std::vector<T> values;
    values.reserve(vertex.size());
    for (const int v : vertex) values.push_back(whole[static_cast<std::size_t>(v)]);
    return values;
  }
};

/// Rows of an array that ranks receive from their owners.
struct HaloRows {
  std::vector<int> rank;               ///< neighbours, ascending
  std::vector<int> first_sent{0};      ///< [neighbours + 1] into `sent`
  std::vector<int> sent;               ///< local rows that each neighbour receives
  std::vector<int> first_received{0};  ///< [neighbours + 1] begin of the rows from each neighbour
  int before = 0;                      ///< number of received rows in front of the rank's own
  int own = 0;                         ///< number of the rank's own rows, which lie in between

  int received() const { return first_received.back(); }  ///< number of received rows
};

}  // namespace plica
