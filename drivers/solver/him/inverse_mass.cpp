// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/LU>
#include <plica/drivers/solver/him/inverse_mass.hpp>
#include <plica/drivers/solver/set_up/build_surface.hpp>
#include <plica/drivers/solver/set_up/to_device.hpp>
#include <plica/kernels/contact/where_touching.hpp>
#include <plica/kernels/him/coarse_filter.hpp>
#include <plica/kernels/him/sparse_rows.hpp>

namespace plica {

namespace {

template <class B>
SparseRows<B> sparse_rows(const std::string& name, const RowMatrix& A) {
  std::vector<int> first{0}, column;
  std::vector<typename B::Real> value;
  for (Eigen::Index a = 0; a < A.rows(); ++a) {
    for (RowMatrix::InnerIterator entry(A, a); entry; ++entry) {
      column.push_back(static_cast<int>(entry.col()));
      value.push_back(static_cast<typename B::Real>(entry.value()));
    }
    first.push_back(static_cast<int>(column.size()));
  }
  return {static_cast<int>(A.rows()), to_device<Indices<B>>(name + ".first", first),
          to_device<Indices<B>>(name + ".column", column), to_device<Scalars<B>>(name + ".value", value)};
}

template <class B>
MassLevel<B> mass_level(const MassSpace& space, bool coarsest) {
  using Real = typename B::Real;
  MassLevel<B> level;
  level.vertices = static_cast<int>(space.up.cols());
  level.up = sparse_rows<B>("him.up", space.up);
  level.down = sparse_rows<B>("him.down", RowMatrix(space.up.transpose()));
  if (!coarsest) {
    const auto n = static_cast<Eigen::Index>(space.inverse_diagonal.size());
    const Eigen::Map<const Eigen::VectorXd> inverse(space.inverse_diagonal.data(), n);
    level.mass = sparse_rows<B>("him.mass", RowMatrix(space.mass * inverse.asDiagonal()));
    level.inverse_diagonal = to_device<Scalars<B>>(
        "him.inverse_diagonal", std::vector<Real>(space.inverse_diagonal.begin(), space.inverse_diagonal.end()));
  }
  level.force = Vectors<B>("plica::him.force", level.vertices);
  level.acceleration = Vectors<B>("plica::him.acceleration", level.vertices);
  return level;
}

template <class... Views>
std::size_t bytes_of_views(const Views&... views) {
  return (0 + ... + (views.span() * sizeof(typename Views::value_type)));
}

template <class B>
std::size_t bytes_of_rows(const SparseRows<B>& A) {
  return bytes_of_views(A.first, A.column, A.value);
}

}  // namespace

template <class B>
InverseMass<B>::InverseMass(const Level<B>& finest, const TetMesh& finest_mesh, const TetMesh& coarsest,
                            const std::vector<MassSpace>& spaces)
    : vertices_(finest.model.vertices), inverse_mass_(finest.model.inverse_mass), weights_{1} {
  for (std::size_t i = 0; i < spaces.size(); ++i) coarser_.push_back(mass_level<B>(spaces[i], i + 1 == spaces.size()));
  if (!spaces.empty()) build_axes(finest_mesh, coarsest);
}

template <class B>
void InverseMass<B>::build_axes(const TetMesh& finest, const TetMesh& coarsest) {
  filter_.vertices = static_cast<int>(coarsest.vertices.size());
  const auto n = static_cast<std::size_t>(filter_.vertices);
  filter_.sample = build_transfer<B>("him.sample", embed(coarsest.vertices, finest, Outside::extrapolate), {});
  filter_.turned = Vectors<B>("plica::him.turned", n);
  filter_.displacement = Vectors<B>("plica::him.displacement", n);
  std::vector<std::array<Real, 3>> axes(3 * n);
  for (std::size_t k = 0; k < axes.size(); ++k) axes[k][k % 3] = 1;
  filter_.rotation = to_device<Vectors<B>>("him.rotation", axes);
  const std::size_t block = CoarseFilter<B>::block;
  filtered_ = Scalars<B>("plica::him.filtered", (3 * n + block - 1) / block * block);
  blocks_ = BlockSums<B>(filter_.vertices);

  std::vector<std::vector<int>> around(n);
  std::vector<std::array<Real, 12>> shapes;
  for (std::size_t e = 0; e < coarsest.tets.size(); ++e) {
    const auto& tet = coarsest.tets[e];
    Eigen::Matrix3d edges;
    for (std::size_t s = 0; s < 3; ++s)
      edges.col(static_cast<Eigen::Index>(s)) =
          coarsest.vertices[static_cast<std::size_t>(tet[s + 1])] - coarsest.vertices[static_cast<std::size_t>(tet[0])];
    const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> inverse = edges.inverse();
    std::array<Real, 12> shape{};
    for (std::size_t k = 0; k < 9; ++k) shape[k] = static_cast<Real>(inverse.data()[k]);
    shape[9] = static_cast<Real>(edges.determinant() / 6);
    shapes.push_back(shape);
    for (const int v : tet) around[static_cast<std::size_t>(v)].push_back(static_cast<int>(e));
  }
  std::vector<int> first{0}, tets;
  for (const auto& own : around) {
    tets.insert(tets.end(), own.begin(), own.end());
    first.push_back(static_cast<int>(tets.size()));
  }
  filter_.first = to_device<Indices<B>>("him.first", first), filter_.tet = to_device<Indices<B>>("him.tet", tets);
  filter_.corner = to_device<decltype(filter_.corner)>("him.corner", coarsest.tets);
  filter_.shape = to_device<decltype(filter_.shape)>("him.shape", shapes);
}

template <class B>
void InverseMass<B>::set_answer(const Eigen::MatrixXd& S) {
  if (coarser_.empty()) return;
  constexpr Eigen::Index block = CoarseFilter<B>::block;
  const Eigen::Index n = S.rows(), blocks = (n + block - 1) / block;
  std::vector<float> values(static_cast<std::size_t>(blocks * n * block), 0.0F);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      values[static_cast<std::size_t>((i / block * n + j) * block + i % block)] =
          static_cast<float>(0.5 * (S(i, j) + S(j, i)));
  filter_.matrix = to_device<decltype(filter_.matrix)>("him.filter", values);
}

template <class B>
void InverseMass<B>::turn(const Exec& exec, const Vectors<B>& u,
                          const Kokkos::View<double*, typename B::Memory>& moved) const {
  if (coarser_.empty()) return;
  update_vertices<B>(exec, "plica::him_sample", filter_.vertices,
                     SampleDisplacement<B>{filter_.sample, u, filter_.displacement});
  reduce<B, 2>(exec, "plica::him_turn", filter_.vertices, TurnAxes<B>{filter_}, blocks_, moved);
}

template <class B>
void InverseMass<B>::answer_coarsest(const Exec& exec, const Count& count) const {
  const MassLevel<B>& level = coarser_.back();
  where_touching<B>(exec, count, "plica::him_turn_forces", level.vertices, TurnForces<B>{filter_, level.force});
  where_touching<B>(exec, count, "plica::him_filter", static_cast<int>(filtered_.extent(0)) / FilterForces<B>::rows,
                    FilterForces<B>{filter_, filtered_});
  where_touching<B>(exec, count, "plica::him_turn_back", level.vertices,
                    TurnBack<B>{filter_, filtered_, level.acceleration, static_cast<Real>(weights_.back())});
}

template <class B>
void InverseMass<B>::apply(const Exec& exec, const Vectors<B>& f, const Vectors<B>& a, const Count& count) const {
  Vectors<B> finer = f;
  for (const MassLevel<B>& level : coarser_) {
    where_touching<B>(exec, count, "plica::him_down", level.vertices, MultiplyRows<B>{level.down, finer, level.force});
    finer = level.force;
  }
  if (!coarser_.empty()) answer_coarsest(exec, count);
  for (std::size_t i = coarser_.size(); i-- > 1;) {
    const MassLevel<B>&level = coarser_[i - 1], &below = coarser_[i];
    where_touching<B>(exec, count, "plica::him_up", level.vertices,
                      AnswerOfLevel<B>{level.mass, below.up, level.inverse_diagonal, level.force, below.acceleration,
                                       level.acceleration, static_cast<Real>(weights_[i])});
  }
  const MassLevel<B> below = coarser_.empty() ? MassLevel<B>{} : coarser_.front();
  update_vertices<B>(
      exec, "plica::him_up", vertices_,
      AnswerOfFinest<B>{below.up, inverse_mass_, f, below.acceleration, a, static_cast<Real>(weights_.front())});
}

template <class B>
std::size_t InverseMass<B>::bytes() const {
  std::size_t total = bytes_of_views(filter_.matrix, filter_.turned, filter_.displacement, filter_.rotation,
                                     filter_.first, filter_.tet, filter_.corner, filter_.shape, filtered_);
  for (const MassLevel<B>& level : coarser_)
    total += bytes_of_rows(level.up) + bytes_of_rows(level.down) + bytes_of_rows(level.mass) +
             bytes_of_views(level.inverse_diagonal, level.force, level.acceleration);
  return total;
}

#define PLICA_INSTANTIATE(Real, Exec) template class InverseMass<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
