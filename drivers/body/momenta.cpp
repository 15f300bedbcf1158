// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Eigenvalues>
#include <plica/core/row_ranges.hpp>
#include <plica/drivers/body/momenta.hpp>

namespace plica {

Momenta momenta_of(const std::vector<double>& mass, const std::vector<Point>& x,
                   const std::vector<Point>& v) {
  Momenta sum;
  for (std::size_t a = 0; a < mass.size(); ++a)
    sum.linear += mass[a] * v[a], sum.angular += mass[a] * x[a].cross(v[a]);
  return sum;
}

// The motion is a + w cross r, with r from the mass centre of the chosen vertices. Then the missing
// momentum is M a, and the missing angular momentum about that centre J w
void restore_momenta(const Momenta& given, const std::vector<double>& mass,
                     const std::vector<Point>& x, const std::vector<int>& chosen,
                     std::vector<Point>& v) {
  constexpr double flat = 1e-9;  // relative moment of inertia about a line of vertices
  constexpr int passes = 2;      // the second one removes the rounding of the first
  if (chosen.empty()) return;
  double total = 0;
  Point centre = Point::Zero();
  for (const int a : chosen)
    total += mass[index_of(a)], centre += mass[index_of(a)] * x[index_of(a)];
  centre /= total;
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  for (const int a : chosen) {
    const Point r = x[index_of(a)] - centre;
    inertia +=
        mass[index_of(a)] * (r.squaredNorm() * Eigen::Matrix3d::Identity() - r * r.transpose());
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(inertia);
  for (int pass = 0; pass < passes; ++pass) {
    const Momenta now = momenta_of(mass, x, v);
    const Point missing = given.linear - now.linear,
                moment = given.angular - now.angular - centre.cross(missing);
    Point spin = Point::Zero();
    for (int k = 0; k < 3; ++k)
      if (principal.eigenvalues()[k] > flat * principal.eigenvalues()[2]) {
        const Point axis = principal.eigenvectors().col(k);
        spin += axis.dot(moment) / principal.eigenvalues()[k] * axis;
      }
    for (const int a : chosen)
      v[index_of(a)] += missing / total + spin.cross(Point(x[index_of(a)] - centre));
  }
}

}  // namespace plica
