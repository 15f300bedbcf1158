// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/LU>
#include <algorithm>
#include <plica/drivers/solver/him/turning_axes.hpp>
#include <plica/drivers/solver/spaces/transfer_matrix.hpp>
#include <plica/kernels/him/coarse_axes.hpp>
#include <plica/kernels/vectors.hpp>

namespace plica {

namespace {

constexpr int smoothings = 6;
constexpr double least_mass = 1e-6, least_volume = 1e-4;  // of the largest, of the mesh's own
constexpr double least_mean = 1e-3;                       // left out of means

/// Where nothing of the finest mesh reaches a vertex: the mesh's motion there.
RowMatrix restriction_by_mass(const TetMesh& finest, const TetMesh& coarsest, const std::vector<double>& mass) {
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
    if (carried[a] > least && m > 0) entries.emplace_back(static_cast<int>(a), static_cast<int>(i), m / carried[a]);
  });
  const Embedding at = embed(coarsest.vertices, finest, Outside::extrapolate);
  for (std::size_t a = 0; a < carried.size(); ++a)
    for (std::size_t c = 0; c < 4 && !(carried[a] > least); ++c)
      entries.emplace_back(static_cast<int>(a), at.vertices[a][c], at.weights[a][c]);
  RowMatrix E(static_cast<Eigen::Index>(carried.size()), static_cast<Eigen::Index>(mass.size()));
  E.setFromTriplets(entries.begin(), entries.end());
  return E;
}

double edges_inverted(const std::vector<Point>& x, const std::array<int, 4>& tet, std::array<double, 10>& shape) {
  Eigen::Matrix3d edges;
  for (std::size_t s = 0; s < 3; ++s)
    edges.col(static_cast<Eigen::Index>(s)) =
        x[static_cast<std::size_t>(tet[s + 1])] - x[static_cast<std::size_t>(tet[0])];
  Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(shape.data()) = edges.inverse();
  return edges.determinant() / 6;
}

