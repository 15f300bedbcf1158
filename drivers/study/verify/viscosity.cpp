// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <numbers>
#include <plica/drivers/elastic/materials.hpp>
#include <plica/drivers/study/direct_solves.hpp>
#include <plica/drivers/study/level_probe.hpp>
#include <plica/drivers/study/sample_bodies.hpp>
#include <plica/drivers/study/verify/list.hpp>

// Boxes whose isochoric second Piola stress S_e is a given function of time times a constant. Their
// shape stays and their size changes, since S_e of F = s F_0 is S_e(F_0)/s^2. The relaxed stress is
// then known in closed form.
namespace plica {

namespace {

constexpr double box_edge = 0.1;  // [m]
const std::vector<PronyTerm> two_terms = {{0.3, 0.02}, {0.4, 0.5}};

/// A box to which sizes s of the deformation s F_0 are applied.
class StretchedBox {
 public:
  StretchedBox(const MaterialInfo& law, const std::string& element)
      : probe_(problem(law, element)), F0_(Eigen::Vector3d(1.1, 0.95, 1.3).asDiagonal()) {
    apply(1, 0, true);
    unit_ = deviator(1);
  }

  /// Returns the stress of shape at `time` [s] over the elastic one at the start.
  /// @param size   S_e over its first value
  /// @param final  true: later calls start from this state
  double stress(double size, double time, bool final) {
    apply(size, time, final);
    return deviator(1 / std::sqrt(size)) / unit_;
  }

 private:
  LevelProbe<HostBackend> probe_;
  Eigen::Matrix3d F0_;
  std::vector<Point> f_;
  double unit_ = 1;

  static Problem problem(const MaterialInfo& law, const std::string& element) {
    const auto box = jittered_box({{0, 0, 0}, {box_edge, box_edge, box_edge}}, {3, 3, 3});
    Problem p = verify_body(box, {std::string(law.name)});
    p.body.element = {element}, p.body.pressure = "plain", p.body.material.prony = two_terms;
    return p;
  }

  void apply(double size, double time, bool final) {
    const std::vector<Point> u =
        affine_field(probe_.problem.body.levels[0], 1 / std::sqrt(size) * F0_, Point::Zero());
    auto& level = probe_.at(0);
    copy(level.exec(), level.state.u, device_field<HostBackend>(u));
    if (final) level.accept_state(time);
    f_ = probe_.force(u, std::vector<Point>(u.size(), Point::Zero()), time);
  }

  /// Returns zz - xx of P F^T / s^2, which contains no pressure.
  double deviator(double s) const {
    const Eigen::Matrix3d P =
        virial(f_, probe_.problem.body.levels[0]) / (box_edge * box_edge * box_edge);
    const Eigen::Matrix3d tau = P * F0_ / s;
    return tau(2, 2) - tau(0, 0);
  }
};

double left_after(double t) {
  double sum = 1;
  for (const auto& [alpha, tau] : two_terms) sum -= alpha * (1 - std::exp(-t / tau));
  return sum;
}

/// Returns the relaxed stress for S_e = 1 + rate t.
double left_of_ramp(double rate, double t) {
  double sum = 1 + rate * t;
  for (const auto& [alpha, tau] : two_terms)
    sum -= alpha * (1 + rate * t - std::exp(-t / tau) + rate * tau * std::expm1(-t / tau));
  return sum;
}

/// Returns the parts of the response to S_e = 1 + a sin wt, over a, after the start has decayed:
/// {in phase, a quarter of a turn ahead}.
std::array<double, 2> moduli(StretchedBox& box, double w, double a, int steps) {
  const double period = 2 * std::numbers::pi / w, h = period / steps;
  const int before = static_cast<int>(std::ceil(15 * 0.5 / period)) * steps;
  std::array<double, 2> sums{};
  for (int n = 1; n <= before + steps; ++n) {
    const double s = box.stress(1 + a * std::sin(w * n * h), n * h, true);
    if (n > before) sums[0] += s * std::sin(w * n * h), sums[1] += s * std::cos(w * n * h);
  }
  return {2 * sums[0] / (steps * a), 2 * sums[1] / (steps * a)};
}

std::array<double, 2> known_moduli(double w) {
  std::array<double, 2> known{1, 0};
  for (const auto& [alpha, tau] : two_terms) {
    const double x = w * tau;
    known[0] -= alpha / (1 + x * x), known[1] += alpha * x / (1 + x * x);
  }
  return known;
}

VerifyRow relaxation_row(const char* quantity, const std::string& element) {
  VerifyRow row{.quantity = quantity, .unit = "1", .element = element, .mesh = "jittered"};
  row.source =
      "Simo & Hughes, Computational Inelasticity, 10.3: the convolution in closed form; alpha .3 "
      ".4, tau 20, 500 ms";
  row.judged = Judged::size, row.tolerance = 1e-10;
  return row;
}

}  // namespace

VerifyRows relaxation(const VerifyContext& context) {
  VerifyRows rows;
  for (const char* element : {"linear", "nodal"}) {
    VerifyRow step = relaxation_row("stress after a step of strain: largest error", element);
    VerifyRow ramp = relaxation_row(
        "stress on a ramp of S_e, in steps of 0.15 to 4 tau: largest error", element);
    VerifyRow within =
        relaxation_row("the same inside such steps, whose start is remembered", element);
    for (const MaterialInfo& law : material_list()) {
      if (!law.with_shape) continue;
      context.proceed();
      double worst[3] = {};
      const auto note = [&](int k, double found, double known) {
        worst[k] = std::max(worst[k], std::abs(found - known));
      };
      StretchedBox held(law, element), pulled(law, element);
      for (const double t : {0.0, 0.003, 0.08, 0.5, 3.0})
        note(0, held.stress(1, t, t != 0.08), left_after(t));
      for (const double t : {0.003, 0.08, 0.5, 0.6}) {
        note(2, pulled.stress(1 + 2 * t, t, false), left_of_ramp(2, t));
        note(1, pulled.stress(1 + 2 * t, t, true), left_of_ramp(2, t));
      }
      step.add(std::string(law.name), 1, worst[0]), ramp.add(std::string(law.name), 1, worst[1]);
      within.add(std::string(law.name), 1, worst[2]);
    }
    rows.insert(rows.end(), {step, ramp, within});
  }
  const double w = 2 * std::numbers::pi * 4;  // 4 Hz: 1/w lies between the terms' times
  const MaterialInfo& law = *find_material("neo_hookean");
  VerifyRow sine = relaxation_row("storage and loss moduli at 4 Hz: larger error", "linear");
  sine.judged = Judged::order, sine.accepted = 2, sine.tolerance = 0.1;
  for (const int steps : {16, 32, 64}) {
    context.proceed();
    StretchedBox box(law, "linear");
    const auto found = moduli(box, w, 0.4, steps), known = known_moduli(w);
    sine.add(std::to_string(steps) + " steps a turn", 1.0 / steps,
             std::max(std::abs(found[0] - known[0]), std::abs(found[1] - known[1])));
  }
  rows.push_back(sine);
  return rows;
}

}  // namespace plica
