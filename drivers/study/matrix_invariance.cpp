// SPDX-License-Identifier: BSD-3-Clause
// Bodies described in other words must move alike.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <plica/core/text.hpp>
#include <plica/drivers/solver/integrators/list.hpp>
#include <plica/drivers/solver/registry.hpp>
#include <plica/drivers/solver/simulation.hpp>
#include <plica/drivers/study/matrix_bodies.hpp>
#include <plica/drivers/study/stability_matrix.hpp>
#include <plica/drivers/study/study_methods.hpp>
#include <random>

namespace plica {

namespace {

using Sim = Simulation<Backend<double, Kokkos::DefaultExecutionSpace>>;

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

/// new number of each vertex
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

/// kg and s stay: stress is per length, density per its cube.
Problem described(const Problem& problem, const Other& other) {
  Problem p = problem;
  for (TetMesh& mesh : p.body.levels) mesh = described(mesh, other);
  p.body.material.young_modulus /= other.scale, p.body.material.density /= std::pow(other.scale, 3);
  p.gravity = other.scale * (other.R * p.gravity);
  const double slack = 1e-6 * other.scale;  // the plane through vertices that round-off has moved
  const Point normal = other.R * Point::UnitX();
  p.body.fixed = {HalfSpaceSelection{other.shift + slack * normal, normal}};
  return p;
}

std::vector<Point> displacement_of(const Problem& problem) {
  Sim simulation(problem);
  for (long n = 0; n < macro_steps && !simulation.check(); ++n) simulation.step();
  std::vector<Point> u = simulation.positions();
  for (std::size_t a = 0; a < u.size(); ++a) u[a] -= problem.body.levels.front().vertices[a];
  return u;
}

/// The largest difference over the largest displacement.
double difference(const Problem& problem, const Other& other) {
  const std::vector<Point> u = displacement_of(problem), w = displacement_of(described(problem, other));
  const std::vector<int> order = shuffled(u.size());
  double largest = 0, most = 0;
  for (std::size_t a = 0; a < u.size(); ++a) {
    const Point& same = w[other.renumber ? static_cast<std::size_t>(order[a]) : a];
    most = std::max(most, u[a].norm());
    largest = std::max(largest, (u[a] - other.R.transpose() * same / other.scale).norm());
  }
  return largest / most;
}

/// What rounding may come to. Each position is rounded by eps times its size, a strain by that over an edge, and the motion compared is of
/// strains of 1e-2: so much per step, and every step adds to it.
double allowed(const Other& other) {
  constexpr double edge = 0.05, strain = 1e-2;
  const double eps = std::numeric_limits<double>::epsilon();
  return eps * (other.shift.norm() + 1) / edge / strain * macro_steps;
}

/// him's inertia is fitted to a hundredth of the largest eigenvalue, which is looked for from a random vector that goes by the
/// vertices' numbers and the axes of space: details move with another inertia by about as much. So are the smoothers of the one
/// cycle that v_cycle_euler answers with.
constexpr double allowed_of_fits = 1e-2;

MatrixRow compared(const std::string& material, const std::string& method, const Other& other) {
  MatrixBody body = clamped_beam();
  body.load_ratio = 1e-3;
  body.load();
  body.problem.body.material.model = material;
  const std::size_t second = method.find('/', method.find('/') + 1);
  const std::string shares = second == std::string::npos ? "" : method.substr(second + 1);
  const StudyCase one = study_case(body.problem, {}, {method.substr(0, second), shares, ""});
  Problem p = problem_of(body.problem, one);
  const bool him = method == "cycle/him", fits = him || method == "single/v_cycle_euler";
  p.integration.macro_step = (him ? 8 : 0.9) * study_level(p, 0).critical_step;
  p.integration.allow_unstable = true;
  const double differs = difference(p, other), most = fits ? allowed_of_fits : allowed(other);
  const std::string outcome = "differs by " + number(differs, 2), expected = "differs by at most " + number(most, 2);
  return {std::string(other.name) + ", " + material, method, expected, outcome, differs <= most, ""};
}

}  // namespace

std::vector<std::function<MatrixRow()>> invariance_cases(MatrixSize size) {
  const bool small = size == MatrixSize::small;
  std::vector<std::string> methods = {"cycle/rs/equal", "cycle/rsv/equal", "cycle/him"};
  for (const std::string& name : names(integrators()))
    Integrators::visit(name, [&](auto member) {
      using Kind = decltype(member);
      const bool steady = !Kind::is_explicit || Kind::limit.radius > 0;  // what grows at every step multiplies rounding
      if (steady && (!small || name == "symplectic_euler")) methods.push_back("single/" + name);
    });
  std::vector<std::function<MatrixRow()>> cases;
  for (const Other& other : others())
    for (const std::string& material : small ? std::vector<std::string>{"neo_hookean"} : names(materials()))
      for (const std::string& method : methods) cases.push_back([=] { return compared(material, method, other); });
  return cases;
}

}  // namespace plica
