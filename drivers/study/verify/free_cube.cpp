// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/study/sparse_stiffness.hpp>
#include <plica/drivers/study/verify/bodies.hpp>
#include <plica/drivers/study/verify/list.hpp>

namespace plica {

VerifyRows free_cube(const VerifyContext& context) {
  constexpr double shift = 1;  // [1/s^2], of the size of the lowest: makes the free body's matrix definite
  VerifyRow row{
      .quantity = "first elastic frequency, E 1 Pa, nu 0.499, 1 kg/m^3, 1 m", .unit = "Hz", .accepted = 0.2626};
  row.source = "Ritz' method, polynomials to degree 12: 0.26260 (Demarest, J. Acoust. Soc. Am. 49, 1971)";
  row.judged = Judged::above, row.power = 2;
  for (const int n : context.refined(4)) {
    context.proceed();
    LevelProbe<HostBackend> probe(verify_body(box_mesh({{0, 0, 0}, {1, 1, 1}}, {n, n, n}), {"linear", 1, 0.499, 1}));
    for (const double f : SparseStiffness(probe).frequencies(10, shift))
      if (f > 1e-3) {  // not one of rigid motion
        row.add(cells_text(n, n, n), 1.0 / n, f);
        break;
      }
  }
  const int percent = static_cast<int>(std::lround(100 * (row.ours.back().value / *row.accepted - 1)));
  row.note = "volumetric locking of linear tetrahedra: " + std::to_string(percent) + " % too high on the finest mesh";
  return {row};
}

}  // namespace plica
