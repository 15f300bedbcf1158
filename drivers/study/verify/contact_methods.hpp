// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <plica/core/problem.hpp>
#include <plica/drivers/body/masses.hpp>
#include <plica/drivers/study/direct_solves.hpp>
#include <plica/drivers/study/sample_bodies.hpp>
#include <plica/drivers/study/verify/list.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <string>
#include <vector>

namespace plica {

/// An integrator, or cycle `him`, with its macro step.
struct ContactMethod {
  std::string name;
  double step = 0;  ///< [s]; 0: automatic

  void apply(Problem& p) const {
    if (name == "him")
      p.integration.cycle = name;
    else
      p.integration.integrator = {name};
    if (step > 0) p.integration.macro_step = step;
  }
  std::string text() const {
    return step > 0 ? name + " " + std::to_string(static_cast<int>(step * 1e3 + 0.5)) + " ms"
                    : name;
  }
};

/// Returns a problem of a body whose whole boundary can touch.
inline Problem touching_body(TetMesh mesh, const MaterialOptions& material) {
  Problem p = verify_body(std::move(mesh), material);
  p.body.surface = boundary_surface(p.body.levels[0]).surface;
  return p;
}

/// Sums over the vertices of level 0.
class BodySums {
 public:
  explicit BodySums(const Body& body)
      : mass_(lumped_masses(body.levels[0], region_densities(body, body.levels[0]))) {}
  double mass() const {
    double sum = 0;
    for (const double m : mass_) sum += m;
    return sum;
  }
  const std::vector<double>& masses() const { return mass_; }
  /// Returns the sum of a field of the vertices, weighted by their masses.
  Point of(const std::vector<Point>& field) const {
    Point sum = Point::Zero();
    for (std::size_t a = 0; a < mass_.size(); ++a) sum += mass_[a] * field[a];
    return sum;
  }

 private:
  std::vector<double> mass_;
};

/// Steps the simulation until a time [s], with the remedies of a run: a step that fails is repeated
/// in shorter ones. Calls look(simulation) after each step.
template <class Look>
void run_until(Simulation<HostBackend>& simulation, double time, const Look& look) {
  while (simulation.time() < time - 1e-9) {
    if (simulation.step_checked()) break;
    look(simulation);
  }
  require_sound(simulation);
}

}  // namespace plica
