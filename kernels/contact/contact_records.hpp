// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/fields.hpp>
#include <plica/core/transfer.hpp>
#include <plica/kernels/contact/contact_law.hpp>
#include <plica/kernels/vectors.hpp>

// Contact data of a level, without its kernels. Code that has contact includes this file and need
// not wait for the kernels to compile.
//
// All contact is in records of one kind: up to four surface points with weights, a normal, a depth,
// a law. W is the sum of the points' values times their weights; its transpose gives the record's
// force to the points.
//
//   a point that touches an obstacle     1
//   a triangle that touches one          w0, w1, w2 of its corners, where it is deepest
//   a point and a triangle               1; -w0, -w1, -w2
//   two edges                            1 - s, s; t - 1, -t
//   a point that is grasped or attached  as the first and the third
//
// The number of a slot says what its record is of. Rows of one slot for each surface point come
// first: one for each obstacle; then, where bodies touch, one of points and triangles, then one of
// edges, which belong to a point where they begin. Behind them is a row of one slot for each
// triangle, for each obstacle. Few slots are in use: those are listed, in their order, and work
// goes over the list.
//
//   slots   | points, obstacle 0 | 1 | ... | points and triangles | edges | triangles, obst. 0
//   list      3 5 8 ...                                           the slots in use, ascending
namespace plica {

/// Numbers of the slots or vertices in use, ascending, and their count. The field itself may be
/// long.
template <class B>
struct DeviceList {
  Indices<B> item;   ///< [most]
  Doubles<B> count;  ///< [1]
  int most = 0;
};

/// Surface points that are attached to another body. Each has a tie to one place on one of that
/// body's triangles, until it tears.
template <class B>
struct Attachments {
  static constexpr int none = -1, beside = -2;
  /// [points] attachment that holds the point. beside - q: point q is held at a triangle of this
  /// point, so that this point touches nothing either. none: not attached. Empty: no attachments at
  /// all
  Indices<B> attachment;
  /// Memory of the obstacles. From number `first` on, [points] 1: torn; empty: nothing tears
  Doubles<B> memory;
  int first = 0;
  Indices<B> triangle;  ///< [points] triangle that holds the point
  Vectors<B> weight;    ///< [points][3] weights of its corners
  int first_law = 0;    ///< first of the attachments' laws, one each

  KOKKOS_INLINE_FUNCTION bool is_torn(int p) const {
    return memory.extent(0) > 0 && memory(first + p) > 0;
  }
  KOKKOS_INLINE_FUNCTION void tear(int p) const { memory(first + p) = 1; }
  KOKKOS_INLINE_FUNCTION bool holds(int p) const {
    return attachment.extent(0) > 0 && attachment(p) >= 0 && !is_torn(p);
  }
  /// Returns true where attachments keep a point from touching anything.
  KOKKOS_INLINE_FUNCTION bool ties(int p) const {
    if (attachment.extent(0) == 0 || attachment(p) == none) return false;
    return !is_torn(attachment(p) <= beside ? beside - attachment(p) : p);
  }
};

/// Surface points that obstacles have grasped. Each has a tie to where it was, relative to the
/// obstacle, when the obstacle closed. There is a place for every obstacle and point, numbered as
/// the slots of contact.
template <class B>
struct Grasps {
  using Real = typename B::Real;
  /// Numbers of each place: a position [m], and 1 where the point is grasped
  static constexpr int numbers = 4;

  int places = 0;     ///< 0: no obstacle can grasp anything, no arrays
  Doubles<B> memory;  ///< memory of the obstacles, with these numbers from `first` on
  int first = 0;
  Indices<B> left_out;  ///< [places] 1: the obstacle never grasps the point; empty: there are none
  int first_law = 0;    ///< first of the laws of grasped points, numbered as the obstacles' laws

