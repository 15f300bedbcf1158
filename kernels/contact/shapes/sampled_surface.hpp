// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/error.hpp>
#include <plica/core/keys.hpp>
#include <plica/kernels/contact/gap.hpp>

namespace plica {

/// Options of the inside of a closed surface, by its signed distance on a regular grid; or of a
/// sheet, which has two sides.
struct SurfaceOptions {
  /// Closed surface, every triangle counter-clockwise seen from outside; or any, with a thickness
  TriangleSurface surface;
  /// Cells of the grid along the surface's longest extent; 0: chosen from its shape
  int cells = 0;
  /// Thickness of a sheet [m], all that is no further from the surface than half of it; 0: the
  /// inside
  double thickness = 0;
};

/// Describes the parameters of a surface: name, kind, unit, range and meaning.
template <class V>
void describe(V& v, SurfaceOptions& o) {
  using namespace keys;
  v("cells", o.cells, Count{0, 512},
    "of its distance grid, along the longest extent; 0: 64, and more where it is thin");
  v("thickness", o.thickness, Quantity{length, not_negative},
    "of a sheet, which need not be closed: half of it on each side; 0: the inside of a closed "
    "surface, and for an open one a fiftieth of its length");
}

/// Inside of a closed surface: signed distances at the nodes of a regular grid, trilinear in
/// between. The normal is the gradient's direction. Outside the grid the distance is a lower bound:
/// the distance to the grid and its margin.
struct SampledSurface {
  /// Name of the shape in scenes
  static constexpr const char* name = "surface";
  /// One line about the shape, for lists
  static constexpr const char* summary =
      "the inside of a closed triangulated surface, or a sheet of one";
  /// Returns the origin of the surface's coordinates, about which torques on the obstacle are at
  /// t = 0 [m].
  static Point origin(const SurfaceOptions&) { return Point::Zero(); }
  using Options = SurfaceOptions;  ///< parameters of the shape

  /// Signed distance to the surface on its grid, as kernels evaluate it.
  template <class Real>
  struct Shape {
    static constexpr bool convex = false;  ///< true where the solid is convex
    const Real* value;  ///< [nodes of z][of y][of x] m, in memory that the calling code can read
    int nodes[3];       ///< along x, y, z; each at least 2
    Vec3<Real> origin;  ///< lowest node
    Real cell;          ///< [m]
    Real margin;        ///< no node on the grid's outside is nearer to the surface [m]

    /// Returns distance and normal at a position in the axes of the shape [m].
    KOKKOS_INLINE_FUNCTION Gap<Real> operator()(const Vec3<Real>& x) const {
      const Vec3<Real> d = x - origin;
      Vec3<Real> beyond, weight;
      Real squared = 0;
      int low[3];
      for (int k = 0; k < 3; ++k) {
        const Real extent = static_cast<Real>(nodes[k] - 1) * cell;
        beyond[k] = d[k] < 0 ? d[k] : d[k] > extent ? d[k] - extent : Real(0);
        squared += beyond[k] * beyond[k];
        const Real at = (d[k] - beyond[k]) / cell;
        low[k] = at < static_cast<Real>(nodes[k] - 2) ? static_cast<int>(at) : nodes[k] - 2;
        weight[k] = at - static_cast<Real>(low[k]);
      }
      if (squared > 0) {
        const Real r = sqrt(squared);
        return {r + margin, (Real(1) / r) * beyond};
      }
      return interpolate(low, weight);
    }

   private:
    KOKKOS_INLINE_FUNCTION Gap<Real> interpolate(const int* low, const Vec3<Real>& weight) const {
      Gap<Real> gap{Real(0), {}};
      for (int corner = 0; corner < 8; ++corner) {
        Real w[3], slope[3];
        int node[3];
        for (int k = 0; k < 3; ++k) {
          const bool high = (corner >> k & 1) != 0;
          node[k] = low[k] + (high ? 1 : 0);
          w[k] = high ? weight[k] : 1 - weight[k];
          slope[k] = high ? Real(1) : Real(-1);
        }
        const Real v = value[(node[2] * nodes[1] + node[1]) * nodes[0] + node[0]];
        gap.distance += w[0] * w[1] * w[2] * v;
        gap.normal += Vec3<Real>{slope[0] * w[1] * w[2] * v, w[0] * slope[1] * w[2] * v,
                                 w[0] * w[1] * slope[2] * v};
      }
      const Real length = sqrt(dot(gap.normal, gap.normal));
      // in the middle between two sides the gradient may vanish: any direction leads out
      gap.normal =
          length > 0 ? (Real(1) / length) * gap.normal : Vec3<Real>{Real(0), Real(0), Real(1)};
      return gap;
    }
  };

  /// Throws InputError for 1 to 3 cells, which are too few.
  static void check(const std::string& path, const Options& o) {
    if (o.cells > 0 && o.cells < 4)
      throw InputError(path + ".cells is " + std::to_string(o.cells) +
                       "; expected at least 4, or 0 to have them chosen");
  }
};

}  // namespace plica
