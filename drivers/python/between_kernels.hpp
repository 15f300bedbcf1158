// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <functional>

namespace plica::python {

/// While this lives, calls a function before each kernel of the library that this thread launches. What it throws comes out of the
/// launch, so that a long macro step or set-up can be left. One at a time.
class BetweenKernels {
 public:
  explicit BetweenKernels(std::function<void()> call);
  ~BetweenKernels();
  BetweenKernels(const BetweenKernels&) = delete;
  BetweenKernels& operator=(const BetweenKernels&) = delete;
};

}  // namespace plica::python
