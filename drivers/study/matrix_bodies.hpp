// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/problem.hpp>

namespace plica {

/// A body of the stability matrix, and what is known of its run beforehand.
struct MatrixBody {
  Problem problem;
  std::vector<Point> displacement;  ///< at the start [m]; empty: none
  double step = 0;                  ///< macro step over the finest critical step; 0: the method's own
  double load_ratio =
      1e-4;  ///< rho g L / E, from which gravity follows: a cantilever four times as long as thick is strained by
             ///< 12 of it at rest and 24 when it is let go; 0: none
  bool gentle = true;             ///< strains stay about a per cent at most
  bool inside_out = false;        ///< elements have J <= 0 at the start
  bool refused = false;           ///< its step is above the limit
  bool unstable = false;          ///< and is taken all the same
  bool may_lack_inertia = false;  ///< for cycle him
  bool barely_overlaps = false;   ///< its levels do
  bool pierces = false;           ///< it strikes faster than its waves: within a step, deeper than it is large

  void load();  ///< sets gravity
};

/// 0.4 x 0.1 x 0.1 m, clamped at x = 0, of 192 tetrahedra and 24.
MatrixBody clamped_beam();

void set_young_modulus(MatrixBody& body, double pascal);
void set_young_modulus_on_earth(MatrixBody& body, double pascal);
void set_poisson_ratio(MatrixBody& body, double ratio);
void set_density(MatrixBody& body, double density);
void set_size(MatrixBody& body, double length);
void set_gravity(MatrixBody& body, double factor);
void set_step(MatrixBody& body, double over_critical);
void set_unstable_step(MatrixBody& body, double over_critical);
/// One layer of cells of level 0 is so many times thinner than it is wide.
void set_slivers(MatrixBody& body, double ratio);
void set_stretch(MatrixBody& body, double factor);
/// Across the beam, along z: 0 flattens, below 0 inverts.
void set_thickness(MatrixBody& body, double factor);
void set_random(MatrixBody& body, double seed);
/// Free, it falls flat on a plane.
void set_impact(MatrixBody& body, double speed);
/// Its outer half is stiffer.
void set_contrast(MatrixBody& body, double ratio);
void set_one_tetrahedron(MatrixBody& body, double edge);
void set_levels(MatrixBody& body, double count);
/// Level 1 lies so many lengths of the beam further along.
void set_overlap(MatrixBody& body, double lengths);

}  // namespace plica
