// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/study/level_probe.hpp>
#include <plica/drivers/study/sample_gradients.hpp>
#include <plica/drivers/study/sparse_stiffness.hpp>
#include <plica/drivers/study/verify/bodies.hpp>
#include <plica/drivers/study/verify/list.hpp>

namespace plica {

namespace {

// Turned by an angle about z, the unstrained body feels a mean stress.
VerifyRow stress_of_a_turn(int n) {
  const Problem problem = irregular_cube(Linear::name, n);
  const TetMesh& mesh = problem.body.levels[0];
  const Lame<double> c = lame_constants(problem.body.material.young_modulus, problem.body.material.poisson_ratio);
  const double angle = 0.4;
  LevelProbe<HostBackend> probe(problem);
  const Eigen::Matrix3d R = Eigen::AngleAxisd(angle, Point::UnitZ()).toRotationMatrix();
  VerifyRow row{.quantity = "linear: xx stress turned by 0.4 rad about z", .unit = "Pa"};
  row.accepted = 2 * (c.mu + c.lambda) * (std::cos(angle) - 1);
  row.source = "2 (mu + lambda) (cos theta - 1), from the strain (R + R^T)/2 - I";
  row.judged = Judged::finest, row.tolerance = 1e-12;
  row.note = "not zero: small strain is not for rotations";
  const auto f = probe.force(affine_field(mesh, R, Point::Zero()));
  row.add(cells_text(n, n, n), 1, virial(f, mesh)(0, 0) / 1e-3);
  return row;
}

}  // namespace

VerifyRows rigid_motion(const VerifyContext& context) {
  VerifyRow row{.quantity = "largest force of a random rotation and translation, over E times a cell's face",
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
    const Eigen::Matrix3d R = M::rotation_invariant ? random_rotation(random) : Eigen::Matrix3d::Identity();
    const auto f = probe.force(affine_field(problem.body.levels[0], R, {0.05, -0.02, 0.01}));
    const double face = 0.01 / (n * n);
    row.add(M::rotation_invariant ? M::name : std::string(M::name) + ", only moved", 1,
            largest_length(f) / (problem.body.material.young_modulus * face));
  });
  return {row, stress_of_a_turn(n)};
}

}  // namespace plica
