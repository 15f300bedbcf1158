// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <plica/core/problem.hpp>
#include <plica/core/text.hpp>
#include <string>
#include <vector>

namespace plica::app {

/// Detects contact within an edge of the border of a part, where the coarser mesh that the border
/// follows makes the body too stiff.
class BorderContact {
 public:
  /// @param mesh     mesh of level 0
  /// @param surface  embedded surface
  BorderContact(const TetMesh& mesh, const TriangleSurface& surface) {
    const Followers& border = mesh.followers;
    for (std::size_t p = 0; p < surface.vertices.size(); ++p)
      for (std::size_t i = 0; i < border.vertex.size(); ++i) {
        const Point& at = mesh.vertices[static_cast<std::size_t>(border.vertex[i])];
        if ((surface.vertices[p] - at).norm() > edge_of(mesh, border.of[i])) continue;
        near_.push_back(p);
        break;
      }
  }

  /// Returns true if points of the surface are near a border.
  bool looks() const { return !near_.empty(); }
  /// Takes in the pressures of contact at the surface's points, at this time [s].
  void look(double time, const std::vector<double>& pressure) {
    const auto pressed = [&](std::size_t p) { return p < pressure.size() && pressure[p] > 0; };
    if (first_ < 0 && std::ranges::any_of(near_, pressed)) first_ = time;
  }
  /// Returns the time of the first contact there [s]; below 0: there was none.
  double first() const { return first_; }
  /// Restores what first() has returned.
  void restore(double first) { first_ = first; }

  /// Returns a warning if something touched near a border; empty: nothing did.
  std::string warning() const {
    if (first_ < 0) return {};
    return text(
        "contact: at ", number(first_, 4),
        " s something touches the body within a coarse edge of the border of a part, where "
        "it is up to 15 % too stiff; expected a part that reaches further round the contact "
        "(body.levels)");
  }

 private:
  std::vector<std::size_t> near_;  // points of the surface
  double first_ = -1;

  // Returns the mean distance of the masters of a border's vertex [m]
  static double edge_of(const TetMesh& mesh, const std::array<int, 4>& masters) {
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t k = i + 1; k < 4; ++k)
        sum += (mesh.vertices[static_cast<std::size_t>(masters[i])] -
                mesh.vertices[static_cast<std::size_t>(masters[k])])
                   .norm();
    return sum / 6;
  }
};

}  // namespace plica::app
