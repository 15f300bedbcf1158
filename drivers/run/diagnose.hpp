// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/run/build_hierarchy.hpp>
#include <vector>

namespace plica {

/// A level's most compressed element and its volume ratio; element -1 where no ratio is finite.
struct WorstElement {
  int element = -1;
  double J = 1;
};
/// Returns the most compressed element of a mesh at these displacements [m].
WorstElement worst_element(const TetMesh& mesh, const std::vector<Point>& displacement);

/// Returns the host's copy of a device field [rows][3]. Waits for `exec`.
template <class B>
std::vector<Point> to_host(const typename B::Exec& exec, const Vectors<B>& field);

/// Returns an inverted element that a force kernel flagged, if any: of the earliest evaluation,
/// that of the smallest J.
template <class B>
std::optional<Diagnosis> find_inverted(const BuiltHierarchy<B>& built);

/// Finds where a run with non-finite values or too much energy went wrong. Returns the level (where
/// it is not given), its first bad vertex and its worst element. The worst element is that of the
/// present state or, where this is not finite, of the snapshot `kept`.
template <class B>
Diagnosis locate_failure(const std::string& kind, const BuiltHierarchy<B>& built,
                         const std::vector<State<B>>& kept, int level = -1,
                         const std::string& reason = {});

}  // namespace plica
