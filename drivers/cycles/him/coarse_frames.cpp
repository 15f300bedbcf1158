// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/LU>
#include <Kokkos_Profiling_ScopedRegion.hpp>
#include <algorithm>
#include <map>
#include <plica/core/to_device.hpp>
#include <plica/drivers/cycles/him/coarse_frames.hpp>
#include <plica/drivers/spaces/transfer_matrix.hpp>
#include <plica/kernels/vectors.hpp>

namespace plica {

namespace {

constexpr int smoothings = 6;
// over the largest mass of a vertex; over the volume of the element in the mesh
constexpr double least_mass = 1e-6, least_volume = 1e-4;
constexpr double least_mean = 1e-3;  // smaller weights are left out of means

/// Returns E: the mean by mass over the finest vertices in the elements around a coarse vertex.
/// A coarse vertex with almost no such mass takes the finest mesh's motion at its place.
RowMatrix restriction_by_mass(const TetMesh& finest, const TetMesh& coarsest,
                              const std::vector<double>& mass) {
  const Embedding in = embed(finest.vertices, coarsest, Outside::clamp);
  std::vector<double> carried(coarsest.vertices.size(), 0.0);
  const auto each = [&](const auto& use) {
    for (std::size_t i = 0; i < mass.size(); ++i)
      for (std::size_t c = 0; c < 4; ++c)
        use(i, static_cast<std::size_t>(in.vertices[i][c]), mass[i] * in.weights[i][c]);
  };
  each([&](std::size_t, std::size_t a, double m) { carried[a] += m; });
  const double least = least_mass * *std::max_element(carried.begin(), carried.end());
  std::vector<Eigen::Triplet<double>> entries;
  each([&](std::size_t i, std::size_t a, double m) {
    if (carried[a] > least && m > 0)
      entries.emplace_back(static_cast<int>(a), static_cast<int>(i), m / carried[a]);
  });
  const Embedding at = embed(coarsest.vertices, finest, Outside::extrapolate);
  for (std::size_t a = 0; a < carried.size(); ++a)
    for (std::size_t c = 0; c < 4 && !(carried[a] > least); ++c)
      entries.emplace_back(static_cast<int>(a), at.vertices[a][c], at.weights[a][c]);
  RowMatrix E(static_cast<Eigen::Index>(carried.size()), static_cast<Eigen::Index>(mass.size()));
  E.setFromTriplets(entries.begin(), entries.end());
  return E;
}

Eigen::Matrix3d edges_of(const std::vector<Point>& x, const std::array<int, 4>& tet) {
  Eigen::Matrix3d edges;
  for (std::size_t s = 0; s < 3; ++s)
    edges.col(static_cast<Eigen::Index>(s)) =
        x[static_cast<std::size_t>(tet[s + 1])] - x[static_cast<std::size_t>(tet[0])];
  return edges;
}

double volume_of(const std::vector<Point>& x, const std::array<int, 4>& tet) {
  return edges_of(x, tet).determinant() / 6;
}

/// Returns E times positions.
std::vector<Point> restricted(const RowMatrix& E, const std::vector<Point>& fine) {
  std::vector<Point> x(static_cast<std::size_t>(E.rows()), Point::Zero());
  for (Eigen::Index a = 0; a < E.rows(); ++a)
    for (RowMatrix::InnerIterator entry(E, a); entry; ++entry)
      x[static_cast<std::size_t>(a)] += entry.value() * fine[static_cast<std::size_t>(entry.col())];
  return x;
}

/// Returns for each vertex the mean over its elements, by volume, of the means of their vertices.
/// Where all elements of a vertex are flat, they count alike.
RowMatrix neighbourhood_mean(const TetMesh& mesh, const std::vector<double>& volume,
                             const std::vector<double>& sum) {
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<double> own(sum.size(), 0.0);
  for (const auto& t : mesh.tets)
    for (const int a : t) own[static_cast<std::size_t>(a)] += 1;
  for (std::size_t e = 0; e < mesh.tets.size(); ++e)
    for (const int a : mesh.tets[e]) {
      const auto row = static_cast<std::size_t>(a);
      for (const int b : mesh.tets[e])
        entries.emplace_back(a, b, (sum[row] > 0 ? volume[e] / sum[row] : 1 / own[row]) / 4);
    }
  const auto n = static_cast<Eigen::Index>(sum.size());
  RowMatrix A(n, n);
  A.setFromTriplets(entries.begin(), entries.end());
  return A;
}

}  // namespace

FrameShape frames_of_mesh(const TetMesh& finest, const TetMesh& coarsest,
                          const std::vector<double>& mass) {
  const Kokkos::Profiling::ScopedRegion region("plica: coarse axes");
  FrameShape result;
  result.restriction = restriction_by_mass(finest, coarsest, mass);
  const std::vector<Point> x = restricted(result.restriction, finest.vertices);
  double mean = 0;
  for (const auto& t : coarsest.tets)
    mean += volume_of(coarsest.vertices, t) / static_cast<double>(coarsest.tets.size());
  std::vector<double> volume;
  std::vector<std::map<int, Point>> gradient(x.size());
  result.at_rest.assign(x.size(), 0.0);
  for (const auto& t : coarsest.tets) {
    const double here = volume_of(x, t);
    const bool flat = !(here >= least_volume * volume_of(coarsest.vertices, t));
    volume.push_back(flat ? 0 : here / mean);
    if (flat) continue;
    const Eigen::Matrix3d inverse = edges_of(x, t).inverse();
    for (const int a : t) {
      const auto add = [&](int b, const Point& derivative) {
        gradient[static_cast<std::size_t>(a)].try_emplace(b, Point::Zero()).first->second +=
            volume.back() * derivative;
      };
      add(t[0], -inverse.colwise().sum().transpose());
      for (int s = 0; s < 3; ++s)
        add(t[static_cast<std::size_t>(s) + 1], inverse.row(s).transpose());
      result.at_rest[static_cast<std::size_t>(a)] += volume.back();
    }
  }
  for (const auto& row : gradient) result.gradient.emplace_back(row.begin(), row.end());
  const RowMatrix once = neighbourhood_mean(coarsest, volume, result.at_rest);
  RowMatrix W = once;
  for (int i = 1; i < smoothings; ++i) W = RowMatrix(W * once);
  W.prune([](Eigen::Index, Eigen::Index, double value) { return value > least_mean; });
  const Eigen::VectorXd sums =
      W * Eigen::Map<const Eigen::VectorXd>(result.at_rest.data(), once.rows());
  for (Eigen::Index a = 0; a < once.rows(); ++a)
    for (RowMatrix::InnerIterator entry(W, a); entry; ++entry)
      entry.valueRef() *= sums[a] > 0 ? 1 / sums[a] : 0.0;
  result.smoothing = std::move(W);
  return result;
}

namespace {

/// Returns the four largest |weights| of each vertex of the finest mesh, scaled to the sum 1.
RowMatrix main_weights(const RowMatrix& P) {
  constexpr std::size_t most = 4;
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<std::pair<double, int>> row;
  for (Eigen::Index a = 0; a < P.rows(); ++a) {
    row.clear();
    for (RowMatrix::InnerIterator entry(P, a); entry; ++entry)
      row.emplace_back(std::abs(entry.value()), static_cast<int>(entry.col()));
    const std::size_t kept = std::min(row.size(), most);
    std::partial_sort(row.begin(), row.begin() + static_cast<std::ptrdiff_t>(kept), row.end(),
                      std::greater<>());
    row.resize(kept);
    double sum = 0;
    for (const auto& [weight, column] : row) sum += weight;
    for (const auto& [weight, column] : row)
      entries.emplace_back(static_cast<int>(a), column, weight / sum);
  }
  RowMatrix result(P.rows(), P.cols());
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

void divide_by_row_sums(RowMatrix& A) {
  for (Eigen::Index a = 0; a < A.rows(); ++a) {
    double sum = 0;
    for (RowMatrix::InnerIterator entry(A, a); entry; ++entry) sum += entry.value();
    for (RowMatrix::InnerIterator entry(A, a); entry; ++entry)
      entry.valueRef() *= sum > 0 ? 1 / sum : 0.0;
  }
}

/// Matrix of derivatives, one for each direction.
using DirectedRows = std::array<RowMatrix, 3>;

}  // namespace

FrameShape frames_of_space(const TetMesh& finest, const RowMatrix& to_finest,
                           const std::vector<double>& mass) {
  const Kokkos::Profiling::ScopedRegion region("plica: coarse axes");
  FrameShape result;
  const Eigen::Index n = to_finest.cols();
  const Eigen::Map<const Eigen::VectorXd> m(mass.data(), to_finest.rows());
  const RowMatrix weights = main_weights(to_finest),
                  carried = RowMatrix(weights.transpose()) * m.asDiagonal();
  result.restriction = carried;
  divide_by_row_sums(result.restriction);
  const std::vector<Point> x = restricted(result.restriction, finest.vertices);
  // W: mean over all points that share a finest vertex with a point
  RowMatrix W = product(carried, weights);
  divide_by_row_sums(W);
  // h_ab = sum over the finest vertices i of weight_ia m_i (X_i - x_a) Pi_ib, so that sum_b u_b
  // h_ab^T is the moment of the motion about x_a; smoothed once by W. Times the inverse moment of
  // rest positions it is a gradient.
  DirectedRows h;
  for (int k = 0; k < 3; ++k) {
    RowMatrix lever = carried;
    for (Eigen::Index a = 0; a < n; ++a)
      for (RowMatrix::InnerIterator entry(lever, a); entry; ++entry)
        entry.valueRef() *= finest.vertices[static_cast<std::size_t>(entry.col())][k] -
                            x[static_cast<std::size_t>(a)][k];
    h[static_cast<std::size_t>(k)] = product(W, product(lever, to_finest));
  }
  result.gradient.resize(static_cast<std::size_t>(n)),
      result.at_rest.assign(static_cast<std::size_t>(n), 1.0);
  for (Eigen::Index a = 0; a < n; ++a) {
    std::map<int, Point> row;
    for (int k = 0; k < 3; ++k)
      for (RowMatrix::InnerIterator entry(h[static_cast<std::size_t>(k)], a); entry; ++entry)
        row.try_emplace(static_cast<int>(entry.col()), Point::Zero()).first->second[k] =
            entry.value();
    Eigen::Matrix3d rest = Eigen::Matrix3d::Zero();
    Point sum = Point::Zero();
    for (const auto& [b, derivative] : row)
      rest += (x[static_cast<std::size_t>(b)] - x[static_cast<std::size_t>(a)]) *
              derivative.transpose(),
          sum += derivative;
    row.try_emplace(static_cast<int>(a), Point::Zero()).first->second -=
        sum;  // makes the row sum to 0: a translation has no gradient
    const Eigen::Matrix3d inverse = rest.inverse();
    // without a gradient this point's frame does not turn
    if (!(std::abs(rest.determinant()) > 0) || !inverse.allFinite()) continue;
    for (const auto& [b, derivative] : row)
      result.gradient[static_cast<std::size_t>(a)].emplace_back(b,
                                                                inverse.transpose() * derivative);
  }
  result.smoothing = std::move(W);
  return result;
}

namespace {

/// Dense matrix [n][3 n or n] in the order of FrameFields: [groups of rows][columns][rows of a
/// group].
template <class B, class Number>
class DenseMatrix {
 public:
  DenseMatrix(Eigen::Index rows, Eigen::Index columns)
      : columns_(columns),
        values_(static_cast<std::size_t>((rows + group - 1) / group * group * columns)) {}
  void set(Eigen::Index row, Eigen::Index column, double value) {
    values_[static_cast<std::size_t>((row / group * columns_ + column) * group + row % group)] =
        static_cast<Number>(value);
  }
  typename FrameFields<B>::template Dense<Number> on_device(const std::string& name) const {
    return to_device<typename FrameFields<B>::template Dense<Number>>(name, values_);
  }

