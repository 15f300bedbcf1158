// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Eigenvalues>
#include <cmath>
#include <plica/drivers/study/largest_stable.hpp>
#include <plica/drivers/study/level_probe.hpp>
#include <plica/drivers/study/small_motion.hpp>
#include <plica/drivers/study/sparse_stiffness.hpp>
#include <plica/drivers/study/verify/bodies.hpp>
#include <plica/drivers/study/verify/list.hpp>

namespace plica {

namespace {

Problem at_any_step(int cells, const std::string& integrator) {
  Problem p = irregular_cube("linear", cells);
  p.integration.integrator = {integrator};
  p.integration.substeps = {1}, p.integration.allow_unstable = true, p.integration.macro_step = 1e-7;
  return p;
}

// From the dense matrix M^-1/2 K M^-1/2
VerifyRow against_eigenvalues(int cells) {
  LevelProbe<HostBackend> probe(at_any_step(cells, "symplectic_euler"));
  const Eigen::MatrixXd S = probe.scaled_by_mass(probe.stiffness_matrix(probe.zero()));
  const double w2 = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(S, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff();
  VerifyRow row{.quantity = "predicted critical step, symplectic_euler", .unit = "s", .accepted = 2 / std::sqrt(w2)};
  row.source = "2/w_max, dense eigenvalues of the same matrices (Hughes, The Finite Element Method, 9.2)";
  row.judged = Judged::finest, row.tolerance = 0.02;
  row.note = "on the sure side by up to 1e-3, which is added to the eigenvalue";
  row.add(cells_text(cells, cells, cells) + ", irregular", 1, probe.built.reports[0].critical_step);
  return row;
}

VerifyRow against_runs(const std::string& integrator, double predicted, int cells) {
  const auto stable = [&](double t) {
    Problem p = at_any_step(cells, integrator);
    p.integration.macro_step = t;
    auto built = build_hierarchy<HostBackend>(p, {});
    return small_motion(built, t, {2000, {}}).bounded;
  };
  VerifyRow row{.quantity = "largest stable step of runs, " + integrator, .unit = "s", .accepted = predicted};
  row.source = "its own prediction before the run; the scalar test equation (Hairer & Wanner, Solving ODEs II, IV.2)";
  row.judged = Judged::finest, row.tolerance = 0.02;
  const LargestStep found = largest_stable({0.97 * predicted, 0.5 * predicted, 2 * predicted, 1.02, 0.002}, stable);
  row.add(cells_text(cells, cells, cells) + ", irregular", 1, found.step);
  return row;
}

}  // namespace

VerifyRows critical_steps(const VerifyContext& context) {
  const int cells = context.small ? 3 : 4;
  context.proceed();
  VerifyRows rows = {against_eigenvalues(cells)};
  for (const std::string& integrator : names(integrators())) {
    context.proceed();
    const LevelReport report = LevelProbe<HostBackend>(at_any_step(cells, integrator)).built.reports[0];
    if (report.explicit_integrator && report.critical_step > 0)  // euler has none without damping
      rows.push_back(against_runs(integrator, report.critical_step, cells));
  }
  return rows;
}

}  // namespace plica
