// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <plica/meshes/cut.hpp>
#include <plica/meshes/embedding.hpp>
#include <vector>

namespace plica {

/// Front of a cut: the place of a blade's edge in a body, which carries it. What a blade sweeps in
/// one step thus begins where it ended in the step before, also where the body has moved in
/// between: nothing is left between the two, and nothing is cut twice.
///
/// The edge is divided by places at equal distances. Each is in a tetrahedron at fixed weights, or
/// outside the body, where it goes with the next place that is inside.
class BladeFront {
 public:
  /// Both ends of the blade's edge [m].
  using Edge = std::array<Point, 2>;

  BladeFront() = default;  ///< makes a front without places, into which an archive is read
  /// Begins at the blade itself, with places that are at most `spacing` apart [m].
  BladeFront(const Edge& edge, double spacing);

  /// Moves the front to where the blade goes, and returns what is swept on the way. Where the body
  /// has carried the front further than the blade goes, it stays. A blade that turns back begins
  /// where it is.
  /// @param tets       tetrahedra of the body
  /// @param positions  where its vertices are [m]
  /// @param from, to   edge of the blade at both ends of a straight way
  Blade advance(const std::vector<std::array<int, 4>>& tets, const std::vector<Point>& positions,
                const Edge& from, const Edge& to);

  /// Names what the front carries to an archive.
  template <class Archive>
  void name_fields(Archive& archive) {
    places_.resize(archive.count(places_.size()));
    archive.number(last_way_.data(), sizeof(Point));
    for (Place& place : places_)
      archive.number(place.tet), archive.number(&place.weights, sizeof(Weights));
  }
  /// Returns whether all places are in some of so many tetrahedra, or outside.
  bool fits(std::size_t tets) const;

 private:
  struct Place {
    int tet = -1;  // -1: outside
    Weights weights = {};
  };
  std::vector<Place> places_;
  Point last_way_ = Point::Zero();

  Point on(const Edge& edge, std::size_t i) const {
    const double s = static_cast<double>(i) / static_cast<double>(places_.size() - 1);
    return (1 - s) * edge[0] + s * edge[1];
  }
  std::vector<Point> shifts(const std::vector<std::array<int, 4>>& tets,
                            const std::vector<Point>& positions, const Edge& blade) const;
  void locate(const std::vector<std::array<int, 4>>& tets, const std::vector<Point>& positions,
              const std::vector<Point>& ends, const std::vector<char>& moved);
};

}  // namespace plica
