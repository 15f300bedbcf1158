// SPDX-License-Identifier: BSD-3-Clause
#include <Kokkos_Profiling_ScopedRegion.hpp>
#include <plica/drivers/cycles/him/inverse_mass.hpp>
#include <plica/drivers/spaces/transfer_matrix.hpp>
#include <plica/kernels/vectors.hpp>

namespace plica {

namespace {

/// Returns the unit s of each vertex of a space: forces are stored times s, accelerations over s.
/// With N = D^-1/2 and s = E N, Q = E D^-1 (2 - M D^-1) E becomes 2 - N M N. Vertices on which no
/// finer vertex depends have s = 0. On the coarsest level s = 1.
Eigen::VectorXd units_of(const MassSpace& space) {
  if (space.scale.empty()) return Eigen::VectorXd::Ones(space.up.cols());
  const auto n = static_cast<Eigen::Index>(space.scale.size());
  const Eigen::Map<const Eigen::ArrayXd> inverse(space.inverse_diagonal.data(), n),
      E(space.scale.data(), n);
  return (E * inverse.sqrt()).matrix();
}

Eigen::VectorXd inverse_of(const Eigen::VectorXd& x) {
  return x.unaryExpr([](double value) { return value > 0 ? 1 / value : 0.0; });
}

/// Returns a level below the finest one or another.
/// @param part  this rank's part of the level above; null: it is whole. Then `down` is left out
template <class B>
MassLevel<B> mass_level(const MassSpace& space, const RowMatrix& up, const Eigen::VectorXd& units,
                        const RankLevel<B>* part) {
  MassLevel<B> level;
  level.vertices = static_cast<int>(space.up.cols());
  level.up = sparse_rows<B, float>("him.up", part ? some_rows(up, part->part.vertex) : up);
  if (!part) level.down = sparse_rows<B, float>("him.down", RowMatrix(up.transpose()));
  if (!space.scale.empty()) {
    const Eigen::Map<const Eigen::ArrayXd> inverse(space.inverse_diagonal.data(), units.size());
    const Eigen::VectorXd N = inverse.sqrt().matrix();
    level.mass = sparse_rows<B, float>("him.mass", N.asDiagonal() * space.mass * N.asDiagonal());
  }
  level.force = zeros<Vectors<B>>("plica::him.force", level.vertices);
  level.acceleration = zeros<Vectors<B>>("plica::him.acceleration", level.vertices);
  return level;
}

}  // namespace

template <class B>
InverseMass<B>::InverseMass(const Scalars<B>& inverse_mass, const std::vector<MassSpace>& spaces,
                            const FrameShape& frames, const RankLevel<B>* part)
    : vertices_(static_cast<int>(inverse_mass.extent(0))),
      inverse_mass_(inverse_mass),
      weights_{1} {
  if (spaces.empty()) return;
  const Kokkos::Profiling::ScopedRegion region("plica: inverse mass");
  weights_.resize(spaces.size() + 1, 0);
  Eigen::VectorXd finer = Eigen::VectorXd::Ones(spaces.front().up.rows());
  RowMatrix share = frames.restriction.transpose();
  for (const MassSpace& space : spaces) {
    const Eigen::VectorXd units = units_of(space);
    const RowMatrix up = inverse_of(finer).asDiagonal() * space.up * units.asDiagonal();
    const RankLevel<B>* const shared = coarser_.empty() ? part : nullptr;
    if (shared)
      down_ = std::make_unique<SharedProduct<B, float>>(*part, "him.down", up.transpose());
    MassLevel<B>& level = coarser_.emplace_back(mass_level<B>(space, up, units, shared));
    share = product(RowMatrix(space.up.transpose()), share);
    if (&space == &spaces.back()) break;
    level.share = sparse_rows<B, float>("him.share", RowMatrix(units.asDiagonal() * share));
    finer = units;
  }
  frames_ = CoarseFrames<B>(frames, share, part);
  filter_.vertices = coarser_.back().vertices;
  filter_.turned =
      zeros<Vectors<B>>("plica::him.turned", static_cast<std::size_t>(filter_.vertices));
  filter_.rotation = frames_.rotation();
}

template <class B>
auto InverseMass<B>::to_device(const Eigen::MatrixXd& S) -> Answer {
  constexpr Eigen::Index block = CoarseInverseMass<B>::block;
  const Eigen::Index n = S.rows(), blocks = (n + block - 1) / block;
  std::vector<float> values(static_cast<std::size_t>(blocks * n * block), 0.0F);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      values[static_cast<std::size_t>((i / block * n + j) * block + i % block)] =
          static_cast<float>(0.5 * (S(i, j) + S(j, i)));
  return plica::to_device<Answer>("him.filter", values);
}

template <class B>
void InverseMass<B>::turn(const Exec& exec, const Vectors<B>& u) const {
  if (!coarser_.empty()) frames_.turn(exec, u);
}

template <class B>
void InverseMass<B>::solve_frame_force(const Exec& exec, const Vectors<B>& q, double t) const {
  if (coarser_.empty()) return;
  const Vectors<B>& given = coarser_.back().force;
  restrict_to_frames(exec, q, {}, frames_.start(given, filter_));
  frames_.find_torques(exec, given, filter_, weights_.back(), t);
}

template <class B>
void InverseMass<B>::push_and_accelerate(const Exec& exec, double t, const Vectors<B>& p,
                                         const Vectors<B>& v, const Vectors<B>& a) const {
  const MeanAcceleration<B> mean{v, a, static_cast<Real>(1 / t)};
  if (coarser_.empty()) {
    apply(exec, p, a);
    return update_vertices<B>(exec, "plica::him_acceleration", vertices_, mean);
  }
  go_up_pushed(
      exec, t,
      AccelerationOfPushed<B>{{frames_.push(t, inverse_mass_, p), answer_of_finest(p, a)}, mean});
}

template <class B>
void InverseMass<B>::push_and_answer(const Exec& exec, double t, const Vectors<B>& p,
                                     const Vectors<B>& q, const Vectors<B>& a) const {
  if (coarser_.empty()) return apply(exec, p, a);
  go_up_pushed(exec, t,
               AnswerOfPushed<B>{frames_.push(t, inverse_mass_, p, q), answer_of_finest(p, a)});
}

template <class B>
template <class Last>
void InverseMass<B>::go_up_pushed(const Exec& exec, double t, const Last& last) const {
  update_vertices<B>(exec, "plica::him_coarsest", groups_of<B>(filter_.vertices),
                     ForceAndAnswer<B>{frames_.force_of_torques(), answer_of_coarsest()});
  for (std::size_t i = 0; i + 1 < coarser_.size(); ++i)
    update_vertices<B>(exec, "plica::axes_share", coarser_[i].vertices,
                       AddShareOfFrames<B>{coarser_[i].share, frames_.force(), coarser_[i].force,
                                           static_cast<Real>(t)});
  go_up(exec, {});
  update_vertices<B>(exec, "plica::him_up", vertices_, last);
}

template <class B>
std::size_t InverseMass<B>::weighed() const {
  std::size_t levels = coarser_.size();
  while (levels > 0 && weights_[levels] == 0) --levels;
  return levels;
}

template <class B>
void InverseMass<B>::go_down_first(const Exec& exec, const Vectors<B>& f,
                                   const Doubles<B>& count) const {
  const MassLevel<B>& level = coarser_.front();
  if (down_) return (*down_)(exec, f, level.force);
  where_touching<B>(exec, count, "plica::him_down", level.vertices,
                    MultiplyRows<B, float>{level.down, f, level.force});
}

template <class B>
Vectors<B> InverseMass<B>::go_down(const Exec& exec, const Vectors<B>& f, std::size_t levels,
                                   const Doubles<B>& count) const {
  if (levels == 0) return f;
  go_down_first(exec, f, count);
  Vectors<B> finer = coarser_.front().force;
  for (std::size_t i = 1; i < levels; ++i) {
    const MassLevel<B>& level = coarser_[i];
    where_touching<B>(exec, count, "plica::him_down", level.vertices,
                      MultiplyRows<B, float>{level.down, finer, level.force});
    finer = level.force;
  }
  return finer;
}

template <class B>
template <class Turn>
void InverseMass<B>::restrict_to_frames(const Exec& exec, const Vectors<B>& f,
                                        const Doubles<B>& count, const Turn& turn) const {
  const MassLevel<B>& coarsest = coarser_.back();
  if (down_ && coarser_.size() == 1) {
    go_down_first(exec, f, count);
    return where_touching<B>(exec, count, "plica::him_turn", coarsest.vertices, turn);
  }
  const Vectors<B> finer = go_down(exec, f, coarser_.size() - 1, count);
  where_touching<B>(exec, count, "plica::him_down", coarsest.vertices,
                    RestrictToFrames<B, Turn>{{coarsest.down, finer, coarsest.force}, turn});
}

template <class B>
void InverseMass<B>::go_up(const Exec& exec, const Doubles<B>& count) const {
  const std::size_t last = weighed();
  for (std::size_t i = std::min(last + 1, coarser_.size()); i-- > 1;) {
    const MassLevel<B>&level = coarser_[i - 1], below = i < last ? coarser_[i] : MassLevel<B>{};
    where_touching<B>(exec, count, "plica::him_up", level.vertices,
                      AnswerOfLevel<B>{level.mass, below.up, level.force, below.acceleration,
                                       level.acceleration, static_cast<Real>(weights_[i])});
  }
}

template <class B>
AnswerOfCoarsest<B> InverseMass<B>::answer_of_coarsest() const {
  return {filter_, coarser_.back().acceleration, static_cast<Real>(weights_.back())};
}

template <class B>
AnswerOfFinest<B> InverseMass<B>::answer_of_finest(const Vectors<B>& f, const Vectors<B>& a) const {
  const MassLevel<B> below = weighed() == 0 ? MassLevel<B>{} : coarser_.front();
  return {below.up, inverse_mass_, f, below.acceleration, a, static_cast<Real>(weights_.front())};
}

template <class B>
void InverseMass<B>::apply(const Exec& exec, const Vectors<B>& f, const Vectors<B>& a,
                           const Doubles<B>& count) const {
  if (coarser_.empty() || weighed() < coarser_.size()) {
    go_down(exec, f, weighed(), count);
  } else {
    restrict_to_frames(exec, f, count, TurnForces<B>{filter_, coarser_.back().force});
    where_touching<B>(exec, count, "plica::him_coarsest", groups_of<B>(filter_.vertices),
                      answer_of_coarsest());
  }
  go_up(exec, count);
  where_touching<B>(exec, count, "plica::him_up", vertices_, answer_of_finest(f, a));
}

#define PLICA_INSTANTIATE(Real, Exec) template class InverseMass<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