  KOKKOS_INLINE_FUNCTION int at(int r) const { return first + numbers * r; }
  KOKKOS_INLINE_FUNCTION bool holds(int r) const { return r < places && memory(at(r) + 3) > 0; }
  KOKKOS_INLINE_FUNCTION bool may_hold(int r) const {
    return left_out.extent(0) == 0 || left_out(r) == 0;
  }
  KOKKOS_INLINE_FUNCTION void hold(int r, const Vec3<Real>& x, const Vec3<double>& moved) const {
    for (int k = 0; k < 3; ++k) memory(at(r) + k) = static_cast<double>(x[k]) - moved[k];
    memory(at(r) + 3) = 1;
  }
  KOKKOS_INLINE_FUNCTION void release(int r) const { memory(at(r) + 3) = 0; }
  /// Returns how far a point at x is from where the obstacle has grasped it [m]. The obstacle has
  /// moved by `moved`.
  KOKKOS_INLINE_FUNCTION Vec3<Real> stretch(int r, const Vec3<Real>& x,
                                            const Vec3<double>& moved) const {
    Vec3<Real> s;
    for (int k = 0; k < 3; ++k)
      s[k] = static_cast<Real>(static_cast<double>(x[k]) - moved[k] - memory(at(r) + k));
    return s;
  }
};

/// Triangles and edges of the surface, for contact between its points.
template <class B>
struct SurfaceMesh {
  int triangles = 0;           ///< 0: contact is of points alone, no arrays
  Indices<B> corner;           ///< [triangles * 3] points, counter-clockwise seen from outside
  Indices<B> first, triangle;  ///< [points + 1] into the triangles around each point
  /// [points + 1] into the edges whose end with the lower number is that point
  Indices<B> first_edge;
  /// [edges * 4] both ends, and the third corners of the triangles left and right of the edge
  Indices<B> edge;
  Indices<B> side;  ///< [triangles * 3] edge from each corner to the next
};

/// Limits of the search for pairs.
template <class Real>
struct PairLimits {
  /// Distance outside beyond which a triangle is not looked for, except by fast points [m]
  Real reach = 0;
  Real margin = 0;  ///< distance that points may gain on reach until the grid is made anew [m]
  /// Distance at rest on one body below which two places are a pair across a gap only [m]
  Real apart = 0;
  bool between = false;  ///< pairs between bodies
  bool self = false;     ///< pairs on one body
};

/// W^T of the records in use. Each vertex that has a part in records has a list of these and of its
/// weights in them, by ascending slots.
template <class B>
struct ContactTranspose {
  DeviceList<B> vertices;  ///< numbers into EmbeddedSurface::vertex
  /// [vertices] number of each vertex in `vertices`; -1: no surface point is in its tetrahedra
  Indices<B> place;
  Indices<B> filled;       ///< [touched] entries while W^T is made
  Indices<B> first, last;  ///< [touched] range of the entries of each vertex in the list
  /// [entries] slots. While W^T is made, with the point and its vertex: 16 i + 4 c + e, i the place
  /// in the list
  Indices<B> record;
  Scalars<B> weight;  ///< [entries]

  /// Calls use(slot, weight) for the entries of the i-th vertex in the list, always in the same
  /// order.
  template <class Use>
  KOKKOS_INLINE_FUNCTION void each(int i, const Use& use) const {
    for (int e = first(i); e < last(i); ++e) use(record(e), weight(e));
  }
};

/// Contact's part in an explicit step. By default nothing happens in the step, and contact is that
/// of a state that stays.
struct ContactStep {
  double span = 0;  ///< h [s]
  /// Time ahead of the state at which the depth is taken, with the velocity there [s]
  double ahead = 0;
  /// Factor of mass damping c [s]: e = (a - c v) / (1 + damped c), and A is divided by 1 + damped c
  double damped = 0;
  /// True where these forces are the step's, so that the carried stretches follow its way; else
  /// they are those of a stage
  bool ends = true;
};

/// Watch for surface points that are further inside an obstacle than makes sense, or not finite.
template <class B>
struct DepthWatch {
  Indices<B> lost;           ///< [1] the last of these points + 1
  typename B::Real deepest;  ///< depth that still makes sense [m]
  KOKKOS_INLINE_FUNCTION void look(int p, typename B::Real distance) const {
    if (!(distance >= -deepest)) Kokkos::atomic_max(&lost(0), p + 1);
  }
};

/// Contacts of one level, on the device.
template <class B>
struct ContactRecords {
  using Real = typename B::Real;
  using Laws = Kokkos::View<ContactLaw<Real>*, typename B::Memory>;
  using Stencil = Kokkos::View<int* [4], Kokkos::LayoutRight, typename B::Memory>;
  using Weights = Kokkos::View<Real* [4], Kokkos::LayoutRight, typename B::Memory>;
  int points = 0, obstacles = 0, bodies = 1,
      faces = 0;  ///< faces: triangles, where an obstacle touches between points; else 0
  bool pairs = false;
  /// Distance from an obstacle beyond which a point is not looked at, unless it is fast [m]
  Real reach = 0;
  Real span = 0;            ///< duration of the step [s]
  bool long_steps = false;  ///< points look along the nearest normal, whatever their path meets
  bool precise = false;     ///< deepest places of triangles are found to rounding, not to 1/1000
  Real edge = 0;            ///< mean edge of the surface [m]
  /// @{ shared by all levels
  /// Laws of obstacles and bodies, of grasped points, of pairs of bodies, of attachments
  Laws law;
  SurfaceMesh<B> mesh;
  Grasps<B> grasps;
  Attachments<B> attached;
  /// @}
  Indices<B> body;      ///< [points] body of each point; empty: there is one
  Indices<B> counted;   ///< [points] see EmbeddedSurface
  DeviceList<B> list;   ///< slots in use
  Doubles<B> touching;  ///< [1] number of records that have a force, or may have one in this step
  Indices<B> near;      ///< [slots] 1: in use
  Indices<B> close;     ///< [1] 1: a point is so near an obstacle that triangles may touch it
  Vectors<B> places;    ///< [points][3] positions of the surface at the step's start [m]
  Doubles<B> fastest;   ///< [1] largest velocity of a point, squared [m^2/s^2]
  Stencil point;        ///< [slots] surface points of the record; -1: none
  Weights weight;       ///< [slots]
  Indices<B> law_of;    ///< [slots]
  Vectors<B> normal;    ///< [slots][3] out of the partner; 0 for a tie
  Scalars<B> depth;     ///< [slots] > 0 inside [m]
  /// [slots][3] way of the obstacle in the step [m]. In an implicit step, where D begins: D = W u -
  /// way
  Vectors<B> way;
  Vectors<B> stretch;  ///< [slots][3] s [m], carried
  Vectors<B> force;    ///< [slots][3] F, on the sites that have weight 1 [N], carried
  /// [slots][3] D without contact's own part; on implicit levels the obstacle's way [m]
  Vectors<B> drift;
  Scalars<B> response;  ///< [slots] rho [1/kg]; 0: no force in this step; explicit levels
  Scalars<B> cap;       ///< [slots] tau [N]; implicit levels
  Blocks<B> block;      ///< [slots][6] dF/dD [kg], weighted; implicit levels
  /// [slots][6] G [1/m], of obstacles that are not convex; implicit levels; see concavity()
  Blocks<B> concavity;
  Indices<B> partner;  ///< [points] triangle that each point was near last; -1: none
  ContactTranspose<B> transpose;

