// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <plica/core/error.hpp>
#include <plica/core/text.hpp>
#include <plica/drivers/elastic/materials.hpp>
#include <plica/drivers/methods/integrators.hpp>
#include <plica/drivers/methods/methods.hpp>
#include <plica/drivers/run/simulation.hpp>
#include <plica/drivers/study/stability_matrix.hpp>
#include <plica/drivers/study/study_case.hpp>
#include <random>

// Runs the cases of the stability matrix, and checks that other descriptions of a body move alike.
namespace plica {

namespace {

using Sim = Simulation<Backend<double, Kokkos::DefaultExecutionSpace>>;

constexpr long look_every = 10;  // macro steps between two checks for finite values

bool all_finite(const std::vector<Point>& points) {
  return std::ranges::all_of(points, [](const Point& p) { return p.allFinite(); });
}

/// Returns whether all that a caller can write of level 0 is finite. The energy at time 0 is not
/// checked: a material may have none in the state that the caller sets.
bool writes_numbers(const Sim& simulation) {
  return (simulation.time() == 0 || std::isfinite(simulation.energies().total())) &&
         all_finite(simulation.positions()) && all_finite(simulation.velocities());
}

/// Returns whether a diagnosis says a place and a remedy, and is of a kind possible in this run.
bool is_sound(const Diagnosis& d, const Problem& p) {
  const bool all_explicit = std::ranges::all_of(p.integration.integrator, is_explicit);
  const bool possible = d.kind == "energy" || d.kind == "non_finite" || d.kind == "contact" ||
                        (d.kind == "speed" && all_explicit) ||
                        (d.kind == "inverted" && forbids_inversion(p.body.material.model)) ||
                        (d.kind == "stability" && p.integration.cycle == "him") ||
                        (d.kind == "solver" && !all_explicit);
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
    simulation.set_state(one.displacement,
                         std::vector<Point>(one.displacement.size(), Point::Zero()));
  row.outcome = "completed";
  for (long n = 1; n <= one.macro_steps; ++n) {
    if (const auto diagnosis = simulation.step_checked()) {
      row.outcome =
          is_sound(*diagnosis, one.problem) ? "stopped: " + diagnosis->kind : "no diagnosis";
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
  MatrixRow row{one.name, one.method, one.expected.text(), {}, false, {}, one.expected.why};
  try {
    run(one, row);
  } catch (const InputError& error) {
    row.outcome = "refused", row.detail = error.what();
  }
  const Expected& e = one.expected;
  row.ok = (e.complete && row.outcome == "completed") || (e.refuse && row.outcome == "refused") ||
           (e.stop && row.outcome.starts_with("stopped: ") &&
            (e.kind.empty() || row.outcome == "stopped: " + e.kind));
  return row;
}

MatrixResult run_matrix(const std::vector<MatrixCase>& cases,
                        const std::vector<std::function<MatrixRow()>>& more,
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

namespace {

constexpr long macro_steps = 100;

/// Another description of a body: its vertices are scale R x + shift, level 0's in another order.
struct Other {
  const char* name;
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Point shift = Point::Zero();
  double scale = 1;
  bool renumber = false;
};

std::vector<Other> others() {
  const Eigen::Matrix3d R = Eigen::AngleAxisd(1.1, Point(1, 2, -2) / 3).toRotationMatrix();
  return {{.name = "turned", .R = R},
          {.name = "moved by 1 km", .shift = {600, 0, -800}},
          {.name = "in millimetres", .scale = 1000},
          {.name = "renumbered", .renumber = true}};
}

/// Returns the new number of each vertex.
std::vector<int> shuffled(std::size_t count) {
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(3));
  return order;
}

TetMesh described(const TetMesh& mesh, const Other& other) {
  TetMesh result = mesh;
  const std::vector<int> order = shuffled(mesh.vertices.size());
  const auto at = [&](int v) { return other.renumber ? order[static_cast<std::size_t>(v)] : v; };
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    result.vertices[static_cast<std::size_t>(at(static_cast<int>(v)))] =
        other.scale * (other.R * mesh.vertices[v]) + other.shift;
  for (auto& tet : result.tets)
    for (int& v : tet) v = at(v);
  if (other.renumber) std::shuffle(result.tets.begin(), result.tets.end(), std::mt19937(4));
  return result;
}

/// Returns the problem in the other description. kg and s stay: stress scales with 1 / length,
/// density with 1 / length^3.
Problem described(const Problem& problem, const Other& other) {
  Problem p = problem;
  for (TetMesh& mesh : p.body.levels) mesh = described(mesh, other);
  p.body.material.young_modulus /= other.scale, p.body.material.density /= std::pow(other.scale, 3);
  p.gravity = other.scale * (other.R * p.gravity);
  const double slack = 1e-6 * other.scale;  // round-off of vertices on the plane
  const Point normal = other.R * Point::UnitX();
  p.body.fixed = {HalfSpaceSelection{other.shift + slack * normal, normal}};
  return p;
}

std::vector<Point> displacement_of(const Problem& problem) {
  Sim simulation(problem);
  for (long n = 0; n < macro_steps && !simulation.step_checked(); ++n) {
  }
  std::vector<Point> u = simulation.positions();
  for (std::size_t a = 0; a < u.size(); ++a) u[a] -= problem.body.levels.front().vertices[a];
  return u;
}

/// Returns the largest difference of displacements over the largest displacement.
double difference(const Problem& problem, const Other& other) {
  const std::vector<Point> u = displacement_of(problem),
                           w = displacement_of(described(problem, other));
  const std::vector<int> order = shuffled(u.size());
  double largest = 0, most = 0;
  for (std::size_t a = 0; a < u.size(); ++a) {
    const Point& same = w[other.renumber ? static_cast<std::size_t>(order[a]) : a];
    most = std::max(most, u[a].norm());
    largest = std::max(largest, (u[a] - other.R.transpose() * same / other.scale).norm());
  }
  return largest / most;
}

/// Returns the relative difference that rounding may cause. A position is rounded by eps times its
/// size, a strain by that over an edge. The compared motion has strains of 1e-2, and every step
/// adds the same error.
double allowed(const Other& other) {
  constexpr double edge = 0.05, strain = 1e-2;
  const double eps = std::numeric_limits<double>::epsilon();
  return eps * (other.shift.norm() + 1) / edge / strain * macro_steps;
}

/// Relative difference allowed for him and v_cycle_euler. him's inertia is fitted to a hundredth of
/// the largest eigenvalue. The search for it starts from a random vector, which depends on the
/// vertices' numbers and the axes of space. The inertia of details thus differs by about a
/// hundredth between descriptions. The smoothers of v_cycle_euler are fitted in this way too.
constexpr double allowed_of_fits = 1e-2;

MatrixRow compared(const std::string& material, const std::string& method, const Other& other) {
  MatrixBody body = clamped_beam();
  body.load_ratio = 1e-3;
  body.load();
  body.problem.body.material.model = material;
  Problem p = problem_of(body.problem, study_case(body.problem, {}, chosen_method(method)));
  const bool him = method == "cycle/him", fits = him || method == "single/v_cycle_euler";
  p.integration.macro_step = (him ? 8 : 0.9) * study_level(p, 0).critical_step;
  p.integration.allow_unstable = true;
  const double differs = difference(p, other), most = fits ? allowed_of_fits : allowed(other);
  const std::string outcome = "differs by " + number(differs, 2),
                    expected = "differs by at most " + number(most, 2);
  return {std::string(other.name) + ", " + material,
          method,
          expected,
          outcome,
          differs <= most,
          "",
          ""};
}

}  // namespace

std::vector<std::function<MatrixRow()>> invariance_cases(MatrixSize size) {
  const bool small = size == MatrixSize::small;
  std::vector<std::string> methods = {"cycle/rs/equal", "cycle/rsv/equal", "cycle/him"};
  for (const std::string& name : names(integrators()))
    Integrators::visit(name, [&](auto member) {
      using Kind = decltype(member);
      // an integrator that is unstable at every step multiplies rounding errors
      const bool steady = !Kind::is_explicit || Kind::limit.radius > 0;
      if (steady && (!small || name == "symplectic_euler")) methods.push_back("single/" + name);
    });
  std::vector<std::function<MatrixRow()>> cases;
  for (const Other& other : others())
    for (const std::string& material :
         small ? std::vector<std::string>{"neo_hookean"} : materials_of_two_constants())
      for (const std::string& method : methods)
        cases.push_back([=] { return compared(material, method, other); });
  return cases;
}

}  // namespace plica
