// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace plica {

/// A stage of an implicit integrator looks for v with M (v - v~) = b F(u, v), u = u~ + (a/b) (v -
/// v~): backward Euler over h has a = h^2, b = h, v~ = v_n and u~ = u_n + h v_n. Its system for a
/// change of v is (1 + b c) M + a K + contact's a k + b d.
struct ImplicitWeights {
  double a = 0;  ///< of derivatives by position [s^2]
  double b = 0;  ///< of derivatives by velocity [s]
  /// Change of displacement over that of velocity [s].
  double ratio() const { return b > 0 ? a / b : 0; }
};

}  // namespace plica
