// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/obstacles.hpp>
#include <plica/core/type_list.hpp>
#include <plica/kernels/contact/shapes/block.hpp>
#include <plica/kernels/contact/shapes/bowl.hpp>
#include <plica/kernels/contact/shapes/capsule.hpp>
#include <plica/kernels/contact/shapes/cone.hpp>
#include <plica/kernels/contact/shapes/cylinder.hpp>
#include <plica/kernels/contact/shapes/plane.hpp>
#include <plica/kernels/contact/shapes/sampled_surface.hpp>
#include <plica/kernels/contact/shapes/sphere.hpp>

/// The shapes of obstacles. Each has its own file, with
///   * a struct of options, in SI, and their table: names, kinds with unit and range, meaning
///     (see core/describe.hpp);
///   * `name` and `summary`, as scenes and lists show them;
///   * `Shape<Real>`, the pointwise signed distance for kernels: Gap operator()(x), with x relative
///     to the obstacle, which may move; whether the solid is `convex`;
///   * `shape<Real>(options)`, which makes a Shape;
///   * `origin(options)`, the point that torques on it are about at t = 0: its centre, or for a
///     surface the origin of the file;
///   * `radius(options)`, the radius of the largest ball in it [m]; a surface has none, it follows
///     from the distances;
///   * where it has them, `check(path, options)`, which throws InputError for values that do
///     not fit each other, and `complete(options)`, which sets values that the options leave open.
namespace plica {

/// List of all obstacle shapes. To add one, include its file and name it here.
using ObstacleShapes =
    TypeList<Plane, Sphere, Bowl, Capsule, Block, Cylinder, Cone, SampledSurface>;

/// Calls f(S{}, options) for the shape S of these options, completed. Returns false where there is
/// none.
template <class F>
bool visit_shape(const ShapeOptions& shape, const F& f) {
  bool found = false;
  ObstacleShapes::for_each([&](auto one) {
    using S = decltype(one);
    const auto* options = std::any_cast<typename S::Options>(&shape);
    if (options == nullptr) return;
    found = true;
    if constexpr (requires { S::complete(*options); })
      f(one, S::complete(*options));
    else
      f(one, *options);
  });
  return found;
}

}  // namespace plica
