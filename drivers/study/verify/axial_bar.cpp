// SPDX-License-Identifier: BSD-3-Clause
#include <numbers>
#include <plica/drivers/study/free_vibration.hpp>
#include <plica/drivers/study/sparse_stiffness.hpp>
#include <plica/drivers/study/verify/bodies.hpp>
#include <plica/drivers/study/verify/list.hpp>

namespace plica {

namespace {

constexpr double E = 1e5, rho = 1000, length = 0.4, width = 0.02;

double accepted(int k) { return (2 * k - 1) / (4 * length) * std::sqrt(E / rho); }

Problem bar(int n) {
  Problem p = verify_body(box_mesh({{0, 0, 0}, {length, width, width}}, {n, 2, 2}), {"linear", E, 0, rho});
  p.body.fixed = {HalfSpaceSelection{{0, 0, 0}, {1, 0, 0}}};
  return p;
}

}  // namespace

// Without lateral strain, nu = 0, motion along the axis alone is the bar's own: the rest of it is held, which leaves bending out.
VerifyRows axial_bar(const VerifyContext& context) {
  constexpr const char* source =
      "(2k - 1)/4L sqrt(E/rho) (Timoshenko, Vibration Problems in Engineering; the one-dimensional wave equation)";
  VerifyRows rows;
  for (int k = 1; k <= 3; ++k) {
    VerifyRow row{.quantity = "f" + std::to_string(k) + ", eigenvalue, nu = 0", .unit = "Hz", .source = source};
    row.accepted = accepted(k), row.judged = Judged::finest, row.tolerance = 0.002;
    rows.push_back(row);
  }
  VerifyRow history{.quantity = "f1, from the free end's motion, nu = 0", .unit = "Hz", .source = source};
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

}  // namespace plica
