// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <plica/drivers/solver/contact.hpp>
#include <plica/drivers/solver/set_up/device_shape.hpp>
#include <plica/drivers/solver/set_up/make_path.hpp>

#include <plica/kernels/contact/contact_kernels.hpp>
#include <plica/kernels/contact/contact_matrix.hpp>
#include <plica/kernels/motion/path.hpp>

namespace plica {

namespace {

template <class B, class Shape>
class ObstacleOf final : public Obstacle<B> {
  using Real = typename B::Real;
  using Exec = typename B::Exec;
  Shape shape_;
  Scalars<B> storage_;  // of the shape
  std::vector<PathKnot> knots_;
  Path path_;
  PenaltyLaw<Real> law_;
  DepthWatch<B> watch_;

  PathPoint at(double time, double ahead) const { return path_step(path_, knots_.data(), time, ahead); }
  static Vec3<Real> rounded(const Vec3<double>& x) {
    return {static_cast<Real>(x[0]), static_cast<Real>(x[1]), static_cast<Real>(x[2])};
  }

  template <bool Tangent>
  void launch(const Exec& exec, const EmbeddedSurface<B>& surface, const State<B>& s, double time,
              const ImplicitWeights& w, double ahead, bool first, const ContactPoints<B>& points) const {
    const PathPoint now = at(time, ahead);
    Kokkos::parallel_for(
        "plica::contact_forces", Kokkos::RangePolicy<Exec>(exec, 0, surface.points),
        ObstacleContact<B, Shape, Tangent>{surface, s.u, s.v, shape_, rounded(now.displacement), rounded(now.velocity),
                                           law_, watch_, static_cast<Real>(ahead), static_cast<Real>(w.a),
                                           static_cast<Real>(w.b), first, points.force, points.block});
  }

 public:
  ObstacleOf(const Shape& shape, const Scalars<B>& storage, const Motion& motion, const PenaltyLaw<Real>& law,
             const DepthWatch<B>& watch)
      : shape_(shape), storage_(storage), path_(make_path(motion, knots_)), law_(law), watch_(watch) {}

