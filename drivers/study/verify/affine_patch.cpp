// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/study/sample_gradients.hpp>
#include <plica/drivers/study/static_equilibrium.hpp>
#include <plica/drivers/study/verify/bodies.hpp>
#include <plica/drivers/study/verify/list.hpp>

namespace plica {

// Boundary vertices go where x = F X + c takes them; inner ones start off their place and must find it.
VerifyRows affine_patch(const VerifyContext& context) {
  constexpr const char* source = "exact: linear shape functions (Irons' patch test; Zienkiewicz & Taylor, FEM vol. 1)";
  VerifyRow place{.quantity = "inner vertices off their place, over the displacement", .unit = "1", .source = source};
  VerifyRow stress{.quantity = "mean first Piola-Kirchhoff stress off P(F), relative", .unit = "1", .source = source};
  place.judged = stress.judged = Judged::size;
  place.tolerance = stress.tolerance = 1e-11;
  std::mt19937 random(9);
  const Eigen::Matrix3d F =
      random_rotation(random) * Eigen::Vector3d(1.2, 0.9, 1.05).asDiagonal() * random_rotation(random);
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
    const Lame<double> c = lame_constants(problem.body.material.young_modulus, problem.body.material.poisson_ratio);
    const Eigen::Matrix3d P = eigen(M::stress(mat3<double>(F), c));
    stress.add(M::name, 1, (virial(probe.force(u), mesh) / 1e-3 - P).norm() / P.norm());
  });
  return {place, stress};
}

}  // namespace plica
