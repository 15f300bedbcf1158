// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Eigenvalues>
#include <cmath>
#include <plica/drivers/spaces/edge_graph.hpp>
#include <plica/drivers/spaces/transfer_matrix.hpp>
#include <vector>

namespace plica {

/// Returns the weight of a point at s radii: (1 - s)^2 (1 + 2 s), and 0 from s = 1.
inline double fit_weight(double s) { return s < 1 ? (1 - s) * (1 - s) * (1 + 2 * s) : 0; }

/// Weighted least-squares fit of degree one to a field, from its values at points near a place.
/// These are moving least squares (Lancaster & Salkauskas 1981). Linear fields are reproduced.
/// Points in a plane or on a line do not define the slope across it. Such directions can be left
/// out of the fit, which is then constant along them.
class LinearFit {
 public:
  /// Removes all points.
  void clear() { offset_.clear(), weight_.clear(); }
  /// Adds a point.
  /// @param offset  from the place to the point, in a unit of length that makes all offsets near 1
  /// @param weight  > 0
  void add(const Point& offset, double weight) {
    offset_.push_back(offset), weight_.push_back(weight);
  }
  /// Returns the number of points.
  std::size_t size() const { return offset_.size(); }

  /// Computes the moments of the points; call it after the last add().
  void prepare() {
    sum_ = 0, centre_.setZero();
    Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
    for (std::size_t k = 0; k < size(); ++k) sum_ += weight_[k], centre_ += weight_[k] * offset_[k];
    centre_ /= sum_;
    for (std::size_t k = 0; k < size(); ++k)
      moments += weight_[k] / sum_ * (offset_[k] - centre_) * (offset_[k] - centre_).transpose();
    axes_.computeDirect(moments);
  }

  /// Returns the variance of the points in the direction in which they are flattest.
  double flattest() const { return axes_.eigenvalues()[0]; }

  /// Computes the weights of the points in the fit without the `dropped` flattest directions. They
  /// sum to 1. Returns the sum of their magnitudes.
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

/// Returns the matrix that gives a field at vertices of a graph from its values at points, [rows x
/// points]. Each row is a LinearFit at a vertex. A point at the distance d (see
/// EdgeGraph::distance) has the fit_weight() of s = d / r. Distances are along edges, so that parts
/// of a body that are close but not connected do not follow each other. r is `reach` times
/// `spacing`. It grows up to 1.8 times while there are fewer than six points or the fit is not
/// good. If it then is not good yet, the flattest directions are left out. Weights below 1e-4 are
/// left out; rows sum to 1.
/// @param rows     vertices of the graph
/// @param points   vertices of the graph; they may also be in `rows`
/// @param spacing  see PointGraph [m]
/// @param reach    radius r over the spacing
RowMatrix moving_least_squares(const EdgeGraph& graph, const std::vector<int>& rows,
                               const std::vector<int>& points, double spacing, double reach);

}  // namespace plica
