// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/study/sample_gradients.hpp>
#include <plica/drivers/study/sparse_stiffness.hpp>
#include <plica/drivers/study/verify/bodies.hpp>
#include <plica/drivers/study/verify/list.hpp>

namespace plica {

namespace {

constexpr double tolerance = 1e-6;
const Lame<double> some_tissue = lame_constants(20e3, 0.4);

// d/dt of a function at 0 by central differences, of fourth order
template <class F>
auto slope_at_zero(const F& f, double h) {
  const auto central = [&](double t) { return ((f(t) - f(-t)) / (2 * t)).eval(); };
  return ((4 * central(h / 2) - central(h)) / 3).eval();
}

template <class M>
double worst_at_a_point(bool of_stress) {
  double worst = 0;
  std::mt19937 random(17);
  std::uniform_real_distribution<double> within(-1, 1);
  for (const Gradient& g : gradients(M::survives_inversion)) {
    const Eigen::Matrix3d D = Eigen::Matrix3d::NullaryExpr([&](auto, auto) { return within(random); });
    const double h = 1e-4 * g.smallest;
    const auto F = [&](double t) { return mat3<double>(Eigen::Matrix3d(g.F + t * D)); };
    const Eigen::Matrix3d P = eigen(M::stress(F(0), some_tissue));
    if (of_stress) {
      const Eigen::Matrix3d dP = eigen(M::stress_change(F(0), mat3<double>(D), some_tissue));
      const auto stress = [&](double t) { return eigen(M::stress(F(t), some_tissue)); };
      worst = std::max(worst, (slope_at_zero(stress, h) - dP).norm() / dP.norm());
    } else {
      const auto energy = [&](double t) { return Eigen::Matrix<double, 1, 1>(M::energy(F(t), some_tissue)); };
      const double found = slope_at_zero(energy, h)(0);
      worst = std::max(worst, std::abs(found - P.cwiseProduct(D).sum()) / (P.norm() * D.norm()));
    }
  }
  return worst;
}

Eigen::VectorXd stacked(const std::vector<Point>& field) {
  Eigen::VectorXd x(static_cast<Eigen::Index>(3 * field.size()));
  for (std::size_t a = 0; a < field.size(); ++a) x.segment<3>(static_cast<Eigen::Index>(3 * a)) = field[a];
  return x;
}

// Of a whole irregular mesh along a random direction: {force against energy, tangent against force}
std::array<double, 2> on_a_mesh(const char* material, int cells) {
  LevelProbe<HostBackend> probe(irregular_cube(material, cells));
  const double size = 0.01 / cells;
  const auto u = random_field(probe.vertices(), size, 1), p = random_field(probe.vertices(), size, 2);
  const auto at = [&](double t) {
    auto moved = u;
    for (std::size_t a = 0; a < u.size(); ++a) moved[a] += t * p[a];
    return moved;
  };
  const Eigen::VectorXd f = stacked(probe.force(u)), direction = stacked(p), Kp = stacked(probe.stiffness(u, p));
  const auto energy = [&](double t) { return Eigen::Matrix<double, 1, 1>(probe.elastic_energy(at(t))); };
  const auto force = [&](double t) { return stacked(probe.force(at(t))); };
  return {std::abs(slope_at_zero(energy, 1e-3)(0) / f.dot(direction) + 1),
          (slope_at_zero(force, 1e-3) + Kp).norm() / Kp.norm()};
}

}  // namespace

VerifyRows derivatives(const VerifyContext& context) {
  constexpr const char* source = "central differences of order 4 of the same functions";
  VerifyRows rows = {{.quantity = "stress off the energy's slope; nearly flat and inverted F among them"},
                     {.quantity = "its change off the stress's slope"},
                     {.quantity = "nodal forces off the slope of the mesh's energy"},
                     {.quantity = "tangent off the slope of the nodal forces"}};
  for (VerifyRow& row : rows) row.unit = "1", row.source = source, row.judged = Judged::size, row.tolerance = tolerance;
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
