// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <limits>
#include <map>
#include <optional>
#include <plica/core/mesh.hpp>
#include <string>
#include <variant>
#include <vector>

/// What is to be simulated, in SI and without files: the library's whole input. Every struct is plain; a default is the
/// value a scene gets that leaves the key out. Ranges are checked where the simulation is set up.
namespace plica {

struct MaterialOptions {
  std::string model = "st_venant_kirchhoff";  ///< a name of kernels/materials/list.hpp
  double young_modulus = 20e3;                ///< [Pa] > 0
  double poisson_ratio = 0.4;                 ///< in [0, 0.5)
  double density = 1000;                      ///< [kg/m^3] > 0
};

/// What a region has of its own; the rest is the body's.
struct RegionOptions {
  std::optional<double> young_modulus;  ///< [Pa] > 0
  std::optional<double> poisson_ratio;  ///< in [0, 0.5)
  std::optional<double> density;        ///< [kg/m^3] > 0
};

/// Vertices chosen at rest, on every level: those in the box, or those of the mesh's vertex set or region of that name.
struct Selection {
  std::optional<Box> box;  ///< of rest positions [m]
  std::string group;       ///< used where there is no box
};

/// Vertices whose motion is given: they move with this velocity from t = 0.
struct PrescribedMotion {
  Selection where;
  Point velocity = Point::Zero();  ///< [m/s]
};

struct DampingOptions {
  double mass = 0;  ///< mass-proportional damping [1/s] >= 0
};

struct InitialOptions {
  std::optional<Point> position;   ///< where the centre of level 0's bounding box starts; none: where the mesh is [m]
  Point velocity = Point::Zero();  ///< of every free vertex [m/s]
  Point angular_velocity = Point::Zero();  ///< about that centre [rad/s]
};

struct Body {
  std::vector<TetMesh> levels;  ///< finest first, at least one
  MaterialOptions material;
  std::map<std::string, RegionOptions> regions;
  std::vector<Selection> fixed;
  std::vector<PrescribedMotion> prescribed;
  DampingOptions damping;
  InitialOptions initial;
  std::optional<TriangleSurface> surface;  ///< embedded in every level; contact acts on its vertices
};

/// How the linear systems of an implicit level are solved.
struct ImplicitOptions {
  double relative_residual = 1e-6;  ///< |r|/|b| at which the conjugate gradients end, in (0, 1)
  int iterations = 0;               ///< > 0: exactly so many iterations instead
  int max_iterations = 2000;        ///< a solve that has not converged by then is counted as a miss
  int newton_iterations = 1;        ///< 1: linearly implicit
  double newton_tolerance = 1e-6;   ///< on |residual| relative to the first, where newton_iterations > 1
};

struct IntegrationOptions {
  std::string cycle = "single";           ///< a name of drivers/solver/cycles/list.hpp
  std::optional<double> macro_step;       ///< [s] > 0; none: 0.9 of the predicted limit
  std::string distribution = "critical";  ///< equal | inverse_elements | critical | custom
  std::vector<double> shares;             ///< of the macro step, finest first, with `custom`; their sum is 1 to 1e-12
  double shift_to_coarsest = 0;           ///< this part of every finer level's share goes to the coarsest, in [0, 1)
  std::vector<std::string> integrator = {"symplectic_euler"};  ///< one for all levels, or one each, finest first
  std::vector<int> substeps = {0};                             ///< likewise; 0: as many as the level's limit asks for
  double safety = 0.9;            ///< of the limit that automatic sub-steps keep, in (0, 1]
  bool allow_unstable = false;    ///< run explicit sub-steps above the limit all the same
  double switch_threshold = 0.1;  ///< epsilon of the switched mappings, > 0
  std::string outside = "clamp";  ///< clamp | extrapolate | keep: vertices outside the other mesh
  ImplicitOptions implicit;
};

/// The half-space below a plane is solid.
struct PlaneOptions {
  Point point = Point::Zero();    ///< on the plane [m]
  Point normal = Point::UnitZ();  ///< out of the solid; any length > 0
};

/// A solid sphere.
struct SphereOptions {
  Point centre = Point::Zero();  ///< [m]
  double radius = 1;             ///< [m] > 0
};

/// A block with flat top out of which a sphere is hollowed: the inside of a spherical shell, up to its rim.
struct BowlOptions {
  Point centre = Point::Zero();  ///< of the sphere [m]
  double radius = 1;             ///< [m] > 0
  double rim = 0;  ///< height of the flat top above the bowl's lowest point [m], in (0, radius]; 0: radius
};

struct ObstacleOptions {
  std::variant<PlaneOptions, SphereOptions, BowlOptions> shape;
  std::optional<double> friction;  ///< Coulomb's coefficient >= 0; none: frictionless
  Point velocity = Point::Zero();  ///< the obstacle moves so from t = 0 [m/s]
};

/// Penalty contact of the embedded surface's vertices. The scales multiply, per surface point, the stiffness E A / h
/// and the damping 2 * 0.5 * sqrt(k rho A h), with A the surface's area per point and h the finest level's mean edge.
struct ContactOptions {
  std::vector<ObstacleOptions> obstacles;
  double stiffness_scale = 1;           ///< > 0
  double damping_scale = 1;             ///< >= 0
  double tangential_damping_scale = 1;  ///< >= 0, caps what friction can do at small sliding speed
};

struct Problem {
  Body body;
  Point gravity = Point::Zero();  ///< [m/s^2]
  IntegrationOptions integration;
  ContactOptions contact;
  bool surface_forces = false;  ///< the caller will put forces of its own on the surface: embed it in every level
};

}  // namespace plica
