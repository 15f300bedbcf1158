// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <optional>
#include <plica/drivers/study/trajectory.hpp>
#include <string>
#include <vector>

namespace plica {

/// Limit of the motions on finer and finer meshes.
struct Limit {
  Trajectory trajectory;
  std::optional<double> order;  ///< observed, of displacement; none: only two meshes
  /// order used to extrapolate: the observed one, clamped to [1, 2]
  double used_order = 2;
  double correction = 0;  ///< from the finest mesh to the limit, relative
  double own_error = 0;   ///< uncertainty of the displacement, relative: see richardson_limit()
  double own_error_velocity = 0;  ///< uncertainty of the velocity, relative
};

/// Returns fine + (fine - coarse) / (2^order - 1).
Trajectory extrapolated(const Trajectory& fine, const Trajectory& coarse, double order);

/// Returns Richardson's limit of u_h = u + C h^p, from meshes with edges h, 2h and optionally 4h
/// (L. F. Richardson, Phil. Trans. R. Soc. A 210, 1911).
///
/// With three meshes, p = log2 |u_4h - u_2h| / |u_2h - u_h|. The part of the error that is not of
/// this power of h shrinks at least as fast as the power. The limit's error is therefore its
/// distance from the limit of the two coarser meshes, over 2^p - 1.
///
/// With two meshes, p is `assumed` and the error is the whole correction. The error is also the
/// whole correction where the observed p is outside [0.8, 3], since errors then do not follow a
/// power law.
///
/// @param fine, coarse  motions at the same vertices and times
/// @param coarsest      motion at the vertices `common` of the others; null: there is none
Limit richardson_limit(const Trajectory& fine, const Trajectory& coarse, const Trajectory* coarsest,
                       const std::vector<int>& common, double assumed = 2);

/// One mesh of a family, and the run of level 0 on it alone.
struct TruthMesh {
  long tets = 0;
  double macro_step = 0;  ///< [s]
  double wall_time = 0;   ///< wall time of the steps [s]
  double error = 0;       ///< displacement against the truth, relative
};

/// Meshes of one kind and the accuracy of their limit. Each mesh has edges half as long as the mesh
/// before.
struct TruthFamily {
  std::string name;               ///< "linear", "linear, jittered"
  std::vector<TruthMesh> meshes;  ///< coarsest first
  std::optional<double> order;    ///< see Limit
  double used_order = 2, correction = 0, own_error = 0;
};

/// Accuracy of the best known motion of a body, which is the limit of one family of meshes. The
/// limit of another family checks it.
struct Truth {
  TruthFamily family, check;
  double difference = 0;  ///< between the limits of the two families, relative
  double time_error = 0;  ///< error of the finest mesh by its time step, relative
  /// Returns the relative uncertainty, the sum of those in space and in time. In space it is the
  /// limit's own error, or if larger, the difference less the other family's own error.
  double error() const;
  /// Returns whether the observed order in space is in [0.8, 3]; else the errors mean nothing.
  bool converges() const { return family.order && *family.order >= 0.8 && *family.order <= 3; }
};

/// One level's mesh with one kind of elements, converged in time. It separates a row's error in
/// time from its error in space.
struct MeshReference {
  std::string element;
  int level = 0;
  double own_error = 0;    ///< in time, relative
  double error_space = 0;  ///< displacement against the truth, relative
  Trajectory trajectory;   ///< at level 0's vertices
};

}  // namespace plica
