// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <plica/drivers/elastic/materials.hpp>
#include <plica/drivers/study/direct_solves.hpp>
#include <plica/drivers/study/level_probe.hpp>
#include <plica/drivers/study/sample_bodies.hpp>
#include <plica/drivers/study/verify/list.hpp>

// Energies of stretched blocks, and the forces that hold them. The deformation is affine, so that
// every mesh has them exactly.
namespace plica {

namespace {
namespace stretched {

constexpr double side = 0.1, young_modulus = 10e3, poisson_ratio = 0.3;  // [m], [Pa], 1

/// Neo-Hookean block of stretches `along` and twice `across`, in closed form.
struct Block {
  double mu, kappa, along, across;
  double J() const { return along * across * across; }
  /// Returns Cauchy's stress in the direction of a stretch [Pa].
  double stress(double stretch) const {
    const double mean = (along * along + 2 * across * across) / 3;
    return mu * std::pow(J(), -5.0 / 3) * (stretch * stretch - mean) + kappa / 2 * (J() - 1 / J());
  }
  /// Returns the force on the faces across the long direction [N].
  double pull() const { return stress(along) * across * across * side * side; }
  /// Returns the force on one of the faces along it [N].
  double push() const { return stress(across) * along * across * side * side; }
  double energy() const {  // [J]
    const double I = along * along + 2 * across * across;
    return side * side * side *
           (mu / 2 * (std::pow(J(), -2.0 / 3) * I - 3) +
            kappa / 4 * (J() * J() - 1 - 2 * std::log(J())));
  }
};

/// Returns the block with free sides, by bisection.
Block with_free_sides(Block b) {
  double low = 0.3, high = 3;
  for (int i = 0; i < 100; ++i) {
    b.across = (low + high) / 2;
    (b.stress(b.across) > 0 ? high : low) = b.across;
  }
  return b;
}

/// Returns the sum of a component of a field over the vertices of the face x[axis] = at.
double sum_on_face(const std::vector<Point>& field, const TetMesh& mesh, int axis, double at) {
  double sum = 0;
  for (std::size_t a = 0; a < field.size(); ++a)
    if (std::abs(mesh.vertices[a][axis] - at) < 1e-9) sum += field[a][axis];
  return sum;
}

VerifyRow row_of(const std::string& quantity, const char* unit, const std::string& element,
                 double accepted, double tolerance) {
  VerifyRow row{.quantity = quantity, .unit = unit, .element = element, .mesh = "jittered"};
  row.accepted = accepted, row.judged = Judged::finest, row.tolerance = tolerance;
  row.source =
      "closed form of the homogeneous deformation (Ogden, Non-Linear Elastic Deformations, "
      "4.2)";
  return row;
}

/// Returns the displacement of a block that rollers hold: at all faces through the origin, and at
/// the far face along x, which is pulled. Its inside starts away from the answer.
std::vector<Point> between_rollers(LevelProbe<HostBackend>& probe, const Block& block, int cells) {
  const TetMesh& mesh = probe.problem.body.levels[0];
  StaticOptions options;
  options.held = [](const Point& X, int axis) {
    return X[axis] < 1e-9 || (axis == 0 && X[0] > side - 1e-9);
  };
  const Eigen::Matrix3d F = Point(block.along, 1, 1).asDiagonal();
  options.start = affine_field(mesh, F, Point::Zero());
  const auto disorder = random_field(mesh.vertices.size(), 0.03 * side / cells, 3);
  for (std::size_t a = 0; a < disorder.size(); ++a)
    for (int k = 0; k < 3; ++k)
      if (!options.held(mesh.vertices[a], k)) options.start[a][k] += disorder[a][k];
  return static_equilibrium(probe, options);
}

VerifyRows rows_of_blocks(const VerifyContext& context) {
  VerifyRows rows;
  const int n = context.small ? 3 : 5;
  const std::string cells = cells_text(n, n, n);
  const Lame<double> c = lame_constants(young_modulus, poisson_ratio);
  const double kappa = c.lambda + 2 * c.mu / 3;
  const Block confined{c.mu, kappa, 0.8, 1}, pulled = with_free_sides({c.mu, kappa, 1.5, 1});
  for (const std::string element : {"linear", "nodal"}) {
    context.proceed();
    const auto problem = [&](const MaterialOptions& material) {
      Problem p = verify_body(jittered_box({{0, 0, 0}, {side, side, side}}, {n, n, n}), material);
      p.body.element = {element}, p.body.pressure = "plain";
      return p;
    };
    MaterialOptions rubber{"mooney_rivlin"};
    rubber.parameters = {{"c10", 900e3}, {"c01", 0}, {"bulk_modulus", 10e9}};
    LevelProbe<HostBackend> stiff(problem(rubber)),
        soft(problem({"neo_hookean", young_modulus, poisson_ratio, 1000}));
    const TetMesh& mesh = soft.problem.body.levels[0];
    const auto stretched_by = [&](double along, double across) {
      const Eigen::Matrix3d F = Point(along, across, across).asDiagonal();
      return affine_field(mesh, F, Point::Zero());
    };

    rows.push_back(row_of("rubber, c10 900 kPa, stretch 1.5 at constant volume: energy", "J",
                          element, 525, 1e-9));
    rows.back().add(cells, 1, stiff.elastic_energy(stretched_by(1.5, 1 / std::sqrt(1.5))));

    const auto squeezed = stretched_by(confined.along, 1);
    const auto force = soft.force(squeezed);
    const std::string walls = "between walls, height 0.8 of that at rest: ";
    rows.push_back(row_of(walls + "energy", "J", element, confined.energy(), 1e-10));
    rows.back().add(cells, 1, soft.elastic_energy(squeezed));
    rows.push_back(row_of(walls + "force of the top", "N", element, confined.pull(), 1e-10));
    rows.back().add(cells, 1, -sum_on_face(force, mesh, 0, side));
    rows.push_back(row_of(walls + "force of a side", "N", element, confined.push(), 1e-10));
    rows.back().add(cells, 1, -sum_on_face(force, mesh, 1, side));

    const auto u = between_rollers(soft, pulled, n);
    const std::string rollers = "pulled to 1.5 between rollers, sides free: ";
    rows.push_back(row_of(rollers + "energy", "J", element, pulled.energy(), 1e-6));
    rows.back().add(cells, 1, soft.elastic_energy(u));
    rows.push_back(row_of(rollers + "force", "N", element, pulled.pull(), 1e-6));
    rows.back().add(cells, 1, -sum_on_face(soft.force(u), mesh, 0, side));
    rows.push_back(row_of(rollers + "width over that at rest", "1", element, pulled.across, 1e-6));
    rows.back().add(cells, 1, 1 + u[vertex_at(mesh, {side, side, side})][1] / side);
  }
  return rows;
}

}  // namespace stretched
}  // namespace

VerifyRows stretched_block(const VerifyContext& context) {
  return stretched::rows_of_blocks(context);
}

}  // namespace plica
