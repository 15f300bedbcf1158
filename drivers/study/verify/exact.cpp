// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/elastic/materials.hpp>
#include <plica/drivers/study/direct_solves.hpp>
#include <plica/drivers/study/level_probe.hpp>
#include <plica/drivers/study/sample_bodies.hpp>
#include <plica/drivers/study/sample_gradients.hpp>
#include <plica/drivers/study/verify/list.hpp>

namespace plica {

// Moves boundary vertices to x = F X + c. Inner vertices start away from that place and must reach
// it.
VerifyRows affine_patch(const VerifyContext& context) {
  constexpr const char* source =
      "exact: linear shape functions (Irons' patch test; Zienkiewicz & Taylor, FEM vol. 1)";
  VerifyRow place{
      .quantity = "error of inner vertices, over the displacement", .unit = "1", .source = source};
  VerifyRow stress{
      .quantity = "error of the mean first Piola-Kirchhoff stress against P(F), relative",
      .unit = "1",
      .source = source};
  place.judged = stress.judged = Judged::size;
  place.tolerance = stress.tolerance = 1e-11;
  std::mt19937 random(9);
  const Eigen::Matrix3d F = random_rotation(random) * Eigen::Vector3d(1.2, 0.9, 1.05).asDiagonal() *
                            random_rotation(random);
  const int n = context.small ? 4 : 8;
  Materials::for_each([&](auto material) {
    using M = decltype(material);
    context.proceed();
    const Problem problem = irregular_cube(M::name, n);
    const TetMesh& mesh = problem.body.levels[0];
    LevelProbe<HostBackend> probe(problem);
    const auto want = affine_field(mesh, F, {0.01, 0.02, -0.03});
    const Box box = bounding_box(mesh.vertices);
    StaticOptions options;
    options.held = [box](const Point& X, int) { return on_boundary(box, X); };
    options.relative_residual = 1e-14;
    options.start = random_field(want.size(), 0.0005, 4);
    for (std::size_t a = 0; a < want.size(); ++a) {
      if (on_boundary(box, mesh.vertices[a])) options.start[a].setZero();
      options.start[a] += want[a];
    }
    const auto u = static_equilibrium(probe, options);
    auto off = u;
    for (std::size_t a = 0; a < u.size(); ++a) off[a] -= want[a];
    place.add(M::name, 1, largest_length(off) / largest_length(want));
    const auto c = M::kernel_constants(
        parameter_values(*find_material(M::name), problem.body.material, {}).data());
    const Eigen::Matrix3d P = eigen(M::stress(mat3<double>(F), c));
    stress.add(M::name, 1, (virial(probe.force(u), mesh) / 1e-3 - P).norm() / P.norm());
  });
  return {place, stress};
}

namespace {

// Returns the row of the mean stress that `linear` has in an unstrained body turned about z.
VerifyRow stress_of_a_turn(int n) {
  const Problem problem = irregular_cube(Linear::name, n);
  const TetMesh& mesh = problem.body.levels[0];
  const Lame<double> c =
      lame_constants(problem.body.material.young_modulus, problem.body.material.poisson_ratio);
  const double angle = 0.4;
  LevelProbe<HostBackend> probe(problem);
  const Eigen::Matrix3d R = Eigen::AngleAxisd(angle, Point::UnitZ()).toRotationMatrix();
  VerifyRow row{.quantity = "linear: xx stress turned by 0.4 rad about z", .unit = "Pa"};
  row.accepted = 2 * (c.mu + c.lambda) * (std::cos(angle) - 1);
  row.source = "2 (mu + lambda) (cos theta - 1), from the strain (R + R^T)/2 - I";
  row.judged = Judged::finest, row.tolerance = 1e-12;
  row.note = "not zero: small strains do not hold for rotations";
  const auto f = probe.force(affine_field(mesh, R, Point::Zero()));
  row.add(cells_text(n, n, n), 1, virial(f, mesh)(0, 0) / 1e-3);
  return row;
}

}  // namespace

VerifyRows rigid_motion(const VerifyContext& context) {
  VerifyRow row{
      .quantity = "largest force of a random rotation and translation, over E times a cell's face",
      .unit = "1"};
  row.source = "frame indifference (Bonet & Wood, Nonlinear Continuum Mechanics for FEA, 4.15)";
  row.judged = Judged::size, row.tolerance = 1e-12;
  const int n = context.small ? 4 : 8;
  std::mt19937 random(11);
  Materials::for_each([&](auto material) {
    using M = decltype(material);
    context.proceed();
    const Problem problem = irregular_cube(M::name, n);
    LevelProbe<HostBackend> probe(problem);
    const Eigen::Matrix3d R =
        M::rotation_invariant ? random_rotation(random) : Eigen::Matrix3d::Identity();
    const auto f = probe.force(affine_field(problem.body.levels[0], R, {0.05, -0.02, 0.01}));
    const double face = 0.01 / (n * n);
    row.add(M::rotation_invariant ? M::name : std::string(M::name) + ", only moved", 1,
            largest_length(f) / (problem.body.material.young_modulus * face));
  });
  return {row, stress_of_a_turn(n)};
}

namespace {

constexpr double tolerance = 1e-6;

// Returns d/dt of a function at 0, by central differences of fourth order
template <class F>
auto slope_at_zero(const F& f, double h) {
  const auto central = [&](double t) { return ((f(t) - f(-t)) / (2 * t)).eval(); };
  return ((4 * central(h / 2) - central(h)) / 3).eval();
}

template <class M>
double worst_at_a_point(bool of_stress) {
  const auto some_tissue = sample_constants<M>();
  double worst = 0;
  std::mt19937 random(17);
  std::uniform_real_distribution<double> within(-1, 1);
  for (const Gradient& g : gradients(M::survives_inversion)) {
    const Eigen::Matrix3d D =
        Eigen::Matrix3d::NullaryExpr([&](auto, auto) { return within(random); });
    const double h = 1e-4 * g.smallest;
    const auto F = [&](double t) { return mat3<double>(Eigen::Matrix3d(g.F + t * D)); };
    const Eigen::Matrix3d P = eigen(M::stress(F(0), some_tissue));
    if (of_stress) {
      const Eigen::Matrix3d dP = eigen(M::stress_change(F(0), mat3<double>(D), some_tissue));
      const auto stress = [&](double t) { return eigen(M::stress(F(t), some_tissue)); };
      worst = std::max(worst, (slope_at_zero(stress, h) - dP).norm() / dP.norm());
    } else {
      const auto energy = [&](double t) {
        return Eigen::Matrix<double, 1, 1>(M::energy(F(t), some_tissue));
      };
      const double found = slope_at_zero(energy, h)(0);
      worst = std::max(worst, std::abs(found - P.cwiseProduct(D).sum()) / (P.norm() * D.norm()));
    }
  }
  return worst;
}

Eigen::VectorXd stacked(const std::vector<Point>& field) {
  Eigen::VectorXd x(static_cast<Eigen::Index>(3 * field.size()));
  for (std::size_t a = 0; a < field.size(); ++a)
    x.segment<3>(static_cast<Eigen::Index>(3 * a)) = field[a];
  return x;
}

// Returns relative errors of derivatives of a whole irregular mesh, along a random direction:
// {force against energy, tangent against force}
std::array<double, 2> on_a_mesh(const char* material, int cells) {
  LevelProbe<HostBackend> probe(irregular_cube(material, cells));
  const double size = 0.01 / cells;
  const auto u = random_field(probe.vertices(), size, 1),
             p = random_field(probe.vertices(), size, 2);
  const auto at = [&](double t) {
    auto moved = u;
    for (std::size_t a = 0; a < u.size(); ++a) moved[a] += t * p[a];
    return moved;
  };
  const Eigen::VectorXd f = stacked(probe.force(u)), direction = stacked(p),
                        Kp = stacked(probe.stiffness(u, p));
  const auto energy = [&](double t) {
    return Eigen::Matrix<double, 1, 1>(probe.elastic_energy(at(t)));
  };
  const auto force = [&](double t) { return stacked(probe.force(at(t))); };
  // short, so that hardly any fibre becomes slack within it: there the tangent jumps
  constexpr double h = 1e-5;
  return {std::abs(slope_at_zero(energy, h)(0) / f.dot(direction) + 1),
          (slope_at_zero(force, h) + Kp).norm() / Kp.norm()};
}

}  // namespace

VerifyRows derivatives(const VerifyContext& context) {
  constexpr const char* source = "central differences of order 4 of the same functions";
  VerifyRows rows = {
      {.quantity = "error of the stress against the derivative of the energy; some F nearly flat "
                   "or inverted"},
      {.quantity = "error of its change against the derivative of the stress"},
      {.quantity = "error of nodal forces against the derivative of the mesh's energy"},
      {.quantity = "error of the tangent against the derivative of the nodal forces"}};
  for (VerifyRow& row : rows)
    row.unit = "1", row.source = source, row.judged = Judged::size, row.tolerance = tolerance;
  Materials::for_each([&](auto material) {
    using M = decltype(material);
    context.proceed();
    rows[0].add(M::name, 1, worst_at_a_point<M>(false));
    rows[1].add(M::name, 1, worst_at_a_point<M>(true));
    const auto mesh = on_a_mesh(M::name, context.small ? 3 : 6);
    rows[2].add(M::name, 1, mesh[0]);
    rows[3].add(M::name, 1, mesh[1]);
  });
  return rows;
}

}  // namespace plica
