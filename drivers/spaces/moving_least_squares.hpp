// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Eigenvalues>
#include <cmath>
#include <plica/drivers/spaces/edge_graph.hpp>
#include <plica/drivers/spaces/transfer_matrix.hpp>
#include <vector>

namespace plica {

/// The weight of a point at s radii: (1 - s)^2 (1 + 2 s), and 0 from s = 1.
inline double fit_weight(double s) { return s < 1 ? (1 - s) * (1 - s) * (1 + 2 * s) : 0; }

/// How the value of a field at one place follows from its values at points near it: the weighted
/// least-squares fit of degree one (moving least squares, Lancaster & Salkauskas 1981). Fields that
/// are linear there are reproduced. Points in a plane or on a line say nothing of the directions
/// across it: those can be left out of the fit, which then is constant in them.
class LinearFit {
 public:
  void clear() { offset_.clear(), weight_.clear(); }
  /// @param offset  from the place to the point [any length that is near 1 for all]
  /// @param weight  > 0
  void add(const Point& offset, double weight) {
    offset_.push_back(offset), weight_.push_back(weight);
  }
  std::size_t size() const { return offset_.size(); }

  /// After the points are in.
  void prepare() {
    sum_ = 0, centre_.setZero();
    Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
    for (std::size_t k = 0; k < size(); ++k) sum_ += weight_[k], centre_ += weight_[k] * offset_[k];
    centre_ /= sum_;
    for (std::size_t k = 0; k < size(); ++k)
      moments += weight_[k] / sum_ * (offset_[k] - centre_) * (offset_[k] - centre_).transpose();
    axes_.computeDirect(moments);
  }

  /// The variance of the points in the direction in which they are flattest.
  double flattest() const { return axes_.eigenvalues()[0]; }

  /// The points' weights without the `dropped` flattest directions; they sum to 1. Returns the sum
  /// of their magnitudes.
  double weights(int dropped, std::vector<double>& result) const {
    constexpr double flat = 1e-4;
    Point slope = Point::Zero();
    for (int k = dropped; k < 3; ++k)
      if (axes_.eigenvalues()[k] > flat)
        slope -= axes_.eigenvectors().col(k) *
                 (axes_.eigenvectors().col(k).dot(centre_) / axes_.eigenvalues()[k]);
    double magnitude = 0;
    result.resize(size());
    for (std::size_t k = 0; k < size(); ++k) {
      result[k] = weight_[k] / sum_ * (1 + slope.dot(offset_[k] - centre_));
      magnitude += std::abs(result[k]);
    }
    return magnitude;
  }

 private:
  std::vector<Point> offset_;
  std::vector<double> weight_;
  double sum_ = 0;
  Point centre_ = Point::Zero();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes_;
};

/// A field at some vertices of a graph from its values at points, which are vertices of it too,
/// [rows x points]: a linear fit at each (see LinearFit). A point at the distance d (see
/// EdgeGraph::distance) counts with the weight of s = d / r: parts of a body that are close but not
/// connected do not follow each other. r is `reach` times `spacing`; it grows up to 1.8 times while
/// there are fewer than six points or they do not give a good fit. What then is still flat is
/// fitted in fewer directions. Weights below 1e-4 are left out; rows sum to 1.
/// @param rows     the vertices
/// @param points   others, or the same
/// @param spacing  see PointGraph [m]
RowMatrix moving_least_squares(const EdgeGraph& graph, const std::vector<int>& rows,
                               const std::vector<int>& points, double spacing, double reach);

}  // namespace plica
