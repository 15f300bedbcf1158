// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <optional>
#include <plica/drivers/study/trajectory.hpp>
#include <string>
#include <vector>

namespace plica {

/// Where motions on finer and finer meshes lead.
struct Limit {
  Trajectory trajectory;
  std::optional<double> order;  ///< observed, of displacement; none: there were two meshes
  /// that the limit is extrapolated with: the observed one, in [1, 2]
  double used_order = 2;
  double correction = 0;  ///< from the finest mesh to the limit, relative
  double own_error = 0;   ///< its uncertainty, relative: see richardson_limit()
  double own_error_velocity = 0;
};

/// fine + (fine - coarse) / (2^order - 1)
Trajectory extrapolated(const Trajectory& fine, const Trajectory& coarse, double order);

/// Richardson's limit (L. F. Richardson, Phil. Trans. R. Soc. A 210, 1911) of u_h = u + C h^p, from
/// meshes with edges h, 2h and where there is one 4h. With three, p = log2 |u_4h - u_2h| / |u_2h -
/// u_h|. What one power of h does not explain shrinks at least as fast as that power: the limit's
/// error is its distance from the limit of the two coarser meshes, over 2^p - 1. With two, p is
/// `assumed` and the error is the whole correction, as it is where p is observed outside [0.8, 3]:
/// then errors do not shrink like that.
///
/// @param fine, coarse  at the same vertices and times
/// @param coarsest      null: there is none; else at the vertices `common` of the others
Limit richardson_limit(const Trajectory& fine, const Trajectory& coarse, const Trajectory* coarsest,
                       const std::vector<int>& common, double assumed = 2);

/// One mesh of a family, run by itself.
struct TruthMesh {
  long tets = 0;
  double macro_step = 0;  ///< [s]
  double wall_time = 0;   ///< of its steps [s]
  double error = 0;       ///< displacement, against the truth
};

/// Meshes of one kind, each with edges half as long as those of the one before, and what their
/// limit is good for.
struct TruthFamily {
  std::string name;               ///< "linear", "linear, jittered"
  std::vector<TruthMesh> meshes;  ///< coarsest first
  std::optional<double> order;    ///< see Limit
  double used_order = 2, correction = 0, own_error = 0;
};

/// What a body really does, as well as it is known: the limit of one family, and how far that of
/// another is from it.
struct Truth {
  TruthFamily family, check;
  double difference = 0;  ///< between their limits, relative
  double time_error = 0;  ///< of the finest mesh by its time step, relative
  /// How uncertain it is: the limit's own error, or what the other family is off beyond its own;
  /// and the error in time.
  double error() const;
  /// The error in space is observed to shrink as it has to, so that the numbers above mean
  /// something.
  bool converges() const { return family.order && *family.order >= 0.8 && *family.order <= 3; }
};

/// One level's mesh with one kind of elements, converged in time: what separates a row's error in
/// time from that in space.
struct MeshReference {
  std::string element;
  int level = 0;
  double own_error = 0;    ///< in time, relative
  double error_space = 0;  ///< displacement, against the truth
  Trajectory trajectory;   ///< at level 0's vertices
};

}  // namespace plica
