// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <plica/drivers/solver/contact.hpp>
#include <plica/drivers/solver/courses.hpp>
#include <plica/drivers/solver/materials.hpp>
#include <plica/drivers/solver/set_up/sample_distance.hpp>
#include <plica/drivers/solver/set_up/to_device.hpp>
#include <plica/kernels/contact/contact_kernels.hpp>

namespace plica {

namespace {

// Of contact that is implicit in an explicit step, over the layer of elements under the surface: what keeps a body visibly outside.
// The linear systems of implicit levels take that of the layer itself, and then the other levels as well: what one level leaves
// inside an obstacle, the next must not throw out.
constexpr double most_stiffening = 64;

}  // namespace

template <class B>
Contact<B>::Contact(const ContactOptions& options, const MaterialOptions& material, int points, double area,
                    double edge, double size, bool stiff)
    : points_(points),
      reach_(edge),
      deepest_(size),
      lost_(zeros<Indices<B>>("plica::contact.lost", 1)),
      stiffening_(stiff ? most_stiffening : 1) {
  const DepthWatch<B> watch{lost_, static_cast<Real>(size)};
  const double per_point = area / points;
  const double soft = options.stiffness_scale * stiffness_at_rest(material) * per_point / edge;
  stiffness_ = stiffening_ * soft;
  const auto critical = [&](double k) {
    return std::sqrt(k * material.density * per_point * edge);
  };  // 2 * 0.5 sqrt(k m)
  damping_ = options.damping_scale * critical(stiffness_);
  const auto law_of = [&](const ObstacleOptions& o, double k) {
    return PenaltyLaw<Real>{static_cast<Real>(k), static_cast<Real>(options.damping_scale * critical(k)),
                            static_cast<Real>(o.friction ? options.tangential_damping_scale * critical(k) : 0),
                            static_cast<Real>(o.friction.value_or(0))};
  };
  std::vector<PenaltyLaw<Real>> laws, implicit_laws;
  for (const ObstacleOptions& o : options.obstacles) {
    laws.push_back(law_of(o, stiffness_)), implicit_laws.push_back(law_of(o, soft));
    obstacles_.push_back(make_obstacle<B>(o, implicit_laws.back(), watch));
  }
  laws_ = to_device<Laws>("contact.laws", laws);
  implicit_laws_ = to_device<Laws>("contact.implicit_laws", implicit_laws);
}

template <class B>
TouchingPoints<B> Contact<B>::make_points(bool implicit) const {
  const std::size_t n = static_cast<std::size_t>(points_), records = n * obstacles_.size();
  TouchingPoints<B> points;
  points.points = points_, points.obstacles = obstacles(), points.reach = static_cast<Real>(reach_);
  points.law = implicit ? implicit_laws_ : laws_;
  points.normal = zeros<Vectors<B>>("plica::contact.normal", records);
  points.velocity = zeros<Vectors<B>>("plica::contact.velocity", records);
  points.force = zeros<Vectors<B>>("plica::contact.force", records);
  points.depth = zeros<Scalars<B>>("plica::contact.depth", records);
  points.mobility = zeros<Scalars<B>>("plica::contact.mobility", records);
  points.count = zeros<Doubles<B>>("plica::contact.count", 1);
  if (implicit) points.block = zeros<Blocks<B>>("plica::contact.block", n);
  return points;
}

template <class B>
void Contact<B>::find(const Exec& exec, const Level<B>& level, const State<B>& s, double time,
                      const TouchingPoints<B>& points) const {
  for (int o = 0; o < obstacles(); ++o)
    obstacles_[static_cast<std::size_t>(o)]->find(exec, level.surface, s, time, o, points);
}

template <class B>
void Contact<B>::linearise(const Exec& exec, const Level<B>& level, const State<B>& s, double time,
                           const ImplicitWeights& w, double ahead, const TouchingPoints<B>& points,
                           const Vectors<B>& f) const {
  for (int o = 0; o < obstacles(); ++o)
    obstacles_[static_cast<std::size_t>(o)]->linearise(exec, level.surface, s, time, w, ahead, o, points);
  update_vertices<B>(exec, "plica::contact_scatter", level.surface.touched,
                     ScatterContact<B>{level.surface, points, f});
}

template <class B>
void Contact<B>::add_product(const Exec& exec, const Level<B>& level, const Vectors<B>& p,
                             const TouchingPoints<B>& points, const Vectors<B>& q) const {
  Kokkos::parallel_for("plica::contact_product", Kokkos::RangePolicy<Exec>(exec, 0, level.surface.points),
                       PointProduct<B>{level.surface, p, points.block, points.force});
  scatter_to_vertices<B>(exec, level.surface, points.force, q);
}

template <class B>
void Contact<B>::add_diagonal(const Exec& exec, const Level<B>& level, const TouchingPoints<B>& points,
                              const Blocks<B>& diagonal) const {
  Kokkos::parallel_for("plica::contact_diagonal", Kokkos::RangePolicy<Exec>(exec, 0, level.surface.touched),
                       AddPointBlocks<B>{level.surface, points.block, diagonal});
}

template <class B>
void Contact<B>::add_matrix(const Exec& exec, const Level<B>& level, const TouchingPoints<B>& points,
                            const BlockMatrix<B>& A) const {
  Kokkos::parallel_for("plica::contact_matrix", Kokkos::RangePolicy<Exec>(exec, 0, level.surface.touched),
                       AddContact<B>{level.surface, points.block, A});
}

template <class B>
double Contact<B>::energy(const Exec& exec, const Level<B>& level, double time, bool implicit,
                          const BlockSums<B>& blocks) const {
  const auto result = zeros<Doubles<B>>("plica::contact_energy", 1);
  double total = 0;
  for (const auto& obstacle : obstacles_) {
    obstacle->energy(exec, level.surface, level.state, time, blocks, result);
    total += host_values(exec, result)[0];
  }
  return implicit ? total : stiffening_ * total;
}

template <class B>
int Contact<B>::take_lost(const Exec& exec) const {
  const int last = host_values(exec, lost_)[0];
  if (last > 0) fill(exec, lost_, 0);
  return last - 1;
}

template <class B>
std::size_t Contact<B>::grid_bytes() const {
  std::size_t total = 0;
  for (const auto& obstacle : obstacles_) total += obstacle->bytes();
  return total;
}

#define PLICA_INSTANTIATE(Real, Exec) template class Contact<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
