// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <plica/core/error.hpp>
#include <plica/drivers/solver/integrators/list.hpp>
#include <plica/drivers/solver/materials.hpp>
#include <plica/drivers/solver/simulation.hpp>
#include <plica/drivers/study/stability_matrix.hpp>
#include <plica/drivers/study/study_case.hpp>

namespace plica {

namespace {

using Sim = Simulation<Backend<double, Kokkos::DefaultExecutionSpace>>;

constexpr long look_every = 10;  // macro steps

bool all_finite(const std::vector<Point>& points) {
  return std::ranges::all_of(points, [](const Point& p) { return p.allFinite(); });
}

/// What a caller can write of level 0. The state that the caller put in is his own: a material may have no energy there.
bool writes_numbers(const Sim& simulation) {
  return (simulation.time() == 0 || std::isfinite(simulation.energies().total())) &&
         all_finite(simulation.positions()) && all_finite(simulation.velocities());
}

/// Whether a diagnosis says where and what to do, and is of a kind that this run can come to.
bool is_sound(const Diagnosis& d, const Problem& p) {
  bool is_explicit = true;
  for (const std::string& name : p.integration.integrator)
    Integrators::visit(name, [&](auto member) { is_explicit = is_explicit && decltype(member)::is_explicit; });
  const bool possible = d.kind == "energy" || d.kind == "non_finite" || d.kind == "contact" ||
                        (d.kind == "speed" && is_explicit) ||
                        (d.kind == "inverted" && forbids_inversion(p.body.material.model)) ||
                        (d.kind == "stability" && p.integration.cycle == "him") || (d.kind == "solver" && !is_explicit);
  return possible && d.level >= 0 && (d.element >= 0 || d.vertex >= 0) && std::isfinite(d.J) &&
         std::isfinite(d.substep_over_critical) && !d.remedy.empty() && !d.text().empty();
}

double critical_step_of(Problem p) {
  p.integration.macro_step = study_level(p, 0).critical_step, p.integration.allow_unstable = true;
  return Sim(p).levels().front().critical_step;
}

void run(const MatrixCase& one, MatrixRow& row) {
  Problem problem = one.problem;
  if (one.step > 0) problem.integration.macro_step = one.step * critical_step_of(problem);
  Sim simulation(problem);
  if (!one.displacement.empty())
    simulation.set_state(one.displacement, std::vector<Point>(one.displacement.size(), Point::Zero()));
  row.outcome = "completed";
  for (long n = 1; n <= one.macro_steps; ++n) {
    simulation.step();
    if (const auto diagnosis = simulation.check()) {
      row.outcome = is_sound(*diagnosis, one.problem) ? "stopped: " + diagnosis->kind : "no diagnosis";
      row.detail = diagnosis->text();
      simulation.return_to_last_good();
      break;
    }
    if (n % look_every == 0 && !writes_numbers(simulation)) break;
  }
  if (!writes_numbers(simulation)) row.outcome = "not finite";
}

}  // namespace

bool forbids_inversion(const std::string& material) {
  const MaterialInfo* info = find_material(material);
  return info != nullptr && !info->allows_inversion;
}

bool MatrixResult::ok() const {
  return std::ranges::all_of(rows, [](const MatrixRow& row) { return row.ok; });
}

MatrixRow run_case(const MatrixCase& one) {
  MatrixRow row{one.name, one.method, one.expected.text(), {}, false, {}};
  try {
    run(one, row);
  } catch (const InputError& error) {
    row.outcome = "refused", row.detail = error.what();
  }
  const Expected& e = one.expected;
  row.ok = (e.complete && row.outcome == "completed") || (e.refuse && row.outcome == "refused") ||
           (e.stop && row.outcome.starts_with("stopped: ") && (e.kind.empty() || row.outcome == "stopped: " + e.kind));
  return row;
}

MatrixResult run_matrix(const std::vector<MatrixCase>& cases, const std::vector<std::function<MatrixRow()>>& more,
                        const MatrixWatch& watch) {
  MatrixResult result;
  const std::size_t all = cases.size() + more.size();
  for (std::size_t i = 0; i < all && !result.stopped; ++i) {
    result.rows.push_back(i < cases.size() ? run_case(cases[i]) : more[i - cases.size()]());
    result.stopped = watch && !watch(result, all);
  }
  result.left_out = all - result.rows.size();
  return result;
}

}  // namespace plica
