// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/element_flags.hpp>
#include <plica/core/model.hpp>
#include <plica/core/surface.hpp>

namespace plica {

/// Vertices that move with given velocities from t = 0; none: no arrays.
template <class B>
struct PrescribedVertices {
  int count = 0;
  Indices<B> vertex;
  Vectors<B> velocity;  ///< [count][3] m/s
};

/// One resolution of the body: what is constant, its state, what is needed to integrate it, and how it exchanges states with
/// its neighbours. Members that a scene does not need stay empty.
template <class B>
struct Level {
  Model<B> model;
  State<B> state;
  PrescribedVertices<B> prescribed;
  EmbeddedSurface<B> surface;  ///< only with contact; on level 0 also for looking at

  Vectors<B> f;           ///< [vertices][3] force at the state about to be integrated [N]
  Vectors<B> partial;     ///< [patch vertices][3] workspace of the element kernels
  ElementFlags<B> flags;  ///< only for materials that do not survive inversion

  Transfer<B> from_finer;  ///< R: level i-1 -> i, empty on the finest
  Transfer<B> to_finer;    ///< P: level i -> i-1, likewise
  Restriction<B> adjoint;  ///< of the finer level's to_finer, where a cycle conserves what it hands down
  State<B> start;          ///< at the start of this cycle, where variations are mapped
  State<B> previous;       ///< at the start of the last cycle, likewise
  Scalars<B> drift_limit;  ///< [vertices] m, where mappings are switched
};

}  // namespace plica
