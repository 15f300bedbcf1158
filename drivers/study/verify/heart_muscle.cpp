// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/elastic/materials.hpp>
#include <plica/drivers/study/direct_solves.hpp>
#include <plica/drivers/study/level_probe.hpp>
#include <plica/drivers/study/sample_bodies.hpp>
#include <plica/drivers/study/verify/list.hpp>

namespace plica {

// Solves a beam of 10 x 1 x 1 mm with fibres along it, clamped at x = 0. A pressure of 4 Pa follows
// its lower face.
VerifyRows bending_heart_muscle(const VerifyContext& context) {
  constexpr double mm = 1e-3;
  VerifyRow row{.quantity = "z of the point (10, 0.5, 1) mm",
                .unit = "mm",
                .element = "nodal",
                .accepted = 4.17};
  row.source =
      "Land et al., Proc. R. Soc. A 471:20150641, 2015, problem 1: 4.17 +- 0.01 of most of 11 "
      "programs";
  row.judged = Judged::finest, row.tolerance = context.small ? 0.15 : 0.04;
  row.note = "theirs is incompressible; here kappa is 50 times mu at rest";
  for (const int n : context.small ? std::vector{2} : std::vector{2, 4}) {
    context.proceed();
    Problem p = verify_body(box_mesh({{0, 0, 0}, {10 * mm, mm, mm}}, {10 * n, n, n}),
                            tissue_material("heart_muscle"));
    p.body.material.fibres = FibreOptions{};
    p.body.element = {"nodal"};
    p.body.fixed = {HalfSpaceSelection{Point::Zero(), Point::UnitX()}};
    p.body.loads = {{HalfSpaceSelection{Point::Zero(), Point::UnitZ()}, FollowerPressure{4},
                     PolygonCourse{{{0, 0}, {1, 1}}}}};
    LevelProbe<HostBackend> probe(p);
    StaticOptions options;
    options.load_steps = 8, options.relative_residual = 1e-5;
    const Point tip(10 * mm, 0.5 * mm, mm);
    const std::size_t at = vertex_at(p.body.levels[0], tip);
    row.add(cells_text(10 * n, n, n), 1.0 / n,
            (1 + static_equilibrium(probe, options)[at][2] / mm));
  }
  if (context.small) return {row};
  VerifyRow limit = row;
  limit.quantity += ", extrapolated from these with order 2", limit.tolerance = 0.01;
  const double coarse = row.ours[0].value, fine = row.ours[1].value;
  limit.ours.clear(), limit.add("20x2x2, 40x4x4", 1, fine + (fine - coarse) / 3);
  return {row, limit};
}

}  // namespace plica
