// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstring>
#include <initializer_list>
#include <plica/core/inlining.hpp>
#include <plica/kernels/materials/material.hpp>
#include <plica/kernels/materials/volumetric.hpp>

// Basis of the laws of tissue: Psi(F) = W(C) + U(J), C = R(J) F^T F with R = J^(-2/3). A law is a
// struct derived from Isochoric<Law>, with W and its two derivatives. The rest is in this file,
// down to det F <= 0 (volume_ratio.hpp). A law has
//   name, summary, parameters, kernel_constants(p), and the statements in material.hpp that
//                             differ from those of Isochoric
//   isochoric(C, c)           W [J/m^3]
//   respond(C, c, to)         S = 2 dW/dC and dS/dC as a sum, by calls of `to`: see IsochoricStress
//   shape_at_rest(e, c)       where it has fibres: the stress of a small strain e without a trace,
//                             determined up to the trace of the stress
namespace plica {

/// Constants that kernels get of every law. Their form is one for all laws, so that all share their
/// kernels.
template <class T>
struct IsochoricConstants {
  T law;       ///< place of the law in IsochoricLaws
  T volume;    ///< choice of Volumetric
  T bulk, mu;  ///< kappa; mu at rest, or a bound of it [Pa]
  T own[12];   ///< constants of the law
  /// Unit vectors: of the fibres and, orthogonal to these, of their sheet; or of two families of
  /// fibres
  Vec3<T> axis[2];
};

/// Receiver of a law's stress: S = sum of w M.
template <class T>
struct IsochoricStress {
  Mat3<T> S;
  KOKKOS_INLINE_FUNCTION void stress(const T& w, const Mat3<T>& M) { S = S + w * M; }
  // Terms of dS/dC, with symmetric matrices M and N, in the order of the functions: dC -> w (M:dC)
  // M, w ((M:dC) N + (N:dC) M), w dC
  KOKKOS_INLINE_FUNCTION void square(const T&, const Mat3<T>&) {}
  KOKKOS_INLINE_FUNCTION void pair(const T&, const Mat3<T>&, const Mat3<T>&) {}
  KOKKOS_INLINE_FUNCTION void identity(const T&) {}
};

/// Receiver of a law's S and dS/dC.
template <class T>
struct IsochoricStiffness : IsochoricStress<T> {
  T D[6][6];  ///< dS/dC by six_of(dC), whose last three count twice
  KOKKOS_INLINE_FUNCTION IsochoricStiffness() {
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) D[i][j] = T(0);
  }
  KOKKOS_INLINE_FUNCTION void square(const T& w, const Mat3<T>& M) {
    const SymMat3<T> m = six_of(M);
    for (int i = 0; i < 6; ++i) {
      const T wm = w * m.a[i];
      for (int j = 0; j < 6; ++j) D[i][j] += wm * m.a[j];
    }
  }
  KOKKOS_INLINE_FUNCTION void pair(const T& w, const Mat3<T>& M, const Mat3<T>& N) {
    const SymMat3<T> m = six_of(M), n = six_of(N);
    for (int i = 0; i < 6; ++i) {
      const T wm = w * m.a[i], wn = w * n.a[i];
      for (int j = 0; j < 6; ++j) D[i][j] += wm * n.a[j] + wn * m.a[j];
    }
  }
  KOKKOS_INLINE_FUNCTION void identity(const T& w) {
    for (int i = 0; i < 6; ++i) D[i][i] += i < 3 ? w : T(0.5f) * w;
  }
  KOKKOS_INLINE_FUNCTION Mat3<T> change(const Mat3<T>& dC) const {
    SymMat3<T> d = six_of(dC), to;
    for (int k = 3; k < 6; ++k) d.a[k] = d.a[k] + d.a[k];
    for (int i = 0; i < 6; ++i) {
      T sum = D[i][0] * d.a[0];
      for (int j = 1; j < 6; ++j) sum += D[i][j] * d.a[j];
      to.a[i] = sum;
    }
    return matrix_of(to);
  }
};

/// Returns F^T G + G^T F; gram(F) is half of it for G = F.
template <class T>
KOKKOS_INLINE_FUNCTION Mat3<T> symmetric_product(const Mat3<T>& F, const Mat3<T>& G) {
  const Mat3<T> A = transpose(F) * G;
  return A + transpose(A);
}
template <class T>
KOKKOS_INLINE_FUNCTION Mat3<T> gram(const Mat3<T>& F) {
  SymMat3<T> c;
  for (int k = 0; k < 3; ++k) {
    c.a[0] += F[k][0] * F[k][0], c.a[1] += F[k][1] * F[k][1], c.a[2] += F[k][2] * F[k][2];
    c.a[3] += F[k][0] * F[k][1], c.a[4] += F[k][0] * F[k][2], c.a[5] += F[k][1] * F[k][2];
  }
  return matrix_of(c);
}

