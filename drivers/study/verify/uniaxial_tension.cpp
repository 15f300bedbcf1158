// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/study/sparse_stiffness.hpp>
#include <plica/drivers/study/verify/bodies.hpp>
#include <plica/drivers/study/verify/list.hpp>

namespace plica {

// The deformation is affine: every mesh has it exactly, an irregular one too.
VerifyRows uniaxial_tension(const VerifyContext& context) {
  context.proceed();
  const double E = 20e3, nu = 0.3, p_over_E = 1e-3, L = 0.4, w = 0.1;
  const int n = context.small ? 2 : 4;
  Problem p = verify_body(jittered_box({{0, 0, 0}, {L, w, w}}, {4 * n, n, n}), {"linear", E, nu, 1000});
  p.body.loads = {{HalfSpaceSelection{{0, 0, 0}, {1, 0, 0}}, Traction{{-p_over_E * E, 0, 0}}, {}},
                  {HalfSpaceSelection{{L, 0, 0}, {-1, 0, 0}}, Traction{{p_over_E * E, 0, 0}}, {}}};
  const auto held = [=](const Point& X, int axis) {  // rigid motion, at three corners
    if (X.norm() < 1e-9) return true;
    return ((X - Point(L, 0, 0)).norm() < 1e-9 && axis > 0) || ((X - Point(0, 0, w)).norm() < 1e-9 && axis == 1);
  };
  LevelProbe<HostBackend> probe(p);
  const SparseStiffness K(probe, held);
  const auto u = K.equilibrium(probe.force(probe.zero()));
  const Point corner = u[vertex_at(p.body.levels[0], {L, w, w})];
  VerifyRows rows = {
      {.quantity = "strain along", .unit = "1", .accepted = p_over_E, .source = "p/E (Hooke)"},
      {.quantity = "strain across", .unit = "1", .accepted = -nu * p_over_E, .source = "-nu p/E (Hooke)"}};
  const double ours[] = {corner[0] / L, corner[1] / w};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    rows[i].judged = Judged::finest, rows[i].tolerance = 1e-10;
    rows[i].add(cells_text(4 * n, n, n) + ", irregular", 1, ours[i]);
  }
  return rows;
}

}  // namespace plica
