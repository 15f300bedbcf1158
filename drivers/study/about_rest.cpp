// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <limits>
#include <plica/drivers/solver/set_up/build_hierarchy.hpp>
#include <plica/drivers/solver/set_up/choose_cycle.hpp>
#include <plica/drivers/solver/set_up/validate.hpp>
#include <plica/drivers/study/about_rest.hpp>

namespace plica {

template <class B>
Problem about_rest(Problem p, const typename B::Exec& exec) {
  validate(p);
  p = with_choice(p, choose_cycle<B>(p, exec));
  p.integration.allow_unstable = true;
  const BuiltHierarchy<B> whole = build_hierarchy<B>(p, exec);
  p.integration.macro_step = whole.macro_step;
  p.integration.distribution = "custom", p.integration.shift_to_coarsest = 0;
  p.integration.shares.clear(), p.integration.substeps.clear();
  for (const LevelReport& level : whole.reports) {
    p.integration.shares.push_back(level.share);
    p.integration.substeps.push_back(level.substeps);
  }
  p.body.material.model = "linear";
  p.gravity = Point::Zero();
  p.contact.obstacles.clear(), p.body.surface.reset(), p.body.loads.clear();
  for (const PrescribedMotion& given : p.body.prescribed) p.body.fixed.push_back(given.where);
  p.body.prescribed.clear();
  p.body.initial = {};
  p.integration.switch_threshold =
      1e-3 * std::sqrt(std::numeric_limits<typename B::Real>::max());  // its square is finite
  p.integration.implicit = {.relative_residual = 1e-12};
  return p;
}

#define PLICA_INSTANTIATE(Real, Exec) template Problem about_rest<Backend<Real, Exec>>(Problem, const Exec&);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