 private:
  static constexpr Eigen::Index group = CoarseInverseMass<B>::group;
  Eigen::Index columns_;
  std::vector<Number> values_;
};

template <class Add>
void for_entries(const RowMatrix& A, const Add& add) {
  for (Eigen::Index a = 0; a < A.rows(); ++a)
    for (RowMatrix::InnerIterator entry(A, a); entry; ++entry) add(a, entry.col(), entry.value());
}

/// Sets the matrices of FrameFields that depend on the gradient G = W D.
template <class B>
void set_gradient(const FrameShape& shape, const RowMatrix& moved, FrameFields<B>& frames) {
  using Real = typename B::Real;
  const Eigen::Index n = moved.rows();
  DenseMatrix<B, Real> force_of(n, 3 * n);
  DenseMatrix<B, float> response(n, 3 * n);
  for (int j = 0; j < 3; ++j) {
    std::vector<std::vector<std::pair<int, double>>> derivative;
    for (const auto& row : shape.gradient)
      for (auto& to = derivative.emplace_back(); const auto& [b, d] : row) to.emplace_back(b, d[j]);
    const RowMatrix G = product(shape.smoothing, matrix_of_rows(derivative, n));
    DenseMatrix<B, Real> gradient_of(n, n);
    for_entries(G, [&](Eigen::Index a, Eigen::Index b, double value) {
      gradient_of.set(a, b, value), force_of.set(b, 3 * a + j, value);
    });
    for_entries(
        product(moved, RowMatrix(G.transpose())),
        [&](Eigen::Index a, Eigen::Index b, double value) { response.set(a, 3 * b + j, value); });
    frames.gradient_of[j] = gradient_of.on_device("axes.gradient_of");
  }
  frames.force_of = force_of.on_device("axes.force_of"),
  frames.response = response.on_device("axes.response");
  const Eigen::VectorXd rest =
      shape.smoothing * Eigen::Map<const Eigen::VectorXd>(shape.at_rest.data(), n);
  frames.at_rest =
      to_device<Scalars<B>>("axes.at_rest", std::vector<Real>(rest.begin(), rest.end()));
}

}  // namespace

template <class B>
CoarseFrames<B>::CoarseFrames(const FrameShape& shape, const RowMatrix& moved,
                              const RankLevel<B>* part)
    : vertices_(static_cast<int>(shape.at_rest.size())),
      sums_(zeros<Sums>("plica::axes.sums",
                        static_cast<std::size_t>(most_rounds * groups_of<B>(vertices_)))) {
  const RowMatrix spread = shape.restriction.transpose();
  if (part)
    restriction_ =
        std::make_unique<SharedProduct<B, Real>>(*part, "axes.restriction", shape.restriction);
  else
    frames_.restriction = sparse_rows<B>("axes.restriction", shape.restriction);
  frames_.spread =
      sparse_rows<B>("axes.spread", part ? some_rows(spread, part->part.vertex) : spread);
  set_gradient<B>(shape, moved, frames_);
  const auto n = static_cast<std::size_t>(vertices_);
  for (Vectors<B>* one : {&share_, &frames_.displacement, &frames_.force})
    *one = zeros<Vectors<B>>("plica::axes.vectors", n);
  frames_.angles =
      zeros<Doubles<B>>("plica::axes.angles", static_cast<std::size_t>(groups_of<B>(vertices_)));
  for (Vectors<B>* one : {&frames_.stiffness, &frames_.torque})
    *one = zeros<Vectors<B>>("plica::axes.matrices", 3 * n);
  std::vector<std::array<Real, 3>> unit(3 * n);
  for (std::size_t k = 0; k < unit.size(); ++k) unit[k][k % 3] = 1;
  rotation_ = to_device<Vectors<B>>("axes.rotation", unit);
}

template <class B>
void CoarseFrames<B>::turn(const Exec& exec, const Vectors<B>& u) const {
  if (restriction_)
    (*restriction_)(exec, u, frames_.displacement);
  else
    update_vertices<B>(exec, "plica::axes_restrict", vertices_,
                       MultiplyRows<B>{frames_.restriction, u, frames_.displacement});
  update_vertices<B>(exec, "plica::axes_turn", groups_of<B>(vertices_),
                     TurnFrames<B>{frames_, rotation_});
}

template <class B>
void CoarseFrames<B>::find_torques(const Exec& exec, const Vectors<B>& given,
                                   const CoarseInverseMass<B>& filter, double weight,
                                   double t) const {
  const CoarseMomentum<B> momentum{given, share_};
  const int groups = groups_of<B>(vertices_);
  FrameRound<B> last;
  for (int i = 0; i < most_rounds; ++i) {
    update_vertices<B>(exec, "plica::axes_torque", groups,
                       TorqueOnFrames<B>{frames_, filter, last, static_cast<Real>(weight)});
    const FrameRound<B> now = round(i);
    update_vertices<B>(exec, "plica::axes_momentum", groups,
                       NextMomentum<B>{frames_, filter, momentum, last, now, static_cast<Real>(t)});
    last = now;
  }
}

#define PLICA_INSTANTIATE(Real, Exec) template class CoarseFrames<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