  KOKKOS_INLINE_FUNCTION int rows() const { return obstacles + (pairs ? 2 : 0); }
  KOKKOS_INLINE_FUNCTION int slots() const { return rows() * points + obstacles * faces; }
  KOKKOS_INLINE_FUNCTION int of_point(int row, int p) const { return row * points + p; }
  KOKKOS_INLINE_FUNCTION int of_face(int obstacle, int t) const {
    return rows() * points + obstacle * faces + t;
  }
  KOKKOS_INLINE_FUNCTION bool is_on_face(int r) const { return r >= rows() * points; }
  /// Returns the obstacle of a record; `obstacles` and above: a pair.
  KOKKOS_INLINE_FUNCTION int row(int r) const {
    return is_on_face(r) ? (r - rows() * points) / faces : r / points;
  }
  KOKKOS_INLINE_FUNCTION bool is_pair(int r) const { return row(r) >= obstacles; }
  /// Returns true where a record couples the vertices of one tetrahedron alone.
  KOKKOS_INLINE_FUNCTION bool is_of_one(int r) const { return r < obstacles * points; }
  KOKKOS_INLINE_FUNCTION int body_of(int p) const { return bodies > 1 ? body(p) : 0; }
  KOKKOS_INLINE_FUNCTION int obstacle_law(int obstacle, int p) const {
    return obstacle * bodies + body_of(p);
  }
  KOKKOS_INLINE_FUNCTION int pair_law(int p, int q) const {
    return 2 * obstacles * bodies + body_of(p) * bodies + body_of(q);
  }
  KOKKOS_INLINE_FUNCTION int held_law(int obstacle, int p) const {
    return grasps.first_law + obstacle_law(obstacle, p);
  }
  KOKKOS_INLINE_FUNCTION const ContactLaw<Real>& law_at(int r) const { return law(law_of(r)); }
  /// Returns the distance of a point that is near nothing [m].
  static KOKKOS_INLINE_FUNCTION Real nowhere() { return Real(1e30); }