/// Value e^q and its derivatives, for laws that stiffen exponentially. Beyond q = 20, where it is
/// 5e8, it is continued by its Taylor polynomial of second order, which is finite for any element.
template <class T>
struct Exponential {
  T less_one, first, second;
  explicit KOKKOS_INLINE_FUNCTION Exponential(const T& q) {
    const T over = max(q - T(20), T(0));
    second = exp(q - over), first = second * (T(1) + over);
    less_one = second * (T(1) + over * (T(1) + T(0.5f) * over)) - T(1);
  }
};

/// Returns the settings that stand behind a law's parameters.
inline TissueSettings settings_at(const double* values) {
  TissueSettings s;
  std::memcpy(static_cast<void*>(&s), values, sizeof s);
  return s;
}

/// Base of a law: P = F (R S - mu A) + g cof F with A of CrushedTerm and g = dU/dJ + dR/dJ h, h =
/// S:F^T F / 2.
template <class Law>
struct Isochoric {
  static constexpr bool rotation_invariant = true;
  static constexpr bool survives_inversion = true;
  static constexpr bool recovers = true;
  static constexpr bool allows_inversion = false;
  static constexpr bool isotropic = true;
  static constexpr bool splits_shape = true;
  template <class T>
  using Constants = IsochoricConstants<T>;

  /// Returns the constants for kernel_constants(p). The settings stand behind the law's own
  /// parameters, at p + their number.
  static IsochoricConstants<double> constants(const double* settings, double bulk, double mu,
                                              std::initializer_list<double> own) {
    const TissueSettings s = settings_at(settings);
    IsochoricConstants<double> c{0, s.volume, bulk, mu, {}, {}};
    int k = 0;
    for (const double value : own) c.own[k++] = value;
    for (int i = 0; i < 3; ++i) c.axis[0][i] = s.axis[i], c.axis[1][i] = s.sheet[i];
    return c;
  }
  static Lame<double> small_strains(const IsochoricConstants<double>& c) {
    return {c.bulk - 2 * c.mu / 3, c.mu};
  }
  static IsochoricConstants<double> with_lambda(IsochoricConstants<double> c, double lambda) {
    c.bulk = lambda + 2 * c.mu / 3;
    return c;
  }

  template <class T>
  using Dilatation = VolumeDilatation<T>;
  template <class T>
  static KOKKOS_INLINE_FUNCTION Volumetric<T> volumetric(const T& J,
                                                         const IsochoricConstants<T>& c) {
    return volumetric(VolumeRatio<T>(J), T(1), c);
  }
  template <class T>
  static KOKKOS_INLINE_FUNCTION Volumetric<T> volumetric(const VolumeRatio<T>& v, const T& bulk,
                                                         const IsochoricConstants<T>& c) {
    return {v, bulk, static_cast<int>(lane(c.volume, 0))};
  }

  template <class T>
  static KOKKOS_INLINE_FUNCTION T energy(const Mat3<T>& F, const IsochoricConstants<T>& c) {
    const VolumeRatio<T> v(determinant(F));
    const Mat3<T> C = gram(F);
    return Law::isochoric(v.factor() * C, c) + volumetric(v, c.bulk, c).energy +
           c.mu * CrushedTerm<T>(trace(C)).energy();
  }

  template <class T>
  static KOKKOS_INLINE_FUNCTION Mat3<T> stress(const Mat3<T>& F, const IsochoricConstants<T>& c) {
    const Mat3<T> H = cofactor(F), C = gram(F);
    const VolumeRatio<T> v(dot(F[0], H[0]));
    const T R = v.factor();
    IsochoricStress<T> law;
    Law::respond(R * C, c, law);
    const T g = volumetric(v, c.bulk, c).first + T(0.5f) * v.factor_slope() * inner(law.S, C);
    return F * (R * law.S - Mat3<T>::diagonal(c.mu * CrushedTerm<T>(trace(C)).stress())) + g * H;
  }

