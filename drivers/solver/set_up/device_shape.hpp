// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <Eigen/Geometry>
#include <plica/core/backend.hpp>
#include <plica/core/obstacles.hpp>
#include <plica/drivers/solver/set_up/sample_distance.hpp>
#include <plica/drivers/solver/set_up/to_device.hpp>
#include <plica/kernels/contact/shapes.hpp>

// The obstacles' options as the shapes that kernels evaluate. `storage` is what a shape points to, for its owner to keep.
namespace plica {

template <class Real>
Vec3<Real> vec(const Point& p) {
  return {static_cast<Real>(p[0]), static_cast<Real>(p[1]), static_cast<Real>(p[2])};
}

template <class B>
auto device_shape(const PlaneOptions& o, Scalars<B>&) {
  using Real = typename B::Real;
  return Plane::Shape<Real>{vec<Real>(o.point), vec<Real>(o.normal.normalized())};
}

template <class B>
auto device_shape(const SphereOptions& o, Scalars<B>&) {
  using Real = typename B::Real;
  return Sphere::Shape<Real>{vec<Real>(o.centre), static_cast<Real>(o.radius)};
}

template <class B>
auto device_shape(const BowlOptions& o, Scalars<B>&) {
  using Real = typename B::Real;
  const double rim = o.rim > 0 ? o.rim : o.radius;
  return Bowl::Shape<Real>{vec<Real>(o.centre), static_cast<Real>(o.radius), static_cast<Real>(rim - o.radius)};
}

template <class B>
auto device_shape(const CapsuleOptions& o, Scalars<B>&) {
  using Real = typename B::Real;
  const Point along = o.to - o.from;
  return Capsule::Shape<Real>{vec<Real>(o.from), vec<Real>(along.normalized()), static_cast<Real>(along.norm()),
                              static_cast<Real>(o.radius)};
}

template <class B>
auto device_shape(const BlockOptions& o, Scalars<B>&) {
  using Real = typename B::Real;
  const double angle = o.rotation.norm();
  const Point axis = angle > 0 ? Point(o.rotation / angle) : Point::UnitZ();
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
  Mat3<Real> axes;
  for (int k = 0; k < 3; ++k) axes[k] = vec<Real>(turn.col(k));
  return Block::Shape<Real>{vec<Real>(o.centre), axes, vec<Real>(o.size / 2)};
}

template <class B>
auto device_shape(const CylinderOptions& o, Scalars<B>&) {
  using Real = typename B::Real;
  const Point along = o.to - o.from;
  return Cylinder::Shape<Real>{vec<Real>((o.from + o.to) / 2), vec<Real>(along.normalized()),
                               static_cast<Real>(along.norm() / 2), static_cast<Real>(o.radius)};
}

template <class B>
auto device_shape(const SurfaceOptions& o, Scalars<B>& storage) {
  using Real = typename B::Real;
  const DistanceGrid grid = sample_distance(o.surface, o.cells);
  storage = to_device<Scalars<B>>("contact.distance_grid", std::vector<Real>(grid.value.begin(), grid.value.end()));
  return SampledSurface::Shape<Real>{storage.data(),
                                     {grid.nodes[0], grid.nodes[1], grid.nodes[2]},
                                     vec<Real>(grid.origin),
                                     static_cast<Real>(grid.cell),
                                     static_cast<Real>(grid.margin)};
}

}  // namespace plica
