// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <optional>
#include <plica/core/fields.hpp>
#include <plica/core/load.hpp>
#include <plica/core/model.hpp>
#include <plica/core/path.hpp>
#include <plica/core/transfer.hpp>
#include <vector>

namespace plica {

/// The first inverted element of each patch since the last clear, where none is allowed: of several
/// in one evaluation, whose threads may all come at once on a GPU, the one with the smallest slot.
/// So what is kept does not depend on the threads.
template <class B>
struct ElementFlags {
  using Word = unsigned long long;
  Kokkos::View<int, typename B::Memory> raised;  ///< 0: none anywhere
  /// [patches] of the force, counted from 1; 0: none
  Indices<B> evaluation;
  /// [patches] slot and volume ratio in one, to be replaced at once
  Kokkos::View<Word*, typename B::Memory> word;

  KOKKOS_INLINE_FUNCTION void raise(int patch, int now, int slot, typename B::Real ratio) const {
    Kokkos::atomic_store(&raised(), 1);
    const int before = Kokkos::atomic_compare_exchange(&evaluation(patch), 0, now);
    const auto bits = Kokkos::bit_cast<std::uint32_t>(static_cast<float>(ratio));
    if (before == 0 || before == now)
      Kokkos::atomic_max(&word(patch), Word{~static_cast<std::uint32_t>(slot)} << 32 | bits);
  }
  /// Of a word: pack * lanes + lane.
  static int slot(Word word) { return static_cast<int>(~static_cast<std::uint32_t>(word >> 32)); }
  /// Of a word: the volume ratio.
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
  Indices<B> path;    ///< [count] the one it follows
  Kokkos::View<Path*, typename B::Memory> paths;
  Kokkos::View<PathKnot*, typename B::Memory> knots;
};

/// A dead load's forces at factor 1.
template <class B>
struct Load {
  int count = 0;
  Indices<B> vertex;  ///< [count]
  Vectors<B> force;   ///< [count][3] N
  LoadCourse course;
};

/// What triangles enclose where its volume is given, see EnclosedVolume.
struct Cavity {
  int load = 0;     ///< of the body's loads
  double rest = 0;  ///< volume at rest [m^3]
  /// the part of it that closes the rims, which does not change [m^3]
  double caps = 0;
  double ratio = 1;              ///< of the volume at rest
  double bulk_modulus = 0;       ///< [Pa]
  Point origin = Point::Zero();  ///< of the vertices' places at rest [m]

  double stiffness() const { return bulk_modulus / rest; }                        ///< [Pa/m^3]
  double goal(double factor) const { return rest * (1 + (ratio - 1) * factor); }  ///< [m^3]
};

/// A pressure on triangles of the boundary, wherever they are.
template <class B>
struct FollowerLoad {
  int count = 0;      ///< of vertices
  Indices<B> vertex;  ///< [count]
  Vectors<B> rest;    ///< [count][3] m
  Indices<B> first;   ///< [count + 1] of the corners of triangles at each
  /// [corners] the other two, counterclockwise from outside, as places in `vertex`
  Indices<B> second, third;
  double pressure = 0;  ///< [Pa]
  LoadCourse course;
  std::optional<Cavity> cavity = {};  ///< its fluid has the pressure then
  /// [1] that they enclose, up to a constant, as last measured [m^3]; [0]: rims move
  Doubles<B> volume = {};
};

/// What a viscous material remembers of its elements: packs of linear ones, rows of nodal ones. A
/// symmetric matrix is xx yy zz xy xz yz.
template <class B>
struct StressMemory {
  int terms = 0;      ///< of the longest Prony series of a region
  Indices<B> region;  ///< [slots / lanes]
  /// [regions][terms][2] keep and gain of H_i <- keep H_i + gain (S - S before) over a step
  Scalars<B> step;
  /// [slots][1 + terms][6] isochoric second Piola stress: elastic, and of each term [Pa]
  Scalars<B> memory;
  /// [slots][6] what relaxation takes off the second Piola stress where it is looked at [Pa]
  Scalars<B> lost;
};

/// One resolution of the body: what is constant, its state, what is needed to integrate it, and how
/// it exchanges states with its neighbours. Members that a scene does not need stay empty.
template <class B>
struct Level {
  Model<B> model;
  State<B> state;
  PrescribedVertices<B> prescribed;
  std::vector<Load<B>> loads;
  std::vector<FollowerLoad<B>> followers;
  EmbeddedSurface<B> surface;  ///< only with contact; on level 0 also for looking at

  Vectors<B> f;            ///< [vertices][3] force at the state about to be integrated [N]
  Vectors<B> partial;      ///< [shares][3] what the element kernels leave, a row per share
  NodalWork<B> nodal;      ///< with nodal elements only
  StressMemory<B> stress;  ///< of viscous materials only
  ElementFlags<B> flags;   ///< only where no element may be inverted

  Transfer<B> from_finer;  ///< R: level i-1 -> i, empty on the finest
  Transfer<B> to_finer;    ///< P: level i -> i-1, likewise
  /// of the finer level's to_finer, where a cycle conserves what it hands down
  Restriction<B> adjoint;
  State<B> start;          ///< at the start of this cycle, where variations are mapped
  State<B> previous;       ///< at the start of the last cycle, likewise
  Scalars<B> drift_limit;  ///< [vertices] m, where mappings are switched
};

}  // namespace plica
