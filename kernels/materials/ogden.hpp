// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/inlining.hpp>
#include <plica/kernels/materials/diagonalise.hpp>
#include <plica/kernels/materials/isochoric.hpp>

namespace plica {

/// Ogden's law: W = sum over terms of c_p (l1^alpha_p + l2^alpha_p + l3^alpha_p - 3), up to six
/// terms. l are the isochoric principal stretches; l^2 are the eigenvalues of C. Ogden, Proc. R.
/// Soc. A 326, 1972. There are three conventions for mu, see cmake/docs/reference/materials.md: c =
/// mu/alpha^2, mu/alpha or 2 mu/alpha^2. Beyond stretches of 1/10 and 10 the powers of l^2 are
/// continued by their Taylor polynomial of second order. A power below 0 makes a barrier that
/// flattened elements do not come back through.
struct Ogden : Isochoric<Ogden> {
  static constexpr const char* name = "ogden";
  static constexpr const char* summary =
      "powers of the principal stretches, up to six terms; brain, liver, rubber";
  static constexpr bool recovers = false;
  static constexpr bool has_terms = true;
  static constexpr int most_terms = TissueSettings::most_terms;
  static constexpr std::array parameters{parameter::bulk_modulus};
  static Constants<double> kernel_constants(const double* p) {
    const double* const settings = p + parameters.size();
    const TissueSettings s = settings_at(settings);
    Constants<double> c = constants(settings, p[0], 0, {});
    for (int k = 0; k < most_terms; ++k) {
      c.own[2 * k] = s.coefficient[k], c.own[2 * k + 1] = s.exponent[k] / 2;
      c.mu += s.coefficient[k] * s.exponent[k] * s.exponent[k] / 2;
    }
    return c;
  }

  /// Sum of c_p x^(alpha_p/2) less its value at 1, and its derivatives.
  template <class T>
  struct Powers {
    T value = T(0), first = T(0), second = T(0);
    PLICA_CALL KOKKOS_FUNCTION void of(const T& x, const IsochoricConstants<T>& c) {
      const T least = T(0.01f), most = T(100), kept = -max(-max(x, least), -most), over = x - kept;
      const T logarithm = log(kept), inverse = T(1) / kept;
      for (int k = 0; k < most_terms; ++k) {
        if (lane(c.own[2 * k], 0) == 0) continue;
        const T h = c.own[2 * k + 1], power = exp(h * logarithm);
        const T slope = c.own[2 * k] * h * power * inverse, bend = (h - T(1)) * slope * inverse;
        value += c.own[2 * k] * (power - T(1)) + over * (slope + T(0.5f) * over * bend);
        first += slope + over * bend, second += bend;
      }
    }
  };
  template <class T>
  struct Spectrum {
    T x[3];
    Vec3<T> axis[3];
    Powers<T> w[3];
    KOKKOS_INLINE_FUNCTION Spectrum(const Mat3<T>& C, const IsochoricConstants<T>& c) {
      decompose(C);
      for (int i = 0; i < 3; ++i) w[i].of(x[i], c);
    }
    PLICA_CALL KOKKOS_FUNCTION void decompose(const Mat3<T>& C) {
      T A[3][3], V[3][3];
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) A[i][j] = C[i][j];
      diagonalise(A, V);
      for (int i = 0; i < 3; ++i) x[i] = A[i][i], axis[i] = {V[0][i], V[1][i], V[2][i]};
    }
    /// Returns (w'(x_i) - w'(x_j)) / (x_i - x_j), computed from w'' where x_i and x_j are close.
    KOKKOS_INLINE_FUNCTION T divided(int i, int j) const {
      using Real = typename LaneOf<T>::type;
      const T gap = x[i] - x[j];
      T slope = T(0.5f) * (w[i].second + w[j].second);
      for (int l = 0; l < LaneOf<T>::count; ++l) {
        const Real g = lane(gap, l), close = closest<Real>() * (lane(x[i], l) + lane(x[j], l));
        if (g > close || g < -close)
          set_lane(slope, l, (lane(w[i].first, l) - lane(w[j].first, l)) / g);
      }
      return slope;
    }
    /// Returns the cube root of rounding: at this relative distance both formulas of divided() are
    /// about as exact.
    template <class Real>
    static KOKKOS_INLINE_FUNCTION constexpr Real closest() {
      return sizeof(Real) == sizeof(double) ? Real(6e-6) : Real(5e-3);
    }
  };

  template <class T>
  static KOKKOS_INLINE_FUNCTION T isochoric(const Mat3<T>& C, const IsochoricConstants<T>& c) {
    const Spectrum<T> s(C, c);
    return s.w[0].value + s.w[1].value + s.w[2].value;
  }
  template <class T, class To>
  static KOKKOS_INLINE_FUNCTION void respond(const Mat3<T>& C, const IsochoricConstants<T>& c,
                                             To& to) {
    const Spectrum<T> s(C, c);
    for (int i = 0; i < 3; ++i) {
      const Mat3<T> M = outer(s.axis[i], s.axis[i]);
      to.stress(T(2) * s.w[i].first, M), to.square(T(2) * s.w[i].second, M);
      const Mat3<T> N = outer(s.axis[i], s.axis[(i + 1) % 3]);
      to.square(s.divided(i, (i + 1) % 3), N + transpose(N));
    }
  }
};

}  // namespace plica
