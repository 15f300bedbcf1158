// SPDX-License-Identifier: BSD-3-Clause
#include <numbers>
#include <plica/core/text.hpp>
#include <plica/drivers/elastic/materials.hpp>
#include <plica/drivers/study/direct_solves.hpp>
#include <plica/drivers/study/sample_bodies.hpp>
#include <plica/drivers/study/verify/box_meshes.hpp>
#include <plica/drivers/study/verify/list.hpp>
#include <plica/kernels/materials/linear.hpp>
#include <plica/meshes/generators.hpp>

namespace plica {

namespace {
namespace cube {

// First elastic frequencies of a free cube with E 1 Pa, nu 0.499, 1 kg/m^3, 1 m [Hz]. Ritz' method
// with polynomials to degree 13, which changes the last frequency by 1e-4 from degree 12 (Demarest,
// J. Acoust. Soc. Am. 49, 1971; Visscher, Migliori, Bell & Reinert, J. Acoust. Soc. Am. 90, 1991)
constexpr double accepted[] = {0.26260, 0.26260, 0.35744, 0.35744, 0.35744, 0.36062, 0.36062,
                               0.36062, 0.40838, 0.40838, 0.40838, 0.46168, 0.46168, 0.46168,
                               0.46365, 0.46365, 0.46365, 0.50747, 0.50747, 0.50747};
constexpr const char* source =
    "Ritz' method, polynomials to degree 13 (Demarest, J. Acoust. Soc. Am. 49, 1971; Visscher et "
    "al., same 90, 1991)";

// Returns the first `count` frequencies of the cube [Hz], without those of rigid motion
std::vector<double> frequencies(const std::string& element, const std::string& kind, int n,
                                int count) {
  // [1/s^2], of the order of the lowest eigenvalue: makes the matrix of the free body definite
  constexpr double shift = 1;
  Problem p = verify_body(box_of(kind, {{0, 0, 0}, {1, 1, 1}}, {n, n, n}), {"linear", 1, 0.499, 1});
  p.body.element = {element};
  LevelProbe<HostBackend> probe(p);
  std::vector<double> f = SparseStiffness(probe).frequencies(6 + count, shift);
  std::erase_if(f, [](double one) { return one < 1e-3; });
  return f;
}

}  // namespace cube
}  // namespace

VerifyRows free_cube(const VerifyContext& context) {
  VerifyRows rows;
  const auto row_of = [](const std::string& element, const std::string& kind) {
    VerifyRow row{.quantity = "first elastic frequency, E 1 Pa, nu 0.499, 1 kg/m^3, 1 m",
                  .unit = "Hz"};
    row.element = element, row.mesh = kind, row.accepted = cube::accepted[0],
    row.source = cube::source, row.power = 2;
    return row;
  };
  for (const std::string kind : {"regular", "delaunay"}) {
    VerifyRow row = row_of("linear", kind);
    row.judged = kind == "regular" ? Judged::above : Judged::nothing;
    for (const int n : kind == "regular" ? context.refined(4) : std::vector{4, 6}) {
      context.proceed();
      row.add(cells_text(n, n, n), 1.0 / n, cube::frequencies("linear", kind, n, 1).at(0));
    }
    const int percent =
        static_cast<int>(std::lround(100 * (row.ours.back().value / *row.accepted - 1)));
    row.note = text("volumetric locking of linear tetrahedra: ", percent,
                    " % too high on the finest mesh");
    rows.push_back(row);
  }
  for (const std::string kind : mesh_kinds) {
    VerifyRow first = row_of("nodal", kind), all = row_of("nodal", kind);
    first.judged = Judged::finest, first.tolerance = context.small ? 0.06 : 0.04;
    all.quantity = "first 20 elastic frequencies: furthest from the accepted ones, relative",
    all.unit = "1";
    all.accepted.reset(), all.judged = Judged::size, all.tolerance = 0.2;
    all.note = "with a mode that the continuum has not, all above it would be off";
    for (const int n : context.small ? std::vector{4} : std::vector{4, 6}) {
      context.proceed();
      const auto f =
          cube::frequencies("nodal", kind, n, static_cast<int>(std::size(cube::accepted)));
      double worst = 0;
      for (std::size_t k = 0; k < std::size(cube::accepted); ++k)
        worst = std::max(worst, std::abs(f.at(k) / cube::accepted[k] - 1));
      first.add(cells_text(n, n, n), 1.0 / n, f.at(0)),
          all.add(cells_text(n, n, n), 1.0 / n, worst);
    }
    rows.push_back(first), rows.push_back(all);
  }
  return rows;
}

// Solves half the thickness of the membrane, with one layer of cells. The middle plane does not
// bend and the surface is free, which is plane stress.
VerifyRows tapered_membrane(const VerifyContext& context) {
  constexpr double accepted[] = {44.623, 130.03, 162.70, 246.05, 379.90, 391.44};
  VerifyRows rows;
  for (std::size_t k = 0; k < std::size(accepted); ++k) {
    VerifyRow row{.quantity = "in-plane frequency " + std::to_string(k + 1),
                  .unit = "Hz",
                  .accepted = accepted[k]};
    row.source = "NAFEMS, Selected Benchmarks for Natural Frequency Analysis, test FV32";
    row.judged = Judged::finest, row.tolerance = context.small ? 0.01 : 0.005;
    rows.push_back(row);
  }
  for (const int n : context.refined(8)) {
    context.proceed();
    TetMesh mesh = grid_mesh({2 * n, n, 1}, {false, true, false}, [](const Point& s) {
      return Point(10 * s[0], (5 - 4 * s[0]) * (s[1] - 0.5), 0.025 * s[2]);
    });
    Problem p = verify_body(std::move(mesh), {"linear", 200e9, 0.3, 8000});
    p.body.fixed = {HalfSpaceSelection{{0, 0, 0}, {1, 0, 0}}};
    LevelProbe<HostBackend> probe(p);
    const auto f = SparseStiffness(probe, [](const Point& X, int axis) {
                     return axis == 2 && X[2] < 1e-9;
                   }).frequencies(6);
    for (std::size_t k = 0; k < rows.size(); ++k)
      rows[k].add(cells_text(2 * n, n, 1), 1.0 / n, f[k]);
  }
  return rows;
}

namespace {
namespace axial {

constexpr double E = 1e5, rho = 1000, length = 0.4, width = 0.02;

double accepted(int k) { return (2 * k - 1) / (4 * length) * std::sqrt(E / rho); }

Problem bar(int n) {
  Problem p =
      verify_body(box_mesh({{0, 0, 0}, {length, width, width}}, {n, 2, 2}), {"linear", E, 0, rho});
  p.body.fixed = {HalfSpaceSelection{{0, 0, 0}, {1, 0, 0}}};
  return p;
}

}  // namespace axial
}  // namespace

// Solves a bar with nu = 0. Without lateral strain its axial motion is along the axis alone. Motion
// across the axis is fixed, which excludes bending.
VerifyRows axial_bar(const VerifyContext& context) {
  using namespace axial;
  constexpr const char* source =
      "(2k - 1)/4L sqrt(E/rho) (Timoshenko, Vibration Problems in Engineering; the one-dimensional "
      "wave equation)";
  VerifyRows rows;
  for (int k = 1; k <= 3; ++k) {
    VerifyRow row{.quantity = "f" + std::to_string(k) + ", eigenvalue, nu = 0",
                  .unit = "Hz",
                  .source = source};
    row.accepted = accepted(k), row.judged = Judged::finest, row.tolerance = 0.002;
    rows.push_back(row);
  }
  VerifyRow history{
      .quantity = "f1, from the free end's motion, nu = 0", .unit = "Hz", .source = source};
  history.accepted = accepted(1), history.judged = Judged::finest, history.tolerance = 0.002;
  for (const int n : context.refined(20)) {
    context.proceed();
    const Problem p = bar(n);
    LevelProbe<HostBackend> probe(p);
    const SparseStiffness K(probe, [](const Point&, int axis) { return axis > 0; });
    const auto f = K.frequencies(3);
    for (std::size_t k = 0; k < 3; ++k) rows[k].add(cells_text(n, 2, 2), 1.0 / n, f[k]);
    std::vector<Point> shape;
    for (const Point& X : p.body.levels[0].vertices)
      shape.emplace_back(std::sin(std::numbers::pi / 2 * X[0] / length), 0, 0);
    history.add(cells_text(n, 2, 2), 1.0 / n, frequency_of_motion(p, shape, 1e-5, 3, accepted(1)));
  }
  rows.push_back(history);
  return rows;
}

namespace {
namespace slender {

constexpr double E = 1e7, rho = 1000, length = 1, side = 0.05, g = 0.1, load = 0.01;  // SI
constexpr double A = side * side, I = side * side * side * side / 12;

// Returns half of the beam, cut along the plane y = 0, in which it bends
Problem beam(int n, double nu) {
  Problem p = verify_body(box_mesh({{0, 0, 0}, {length, side / 2, side}}, {20 * n, n / 2, n}),
                          {"linear", E, nu, rho});
  p.body.fixed = {HalfSpaceSelection{{0, 0, 0}, {1, 0, 0}}};
  p.body.loads = {
      {HalfSpaceSelection{{length, 0, 0}, {-1, 0, 0}}, Traction{{0, 0, -load / A}}, {}}};
  return p;
}

bool held(const Point& X, int axis) { return axis == 1 && X[1] < 1e-9; }

// Compares the frequency of a whole beam in motion with its eigenvalue on the same mesh
VerifyRow from_its_motion(int n) {
  Problem p = verify_body(box_mesh({{0, 0, 0}, {length, side, side}}, {20 * n, n, n}),
                          {"linear", E, 0.3, rho});
  p.body.fixed = {HalfSpaceSelection{{0, 0, 0}, {1, 0, 0}}};
  std::vector<Point> shape;
  for (const Point& X : p.body.levels[0].vertices) shape.emplace_back(0, 0, X[0] * X[0]);
  LevelProbe<HostBackend> probe(p);
  VerifyRow row{.quantity = "f1 from the tip's motion against the same mesh's eigenvalue, nu = 0.3",
                .unit = "Hz"};
  row.accepted = SparseStiffness(probe).lowest_frequency(shape);
  row.source = "inverse iteration with direct solves on this mesh";
  row.judged = Judged::finest, row.tolerance = 1e-3;
  row.add(cells_text(20 * n, n, n), 1, frequency_of_motion(p, shape, 1e-5, 3, *row.accepted));
  return row;
}

// Compares the frequency of a short beam in motion with the eigenvalue of `linear` on the same
// mesh. Small motions are the same in every material
VerifyRows of_a_short_beam(const VerifyContext& context) {
  Problem p = verify_body(jittered_box({{0, 0, 0}, {0.4, 0.1, 0.1}}, {12, 3, 3}),
                          {"linear", 1e5, 0.3, 1000});
  p.body.fixed = {HalfSpaceSelection{{0, 0, 0}, {1, 0, 0}}};
  std::vector<Point> shape;
  for (const Point& X : p.body.levels[0].vertices) shape.emplace_back(0, 0, X[0] * X[0]);
  LevelProbe<HostBackend> probe(p);
  const double accepted = SparseStiffness(probe).lowest_frequency(shape);
  VerifyRows rows;
  const auto add = [&](const std::string& material, const std::string& integrator,
                       double tolerance) {
    context.proceed();
    p.body.material.model = material, p.integration.integrator = {integrator};
    VerifyRow row{.quantity = "f1 of a short beam from its motion, " + material + ", " + integrator,
                  .unit = "Hz"};
    row.accepted = accepted,
    row.source = "inverse iteration with direct solves on this mesh, linear";
    row.judged = Judged::finest, row.tolerance = tolerance;
    row.add(cells_text(12, 3, 3) + ", irregular", 1,
            frequency_of_motion(p, shape, 1e-5, 3, accepted));
    rows.push_back(row);
  };
  for (const std::string& material : materials_of_two_constants())
    add(material, "symplectic_euler", material == Linear::name ? 1e-3 : 2e-3);
  add(Linear::name, "rk4", 1e-3);
  return rows;
}

struct Theory {
  double tip, sag, frequency;
};

// Returns the solution for Timoshenko's beam: Euler-Bernoulli bending, and shear with factor 5/6
Theory theory(double nu) {
  const double shear = 5.0 / 6 * E / (2 * (1 + nu)) * A, beta = 1.8751;
  const double tip = load * std::pow(length, 3) / (3 * E * I),
               sag = rho * A * g * std::pow(length, 4) / (8 * E * I);
  return {tip + load * length / shear, sag + rho * A * g * length * length / (2 * shear),
          beta * beta / (2 * std::numbers::pi * length * length) * std::sqrt(E * I / (rho * A))};
}

VerifyRows rows_for(double nu, const VerifyContext& context) {
  const Theory want = theory(nu);
  const std::string of = nu == 0 ? ", nu = 0" : nu == 0.3 ? ", nu = 0.3" : ", nu = 0.45";
  VerifyRows rows = {
      {.quantity = "deflection under a load at the tip" + of, .unit = "m", .accepted = want.tip},
      {.quantity = "deflection under its own weight" + of, .unit = "m", .accepted = want.sag},
      {.quantity = "first bending frequency" + of, .unit = "Hz", .accepted = want.frequency}};
  rows[0].source = "PL^3/3EI + PL/kGA, k = 5/6 (Timoshenko, Strength of Materials, art. 39)";
  rows[1].source = "rho A g L^4/8EI + rho A g L^2/2kGA (the same)";
  rows[2].source =
      "1.8751^2/(2 pi L^2) sqrt(EI/rho A) (Timoshenko, Vibration Problems in Engineering)";
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

}  // namespace slender
}  // namespace

VerifyRows cantilever(const VerifyContext& context) {
  using namespace slender;
  VerifyRows rows;
  for (const double nu : context.small ? std::vector{0.3} : std::vector{0.0, 0.3, 0.45})
    for (VerifyRow& row : rows_for(nu, context)) rows.push_back(std::move(row));
  context.proceed();
  rows.push_back(from_its_motion(context.small ? 2 : 3));
  for (VerifyRow& row : of_a_short_beam(context)) rows.push_back(std::move(row));
  return rows;
}

}  // namespace plica