  void forces(const Exec& exec, const EmbeddedSurface<B>& surface, const State<B>& s, double time, bool first,
              const ContactPoints<B>& points) const override {
    launch<false>(exec, surface, s, time, {}, 0, first, points);
  }
  void linearise(const Exec& exec, const EmbeddedSurface<B>& surface, const State<B>& s, double time,
                 const ImplicitWeights& w, double ahead, bool first, const ContactPoints<B>& points) const override {
    launch<true>(exec, surface, s, time, w, ahead, first, points);
  }
  void find(const Exec& exec, const EmbeddedSurface<B>& surface, const State<B>& s, double time, bool first,
            const TouchingPoints<B>& points) const override {
    const PathPoint now = at(time, 0);
    Kokkos::parallel_for("plica::find_touching", Kokkos::RangePolicy<Exec>(exec, 0, surface.points),
                         FindTouching<B, Shape>{surface, s, shape_, rounded(now.displacement), rounded(now.velocity),
                                                law_, watch_, first, points});
  }
  void energy(const Exec& exec, const EmbeddedSurface<B>& surface, const State<B>& s, double time,
              const BlockSums<B>& blocks, const Kokkos::View<double*, typename B::Memory>& result) const override {
    reduce<B, 1>(exec, "plica::contact_energy", surface.points,
                 ContactEnergy<B, Shape>{surface, s.u, s.v, shape_, rounded(at(time, 0).displacement), law_.stiffness},
                 blocks, result);
  }
  std::size_t bytes() const override { return storage_.span() * sizeof(Real); }
};

}  // namespace

template <class B>
Contact<B>::Contact(const ContactOptions& options, const MaterialOptions& material, int points, double area,
                    double edge, double size)
    : points_(points), deepest_(size), lost_("plica::contact.lost") {
  const DepthWatch<B> watch{lost_, static_cast<Real>(size)};
  const double per_point = area / points;
  stiffness_ = options.stiffness_scale * material.young_modulus * per_point / edge;
  const double critical = std::sqrt(stiffness_ * material.density * per_point * edge);  // 2 * 0.5 * sqrt(k m)
  const double normal = options.damping_scale * critical, tangential = options.tangential_damping_scale * critical;
  damping_ = normal_damping_ = normal;
  for (const ObstacleOptions& o : options.obstacles) {
    if (o.friction) damping_ = std::max(damping_, tangential);
    const PenaltyLaw<Real> law{static_cast<Real>(stiffness_), static_cast<Real>(normal),
                               static_cast<Real>(o.friction ? tangential : 0),
                               static_cast<Real>(o.friction.value_or(0))};
    std::visit(
        [&](const auto& shape) {
          Scalars<B> storage;
          const auto made = device_shape<B>(shape, storage);
          using Shape = std::decay_t<decltype(made)>;
          obstacles_.push_back(std::make_unique<ObstacleOf<B, Shape>>(made, storage, o.motion, law, watch));
        },
        o.shape);
  }
}

template <class B>
ContactPoints<B> Contact<B>::make_points(bool implicit) const {
  ContactPoints<B> points{Vectors<B>("plica::contact.force", points_), {}};
  if (implicit) points.block = Blocks<B>("plica::contact.block", points_);
  return points;
}

template <class B>
void Contact<B>::add_forces(const Exec& exec, const Level<B>& level, const State<B>& s, double time,
                            const ContactPoints<B>& points, const Vectors<B>& f) const {
  for (std::size_t i = 0; i < obstacles_.size(); ++i)
    obstacles_[i]->forces(exec, level.surface, s, time, i == 0, points);
  scatter_to_vertices<B>(exec, level.surface, points.force, f);
}

template <class B>
void Contact<B>::linearise(const Exec& exec, const Level<B>& level, const State<B>& s, double time,
                           const ImplicitWeights& w, double ahead, const ContactPoints<B>& points,
                           const Vectors<B>& f) const {
  for (std::size_t i = 0; i < obstacles_.size(); ++i)
    obstacles_[i]->linearise(exec, level.surface, s, time, w, ahead, i == 0, points);
  scatter_to_vertices<B>(exec, level.surface, points.force, f);
}

template <class B>
void Contact<B>::find(const Exec& exec, const Level<B>& level, const State<B>& s, double time,
                      const TouchingPoints<B>& points) const {
  for (std::size_t i = 0; i < obstacles_.size(); ++i) obstacles_[i]->find(exec, level.surface, s, time, i == 0, points);
}

template <class B>
void Contact<B>::add_product(const Exec& exec, const Level<B>& level, const Vectors<B>& p,
                             const ContactPoints<B>& points, const Vectors<B>& q) const {
  Kokkos::parallel_for("plica::contact_product", Kokkos::RangePolicy<Exec>(exec, 0, level.surface.points),
                       PointProduct<B>{level.surface, p, points.block, points.force});
  scatter_to_vertices<B>(exec, level.surface, points.force, q);
}

template <class B>
void Contact<B>::add_diagonal(const Exec& exec, const Level<B>& level, const ContactPoints<B>& points,
                              const Blocks<B>& diagonal) const {
  Kokkos::parallel_for("plica::contact_diagonal", Kokkos::RangePolicy<Exec>(exec, 0, level.surface.touched),
                       AddPointBlocks<B>{level.surface, points.block, diagonal});
}

template <class B>
void Contact<B>::add_matrix(const Exec& exec, const Level<B>& level, const ContactPoints<B>& points,
                            const BlockMatrix<B>& A) const {
  Kokkos::parallel_for("plica::contact_matrix", Kokkos::RangePolicy<Exec>(exec, 0, level.surface.touched),
                       AddContact<B>{level.surface, points.block, A});
}

template <class B>
double Contact<B>::energy(const Exec& exec, const Level<B>& level, double time, const BlockSums<B>& blocks) const {
  const Kokkos::View<double*, typename B::Memory> result("plica::contact_energy", 1);
  double total = 0;
  for (const auto& obstacle : obstacles_) {
    obstacle->energy(exec, level.surface, level.state, time, blocks, result);
    exec.fence();
    total += Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), result)(0);
  }
  return total;
}

template <class B>
int Contact<B>::take_lost(const Exec& exec) const {
  int last = 0;
  exec.fence("plica::contact_lost");
  Kokkos::deep_copy(last, lost_);
  if (last > 0) Kokkos::deep_copy(exec, lost_, 0);
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
