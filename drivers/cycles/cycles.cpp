// SPDX-License-Identifier: BSD-3-Clause
// Functions that make the cycles, by name.
#include <plica/drivers/cycles/fas.hpp>
#include <plica/drivers/cycles/v_cycle.hpp>

namespace plica {

namespace {

/// Returns a V-cycle with these mappings. Checks that the entry's needs are those of the mappings.
template <class B, class Entry, class Down, class Up>
std::unique_ptr<Stepper<B>> v_cycle() {
  static_assert(Entry::needs.drift_limits == ((Down::needs_state && Down::needs_variation) ||
                                              (Up::needs_state && Up::needs_variation)));
  return std::make_unique<VCycle<B, Down, Up>>();
}

}  // namespace

template <class B>
std::unique_ptr<Stepper<B>> Single::make() {
  return v_cycle<B, Single, MapState, MapState>();
}
template <class B>
std::unique_ptr<Stepper<B>> Rs::make() {
  return v_cycle<B, Rs, MapState, MapState>();
}
template <class B>
std::unique_ptr<Stepper<B>> Rv::make() {
  return v_cycle<B, Rv, MapVariation, MapVariation>();
}
template <class B>
std::unique_ptr<Stepper<B>> Rsv::make() {
  return v_cycle<B, Rsv, MapSwitched, MapSwitched>();
}
template <class B>
std::unique_ptr<Stepper<B>> RsvSv::make() {
  return v_cycle<B, RsvSv, MapState, MapVariation>();
}
template <class B>
std::unique_ptr<Stepper<B>> Fas::make() {
  return std::make_unique<FasCycle<B>>();
}

#define PLICA_INSTANTIATE(Real, Exec)                                                         \
  template std::unique_ptr<Stepper<Backend<Real, Exec>>> Single::make<Backend<Real, Exec>>(); \
  template std::unique_ptr<Stepper<Backend<Real, Exec>>> Rs::make<Backend<Real, Exec>>();     \
  template std::unique_ptr<Stepper<Backend<Real, Exec>>> Rv::make<Backend<Real, Exec>>();     \
  template std::unique_ptr<Stepper<Backend<Real, Exec>>> Rsv::make<Backend<Real, Exec>>();    \
  template std::unique_ptr<Stepper<Backend<Real, Exec>>> RsvSv::make<Backend<Real, Exec>>();  \
  template std::unique_ptr<Stepper<Backend<Real, Exec>>> Fas::make<Backend<Real, Exec>>();
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
