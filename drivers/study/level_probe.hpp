// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <plica/core/to_device.hpp>
#include <plica/drivers/run/build_hierarchy.hpp>
#include <plica/drivers/run/diagnose.hpp>
#include <vector>

namespace plica {

/// Copies a host field to the device.
template <class B>
Vectors<B> device_field(const std::vector<Point>& field) {
  return to_device<Vectors<B>>("field", rows<typename B::Real>(field));
}

/// Levels of a problem, whose forces and matrix products are computed without an integrator.
template <class B>
class LevelProbe {
 public:
  explicit LevelProbe(const Problem& of) : problem(of), built(build_hierarchy<B>(problem, {})) {}
  Problem problem;
  BuiltHierarchy<B> built;

  Level<B>& at(int i) { return (*built.hierarchy)[i]; }
  std::size_t vertices(int i = 0) { return static_cast<std::size_t>(at(i).model.vertices); }
  std::vector<Point> zero(int i = 0) { return std::vector<Point>(vertices(i), Point::Zero()); }

  std::vector<Point> force(const std::vector<Point>& u, const std::vector<Point>& v,
                           double time = 0, int i = 0) {
    at(i).evaluate(state(u, v), time, at(i).f);
    return to_host<B>(built.hierarchy->exec(), at(i).f);
  }
  std::vector<Point> force(const std::vector<Point>& u) {
    return force(u, std::vector<Point>(u.size(), Point::Zero()));
  }

  /// Returns K(u) p, the elastic stiffness alone.
  std::vector<Point> stiffness(const std::vector<Point>& u, const std::vector<Point>& p,
                               int i = 0) {
    const LevelData<B>& level = at(i);
    at(i).tangent(state(u, p), device_field<B>(p));
    const auto shares = to_host<B>(built.hierarchy->exec(), level.partial);
    const auto host = [](const auto& view) {
      return Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), view);
    };
    const auto first = host(level.model.shares.first), copy = host(level.model.shares.row);
    const auto weight = host(level.model.shares.weight);
    std::vector<Point> q(p.size(), Point::Zero());
    for (std::size_t a = 0; a < q.size(); ++a)
      for (int s = first(a); s < first(a + 1); ++s)
        q[a] -= (weight.extent(0) > 0 ? static_cast<double>(weight(s)) : 1.0) *
                shares[static_cast<std::size_t>(copy(s))];
    return q;
  }

  /// Returns D(u) p: minus the force that a velocity p adds.
  std::vector<Point> damping(const std::vector<Point>& u, const std::vector<Point>& p, int i = 0) {
    std::vector<Point> q = force(u, zero(i), 0, i);
    const std::vector<Point> f = force(u, p, 0, i);
    for (std::size_t a = 0; a < q.size(); ++a) q[a] -= f[a];
    return q;
  }

  /// Returns K(u) p with the pressures that follow the body, at the time of the last evaluation.
  /// That evaluation must have been at u.
  std::vector<Point> tangent(const std::vector<Point>& u, const std::vector<Point>& p) {
    std::vector<Point> q = stiffness(u, p);
    const Vectors<B> added = device_field<B>(zero());
    at(0).add_term_product(state(u, p), device_field<B>(p), 1, false, added);
    const auto follower = to_host<B>(built.hierarchy->exec(), added);
    for (std::size_t a = 0; a < q.size(); ++a) q[a] += follower[a];
    return q;
  }

  /// Returns the elastic energy of level 0 [J], a sum of the vertices' shares.
  double elastic_energy(const std::vector<Point>& u) {
    const LevelData<B>& level = at(0);
    at(0).elasticity().energy(built.hierarchy->exec(), level, device_field<B>(u));
    const auto shares = to_host<B>(built.hierarchy->exec(), level.partial);
    double sum = 0;
    for (int i = 0; i < level.model.shares.rows; ++i) sum += shares[static_cast<std::size_t>(i)][0];
    return sum;
  }

  std::vector<double> mass(int i = 0) { return values(at(i).model.mass); }
  std::vector<double> inverse_mass(int i = 0) { return values(at(i).model.inverse_mass); }

  /// Returns the degrees of freedom of the free vertices, 3 a + k.
  std::vector<int> free(int i = 0) {
    std::vector<int> list;
    const auto inverse = inverse_mass(i);
    for (std::size_t a = 0; a < inverse.size(); ++a)
      for (int k = 0; k < 3 && inverse[a] > 0; ++k) list.push_back(static_cast<int>(3 * a) + k);
    return list;
  }

  /// Returns K(u) as a dense matrix over all degrees of freedom.
  Eigen::MatrixXd stiffness_matrix(const std::vector<Point>& u, int i = 0) {
    return matrix_of(u.size(), [&](const std::vector<Point>& p) { return stiffness(u, p, i); });
  }
  /// Returns D(u) as a dense matrix over all degrees of freedom.
  Eigen::MatrixXd damping_matrix(const std::vector<Point>& u, int i = 0) {
    return matrix_of(u.size(), [&](const std::vector<Point>& p) { return damping(u, p, i); });
  }

  /// Returns M^-1/2 A M^-1/2 over the free degrees of freedom. Its eigenvalues are the squares of
  /// the angular frequencies [1/s^2].
  Eigen::MatrixXd scaled_by_mass(const Eigen::MatrixXd& A, int i = 0) {
    const auto list = free(i);
    const auto m = mass(i);
    const auto n = static_cast<Eigen::Index>(list.size());
    Eigen::MatrixXd S(n, n);
    for (Eigen::Index r = 0; r < n; ++r)
      for (Eigen::Index c = 0; c < n; ++c) {
        const int a = list[static_cast<std::size_t>(r)], b = list[static_cast<std::size_t>(c)];
        S(r, c) = A(a, b) / std::sqrt(m[static_cast<std::size_t>(a / 3)] *
                                      m[static_cast<std::size_t>(b / 3)]);
      }
    return 0.5 * (S + S.transpose());
  }

 private:
  template <class Product>
  static Eigen::MatrixXd matrix_of(std::size_t vertices, const Product& product) {
    const auto n = static_cast<Eigen::Index>(3 * vertices);
    Eigen::MatrixXd A(n, n);
    std::vector<Point> p(vertices, Point::Zero());
    for (Eigen::Index j = 0; j < n; ++j) {
      p[static_cast<std::size_t>(j / 3)][j % 3] = 1;
      const auto column = product(p);
      p[static_cast<std::size_t>(j / 3)][j % 3] = 0;
      for (Eigen::Index r = 0; r < n; ++r) A(r, j) = column[static_cast<std::size_t>(r / 3)][r % 3];
    }
    return A;
  }
  static State<B> state(const std::vector<Point>& u, const std::vector<Point>& v) {
    State<B> s;
    s.u = device_field<B>(u), s.v = device_field<B>(v);
    return s;
  }
  static std::vector<double> values(const Scalars<B>& view) {
    const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), view);
    std::vector<double> list;
    for (std::size_t a = 0; a < host.extent(0); ++a) list.push_back(static_cast<double>(host(a)));
    return list;
  }
};

}  // namespace plica