  /// Tangent: dP = dF S + F (D:dC + dJ Z) + g d(cof F) + (k dJ + Z:dC/2) cof F. S is R S - mu A of
  /// the stress, and Z = dR/dJ (R dS/dC:C + S) with the law's own S.
  template <class T>
  struct Tangent {
    Mat3<T> F, H, S, Z;
    IsochoricStiffness<T> law;
    T g, k;
    PLICA_CALL PLICA_FLATTEN KOKKOS_FUNCTION Tangent(const Mat3<T>& at,
                                                     const IsochoricConstants<T>& c)
        : F(at), H(cofactor(at)) {
      const Mat3<T> C = gram(F);
      const VolumeRatio<T> v(dot(F[0], H[0]));
      const T R = v.factor(), slope = v.factor_slope();
      Law::respond(R * C, c, law);
      const T half = T(0.5f) * inner(law.S, C);
      const Volumetric<T> volume = volumetric(v, c.bulk, c);
      const CrushedTerm<T> crushed(trace(C));
      const Mat3<T> DC = law.change(C);
      g = volume.first + slope * half;
      k = volume.second + v.factor_bend() * half + T(0.5f) * slope * slope * inner(C, DC);
      Z = slope * (R * DC + law.S);
      S = R * law.S - Mat3<T>::diagonal(c.mu * crushed.stress());
      for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 6; ++j) law.D[i][j] = R * R * law.D[i][j];
      law.square(T(0.5f) * c.mu * crushed.stiffness(), Mat3<T>::identity());
    }
    PLICA_CALL PLICA_FLATTEN KOKKOS_FUNCTION Mat3<T> operator()(const Mat3<T>& dF) const {
      const Mat3<T> dC = symmetric_product(F, dF);
      const T dJ = inner(H, dF);
      return dF * S + F * (law.change(dC) + dJ * Z) + g * cofactor_change(F, dF) +
             (k * dJ + T(0.5f) * inner(Z, dC)) * H;
    }
    using Corner = ColumnsOfCorner<T>;
    KOKKOS_INLINE_FUNCTION Corner corner(const Vec3<T>& p) const {
      Corner made{p, {}};
      for (int i = 0; i < 3; ++i) {
        Mat3<T> dF;
        dF[i] = p;
        made.dP[i] = (*this)(dF);
      }
      return made;
    }
    KOKKOS_INLINE_FUNCTION Mat3<T> block(const Corner& p, const Corner& q) const {
      return q.block(p);
    }
  };

  template <class T>
  static KOKKOS_INLINE_FUNCTION Mat3<T> stress_change(const Mat3<T>& F, const Mat3<T>& dF,
                                                      const IsochoricConstants<T>& c) {
    return Tangent<T>(F, c)(dF);
  }

  template <class T>
  static KOKKOS_INLINE_FUNCTION Mat3<T> stress_at_rest(const Mat3<T>& G,
                                                       const IsochoricConstants<T>& c) {
    const T t = trace(G), third = T(1) / T(3);
    const Mat3<T> S =
        Law::shape_at_rest(T(0.5f) * (G + transpose(G)) - Mat3<T>::diagonal(third * t), c);
    return S + Mat3<T>::diagonal(c.bulk * t - third * trace(S));
  }
  template <class T>
  static KOKKOS_INLINE_FUNCTION Mat3<T> shape_at_rest(const Mat3<T>& e,
                                                      const IsochoricConstants<T>& c) {
    return (c.mu + c.mu) * e;
  }
};

/// Energy W and its derivatives by the invariants of C: x = I1 - 3, y = I2 - 3.
template <class T>
struct OfInvariants {
  T W, x, y, xx, xy, yy;
};

/// Base of a law with W(I1, I2), which provides of_invariants(x, y, c).
template <class Law>
struct InvariantLaw : Isochoric<Law> {
  template <class T>
  static KOKKOS_INLINE_FUNCTION T second_invariant(const Mat3<T>& C) {
    return C[0][0] * C[1][1] + C[1][1] * C[2][2] + C[2][2] * C[0][0] - C[0][1] * C[0][1] -
           C[0][2] * C[0][2] - C[1][2] * C[1][2];
  }
  template <class T>
  static KOKKOS_INLINE_FUNCTION T isochoric(const Mat3<T>& C, const IsochoricConstants<T>& c) {
    return Law::of_invariants(trace(C) - T(3), second_invariant(C) - T(3), c).W;
  }
  template <class T, class To>
  static KOKKOS_INLINE_FUNCTION void respond(const Mat3<T>& C, const IsochoricConstants<T>& c,
                                             To& to) {
    const T I = trace(C), two = T(2);
    const OfInvariants<T> w = Law::of_invariants(I - T(3), second_invariant(C) - T(3), c);
    const Mat3<T> one = Mat3<T>::identity(), N = Mat3<T>::diagonal(I) - C;  // dI1/dC, dI2/dC
    to.stress(two * w.x, one), to.stress(two * w.y, N);
    to.square(two * (w.xx + w.y), one), to.identity(-two * w.y);
    to.pair(two * w.xy, one, N), to.square(two * w.yy, N);
  }
};

}  // namespace plica
