// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <memory>
#include <optional>
#include <plica/core/fields.hpp>
#include <plica/core/load.hpp>
#include <plica/core/model.hpp>
#include <plica/core/path.hpp>
#include <plica/core/transfer.hpp>
#include <vector>

namespace plica {

/// First inverted element of each patch since the last clear, where none is allowed. One evaluation
/// may find several, and on a GPU all its threads may come at once. The element with the smallest
/// slot is then taken, which does not depend on the threads.
template <class B>
struct ElementFlags {
  using Word = unsigned long long;
  Kokkos::View<int, typename B::Memory> raised;  ///< 0: no element is inverted
  /// [patches] evaluation of the force that found it, counted from 1; 0: none
  Indices<B> evaluation;
  /// [patches] slot and volume ratio in one word, so that both are replaced at once
  Kokkos::View<Word*, typename B::Memory> word;

  KOKKOS_INLINE_FUNCTION void raise(int patch, int now, int slot, typename B::Real ratio) const {
    Kokkos::atomic_store(&raised(), 1);
    const int before = Kokkos::atomic_compare_exchange(&evaluation(patch), 0, now);
    const auto bits = Kokkos::bit_cast<std::uint32_t>(static_cast<float>(ratio));
    if (before == 0 || before == now)
      Kokkos::atomic_max(&word(patch), Word{~static_cast<std::uint32_t>(slot)} << 32 | bits);
  }
  /// Returns the slot in a word: pack * lanes + lane.
  static int slot(Word word) { return static_cast<int>(~static_cast<std::uint32_t>(word >> 32)); }
  /// Returns the volume ratio in a word.
  static float J(Word word) { return Kokkos::bit_cast<float>(static_cast<std::uint32_t>(word)); }

  void clear(const typename B::Exec& exec) const {
    if (evaluation.extent(0) == 0) return;
    fill(exec, raised, 0);
    fill(exec, evaluation, 0);
    fill(exec, word, 0);
  }
};

template <class B>
ElementFlags<B> make_element_flags(int patches) {
  return {Kokkos::View<int, typename B::Memory>("plica::flags.raised"),
          zeros<Indices<B>>("plica::flags.evaluation", patches),
          zeros<decltype(ElementFlags<B>::word)>("plica::flags.word", patches)};
}

/// Vertices whose motion is given; none: no arrays.
template <class B>
struct PrescribedVertices {
  int count = 0;
  Indices<B> vertex;  ///< [count]
  Indices<B> path;    ///< [count] path that the vertex follows
  Kokkos::View<Path*, typename B::Memory> paths;
  Kokkos::View<PathKnot*, typename B::Memory> knots;
  /// [paths]; empty: no path is a turn
  Kokkos::View<TurnAxis*, typename B::Memory> turns;
  /// [count][3] place at rest from the point that the vertex turns about [m]; empty likewise
  Kokkos::View<double* [3], Kokkos::LayoutRight, typename B::Memory> arm;
};

/// Vertices that are held along one or two directions, and slide across them; none: no arrays.
template <class B>
struct SlidingVertices {
  int count = 0;
  Indices<B> vertex;  ///< [count]
  /// [count] two unit vectors at right angles, along which the vertex is held. Where it is held
  /// along one, the second is 0
  Kokkos::View<double* [6], Kokkos::LayoutRight, typename B::Memory> normals;
  Indices<B> place;  ///< [vertices] number of each vertex in `vertex`; -1: it does not slide

  /// Returns one of the two directions along which a vertex is held.
  KOKKOS_INLINE_FUNCTION Vec3<double> normal(int i, int which) const {
    return {normals(i, 3 * which), normals(i, 3 * which + 1), normals(i, 3 * which + 2)};
  }
};

/// Forces of a dead load at factor 1.
template <class B>
struct Load {
  int count = 0;
  Indices<B> vertex;  ///< [count]
  Vectors<B> force;   ///< [count][3] N
  LoadCourse course;
};

/// Volume that triangles enclose, for a load that gives it, see EnclosedVolume.
struct Cavity {
  int load = 0;     ///< number among the body's loads
  double rest = 0;  ///< volume at rest [m^3]
  /// Part of the volume that closes the rims and does not change [m^3]
  double caps = 0;
  double ratio = 1;         ///< volume given at factor 1, over that at rest
  double bulk_modulus = 0;  ///< [Pa]
  /// Point from which the places of vertices at rest are measured [m]
  Point origin = Point::Zero();

