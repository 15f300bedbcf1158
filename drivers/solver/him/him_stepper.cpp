// SPDX-License-Identifier: BSD-3-Clause
#include <Kokkos_Profiling_ScopedRegion.hpp>
#include <algorithm>
#include <plica/core/error.hpp>
#include <plica/core/text.hpp>
#include <plica/drivers/solver/him/him_stepper.hpp>
#include <plica/drivers/solver/set_up/to_device.hpp>
#include <plica/drivers/solver/spaces/coarse_spaces.hpp>
#include <plica/drivers/solver/spaces/coarse_stiffness.hpp>

namespace plica {

namespace {

// Times the critical step of the finest level; over spaces made of it, slivers left out
constexpr double automatic_step = 8, step_with_contact = 4;
/// The largest t^2 lambda_max(A K) of steps that are given back: half way from that at rest to where WatchSpectrum reports it.
double steady_product(double sigma) { return (4 * sigma * sigma + 3.4) / 2; }

void expect_small(const TetMesh& coarsest, std::size_t level) {
  const auto most = static_cast<std::size_t>(CoarseModes::most_unknowns / 3);
  if (coarsest.vertices.size() > most)
    throw InputError("cycle him solves its coarsest level by a dense matrix; level " + std::to_string(level) + " has " +
                     std::to_string(coarsest.vertices.size()) + " vertices, expected at most " + std::to_string(most) +
                     ": add a coarser level, of 200 to 350 vertices");
}

template <class B>
LevelsBelow coarser_levels(const StepperSetup<B>& setup, const BlockRows& K) {
  std::vector<RestLevel> levels;
  for (std::size_t i = 0; i < setup.meshes.size(); ++i)
    levels.push_back({setup.meshes[i], setup.constants[i].constrained, i > 0 ? &setup.up[i] : nullptr});
  SpaceOptions options{.sizes = {}, .slivers = true};
  if (levels.size() == 1)
    options.sizes = space_sizes(setup.problem.body, setup.constants[0].constrained,
                                setup.contact ? him_sizes_with_contact : him_sizes);
  return levels_below(levels, setup.constants[0].mass, K, options, setup.problem.integration.him.smoothing);
}

/// What the reports say of spaces: they have no elements. They come below the finest level, above coarser meshes.
void report_spaces(const std::vector<CoarseSpace>& made, std::vector<LevelReport>& reports) {
  auto place = reports.begin();
  for (const CoarseSpace& space : made) {
    place = reports.emplace(place + 1);
    LevelReport& report = *place;
    report.kind = space.slivers ? LevelKind::slivers : LevelKind::space;
    report.vertices = static_cast<int>(space.points.size());
    report.mean_edge = space.spacing;
    report.nonzeros = static_cast<double>(space.up.nonZeros()) / static_cast<double>(space.up.rows());
    report.element = "none";
  }
}

template <class B>
HimParts<B> him_parts(StepperSetup<B>& setup) {
  const auto& exec = setup.hierarchy.exec();
  const Level<B>& finest = setup.hierarchy[0];
  const std::vector<TetMesh>& meshes = setup.meshes;
  const LevelConstants& constants = setup.constants[0];
  std::vector<std::array<double, 2>> lame;
  for (const auto& one : constants.lame) lame.push_back({one.lambda, one.mu});
  const LevelsBelow coarser = coarser_levels<B>(setup, rest_stiffness(meshes.front(), lame));
  report_spaces(coarser.made, setup.reports);
  const auto spaces = mass_spaces(coarser.transfers, constants.mass);
  HimParts<B> parts;
  parts.options = setup.problem.integration.him;
  parts.detail = meshes.size() == 1 && !coarser.made.empty() && coarser.made.front().slivers;
  std::optional<CoarseModes> modes;
  AxesShape axes;
  if (!spaces.empty()) {
    const RowMatrix whole = to_finest(spaces);
    modes.emplace(coarse_stiffness(meshes.front(), lame, whole), spaces.back().mass);
    axes = meshes.size() > 1 ? axes_of_mesh(meshes.front(), meshes.back(), constants.mass)
                             : axes_of_space(meshes.front(), whole, constants.mass);
  }
  parts.inverse_mass = std::make_unique<InverseMass<B>>(finest, spaces, axes);
  parts.fitter = std::make_unique<InertiaFitter<B>>(exec, finest, setup.elasticity, setup.eigenvalue,
                                                    *parts.inverse_mass, std::move(modes));
  if (setup.contact) {
    const auto n = static_cast<std::size_t>(finest.model.vertices);
    parts.contact_force = zeros<Vectors<B>>("plica::him.contact_force", n);
    parts.contact_answer = zeros<Vectors<B>>("plica::him.contact_answer", n);
  }
  const bool free = std::ranges::count(constants.constrained, 1) == 0;
  if (free && !spaces.empty()) {
    const Box box = bounding_box(meshes.front().vertices);
    std::vector<Point> rest = meshes.front().vertices;
    for (Point& p : rest) p -= (box.min + box.max) / 2;
    parts.free.emplace(to_device<Vectors<B>>("him.rest", rows<typename B::Real>(rest)));
  }
  return parts;
}

[[noreturn]] void refuse_step(double t, double fits, double critical) {
  throw InputError(text("integration.macro_step ", number(t, 4), " s is ", number(t / critical, 3),
                        " times the finest level's critical step ", number(critical, 4),
                        " s, and no inertia makes it stable in cycle him; expected at most about ", number(fits, 3),
                        " s, or a finer coarsest level"));
}

/// The fit to the scene's macro step, or to the longest that it takes by itself.
template <class B>
InertiaFit fit_step(const StepperSetup<B>& setup, HimParts<B>& parts) {
  const std::optional<double>& given = setup.problem.integration.macro_step;
  const Vectors<B>& u = setup.hierarchy[0].state.u;
  const double critical = parts.fitter->critical_steps()[parts.detail], sigma = parts.options.sigma;
  const bool coarse = parts.inverse_mass->levels() > 1;
  const double usual = setup.contact ? step_with_contact : automatic_step;
  const double asked = given.value_or((coarse ? usual : sigma) * critical);
  for (double t = asked; t > 0.01 * std::min(asked, critical); t /= 2)
    if (const auto fit = parts.fitter->fit(t, sigma, u)) {
      if (given && t < asked) refuse_step(asked, t, setup.reports.front().critical_step);
      return *fit;
    }
  refuse_step(asked, 0, setup.reports.front().critical_step);
}

}  // namespace

template <class B>
void HimStepper<B>::plan(StepperSetup<B>& setup) {
  if (setup.meshes.size() > 1) expect_small(setup.meshes.back(), setup.meshes.size() - 1);
  may_repair_ = setup.problem.integration.on_failure.halvings == FailureOptions::automatic;
  HimParts<B> parts = him_parts<B>(setup);
  parts.fit = fit_step<B>(setup, parts);
  take(setup.hierarchy, std::move(parts));
  setup.macro_step = parts_.fit.step;
  const std::vector<double>& own = parts_.fitter->critical_steps();
  for (std::size_t i = 0; i < setup.reports.size(); ++i) {
    LevelReport& report = setup.reports[i];
    report.inertia = parts_.fit.inertia[i];
    report.explicit_integrator = false;  // no critical step limits it
    report.share = i == 0 ? 1 : 0, report.substeps = i == 0 ? 1 : 0;
    if (i > 0) report.integrator = "none";
    if (i < own.size()) report.detail_step = own[i];
  }
  const int coarsest = setup.reports.size() > 1 ? setup.reports.back().vertices : 0;
  setup.him = HimReport{parts_.fit.product, parts_.fit.bound, coarsest, 3 * coarsest <= CoarseModes::most_modes};
}

template <class B>
void HimStepper<B>::take(const Hierarchy<B>& h, HimParts<B>&& parts) {
  parts_ = std::move(parts);
  scale_at(0) = parts_.fit.scale;
  n_ = h[0].model.vertices;
  p_ = Vectors<B>("plica::him.p", n_), g_ = Vectors<B>("plica::him.g", n_), a_ = Vectors<B>("plica::him.a", n_);
  f_before_ = Vectors<B>("plica::him.f_before", n_), a_before_ = Vectors<B>("plica::him.a_before", n_);
  blocks_ = BlockSums<B>(n_);
  contact_ = {parts_.contact_force, h[0].response().records().touching};
  turned_ = Count("plica::him.turned", 1), sums_ = Count("plica::him.sums", 2), watch_ = Count("plica::him.watch", 3);
}

template <class B>
bool HimStepper<B>::repair(Hierarchy<B>& h, double t) {
  ++repairs_;
  regaining_.cut();
  for (int next = halvings_ + 1; next <= most_halvings; ++next)
    if (const auto fit = parts_.fitter->fit(t / (1 << next), parts_.options.sigma, h[0].state.u)) {
      parts_.fit = *fit;
      halvings_ = next, scale_at(next) = fit->scale;
      begin(h);
      return true;
    }
  use(t);
  return false;
}

template <class B>
void HimStepper<B>::lengthen(Hierarchy<B>& h, double t, long steps) {
  if (halvings_ == 0 || !regaining_.due(steps)) return;
  const double sigma = parts_.options.sigma;
  int fitting = halvings_;
  for (int next = fitting - 1; next >= 0; --next) {
    if (scale_at(next) == 0) continue;
    const double step = t / (1 << next);
    parts_.fitter->use(step, sigma, scale_at(next));
    if (parts_.fitter->product(step, h[0].state.u) > steady_product(sigma)) break;
    fitting = next;
  }
  const bool longer = fitting < halvings_;
  regaining_.tried(steps, longer);
  halvings_ = fitting;
  use(t);
  if (longer) begin(h);
}

template <class B>
std::unique_ptr<Stepper<B>> Him::make() {
  return std::make_unique<HimStepper<B>>();
}

#define PLICA_INSTANTIATE(Real, Exec)             \
  template class HimStepper<Backend<Real, Exec>>; \
  template std::unique_ptr<Stepper<Backend<Real, Exec>>> Him::make<Backend<Real, Exec>>();
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
