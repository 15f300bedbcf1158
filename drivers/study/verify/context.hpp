// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>
#include <plica/drivers/study/verify.hpp>

namespace plica {

/// Thrown where the caller wants no more.
struct VerifyStopped {};

/// What a problem is told about how it is to be solved.
struct VerifyContext {
  bool small = false;
  std::function<bool()> go_on;

  /// To be called before each piece of work.
  void proceed() const {
    if (go_on && !go_on()) throw VerifyStopped{};
  }
  /// Three numbers of cells, each twice the one before; the first of the small version is half the `coarsest`, which is even.
  std::vector<int> refined(int coarsest) const {
    const int first = small ? coarsest / 2 : coarsest;
    return {first, 2 * first, 4 * first};
  }
};

inline std::string cells_text(int x, int y, int z) {
  return std::to_string(x) + "x" + std::to_string(y) + "x" + std::to_string(z);
}

}  // namespace plica
