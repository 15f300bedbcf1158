// SPDX-License-Identifier: BSD-3-Clause
#include <limits>
#include <plica/drivers/elastic/materials.hpp>
#include <plica/drivers/study/direct_solves.hpp>
#include <plica/drivers/study/level_probe.hpp>
#include <plica/drivers/study/sample_bodies.hpp>
#include <plica/drivers/study/verify/list.hpp>
#include <plica/kernels/materials/list.hpp>

// Laws of tissue in homogeneous states, against Cauchy's stress in closed form. The closed form is
// written in principal stretches. It is thus independent of the kernels, which use stretches only
// for Ogden's law. Fibres lie along z.
namespace plica {

namespace {

constexpr double edge = 0.1;  // [m]
using Stretches = Eigen::Vector3d;

/// A law with the parameters that a scene gives.
struct Law {
  std::string name;
  MaterialOptions material;
  double operator[](const char* parameter) const {
    const MaterialInfo& info = *find_material(name);
    const std::vector<double> values = parameter_values(info, material, {});
    for (std::size_t i = 0; i < info.parameters.size(); ++i)
      if (info.parameters[i].name == std::string_view(parameter)) return values[i];
    return std::numeric_limits<double>::quiet_NaN();
  }
};

Law law_along_z(const MaterialInfo& info, const std::string& volume) {
  Law law{std::string(info.name), complete({std::string(info.name)})};
  law.material.volume = volume;
  if (info.has_fibres) law.material.fibres = FibreOptions{Point::UnitZ(), Point::UnitX()};
  if (law.name == "holzapfel_gasser_ogden") law.material.parameters = {{"angle", 0}};
  if (law.name == "costa")  // isotropic across the fibres
    law.material.parameters = {{"b_ss", 3}, {"b_nn", 3}, {"b_sn", 3}, {"b_fs", 4}, {"b_fn", 4}};
  return law;
}

/// Returns l dW/dl of the fibres' part of the energy alone, at a stretch l of the fibres.
double fibre_pull(const Law& law, double l, double I1) {
  if (law.name == "transversely_isotropic") return 2 * law["eta"] * (l * l - 1) * l * l;
  if (law.name != "holzapfel_gasser_ogden") return 0;
  const double E = std::max(law["kappa"] * (I1 - 3) + (1 - 3 * law["kappa"]) * (l * l - 1), 0.0);
  return 4 * law["k1"] * E * std::exp(law["k2"] * E * E) * l * l;  // two families
}

/// Returns dW/dI1 and dW/dI2 of the part of the energy without fibres.
std::array<double, 2> by_invariants(const Law& law, double I1, double I2) {
  const double x = I1 - 3, y = I2 - 3;
  if (law.name == "mooney_rivlin") return {law["c10"], law["c01"]};
  if (law.name == "polynomial")
    return {law["c10"] + 2 * law["c20"] * x + law["c11"] * y,
            law["c01"] + law["c11"] * x + 2 * law["c02"] * y};
  if (law.name == "veronda_westmann") {
    const double mu = law["c1"] * law["c2"];
    return {mu * std::exp(law["c2"] * x), -mu / 2};
  }
  if (law.name == "arruda_boyce") {
    const double N = law["lambda_m"] * law["lambda_m"];
    return {law["mu"] * (1.0 / 2 + I1 / (10 * N) + 11 * I1 * I1 / (350 * N * N) +
                         19 * std::pow(I1 / N, 3) / 1750 + 519 * std::pow(I1 / N, 4) / 134750),
            0};
  }
  if (law.name == "gent") return {law["mu"] / 2 / (1 - x / law["j_m"]), 0};
  return {law[law.name == "transversely_isotropic" ? "mu" : "c"] / 2, 0};
}

/// Returns l_i dW/dl_i of isochoric stretches along x, y, z.
Stretches pulls(const Law& law, const Stretches& l) {
  Stretches t;
  const double I1 = l.squaredNorm(), I2 = l.cwiseInverse().squaredNorm();
  if (law.name == "ogden") {
    t.setZero();
    for (const OgdenTerm& term : law.material.terms)
      t +=
          term.mu / term.alpha * l.array().pow(term.alpha).matrix();  // c alpha with c = mu/alpha^2
    return t;
  }
  if (law.name == "costa") {
    const Stretches E = (l.array().square() - 1).matrix() / 2,
                    b(law["b_ss"], law["b_nn"], law["b_ff"]);
    const double Q = b.dot(E.cwiseAbs2());
    return law["a"] * std::exp(Q) * b.cwiseProduct(E).cwiseProduct(l.cwiseAbs2());
  }
  const auto [W1, W2] = by_invariants(law, I1, I2);
  for (int i = 0; i < 3; ++i) t[i] = 2 * l[i] * l[i] * (W1 + W2 * (I1 - l[i] * l[i]));
  t[2] += fibre_pull(law, l[2], I1);
  return t;
}

double pressure(const Law& law, double J) {
  const double k = law["bulk_modulus"];
  if (law.material.volume == "logarithmic") return k * std::log(J) / J;
  return law.material.volume == "quadratic" ? k * (J - 1) : k / 2 * (J - 1 / J);
}

/// Returns Cauchy's stress along x, y, z.
Stretches principal_stress(const Law& law, const Stretches& l) {
  const double J = l.prod();
  const Stretches t = pulls(law, l / std::cbrt(J));
  return (t.array() - t.mean()).matrix() / J + Stretches::Constant(pressure(law, J));
}

/// Returns the stretches along x, y, z. Those given are kept; free ones (0) are equal and without
/// stress. Bisection finds them, since a stress rises with its own stretch.
Stretches with_free_sides(const Law& law, const Stretches& given) {
  const auto at = [&](double side) {
    return Stretches(given.unaryExpr([side](double l) { return l > 0 ? l : side; }));
  };
  Eigen::Index free = 0;
  given.minCoeff(&free);
  double low = 0.3, high = 3;
  for (int i = 0; i < 200; ++i) {
    const double middle = (low + high) / 2;
    (principal_stress(law, at(middle))[free] > 0 ? high : low) = middle;
  }
  return at((low + high) / 2);
}

/// Returns Cauchy's stress xz of the shear x += shear z, which keeps the volume. The part without
/// fibres is computed by principal stretches.
double shear_stress(const Law& law, double shear) {
  if (law.name == "costa") {
    const double E = shear * shear / 2, Q = law["b_ff"] * E * E + law["b_fs"] * shear * shear / 2;
    return law["a"] * std::exp(Q) * (law["b_fs"] * shear / 2 + law["b_ff"] * E * shear);
  }
  const double root = std::sqrt(shear * shear + 4), l = (shear + root) / 2;
  Law matrix = law;
  double fibres = 0;
  if (find_material(law.name)->has_fibres) {
    const double stretch = std::sqrt(1 + shear * shear);
    fibres = shear * fibre_pull(law, stretch, 3 + shear * shear) / (stretch * stretch);
    for (const char* own : {"eta", "k1"})
      if (!std::isnan(law[own])) matrix.material.parameters[own] = 0;
  }
  const Stretches t = pulls(matrix, {l, 1, 1 / l});
  return fibres + (t[0] - t[2]) / root;
}

/// Mean first Piola-Kirchhoff stress of the deformed box, and the largest force on a vertex away
/// from the fixed faces.
struct Found {
  Eigen::Matrix3d P;
  double free = 0;
};
Found deformed(const Law& law, const std::string& element, int cells, const Eigen::Matrix3d& F,
               const std::function<bool(const Point&)>& held) {
  Problem p = verify_body(jittered_box({{0, 0, 0}, {edge, edge, edge}}, {cells, cells, cells}),
                          law.material);
  p.body.material = law.material, p.body.element = {element}, p.body.pressure = "plain";
  LevelProbe<HostBackend> probe(p);
  const TetMesh& mesh = p.body.levels[0];
  const auto f = probe.force(affine_field(mesh, F, Point::Zero()));
  Found found{virial(f, mesh) / (edge * edge * edge), 0};
  for (std::size_t a = 0; a < f.size(); ++a)
    if (!held(mesh.vertices[a])) found.free = std::max(found.free, f[a].norm());
  return found;
}

}  // namespace

VerifyRows laws_of_tissue(const VerifyContext& context) {
  VerifyRows rows;
  const int n = context.small ? 3 : 5;
  const auto far = [](double x) { return x < 1e-9 || x > edge - 1e-9; };
  for (const char* element : {"linear", "nodal"}) {
    const char* const quantities[4] = {
        "stretch 1.25 along z, sides free: error of the stress, relative",
        "stretch 1.15 along x and y, z free: error of the stress, relative",
        "shear of 0.4 in xz: error of the shear stress, relative",
        "of both stretches: largest force off the held faces, over the stress times a cell's face"};
    VerifyRows four;
    for (const char* quantity : quantities)
      four.push_back({.quantity = quantity, .unit = "1", .element = element});
    for (VerifyRow& row : four) {
      row.mesh = "jittered", row.judged = Judged::size, row.tolerance = 1e-10;
      row.source =
          "closed form by principal stretches, one scalar equation for the free sides (Ogden, "
          "Non-Linear Elastic "
          "Deformations, 4.2, 4.3)";
      row.note = "the worst of volume simo_hughes, logarithmic, quadratic; fibres along z";
    }
    for (const MaterialInfo& info : material_list()) {
      if (!info.of_tissue) continue;
      context.proceed();
      double worst[4] = {};
      for (const std::string& volume : names(volumes())) {
        const Law law = law_along_z(info, volume);
        const auto stretched = [&](int k, const Stretches& given, int axis, const auto& held) {
          const Stretches l = with_free_sides(law, given);
          const double P = principal_stress(law, l)[axis] * l.prod() / l[axis];
          const Found found = deformed(law, element, n, l.asDiagonal(), held);
          worst[k] = std::max(worst[k], std::abs(found.P(axis, axis) / P - 1));
          worst[3] = std::max(worst[3], found.free / (std::abs(P) * edge * edge / (n * n)));
        };
        stretched(0, {0, 0, 1.25}, 2, [&](const Point& X) { return far(X[2]); });
        stretched(1, {1.15, 1.15, 0}, 0, [&](const Point& X) { return far(X[0]) || far(X[1]); });
        Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
        F(0, 2) = 0.4;
        const Found found = deformed(law, element, n, F, [](const Point&) { return true; });
        worst[2] = std::max(worst[2],
                            std::abs((found.P * F.transpose())(0, 2) / shear_stress(law, 0.4) - 1));
      }
      for (std::size_t k = 0; k < 4; ++k) four[k].add(std::string(info.name), 1, worst[k]);
    }
    for (VerifyRow& row : four) rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace plica
