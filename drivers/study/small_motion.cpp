// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <plica/core/to_device.hpp>
#include <plica/drivers/run/build_hierarchy.hpp>
#include <plica/drivers/run/energy_meter.hpp>
#include <plica/drivers/run/validate.hpp>
#include <plica/drivers/study/small_motion.hpp>
#include <random>

namespace plica {

template <class B>
Problem about_rest(Problem p, const typename B::Exec& exec) {
  validate(p);
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
  remove_contact(p), p.body.loads.clear();
  for (const PrescribedMotion& given : p.body.prescribed) p.body.fixed.push_back(given.where);
  p.body.prescribed.clear();
  p.body.initial = {};
  p.integration.switch_threshold =
      1e-3 * std::sqrt(std::numeric_limits<typename B::Real>::max());  // finite square
  p.integration.implicit = {.relative_residual = 1e-12};
  return p;
}

namespace {

// largest energy of the last quarter over the first for which a motion is bounded
constexpr double largest_energy_ratio = 10;
// energy over that at the start above which a motion is surely unbounded
constexpr double hopeless = 1e12;
constexpr double amplitude = 1e-6;  // motion per macro step over the mean edge
constexpr double quarters = 0.75;   // part of a run from its first quarter to its last

/// Removes translation and rotation from the velocities of a body without fixed vertices. Rigid
/// drift is no growth, but mappings between meshes make some strain of it.
void take_rigid(const std::vector<Point>& x, const std::vector<double>& mass,
                std::vector<Point>& v) {
  double whole = 0;
  Point centre = Point::Zero(), momentum = Point::Zero(), spin = Point::Zero();
  for (std::size_t a = 0; a < x.size(); ++a)
    whole += mass[a], centre += mass[a] * x[a], momentum += mass[a] * v[a];
  centre /= whole, momentum /= whole;
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  for (std::size_t a = 0; a < x.size(); ++a) {
    const Point r = x[a] - centre;
    spin += mass[a] * r.cross(v[a]);
    inertia += mass[a] * (r.squaredNorm() * Eigen::Matrix3d::Identity() - r * r.transpose());
  }
  const Point omega = inertia.ldlt().solve(spin);
  for (std::size_t a = 0; a < x.size(); ++a) v[a] -= momentum + omega.cross(x[a] - centre);
}

template <class B>
void start(BuiltHierarchy<B>& built, double t) {
  Hierarchy<B>& hierarchy = *built.hierarchy;
  const LevelData<B>& level = hierarchy[0];
  hierarchy.exec().fence("plica::small_motion");
  const auto inverse =
      Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), level.model.inverse_mass);
  const double speed = amplitude * built.reports.front().mean_edge / t;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> within(-speed, speed);
  std::vector<Point> velocity(inverse.extent(0), Point::Zero());
  std::vector<double> mass;
  for (std::size_t a = 0; a < velocity.size(); ++a) {
    for (int k = 0; k < 3 && inverse(a) > 0; ++k) velocity[a][k] = within(random);
    if (inverse(a) > 0) mass.push_back(1 / static_cast<double>(inverse(a)));
  }
  if (mass.size() == velocity.size()) take_rigid(built.meshes.front().vertices, mass, velocity);
  copy(hierarchy.exec(), level.state.v,
       to_device<Vectors<B>>("start", rows<typename B::Real>(velocity)));
  fill(hierarchy.exec(), level.state.u, 0);
  for (auto& part : hierarchy.levels) part.integrator->reset_history();
  built.stepper->begin(hierarchy);
}

}  // namespace

double visible_growth(double modes, long macro_steps) {
  return std::log(largest_energy_ratio * modes) / (2 * quarters * static_cast<double>(macro_steps));
}

template <class B>
SmallMotion small_motion(BuiltHierarchy<B>& built, double t, const SmallMotionOptions& options) {
  start(built, t);
  Hierarchy<B>& hierarchy = *built.hierarchy;
  const EnergyMeter<B> meter(hierarchy, built.meshes.front(), built.reports.front().mass,
                             Point::Zero());
  const long n = options.macro_steps;
  double first = meter.all(0).total(), last = 0;
  const double at_start = first;
  SmallMotion found;
  for (long i = 1; i <= n; ++i) {
    for (auto& part : hierarchy.levels) part.begin_macro_step();
    built.stepper->step(hierarchy, 0, t);
    const double energy = meter.all(0).total();
    if (!(energy <= hopeless * at_start))
      return {false, false, std::numeric_limits<double>::infinity()};
    if (4 * i <= n) first = std::max(first, energy);
    if (4 * i > 3 * n) last = std::max(last, energy);
    if (options.go_on && !options.go_on()) return {true, true, 0};
  }
  found.bounded = last <= largest_energy_ratio * first;
  if (last > 0 && first > 0)
    found.growth = std::log(last / first) / (2 * quarters * static_cast<double>(n));
  return found;
}

#define PLICA_INSTANTIATE(Real, Exec)                                             \
  template Problem about_rest<Backend<Real, Exec>>(Problem, const Exec&);         \
  template SmallMotion small_motion(BuiltHierarchy<Backend<Real, Exec>>&, double, \
                                    const SmallMotionOptions&);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
