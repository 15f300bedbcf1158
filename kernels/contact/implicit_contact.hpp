// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/matrices.hpp>
#include <plica/kernels/contact/contact_kernels.hpp>
#include <plica/kernels/reduce.hpp>

// Contact in an implicit stage. Records are found once, at the start of the step. D = W u - way is
// a record's way since then. Where the stage is within the step, D is scaled up to the end of the
// step (the obstacle's part of it is that of the whole step). The law (contact_law.hpp) then gives,
// for the cap tau of the last iterate, the potential phi + psi, its force F and its second
// derivative
//
//   C = kn N N^T + lam G + kt' (1 - N N^T), in slip (tau/|x|) (1 - N N^T - t t^T), t = x/|x|
//
// which is positive. The system contains W^T C W:
//
//     vertices  --W-->  records  --C-->  records  --W^T-->  vertices
//
// In a hollow of curvature G (see concavity()) the depth is d0 - N.D + D.G D/2, and N turns with
// it. Points that touch obstacles couple the vertices of one tetrahedron, which is what an
// assembled matrix has room for; all other records are in products alone.
namespace plica {

/// Adds scale * block to sum.
template <class Real>
KOKKOS_INLINE_FUNCTION void add_scaled(SymMat3<Real>& sum, Real scale, const SymMat3<Real>& block) {
  for (int k = 0; k < 6; ++k) sum[k] += scale * block[k];
}

/// Sets `way` to where D begins, moves the obstacle's way to `drift`, and sets the caps by the last
/// forces.
template <class B>
struct BeginContact {
  using Real = typename B::Real;
  EmbeddedSurface<B> surface;
  Vectors<B> u;
  ContactRecords<B> records;
  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    const int r = records.list.item(i);
    const ContactLaw<Real> law = records.law_at(r);
    const Vec3<Real> N = vector_at<B>(records.normal, r), F = vector_at<B>(records.force, r);
    records.cap(r) = law.is_tie() ? law.strength : law.friction * Kokkos::max(Real(0), dot(F, N));
    set_vector<B>(records.drift, r, vector_at<B>(records.way, r));
    set_vector<B>(records.way, r, records.value(surface, u, r) + vector_at<B>(records.way, r));
  }
};

/// Law of each record at a state.
template <class B>
struct ImplicitContact {
  using Real = typename B::Real;
  EmbeddedSurface<B> surface;
  State<B> state;
  ContactRecords<B> records;
  Real h;      ///< duration of the step [s]
  Real scale;  ///< factor of ways, up to the end of the step
  Real ahead;  ///< time ahead of the state, with its velocities [s]

  struct Answer {
    Vec3<Real> force, shear;  ///< F, x
    Vec3<Real> way;           ///< D
    Vec3<Real> normal;        ///< N, as it has turned in a hollow
    Real lam = 0, end = 0;    ///< end: the depth at the end of the step [m]
    Real length = 0;          ///< |x|
    bool slips = false;
  };
  KOKKOS_INLINE_FUNCTION Answer at(int r, const LawOfStep<Real>& law, bool tie) const {
    Answer a;
    Vec3<Real> D = records.value(surface, state.u, r) - vector_at<B>(records.way, r);
    if (ahead > 0) D += ahead * records.value(surface, state.v, r);
    if (scale > 1) D = scale * D + (scale - 1) * vector_at<B>(records.drift, r);
    const Vec3<Real> N = vector_at<B>(records.normal, r);
    a.normal = N, a.way = D;
    if (!tie) {
      a.end = records.depth(r) - dot(N, D);
      if (records.concavity.extent(0) > 0) {
        const Vec3<Real> turn = block_at<B>(records.concavity, r) * D;
        a.end += Real(0.5) * dot(D, turn), a.normal -= turn;
      }
      a.lam = law.normal_force(records.depth(r), a.end);
    }
    a.shear = across(D, N) + law.memory * vector_at<B>(records.stretch, r);
    a.length = Kokkos::sqrt(dot(a.shear, a.shear));
    a.slips = law.kt * a.length > records.cap(r);
    const Real over = a.slips ? records.cap(r) / a.length : law.kt;
    a.force = a.lam * a.normal - over * a.shear;
    return a;
  }
};

/// Computes the force [N] of each record and its block `weight` C [kg]. It sums up the potential
/// [J] and the sizes of the forces [N].
template <class B>
struct LineariseContact {
  using Real = typename B::Real;
  ImplicitContact<B> contact;
  Real weight;
  bool blocks;  ///< false: the potential alone
  /// Blocks of slipping records as if they kept their friction in all directions, against overshoot
  bool secant = false;

  KOKKOS_INLINE_FUNCTION Sums<2> operator()(int i) const {
    const ContactRecords<B>& records = contact.records;
    const int r = records.list.item(i);
    const ContactLaw<Real> of = records.law_at(r);
    const bool tie = of.is_tie();
    const LawOfStep<Real> law(of, contact.h);
    const auto a = contact.at(r, law, tie);
    const Real cap = records.cap(r), by_shear = a.slips ? cap * (a.length - cap / (2 * law.kt))
                                                        : law.kt / 2 * a.length * a.length;
    const Real by_normal = tie ? Real(0) : a.lam * a.lam / (2 * law.kn);
    if (blocks) {
      set_vector<B>(records.force, r, a.force);
      set_block<B>(records.block, r, block(r, law, a, tie));
    }
    return {{static_cast<double>(by_normal) + static_cast<double>(by_shear),
             static_cast<double>(Kokkos::sqrt(dot(a.force, a.force)))}};
  }

