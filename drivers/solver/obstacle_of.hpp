// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/drivers/solver/contact.hpp>
#include <plica/drivers/solver/courses.hpp>
#include <plica/drivers/solver/set_up/sample_distance.hpp>
#include <plica/kernels/boundary_conditions.hpp>
#include <plica/kernels/contact/implicit_response.hpp>
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
  Point origin_;        // at t = 0
  std::vector<PathKnot> knots_;
  Path path_;
  DepthWatch<B> watch_;

  PathPoint at(double time, double ahead) const { return path_step(path_, knots_.data(), time, ahead); }
  static Vec3<Real> rounded(const Vec3<double>& x) {
    return {static_cast<Real>(x[0]), static_cast<Real>(x[1]), static_cast<Real>(x[2])};
  }

 public:
  ObstacleOf(const Shape& shape, const Scalars<B>& storage, const Point& origin, const Motion& motion,
             const DepthWatch<B>& watch)
      : shape_(shape), storage_(storage), origin_(origin), path_(make_path(motion, knots_)), watch_(watch) {}

  void linearise(const Exec& exec, const EmbeddedSurface<B>& surface, const State<B>& s, double time,
                 const ImplicitWeights& w, double ahead, int number, const TouchingPoints<B>& points) const override {
    const PathPoint now = at(time, ahead);
    update_vertices<B>(exec, "plica::contact_forces", surface.points,
                       ObstacleContact<B, Shape>{surface, s.u, s.v, shape_, rounded(now.displacement),
                                                 rounded(now.velocity), watch_, static_cast<Real>(ahead),
                                                 static_cast<Real>(w.a), static_cast<Real>(w.b), number, points});
  }
  void find(const Exec& exec, const EmbeddedSurface<B>& surface, const State<B>& s, double time, int number,
            const TouchingPoints<B>& points) const override {
    const PathPoint now = at(time, 0);
    update_vertices<B>(exec, "plica::contact_find", surface.points,
                       FindTouching<B, Shape>{surface, s, shape_, rounded(now.displacement), rounded(now.velocity),
                                              watch_, points.record(number, 0), points});
  }
  void energy(const Exec& exec, const EmbeddedSurface<B>& surface, const State<B>& s, double time, int number,
              const PointLaws<B>& law, const BlockSums<B>& blocks, const Doubles<B>& result) const override {
    reduce<B, 1>(exec, "plica::contact_energy", surface.points,
                 ContactEnergy<B, Shape>{surface, s.u, s.v, shape_, rounded(at(time, 0).displacement), law, number},
                 blocks, result);
  }
  Point origin(double time) const override {
    const Vec3<double> moved = at(time, 0).displacement;
    return origin_ + Point(moved[0], moved[1], moved[2]);
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
std::unique_ptr<Obstacle<B>> make_obstacle(const ObstacleOptions& options, const DepthWatch<B>& watch) {
  std::unique_ptr<Obstacle<B>> obstacle;
  visit_shape(options.shape, [&](auto shape, const auto& its) {
    Scalars<B> storage;
    const auto made = device_shape<B>(shape, its, storage);
    using Shape = std::decay_t<decltype(made)>;
    obstacle =
        std::make_unique<ObstacleOf<B, Shape>>(made, storage, decltype(shape)::origin(its), options.motion, watch);
  });
  return obstacle;
}

}  // namespace plica
