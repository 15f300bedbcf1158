// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/solver/contact.hpp>
#include <plica/drivers/solver/courses.hpp>
#include <plica/drivers/solver/set_up/sample_distance.hpp>
#include <plica/kernels/boundary_conditions.hpp>
#include <plica/kernels/contact/contact_kernels.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <type_traits>

// For obstacles_float.cpp and obstacles_double.cpp alone: the kernels of all shapes are the longest thing to compile here.
namespace plica {

/// An obstacle of one shape.
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
              const BlockSums<B>& blocks, const Doubles<B>& result) const override {
    reduce<B, 1>(exec, "plica::contact_energy", surface.points,
                 ContactEnergy<B, Shape>{surface, s.u, s.v, shape_, rounded(at(time, 0).displacement), law_.stiffness},
                 blocks, result);
  }
  std::size_t bytes() const override { return storage_.span() * sizeof(Real); }
};

/// The shape as kernels evaluate it; `storage` is what it points to, for its owner to keep.
template <class B, class S>
auto device_shape(S, const typename S::Options& o, Scalars<B>& storage) {
  using Real = typename B::Real;
  if constexpr (std::is_same_v<S, SampledSurface>) {
    const DistanceGrid grid = sample_distance(o.surface, o.cells);
    storage = to_device<Scalars<B>>("contact.distance_grid", std::vector<Real>(grid.value.begin(), grid.value.end()));
    return SampledSurface::Shape<Real>{storage.data(),
                                       {grid.nodes[0], grid.nodes[1], grid.nodes[2]},
                                       vec3<Real>(grid.origin),
                                       static_cast<Real>(grid.cell),
                                       static_cast<Real>(grid.margin)};
  } else {
    return S::template shape<Real>(o);
  }
}

template <class B>
std::unique_ptr<Obstacle<B>> make_obstacle(const ObstacleOptions& options, const PenaltyLaw<typename B::Real>& law,
                                           const DepthWatch<B>& watch) {
  std::unique_ptr<Obstacle<B>> obstacle;
  visit_shape(options.shape, [&](auto shape, const auto& its) {
    Scalars<B> storage;
    const auto made = device_shape<B>(shape, its, storage);
    using Shape = std::decay_t<decltype(made)>;
    obstacle = std::make_unique<ObstacleOf<B, Shape>>(made, storage, options.motion, law, watch);
  });
  return obstacle;
}

}  // namespace plica
