// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/study/sparse_stiffness.hpp>
#include <plica/drivers/study/verify/bodies.hpp>
#include <plica/drivers/study/verify/list.hpp>
#include <plica/meshes/grid_mesh.hpp>

namespace plica {

// Half its thickness, one layer of cells: the middle plane does not bend, the surface is free, which is plane stress.
VerifyRows tapered_membrane(const VerifyContext& context) {
  constexpr double accepted[] = {44.623, 130.03, 162.70, 246.05, 379.90, 391.44};
  VerifyRows rows;
  for (std::size_t k = 0; k < std::size(accepted); ++k) {
    VerifyRow row{.quantity = "in-plane frequency " + std::to_string(k + 1), .unit = "Hz", .accepted = accepted[k]};
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
    const auto f =
        SparseStiffness(probe, [](const Point& X, int axis) { return axis == 2 && X[2] < 1e-9; }).frequencies(6);
    for (std::size_t k = 0; k < rows.size(); ++k) rows[k].add(cells_text(2 * n, n, 1), 1.0 / n, f[k]);
  }
  return rows;
}

}  // namespace plica
