// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/drivers/study/static_equilibrium.hpp>
#include <stdexcept>

namespace plica {

namespace {

constexpr int most_iterations = 40, most_halvings = 12;
constexpr double round_off = 1e-8;  // of the largest residual: where it can no longer fall, below this, it is at rest

class Newton {
 public:
  Newton(LevelProbe<HostBackend>& probe, const StaticOptions& options)
      : probe_(probe), options_(options), stiffness_(probe, options.held) {}

  std::vector<Point> to(double time, std::vector<Point> u) {
    double size = residual(u, time).norm();
    largest_ = std::max(largest_, size);
    for (int i = 0; i < most_iterations; ++i) {
      if (size <= options_.relative_residual * largest_) return u;
      stiffness_.linearise(u);
      const auto change = stiffness_.equilibrium(forces(u, time));
      const auto moved = search(u, change, time, size);
      if (!moved && size <= round_off * largest_) return u;
      if (!moved) break;
      u = *moved;
    }
    throw std::runtime_error("Newton's method leaves a residual of " + std::to_string(size / largest_));
  }

 private:
  LevelProbe<HostBackend>& probe_;
  const StaticOptions& options_;
  SparseStiffness stiffness_;
  double largest_ = 0;

  std::vector<Point> forces(const std::vector<Point>& u, double time) {
    auto f = probe_.force(u, probe_.zero(), time);
    for (std::size_t a = 0; a < options_.force.size(); ++a) f[a] += options_.force[a];
    return f;
  }
  Eigen::VectorXd residual(const std::vector<Point>& u, double time) { return stiffness_.part(forces(u, time)); }

  // The first of u + change, u + change/2 ... with a smaller residual
  std::optional<std::vector<Point>> search(const std::vector<Point>& u, const std::vector<Point>& change, double time,
                                           double& size) {
    double step = 1;
    for (int i = 0; i < most_halvings; ++i, step /= 2) {
      auto moved = u;
      for (std::size_t a = 0; a < u.size(); ++a) moved[a] += step * change[a];
      const double next = residual(moved, time).norm();
      if (!(next < size)) continue;
      size = next;
      return moved;
    }
    return {};
  }
};

}  // namespace

std::vector<Point> static_equilibrium(LevelProbe<HostBackend>& probe, const StaticOptions& options) {
  Newton newton(probe, options);
  std::vector<Point> u = options.start.empty() ? probe.zero() : options.start;
  for (int s = 1; s <= options.load_steps; ++s) u = newton.to(double(s) / options.load_steps, std::move(u));
  return u;
}

}  // namespace plica
