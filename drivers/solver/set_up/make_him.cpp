// SPDX-License-Identifier: BSD-3-Clause
#include <plica/core/error.hpp>
#include <plica/core/text.hpp>
#include <plica/drivers/solver/cycles/him.hpp>
#include <plica/drivers/solver/set_up/make_him.hpp>
#include <plica/drivers/solver/set_up/to_device.hpp>

namespace plica {

namespace {

constexpr double automatic_step = 8;  // times the finest level's critical step

Eigen::MatrixXd on_vectors(const RowMatrix& A) {
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(3 * A.rows(), 3 * A.cols());
  for (Eigen::Index a = 0; a < A.rows(); ++a)
    for (RowMatrix::InnerIterator entry(A, a); entry; ++entry)
      for (int k = 0; k < 3; ++k) all(3 * a + k, 3 * entry.col() + k) = entry.value();
  return all;
}

void expect_small(const TetMesh& coarsest, std::size_t level) {
  const auto most = static_cast<std::size_t>(CoarseModes::most_unknowns / 3);
  if (coarsest.vertices.size() > most)
    throw InputError("cycle him answers its coarsest level by a dense matrix; level " + std::to_string(level) +
                     " has " + std::to_string(coarsest.vertices.size()) + " vertices, expected at most " +
                     std::to_string(most) + ": add a coarser level, of 200 to 350 vertices");
}

template <class B>
HimParts<B> him_parts(const Problem& problem, const std::vector<LevelConstants>& constants,
                      const std::vector<Embedding>& up, std::shared_ptr<const Elasticity<B>> elasticity,
                      std::shared_ptr<const Contact<B>> contact, const BuiltHierarchy<B>& built) {
  const auto& exec = built.hierarchy->exec();
  const Level<B>& finest = (*built.hierarchy)[0].level;
  const std::vector<TetMesh>& meshes = built.meshes;
  std::vector<MassMesh> spaces_of;
  for (std::size_t i = 0; i < meshes.size(); ++i) spaces_of.push_back({meshes[i], constants[i].constrained, up[i]});
  const auto spaces = mass_spaces(spaces_of, constants[0].mass, problem.integration.him.smoothing);
  HimParts<B> parts;
  parts.options = problem.integration.him;
  parts.inverse_mass = std::make_unique<InverseMass<B>>(finest, meshes.front(), meshes.back(), spaces);
  std::optional<CoarseModes> modes;
  if (!spaces.empty()) {
    std::vector<std::array<double, 2>> lame;
    for (const auto& one : constants[0].lame) lame.push_back({one.lambda, one.mu});
    modes.emplace(coarse_stiffness(meshes.front(), lame, to_finest(spaces)), on_vectors(spaces.back().mass));
  }
  parts.fitter =
      std::make_unique<InertiaFitter<B>>(exec, finest, std::move(elasticity), *parts.inverse_mass, std::move(modes));
  if (contact) parts.contact = std::make_unique<ContactResponse<B>>(std::move(contact), finest.model.vertices);
  bool free = true;
  for (const char constrained : constants[0].constrained) free = free && !constrained;
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
InertiaFit fit_step(const Problem& problem, HimParts<B>& parts, const Vectors<B>& u) {
  const double critical = parts.fitter->critical_steps().front(), sigma = parts.options.sigma;
  const bool coarse = parts.inverse_mass->levels() > 1;
  const double asked = problem.integration.macro_step.value_or((coarse ? automatic_step : sigma) * critical);
  for (double t = asked; t > 0.01 * critical; t /= 2)
    if (const auto fit = parts.fitter->fit(t, sigma, u)) {
      if (problem.integration.macro_step && t < asked) refuse_step(asked, t, critical);
      return *fit;
    }
  refuse_step(asked, 0, critical);
}

}  // namespace

template <class B>
std::unique_ptr<Cycle<B>> make_him(const Problem& problem, const std::vector<LevelConstants>& constants,
                                   const std::vector<Embedding>& up, std::shared_ptr<const Elasticity<B>> elasticity,
                                   std::shared_ptr<const Contact<B>> contact, BuiltHierarchy<B>& built) {
  if (built.meshes.size() > 1) expect_small(built.meshes.back(), built.meshes.size() - 1);
  HimParts<B> parts = him_parts<B>(problem, constants, up, std::move(elasticity), std::move(contact), built);
  parts.fit = fit_step<B>(problem, parts, (*built.hierarchy)[0].level.state.u);
  built.macro_step = parts.fit.step;
  for (std::size_t i = 0; i < built.reports.size(); ++i) {
    LevelReport& report = built.reports[i];
    report.inertia = parts.fit.inertia[i];
    report.explicit_integrator = false;  // no critical step limits it
    report.share = i == 0 ? 1 : 0, report.substeps = i == 0 ? 1 : 0;
    if (i > 0) report.integrator = "none";
    if (i < parts.fitter->critical_steps().size()) report.critical_step = parts.fitter->critical_steps()[i];
  }
  const int coarsest = built.reports.size() > 1 ? built.reports.back().vertices : 0;
  built.him = HimReport{parts.fit.product, parts.fit.bound, coarsest, 3 * coarsest <= CoarseModes::most_modes};
  return std::make_unique<HimCycle<B>>(*built.hierarchy, std::move(parts));
}

#define PLICA_INSTANTIATE(Real, Exec)                                                                              \
  template std::unique_ptr<Cycle<Backend<Real, Exec>>> make_him<Backend<Real, Exec>>(                              \
      const Problem&, const std::vector<LevelConstants>&, const std::vector<Embedding>&,                           \
      std::shared_ptr<const Elasticity<Backend<Real, Exec>>>, std::shared_ptr<const Contact<Backend<Real, Exec>>>, \
      BuiltHierarchy<Backend<Real, Exec>>&);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
