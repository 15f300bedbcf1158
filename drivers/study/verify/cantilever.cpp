// SPDX-License-Identifier: BSD-3-Clause
#include <numbers>
#include <plica/drivers/study/free_vibration.hpp>
#include <plica/drivers/study/sparse_stiffness.hpp>
#include <plica/drivers/study/verify/bodies.hpp>
#include <plica/drivers/study/verify/list.hpp>

namespace plica {

namespace {

constexpr double E = 1e7, rho = 1000, length = 1, side = 0.05, g = 0.1, load = 0.01;  // SI
constexpr double A = side * side, I = side * side * side * side / 12;

// Half of it, cut along the plane y = 0 in which it bends
Problem beam(int n, double nu) {
  Problem p = verify_body(box_mesh({{0, 0, 0}, {length, side / 2, side}}, {20 * n, n / 2, n}), {"linear", E, nu, rho});
  p.body.fixed = {HalfSpaceSelection{{0, 0, 0}, {1, 0, 0}}};
  p.body.loads = {{HalfSpaceSelection{{length, 0, 0}, {-1, 0, 0}}, Traction{{0, 0, -load / A}}, {}}};
  return p;
}

bool held(const Point& X, int axis) { return axis == 1 && X[1] < 1e-9; }

// A whole beam in motion beside its eigenvalue on the same mesh
VerifyRow from_its_motion(int n) {
  Problem p = verify_body(box_mesh({{0, 0, 0}, {length, side, side}}, {20 * n, n, n}), {"linear", E, 0.3, rho});
  p.body.fixed = {HalfSpaceSelection{{0, 0, 0}, {1, 0, 0}}};
  std::vector<Point> shape;
  for (const Point& X : p.body.levels[0].vertices) shape.emplace_back(0, 0, X[0] * X[0]);
  LevelProbe<HostBackend> probe(p);
  VerifyRow row{.quantity = "f1 from the tip's motion against the same mesh's eigenvalue, nu = 0.3", .unit = "Hz"};
  row.accepted = SparseStiffness(probe).lowest_frequency(shape);
  row.source = "inverse iteration with direct solves on this mesh";
  row.judged = Judged::finest, row.tolerance = 1e-3;
  row.add(cells_text(20 * n, n, n), 1, frequency_of_motion(p, shape, 1e-5, 3, *row.accepted));
  return row;
}

struct Theory {
  double tip, sag, frequency;
};

// Timoshenko's beam: the shear of a section of factor 5/6 beside Euler's and Bernoulli's bending
Theory theory(double nu) {
  const double shear = 5.0 / 6 * E / (2 * (1 + nu)) * A, beta = 1.8751;
  const double tip = load * std::pow(length, 3) / (3 * E * I), sag = rho * A * g * std::pow(length, 4) / (8 * E * I);
  return {tip + load * length / shear, sag + rho * A * g * length * length / (2 * shear),
          beta * beta / (2 * std::numbers::pi * length * length) * std::sqrt(E * I / (rho * A))};
}

VerifyRows rows_for(double nu, const VerifyContext& context) {
  const Theory want = theory(nu);
  const std::string of = nu == 0 ? ", nu = 0" : nu == 0.3 ? ", nu = 0.3" : ", nu = 0.45";
  VerifyRows rows = {{.quantity = "deflection under a load at the tip" + of, .unit = "m", .accepted = want.tip},
                     {.quantity = "deflection under its own weight" + of, .unit = "m", .accepted = want.sag},
                     {.quantity = "first bending frequency" + of, .unit = "Hz", .accepted = want.frequency}};
  rows[0].source = "PL^3/3EI + PL/kGA, k = 5/6 (Timoshenko, Strength of Materials, art. 39)";
  rows[1].source = "rho A g L^4/8EI + rho A g L^2/2kGA (the same)";
  rows[2].source = "1.8751^2/(2 pi L^2) sqrt(EI/rho A) (Timoshenko, Vibration Problems in Engineering)";
  for (VerifyRow& row : rows) row.judged = Judged::limit, row.tolerance = 0.015, row.power = -1;
  rows[2].power = 2;
  for (const int n : {2, 4, 8}) {
    context.proceed();
    const Problem p = beam(n, nu);
    const TetMesh& mesh = p.body.levels[0];
    LevelProbe<HostBackend> probe(p);
    const SparseStiffness K(probe, held);
    auto weight = probe.zero();
    const auto mass = probe.mass();
    for (std::size_t a = 0; a < weight.size(); ++a) weight[a] = {0, 0, -g * mass[a]};
    const std::size_t tip = vertex_at(mesh, {length, 0, side / 2});
    const std::string cells = cells_text(20 * n, n, n);
    rows[0].add(cells, 1.0 / n, -K.equilibrium(probe.force(probe.zero()))[tip][2]);
    rows[1].add(cells, 1.0 / n, -K.equilibrium(weight)[tip][2]);
    rows[2].add(cells, 1.0 / n, K.frequencies(1)[0]);
  }
  for (VerifyRow& row : rows) {
    const double off = std::abs(row.ours.back().value / *row.accepted - 1);
    row.note = "linear tetrahedra lock: " + std::to_string(std::lround(100 * off)) +
               " % off on the finest mesh; its stiffness is extrapolated";
  }
  rows[2].note += "; without the shear and rotary inertia of a real beam, 0.2 %";
  return rows;
}

}  // namespace

VerifyRows cantilever(const VerifyContext& context) {
  VerifyRows rows;
  for (const double nu : context.small ? std::vector{0.3} : std::vector{0.0, 0.3, 0.45})
    for (VerifyRow& row : rows_for(nu, context)) rows.push_back(std::move(row));
  context.proceed();
  rows.push_back(from_its_motion(context.small ? 2 : 3));
  for (VerifyRow& row : rows) {
    const double off = std::abs(row.ours.back().value / *row.accepted - 1);
    row.note = "linear tetrahedra lock: " + std::to_string(std::lround(100 * off)) +
               " % off on the finest mesh; its stiffness is extrapolated";
  }
  rows[2].note += "; without the shear and rotary inertia of a real beam, 0.2 %";
  return rows;
}

}  // namespace plica
