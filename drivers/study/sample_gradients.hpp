// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <array>
#include <plica/core/small.hpp>
#include <plica/kernels/materials/list.hpp>
#include <random>
#include <vector>

// Deformation gradients for tests of materials.
namespace plica {

inline Eigen::Matrix3d random_rotation(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
      .normalized()
      .toRotationMatrix();
}

template <class T>
Mat3<T> mat3(const Eigen::Matrix3d& m) {
  using Real = typename LaneOf<T>::type;
  Mat3<T> A;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) A[r][c] = T(static_cast<Real>(m(r, c)));
  return A;
}

inline Eigen::Matrix3d eigen(const Mat3<double>& A) {
  Eigen::Matrix3d m;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) m(r, c) = A[r][c];
  return m;
}

/// Returns a material's constants for standard parameters and skew fibres (TissueSettings).
/// Standard are young_modulus 20 kPa, poisson_ratio 0.4, and the values of the others that it
/// declares.
template <class M>
typename M::template Constants<double> sample_constants() {
  std::vector<double> values;
  for (const MaterialParameter& p : M::parameters) values.push_back(p.standard);
  const std::vector<double> settings = as_list(TissueSettings{});
  values.insert(values.end(), settings.begin(), settings.end());
  return M::kernel_constants(values.data());
}

/// Returns the values of sample_constants() as constants of type T, a number or a pack.
template <class M, class T>
typename M::template Constants<T> sample_constants_as() {
  const std::vector<double> values = as_list(sample_constants<M>());
  return load_constants<M, T>(
      [&](int k) {
        return static_cast<typename LaneOf<T>::type>(values[static_cast<std::size_t>(k)]);
      },
      0);
}

/// A deformation gradient and the scale on which it may be varied.
struct Gradient {
  Eigen::Matrix3d F;
  double smallest;  ///< smallest singular value of F; 0.05 where it is 0
};

/// Returns mild, large and nearly flat deformations in random directions.
/// @param inverted  true: flat and inverted deformations too
inline std::vector<Gradient> gradients(bool inverted) {
  std::vector<Eigen::Vector3d> stretches = {{1.02, 0.99, 1.01}, {1.4, 0.8, 0.9},  {3.0, 0.5, 0.6},
                                            {1.1, 0.9, 1e-3},   {1.2, 0.7, 0.05}, {0.3, 0.25, 0.2}};
  if (inverted)
    stretches.insert(
        stretches.end(),
        {{1.2, 0.7, -0.2}, {1.1, 0.9, -1e-3}, {2.0, 1.1, -0.5}, {1.2, 0.8, 0.0}, {0.5, 0.2, -0.1}});
  std::mt19937 random(3);
  std::vector<Gradient> list;
  for (const Eigen::Vector3d& s : stretches)
    for (int i = 0; i < 3; ++i)
      list.push_back(
          {random_rotation(random) * s.asDiagonal() * random_rotation(random).transpose(),
           s[2] == 0 ? 0.05 : s.cwiseAbs().minCoeff()});
  return list;
}

}  // namespace plica
