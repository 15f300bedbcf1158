// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace plica {

/// A cycle at a macro step that was tried out.
struct CycleTrial {
  std::string cycle;            ///< its name
  double macro_step = 0;        ///< [s]
  double over_critical = 0;     ///< the same over the finest level's critical step
  std::optional<double> error;  ///< of level 0's displacements in the trial, relative (L2); none: there is no number
  std::string reason;           ///< why it is out, or was taken without a number; empty otherwise
};

/// What `integration.cycle: auto` has come to.
struct CycleChoice {
  std::string cycle;         ///< him | single
  double macro_step = 0;     ///< [s]
  double over_critical = 0;  ///< the same over the finest level's critical step
  std::string error_class;   ///< that was asked for
  double allowed = 0;        ///< the error it allows
  double duration = 0;       ///< of the trials [s]; 0: there was nothing to try
  std::vector<CycleTrial>
      trials;          ///< the longest step first, up to the one within the class; level 0 alone last where none is
  std::string reason;  ///< one sentence
};

}  // namespace plica