  /// Returns W of a field; `absolute_weights`: by absolute weights.
  KOKKOS_INLINE_FUNCTION Vec3<Real> value(const EmbeddedSurface<B>& surface, const Vectors<B>& x,
                                          int r, bool absolute_weights = false) const {
    Vec3<Real> sum;
    for (int c = 0; c < 4; ++c) {
      const int p = point(r, c);
      if (p < 0) continue;
      const Real w = weight(r, c);
      sum += absolute_weights ? Kokkos::abs(w) * sum_of_parts_at<B>(surface.embedding, x, p)
                              : w * value_at<B>(surface.embedding, x, p);
    }
    return sum;
  }
  /// Returns the position at which the record's force acts on the sites of positive weight [m].
  KOKKOS_INLINE_FUNCTION Vec3<Real> place(const EmbeddedSurface<B>& surface, const Vectors<B>& u,
                                          int r) const {
    Vec3<Real> x;
    for (int c = 0; c < 4; ++c)
      if (point(r, c) >= 0 && weight(r, c) > 0)
        x += weight(r, c) * value_at<B>(surface.embedding, u, point(r, c),
                                        vector_at<B>(surface.rest, point(r, c)));
    return x;
  }
  KOKKOS_INLINE_FUNCTION void set_stencil(int r, int a, int b, int c, int d, Real wa, Real wb,
                                          Real wc, Real wd) const {
    point(r, 0) = a, point(r, 1) = b, point(r, 2) = c, point(r, 3) = d;
    weight(r, 0) = wa, weight(r, 1) = wb, weight(r, 2) = wc, weight(r, 3) = wd;
  }
  /// Sets the normal of a slot that comes into use or goes on in it. The carried stretch is turned
  /// into the plane across the normal.
  KOKKOS_INLINE_FUNCTION void use(int r, int its_law, const Vec3<Real>& N, Real its_depth,
                                  const Vec3<Real>& its_way, const Vec3<Real>& spin) const {
    if (near(r) == 0 || law_at(r).is_tie()) {
      set_vector<B>(stretch, r, {}), set_vector<B>(force, r, {});
    } else {
      const Vec3<Real> s = vector_at<B>(stretch, r);
      if (const Real square = dot(s, s); square > 0) {
        const Vec3<Real> turned = across(s + cross(spin, s), N);
        const Real left = dot(turned, turned);
        set_vector<B>(stretch, r, left > 0 ? Kokkos::sqrt(square / left) * turned : turned);
      }
    }
    near(r) = 1, law_of(r) = its_law, depth(r) = its_depth;
    set_vector<B>(normal, r, N), set_vector<B>(way, r, its_way);
  }
  /// Sets a slot to a tie, whose stretch is given.
  KOKKOS_INLINE_FUNCTION void tie(int r, int its_law, const Vec3<Real>& its_stretch,
                                  const Vec3<Real>& its_way) const {
    if (near(r) == 0) set_vector<B>(force, r, {});
    near(r) = 1, law_of(r) = its_law, depth(r) = -nowhere();
    set_vector<B>(normal, r, {}), set_vector<B>(way, r, its_way),
        set_vector<B>(stretch, r, its_stretch);
  }
  KOKKOS_INLINE_FUNCTION void leave(int r) const { near(r) = 0; }
  /// Returns true for a tie whose last force was its strength.
  KOKKOS_INLINE_FUNCTION bool is_torn(int r) const {
    constexpr Real rounding = Real(1e-3);
    if (near(r) == 0 || !law_at(r).is_tie()) return false;
    const Vec3<Real> F = vector_at<B>(force, r);
    const Real least = (1 - rounding) * law_at(r).strength;
    return dot(F, F) >= least * least;
  }
  /// Returns true where steps are implicit: then depths are of the end of the last step.
  KOKKOS_INLINE_FUNCTION bool is_implicit() const { return block.extent(0) > 0; }
  /// Returns true where a record is in the linear system.
  KOKKOS_INLINE_FUNCTION bool is_stiff(int r) const {
    return block(r, 0) + block(r, 1) + block(r, 2) > 0;
  }
};

/// Weights that count by their absolute values: none; those of obstacles alone; all. Those of
/// obstacles alone are for an A that is no multiple of 1: the two sides of a pair respond alike to
/// a force of one direction.
enum class AbsoluteWeights { none, obstacles, all };

/// Returns the force [N] that the records put on the i-th vertex in the list.
template <class B>
KOKKOS_INLINE_FUNCTION Vec3<typename B::Real> contact_force(
    const ContactRecords<B>& records, int i,
    AbsoluteWeights absolute_weights = AbsoluteWeights::none) {
  Vec3<typename B::Real> sum;
  records.transpose.each(i, [&](int r, typename B::Real w) {
    const bool absolute = absolute_weights == AbsoluteWeights::all ||
                          (absolute_weights == AbsoluteWeights::obstacles && !records.is_pair(r));
    sum += (absolute ? Kokkos::abs(w) : w) * vector_at<B>(records.force, r);
  });
  return sum;
}

}  // namespace plica
