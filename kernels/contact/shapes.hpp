// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <plica/core/type_list.hpp>
#include <plica/kernels/contact/shapes/block.hpp>
#include <plica/kernels/contact/shapes/bowl.hpp>
#include <plica/kernels/contact/shapes/capsule.hpp>
#include <plica/kernels/contact/shapes/cylinder.hpp>
#include <plica/kernels/contact/shapes/plane.hpp>
#include <plica/kernels/contact/shapes/sampled_surface.hpp>
#include <plica/kernels/contact/shapes/sphere.hpp>

// Obstacles: pointwise signed distance functions, Gap operator()(x), with x relative to the obstacle, which may move.
namespace plica {

/// Every obstacle shape there is. One more: its file above, its name here.
using ObstacleShapes = TypeList<Plane, Sphere, Bowl, Capsule, Block, Cylinder, SampledSurface>;

}  // namespace plica
