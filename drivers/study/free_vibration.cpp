// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/solver/simulation.hpp>
#include <plica/drivers/study/free_vibration.hpp>
#include <plica/drivers/study/sparse_stiffness.hpp>
#include <stdexcept>

namespace plica {

double frequency_of_motion(const Problem& problem, const std::vector<Point>& shape, double amplitude, int periods,
                           double guess) {
  Simulation<HostBackend> simulation(problem);
  std::size_t tip = 0;
  for (std::size_t a = 0; a < shape.size(); ++a)
    if (shape[a].norm() > shape[tip].norm()) tip = a;
  std::vector<Point> u = shape;
  for (Point& p : u) p *= amplitude / shape[tip].norm();
  simulation.set_state(u, std::vector<Point>(u.size(), Point::Zero()));
  const Point direction = shape[tip].normalized();
  const auto displacement = simulation.displacement();
  double before = amplitude, first = -1, last = -1;
  int crossings = 0;
  while (simulation.time() < (periods + 1) / guess) {
    simulation.step();
    Kokkos::fence("plica::frequency_of_motion");
    double now = 0;
    for (int k = 0; k < 3; ++k) now += direction[k] * displacement(tip, static_cast<std::size_t>(k));
    if (before > 0 && now <= 0) {
      last = simulation.time() - simulation.macro_step() * now / (now - before);
      if (crossings++ == 0) first = last;
    }
    before = now;
  }
  if (const auto bad = simulation.check()) throw std::runtime_error(bad->text());
  return (crossings - 1) / (last - first);
}

}  // namespace plica