  KOKKOS_INLINE_FUNCTION SymMat3<Real> block(int r, const LawOfStep<Real>& law,
                                             const typename ImplicitContact<B>::Answer& a,
                                             bool tie) const {
    constexpr int row[6] = {0, 1, 2, 0, 0, 1}, column[6] = {0, 1, 2, 1, 2, 2};  // order of SymMat3
    const Vec3<Real> N = vector_at<B>(contact.records.normal, r);
    const Real over = a.slips ? contact.records.cap(r) / a.length : law.kt;
    SymMat3<Real> C{};
    if (!tie && a.lam > 0 && contact.records.concavity.extent(0) > 0)
      add_scaled(C, weight * a.lam, block_at<B>(contact.records.concavity, r));
    for (int k = 0; k < 6; ++k) {
      const int i = row[k], j = column[k];
      const Real one = i == j ? Real(1) : Real(0);
      Real sum = over * (one - N[i] * N[j]);
      if (!tie && a.lam > 0) sum += law.kn * a.normal[i] * a.normal[j];
      if (a.slips && !secant) sum -= over / (a.length * a.length) * a.shear[i] * a.shear[j];
      C[k] += weight * sum;
    }
    return C;
  }
};

/// Sets the caps to mu times the normal forces at the state.
template <class B>
struct UpdateCaps {
  using Real = typename B::Real;
  ImplicitContact<B> contact;
  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    const int r = contact.records.list.item(i);
    const ContactLaw<Real> of = contact.records.law_at(r);
    if (!of.is_tie())
      contact.records.cap(r) =
          of.friction * contact.at(r, LawOfStep<Real>(of, contact.h), false).lam;
  }
};

/// Ends a step: sets its forces, the carried stretches and the depths there. Returns the work of
/// friction [J].
template <class B>
struct EndContact {
  using Real = typename B::Real;
  ImplicitContact<B> contact;
  KOKKOS_INLINE_FUNCTION Sums<1> operator()(int i) const {
    const ContactRecords<B>& records = contact.records;
    const int r = records.list.item(i);
    const ContactLaw<Real> of = records.law_at(r);
    const LawOfStep<Real> law(of, contact.h);
    const auto a = contact.at(r, law, of.is_tie());
    set_vector<B>(records.force, r, a.force);
    const Real over = a.slips ? records.cap(r) / a.length : law.kt;
    if (of.is_tie()) {
      set_vector<B>(records.stretch, r,
                    a.shear - (law.memory - 1) * vector_at<B>(records.stretch, r));
      return {};
    }
    const Vec3<Real> s = vector_at<B>(records.stretch, r);
    const bool sticks = a.lam > 0 && of.friction > 0 && law.kt > 0;
    set_vector<B>(records.stretch, r,
                  sticks ? (1 / law.kt) * (over * a.shear + law.rate * s) : Vec3<Real>{});
    records.depth(r) = a.end;
    return {{-static_cast<double>(over * dot(a.shear, a.way))}};
  }
};

/// Computes the product of each record's block with a field's value there. `beside`: only for
/// records that are in no matrix.
template <class B>
struct ContactProduct {
  EmbeddedSurface<B> surface;
  Vectors<B> x;
  ContactRecords<B> records;
  Vectors<B> product;  ///< [slots][3]
  bool beside;
  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    const int r = records.list.item(i);
    Vec3<typename B::Real> force;
    if (!(beside && records.is_of_one(r)))
      force = block_at<B>(records.block, r) * records.value(surface, x, r);
    set_vector<B>(product, r, force);
  }
};

/// Adds the vertex blocks of W^T C W, [vertices][6]. A vertex gets the blocks of all records that
/// it has a part in.
template <class B>
struct AddContactBlocks {
  EmbeddedSurface<B> surface;
  ContactRecords<B> records;
  bool beside;  ///< see ContactProduct
  Blocks<B> diagonal;

  KOKKOS_INLINE_FUNCTION void operator()(int i) const {
    const int a = surface.vertex(records.transpose.vertices.item(i));
    auto sum = block_at<B>(diagonal, a);
    records.transpose.each(i, [&](int r, typename B::Real w) {
      if (!(beside && records.is_of_one(r))) add_scaled(sum, w * w, block_at<B>(records.block, r));
    });
    set_block<B>(diagonal, a, sum);
  }
};

/// Adds scale W^T C W of points that touch obstacles to A. Each work item adds to a row of A, its
/// records in order, the blocks that are stored in it. Vertices of one tetrahedron are coupled in A
/// already, unless the row's motion is given.
template <class B>
struct AddContactToMatrix {
  using Real = typename B::Real;
  EmbeddedSurface<B> surface;
  ContactRecords<B> records;
  Real scale;
  BlockMatrix<B> A;

  KOKKOS_INLINE_FUNCTION void operator()(int item) const {
    const int a = surface.vertex(records.transpose.vertices.item(item)), first = A.first(a),
              last = A.first(a + 1);
    records.transpose.each(item, [&](int r, Real own) {
      if (!records.is_of_one(r)) return;
      const auto C = block_at<B>(records.block, r);
      const int p = records.point(r, 0);
      for (int c = 0; c < 4; ++c) {
        const Real w = surface.embedding.weight(p, c);
        if (w == 0) continue;
        int at = first;
        while (at < last && A.column(at) != surface.embedding.source(p, c)) ++at;
        if (at < last && A.is_stored(a, at)) add_block<B>(A, at, scale * own * w, C);
      }
    });
  }
};

}  // namespace plica
