// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace plica {

/// Weights of a stage of an implicit integrator. The stage looks for v with M (v - v~) = b F(u, v),
/// u = u~ + (a/b) (v - v~). Backward Euler over h has a = h^2, b = h, v~ = v_n and u~ = u_n + h
/// v_n. The system for a change of v is (1 + b c) M + a K + contact's a k + b d.
struct ImplicitWeights {
  double a = 0;  ///< weight of derivatives by position [s^2]
  double b = 0;  ///< weight of derivatives by velocity [s]
  /// Returns the change of displacement over that of velocity [s].
  double ratio() const { return b > 0 ? a / b : 0; }
};

}  // namespace plica