/// Each vertex's mean over its elements, by volume, of the means of their vertices; of flat ones by the volumes in the mesh.
RowMatrix neighbourhood_mean(const TetMesh& mesh, const std::vector<double>& volume, const std::vector<double>& sum) {
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

AxesShape axes_shape(const TetMesh& finest, const TetMesh& coarsest, const std::vector<double>& mass) {
  AxesShape result;
  result.restriction = restriction_by_mass(finest, coarsest, mass);
  std::vector<Point> x(coarsest.vertices.size(), Point::Zero());
  for (Eigen::Index a = 0; a < result.restriction.rows(); ++a)
    for (RowMatrix::InnerIterator entry(result.restriction, a); entry; ++entry)
      x[static_cast<std::size_t>(a)] += entry.value() * finest.vertices[static_cast<std::size_t>(entry.col())];
  std::vector<double> volume;
  double mean = 0;
  for (const auto& t : coarsest.tets) {
    std::array<double, 10> shape{};
    const double there = edges_inverted(coarsest.vertices, t, shape), here = edges_inverted(x, t, shape);
    const bool flat = !(here >= least_volume * there);
    if (flat) shape = {};
    volume.push_back(flat ? 0 : here), mean += there / static_cast<double>(coarsest.tets.size());
    result.tets.push_back(shape);
  }
  std::vector<double> sum(x.size(), 0.0);
  for (std::size_t e = 0; e < volume.size(); ++e) {
    result.tets[e][9] = volume[e] /= mean;
    for (const int a : coarsest.tets[e]) sum[static_cast<std::size_t>(a)] += volume[e];
  }
  const RowMatrix once = neighbourhood_mean(coarsest, volume, sum);
  RowMatrix all_of_it = once;
  for (int i = 1; i < smoothings; ++i) all_of_it = RowMatrix(all_of_it * once);
  all_of_it.prune([](Eigen::Index, Eigen::Index, double value) { return value > least_mean; });
  const Eigen::VectorXd sums = all_of_it * Eigen::Map<const Eigen::VectorXd>(sum.data(), once.rows());
  for (Eigen::Index a = 0; a < once.rows(); ++a)
    for (RowMatrix::InnerIterator entry(all_of_it, a); entry; ++entry)
      entry.valueRef() *= sums[a] > 0 ? 1 / sums[a] : 0.0;
  result.smoothing = all_of_it;
  return result;
}

namespace {

constexpr int most_rounds = 6;
constexpr double round_tolerance = 1e-3, least_share = 1e-6;  // of the momenta that the force adds, of all of them

}  // namespace

template <class B>
TurningAxes<B>::TurningAxes(const TetMesh& coarsest, const AxesShape& shape, const RowMatrix& all)
    : vertices_(static_cast<int>(coarsest.vertices.size())),
      tets_(static_cast<int>(coarsest.tets.size())),
      blocks_(vertices_),
      open_(zeros<Doubles<B>>("plica::axes.open", 1)),
      sums_(zeros<Doubles<B>>("plica::axes.sums", 3)) {
  const RowMatrix spread = shape.restriction.transpose();
  axes_.restriction = sparse_rows<B>("axes.restriction", shape.restriction);
  axes_.spread = sparse_rows<B>("axes.spread", spread);
  axes_.smoothing = sparse_rows<B>("axes.smoothing", shape.smoothing);
  axes_.smoothing_of = sparse_rows<B>("axes.smoothing_of", RowMatrix(shape.smoothing.transpose()));
  axes_.response = sparse_rows<B>("axes.response", RowMatrix(RowMatrix(all.transpose()) * spread));
  const auto n = static_cast<std::size_t>(vertices_);
  for (Vectors<B>* one : {&share_, &momentum_, &axes_.displacement, &axes_.force})
    *one = zeros<Vectors<B>>("plica::axes.vectors", n);
  for (Vectors<B>* one : {&axes_.gradient, &axes_.stiffness, &axes_.torque})
    *one = zeros<Vectors<B>>("plica::axes.matrices", 3 * n);
  std::vector<std::array<Real, 3>> unit(3 * n);
  for (std::size_t k = 0; k < unit.size(); ++k) unit[k][k % 3] = 1;
  rotation_ = to_device<Vectors<B>>("axes.rotation", unit);

  std::vector<std::vector<int>> around(n);
  std::vector<std::array<Real, 10>> shapes(coarsest.tets.size());
  for (std::size_t e = 0; e < coarsest.tets.size(); ++e) {
    for (std::size_t k = 0; k < 10; ++k) shapes[e][k] = static_cast<Real>(shape.tets[e][k]);
    for (std::size_t c = 0; c < 4; ++c)
      around[static_cast<std::size_t>(coarsest.tets[e][c])].push_back(static_cast<int>(4 * e + c));
  }
  axes_.of_tet = zeros<Vectors<B>>("plica::axes.matrices", 3 * coarsest.tets.size());
  std::vector<int> first{0}, places;
  for (const auto& own : around) {
    places.insert(places.end(), own.begin(), own.end());
    first.push_back(static_cast<int>(places.size()));
  }
  axes_.first = to_device<Indices<B>>("axes.first", first), axes_.place = to_device<Indices<B>>("axes.place", places);
  axes_.corner = to_device<decltype(axes_.corner)>("axes.corner", coarsest.tets);
  axes_.shape = to_device<decltype(axes_.shape)>("axes.shape", shapes);
}

template <class B>
void TurningAxes<B>::turn(const Exec& exec, const Vectors<B>& u, const Doubles<B>& moved) const {
  update_vertices<B>(exec, "plica::axes_restrict", vertices_,
                     MultiplyRows<B>{axes_.restriction, u, axes_.displacement});
  update_vertices<B>(exec, "plica::axes_gradients", tets_, GradientsOfTets<B>{axes_});
  update_vertices<B>(exec, "plica::axes_gradients", vertices_, SumGradients<B>{axes_});
  reduce<B, 2>(exec, "plica::axes_turn", vertices_, TurnAxes<B>{axes_, rotation_}, blocks_, moved);
}

template <class B>
void TurningAxes<B>::push(const Exec& exec, const Vectors<B>& q, const Filter& filter, double weight, double t,
                          const Model<B>& model, const Vectors<B>& p) const {
  const auto h = static_cast<Real>(t);
  fill(exec, open_, 1);
  combine<B>(exec, "plica::axes_momentum", 1, q, 1, share_, momentum_);  // where to start from
  for (int round = 0; round < most_rounds; ++round) {
    const Scalars<B>& x = filter(momentum_, open_);
    where_touching<B>(exec, open_, "plica::axes_torque", vertices_,
                      TorqueOnAxes<B>{axes_, rotation_, momentum_, x, static_cast<Real>(weight)});
    where_touching<B>(exec, open_, "plica::axes_torque", vertices_, TorqueOnGradients<B>{axes_});
    where_touching<B>(exec, open_, "plica::axes_force", tets_, ForcesOfTets<B>{axes_});
    where_touching<B>(exec, open_, "plica::axes_force", vertices_, SumForces<B>{axes_});
    reduce<B, 3>(exec, "plica::axes_momentum", vertices_,
                 NextMomentum<B>{axes_.response, axes_.force, q, share_, momentum_, open_, h}, blocks_, sums_);
    update_vertices<B>(exec, "plica::axes_decide", 1, DecideToGoOn<B>{sums_, open_, round_tolerance, least_share});
  }
  update_vertices<B>(exec, "plica::axes_push", model.vertices,
                     PushByAxes<B>{axes_.spread, model.inverse_mass, axes_.force, p, h});
}

template <class B>
std::size_t TurningAxes<B>::bytes() const {
  std::size_t total =
      bytes_of_views(axes_.first, axes_.place, axes_.of_tet, axes_.corner, axes_.shape, axes_.displacement,
                     axes_.gradient, axes_.stiffness, axes_.torque, axes_.force, rotation_, share_, momentum_);
  for (const SparseRows<B>* one :
       {&axes_.restriction, &axes_.spread, &axes_.smoothing, &axes_.smoothing_of, &axes_.response})
    total += bytes_of_rows(*one);
  return total;
}

#define PLICA_INSTANTIATE(Real, Exec) template class TurningAxes<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
