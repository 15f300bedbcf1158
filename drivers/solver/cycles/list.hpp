// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/type_list.hpp>
#include <plica/drivers/solver/cycles/fas.hpp>
#include <plica/drivers/solver/cycles/him.hpp>
#include <plica/drivers/solver/cycles/v_cycle.hpp>

namespace plica {

/// Level 0 alone.
struct Single {
  static constexpr const char* name = "single";
  static constexpr const char* summary = "the finest level alone";
  static constexpr bool uses_coarse_levels = false, integrates_coarse_levels = false;
  static constexpr bool switched = false, inherits_masses = false;
  template <class B>
  using Of = VCycle<B, MapState, MapState>;
};

/// The paper's V-cycle with one of its mappings each way.
template <class Down, class Up>
struct PaperCycle {
  static constexpr bool uses_coarse_levels = true, integrates_coarse_levels = true, inherits_masses = false;
  static constexpr bool switched =
      (Down::needs_state && Down::needs_variation) || (Up::needs_state && Up::needs_variation);
  template <class B>
  using Of = VCycle<B, Down, Up>;
};
struct Rs : PaperCycle<MapState, MapState> {
  static constexpr const char* name = "rs";
  static constexpr const char* summary = "state down and up";
};
struct Rv : PaperCycle<MapVariation, MapVariation> {
  static constexpr const char* name = "rv";
  static constexpr const char* summary = "variation down and up";
};
struct Rsv : PaperCycle<MapSwitched, MapSwitched> {
  static constexpr const char* name = "rsv";
  static constexpr const char* summary =
      "the paper's: state where levels have drifted apart, variation elsewhere, down and up";
};
struct RsvSv : PaperCycle<MapState, MapVariation> {
  static constexpr const char* name = "rsv_sv";
  static constexpr const char* summary = "state down, variation up";
};

struct Fas {
  static constexpr const char* name = "fas";
  static constexpr const char* summary = "state down, variation up, coarse forces corrected to the finest level's";
  static constexpr bool uses_coarse_levels = true, integrates_coarse_levels = true;
  static constexpr bool switched = false, inherits_masses = true;
  template <class B>
  using Of = FasCycle<B>;
};

struct Him {
  static constexpr const char* name = "him";
  static constexpr const char* summary =
      "hierarchical inverse mass: one force of the finest level per step, answered by all levels";
  static constexpr bool uses_coarse_levels = true, integrates_coarse_levels = false;
  static constexpr bool switched = false, inherits_masses = false;
  template <class B>
  using Of = HimCycle<B>;
};

/// Every cycle there is. One more: its struct above or its own file, its name here.
using Cycles = TypeList<Single, Rs, Rv, Rsv, RsvSv, Fas, Him>;

}  // namespace plica