  /// Returns the pressure per volume that is missing [Pa/m^3].
  double stiffness() const { return bulk_modulus / rest; }
  /// Returns the volume that is given at a factor [m^3].
  double goal(double factor) const { return rest * (1 + (ratio - 1) * factor); }
};

/// A pressure on triangles of the boundary, wherever they are in the current state.
template <class B>
struct FollowerLoad {
  int count = 0;      ///< number of vertices
  Indices<B> vertex;  ///< [count]
  Vectors<B> rest;    ///< [count][3] m
  /// [count + 1] into second and third: the corners of triangles at each vertex
  Indices<B> first;
  /// [corners] the other two vertices of the triangle, counterclockwise from outside, as places in
  /// `vertex`
  Indices<B> second, third;
  double pressure = 0;  ///< [Pa]
  LoadCourse course;
  /// Cavity that the triangles enclose; the pressure is then that of its fluid
  std::optional<Cavity> cavity = {};
  /// [1] volume that the triangles enclose, up to a constant, as last measured [m^3]; [0]: rims
  /// move
  Doubles<B> volume = {};
};

/// Memory of a viscous material for its elements: packs of linear ones, rows of nodal ones. A
/// symmetric matrix is xx yy zz xy xz yz.
template <class B>
struct ViscousHistory {
  int terms = 0;      ///< number of terms of the longest Prony series
  Indices<B> region;  ///< [slots / lanes]
  /// [regions][terms][2] keep and gain of H_i <- keep H_i + gain (S - S before) over a step
  Scalars<B> step;
  /// [slots][1 + terms][6] isochoric second Piola stress: elastic, and of each term [Pa]
  Scalars<B> memory;
  /// [slots][6] relaxed stress at the time of the forces, without the part that follows the state.
  /// It is taken off the second Piola stress [Pa]
  Scalars<B> relaxed;
};

template <class B>
struct RankLevel;
template <class B>
class GatheredVertices;

/// One resolution of the body: constants, state, work arrays, and the exchange of states with its
/// neighbour levels. Members that a scene does not need stay empty.
template <class B>
struct LevelData {
  Model<B> model;
  State<B> state;
  PrescribedVertices<B> prescribed;
  SlidingVertices<B> sliding;
  EmbeddedSurface<B> surface;  ///< with contact; on level 0 also for output

  Vectors<B> f;  ///< [vertices][3] force at the state about to be integrated [N]
  /// [shares][3] results of the element kernels, a row per share
  Vectors<B> partial;
  NodalWork<B> nodal;        ///< work arrays of nodal elements
  ViscousHistory<B> stress;  ///< memory of viscous materials
  ElementFlags<B> flags;     ///< inverted elements, where none is allowed
  /// Part that this rank has of the level, see kernels/halo.hpp; none: one process has all of it
  std::shared_ptr<const RankLevel<B>> ranks;
  /// Part that this rank has of model.float_rows, and their messages
  std::shared_ptr<const RankLevel<Backend<float, typename B::Exec>>> float_ranks;

  Transfer<B> from_finer;  ///< R: level i-1 -> i, empty on the finest
  Transfer<B> to_finer;    ///< P: level i -> i-1, empty on the finest
  /// Adjoint of to_finer, where a cycle conserves what it hands down
  Restriction<B> adjoint;
  /// Vertices that from_finer and adjoint read of level i-1, and that to_finer reads of this level,
  /// see kernels/halo.hpp; none: one process has all of that level
  std::shared_ptr<const GatheredVertices<B>> of_finer, for_finer;
  /// Inverse masses of the vertices of level i-1 that adjoint reads [1/kg]
  Scalars<B> finer_inverse_mass;
  /// State at the start of this cycle, from which variations are mapped
  State<B> start;
  /// State at the start of the last cycle, from which variations are mapped
  State<B> previous;
  /// [vertices] drift above which switched mappings take the state [m]
  Scalars<B> drift_limit;
};

}  // namespace plica
