// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <limits>
#include <map>
#include <optional>
#include <plica/core/load.hpp>
#include <plica/core/obstacles.hpp>
#include <string>
#include <vector>

/// What is to be simulated, in SI and without files: the library's whole input. Every struct is
/// plain; a default is the value a scene gets that leaves the key out. Ranges and names are in
/// describe.hpp; they are checked where the simulation is set up. Large structs have their copies
/// in problem.cpp: each takes the compiler seconds.
namespace plica {

/// Directions round a line: of circles about it, turned by an angle towards it. Their sheets are
/// the cylinders about it.
struct FibreWinding {
  Point point = Point::Zero();  ///< on the line [m]
  Point axis = Point::UnitZ();  ///< along it; its length does not matter
  double angle = 0;             ///< of the helix: 0 round the line, a right angle along it [rad]
};

/// The directions of a body's fibres at rest: the same everywhere, by a rule, or of each element.
struct FibreOptions {
  Point axis = Point::UnitX();  ///< along them; its length does not matter
  /// across them, in the plane of their sheets or families
  std::optional<Point> sheet = {};
  std::optional<FibreWinding> around = {};  ///< instead of `axis` and `sheet`
  /// instead of `axis`: from these vertices of level 0 the shortest way ...
  std::optional<Selection> from = {};
  std::optional<Selection> to = {};  ///< ... to these: see flow_directions()
  /// instead of `axis`: the vectors of this name in TetMesh::tet_vectors
  std::string field = {};
  std::string sheet_field = {};  ///< instead of `sheet`, likewise
};

/// A part of the stress of shape that relaxes: of a step of strain, alpha e^(-t/tau) of it is left
/// after a time t.
struct PronyTerm {
  double alpha = 0;  ///< part of the stress at once
  double tau = 0;    ///< [s]
};

/// One of the sum that Ogden's law is.
struct OgdenTerm {
  double mu = 0;     ///< [Pa]
  double alpha = 0;  ///< exponent, not 0
};

/// What a body is made of.
struct MaterialOptions {
  std::string model = "st_venant_kirchhoff";  ///< of materials()
  double young_modulus = 20e3;                ///< [Pa]
  double poisson_ratio = 0.4;                 ///< lateral contraction
  double density = 1000;                      ///< [kg/m^3]
  /// whether elements may turn inside out; none: as the material has it
  std::optional<bool> allow_inversion = {};
  /// what else this material declares, by name, in SI
  std::map<std::string, double> parameters = {};
  /// of volumes(): U(J) of laws of tissue; none: simo_hughes
  std::optional<std::string> volume = {};
  std::optional<std::string> convention = {};  ///< of ogden_conventions(), for mu in `terms`
  std::vector<OgdenTerm> terms = {};           ///< of Ogden's law, 1 to 6
  std::vector<PronyTerm> prony = {};           ///< relaxation; none: the material is elastic
  /// of laws with fibres; a scene has it as body.fibres
  std::optional<FibreOptions> fibres = {};
  /// whose values these were, see tissue_material()
  std::string tissue = {};
};

/// What of DampingOptions a region has of its own.
struct RegionDamping {
  std::optional<double> mass;       ///< [1/s]
  std::optional<double> stiffness;  ///< [s]
};

/// What a region has of its own; the rest is the body's.
struct RegionOptions {
  /// its elements; none: those of the mesh's region of that name
  std::optional<Selection> where;
  std::optional<double> young_modulus;            ///< [Pa]
  std::optional<double> poisson_ratio;            ///< lateral contraction
  std::optional<double> density;                  ///< [kg/m^3]
  RegionDamping damping;                          ///< likewise
  std::map<std::string, double> parameters = {};  ///< of the material, likewise
  std::vector<OgdenTerm> terms = {};              ///< instead of the body's, where there are any
  std::vector<PronyTerm> prony = {};              ///< likewise
  std::optional<FibreOptions> fibres = {};        ///< instead of the body's
};

/// Vertices whose motion is given.
struct PrescribedMotion {
  Selection where;  ///< which
  Motion motion;    ///< from where they are at rest
};

/// Damping by mass, with forces -mass M v, and by stiffness, with a stress against the rate of
/// strain: that of the material at rest, times `stiffness`, see kernels/elastic/damping_stress.hpp.
/// The second acts on no motion of the whole body. Together they are Rayleigh's damping near rest:
/// there a mode of frequency w [rad/s] decays like exp(-(mass + stiffness w^2) t / 2).
struct DampingOptions {
  double mass = 0;       ///< [1/s]
  double stiffness = 0;  ///< [s]
};

/// Initial velocity of a part of the body, chosen on level 0.
struct PartVelocity {
  Selection where;                         ///< its vertices
  Point velocity = Point::Zero();          ///< [m/s]
  Point angular_velocity = Point::Zero();  ///< about the centre of their bounding box [rad/s]
};

/// Initial rotation about the line between two points of the mesh at rest, before it is placed:
/// none in the plane through the first across the line, growing linearly along it.
struct TwistOptions {
  Point from = Point::Zero();  ///< [m]
  Point to = Point::UnitX();   ///< another one [m]
  /// at the second; seen from there, counter-clockwise where positive [rad/s]
  double angular_velocity = 0;
};

/// The state at t = 0: placed and moving, at rest in shape where nothing deforms it. Velocities add
/// up. Vertices that are fixed or whose motion is given are where they would be anyway.
struct InitialOptions {
  /// Compiled in problem.cpp alone.
  /// @{
  InitialOptions();
  InitialOptions(const InitialOptions&);
  InitialOptions(InitialOptions&&) noexcept;
  InitialOptions& operator=(const InitialOptions&);
  InitialOptions& operator=(InitialOptions&&) noexcept;
  ~InitialOptions();
  /// @}

  /// where the centre of level 0's bounding box starts; none: where the mesh is [m]
  std::optional<Point> position;
  Point velocity = Point::Zero();          ///< of every free vertex [m/s]
  Point angular_velocity = Point::Zero();  ///< about that centre [rad/s]
  std::optional<TwistOptions> twist;       ///< a rotation that grows along an axis
  std::vector<PartVelocity> parts;         ///< velocities of parts of the body
  /// along x, y, z about that centre: 0 flattens, a negative one turns inside out
  Point stretch = Point::Ones();
  std::optional<int> random;  ///< seed: each vertex anywhere in level 0's bounding box instead
};

inline constexpr int fewest_points = 30;  ///< of a coarse space

/// One of several bodies that are stepped as one: the elements whose region has its name, or begins
/// with that and a slash. See join_bodies().
struct BodyPart {
  std::string name;          ///< not empty
  MaterialOptions material;  ///< where its regions have no other: contact is as stiff as that
  /// of its surface; the body's surface has those of all parts, in their order
  int points = 0;
  std::optional<std::vector<int>> coarsen = {};  ///< its own numbers, see Body::coarsen
};

/// A deformable body.
struct Body {
  /// Compiled in problem.cpp alone.
  /// @{
  Body();
  Body(const Body&);
  Body(Body&&) noexcept;
  Body& operator=(const Body&);
  Body& operator=(Body&&) noexcept;
  ~Body();
  /// @}

  std::vector<TetMesh> levels;  ///< finest first, at least one
  /// Coarse spaces of the last mesh, for methods that need coarse levels but no coarse elements
  /// (him, multigrid): their numbers of points, finest first; empty: as many as it takes. None:
  /// likewise, where a method needs them.
  std::optional<std::vector<int>> coarsen = {};
  /// of elements(): one for all levels, or one each, finest first
  std::vector<std::string> element = {"auto"};
  double stabilisation = 0.4;                    ///< beta of nodal elements
  std::string pressure = "auto";                 ///< of pressures(), of nodal elements
  MaterialOptions material;                      ///< everywhere but where a region has its own
  std::map<std::string, RegionOptions> regions;  ///< by name
  std::vector<Selection> fixed;                  ///< vertices that stay where they are
  std::vector<PrescribedMotion> prescribed;      ///< vertices whose motion is given
  std::vector<LoadOptions> loads;                ///< forces from outside
  DampingOptions damping;                        ///< of the whole body
  InitialOptions initial;                        ///< state at t = 0
  /// embedded in every level; contact acts on its vertices
  std::optional<TriangleSurface> surface;
  std::vector<BodyPart> parts = {};  ///< where it is several bodies; empty: one
};

/// Whether any of it is damped in proportion to its mass.
bool damps_by_mass(const Body& body);
/// Whether any of it is damped in proportion to its stiffness.
bool damps_by_stiffness(const Body& body);

/// How the linear systems of an implicit level are solved.
struct ImplicitOptions {
  std::string solver = "auto";          ///< of linear_solver_choices()
  std::string preconditioner = "auto";  ///< of preconditioner_choices()
  std::string matrix = "auto";          ///< of matrix_choices()
  /// of chebyshev, and of what smooths before and after in multigrid
  int polynomial_degree = 3;
  double relative_residual = 1e-6;  ///< |r|/|b| at which the conjugate gradients end
  int iterations = 0;               ///< above 0: exactly so many iterations instead
  /// a solve that has not converged by then is counted as a miss
  int max_iterations = 2000;
  /// at most, per stage; 1: linearly implicit; 0: auto, see newton_iterations()
  int newton_iterations = 0;
  /// part of the forces that may be unbalanced; none: see StageSolver
  std::optional<double> newton_tolerance = {};
  double newton_residual = 0;    ///< or below this [N]
  std::string tangent = "auto";  ///< of tangents()
  /// Of generalized_alpha: what is left of the fastest modes after a step; none: see
  /// rho_infinity().
  std::optional<double> rho_infinity = {};
};

/// Of the cycle `him`.
struct HimOptions {
  double sigma = 0.8;  ///< part of the stability limit that steps use at rest
  /// of slowed motion, per step; none: 1e-4 where the body turns
  std::optional<double> dissipation;
  bool smoothing = true;  ///< of its transfers
};

/// What becomes of a macro step that does not pass its checks, or that Newton's method does not
/// solve.
struct FailureOptions {
  static constexpr int automatic = -1;  ///< left to most_halvings()
  /// at most, of a macro step; 0: none, and nothing is repaired
  int halvings = automatic;
  /// of unsolved_outcomes(): of the shortest part that is not solved
  std::string unsolved = "accept";
};

/// How a body is stepped in time.
struct IntegrationOptions {
  /// Compiled in problem.cpp alone.
  /// @{
  IntegrationOptions();
  IntegrationOptions(const IntegrationOptions&);
  IntegrationOptions(IntegrationOptions&&) noexcept;
  IntegrationOptions& operator=(const IntegrationOptions&);
  IntegrationOptions& operator=(IntegrationOptions&&) noexcept;
  ~IntegrationOptions();
  /// @}

  std::string cycle = "single";           ///< of cycle_choices()
  std::string error_class = "balanced";   ///< of cycle auto, of error_classes()
  std::optional<double> macro_step;       ///< [s]; none: 0.9 of the predicted limit
  std::string distribution = "critical";  ///< of distributions()
  /// of the macro step, finest first, with `custom`; their sum is 1 to 1e-12
  std::vector<double> shares;
  /// this part of every finer level's share goes to the coarsest
  double shift_to_coarsest = 0;
  /// one for all levels, or one each, finest first
  std::vector<std::string> integrator = {"symplectic_euler"};
  /// likewise; 0: as many as the level's limit asks for
  std::vector<int> substeps = {0};
  /// of the limit that automatic sub-steps keep
  double safety = 0.9;
  /// run explicit sub-steps above the limit all the same
  bool allow_unstable = false;
  double switch_threshold = 0.1;  ///< epsilon of the switched mappings
  /// of outside_rules(): vertices outside the other mesh
  std::string outside = "clamp";
  /// of relaxation_rules(): how Prony series go on
  std::string relaxation = "exponential";
  ImplicitOptions implicit;   ///< of implicit levels
  HimOptions him;             ///< of the hierarchical inverse mass
  FailureOptions on_failure;  ///< of a bad macro step
};

/// Points of one of several bodies, held by springs without length to the places on another one's
/// surface that they start nearest to.
struct AttachmentOptions {
  std::string body;  ///< whose points are attached
  std::string to;    ///< the body that they are attached to
  /// of the body's surface points where they start; none: all of them
  std::optional<Selection> where = {};
  /// how far from the other's surface a point may be that is attached [m]
  double reach = 0;
  std::optional<double> stiffness = {};  ///< of each point's spring [N/m]; none: as contact has it
  /// force at which a point's spring tears [N]; none: it never does
  std::optional<double> strength = {};
};

/// Penalty contact of the embedded surface's vertices with obstacles and with the surface's
/// triangles, see cmake/docs/contact.md. The scales multiply, per surface point, the stiffness k =
/// 64 E A / h (of two bodies both layers in series) and the damping 2 * 0.5 * sqrt(k rho A h), with
/// A the surface's area per point and h the finest level's mean edge.
struct ContactOptions {
  /// Compiled in problem.cpp alone.
  /// @{
  ContactOptions();
  ContactOptions(const ContactOptions&);
  ContactOptions(ContactOptions&&) noexcept;
  ContactOptions& operator=(const ContactOptions&);
  ContactOptions& operator=(ContactOptions&&) noexcept;
  ~ContactOptions();
  /// @}

  std::vector<ObstacleOptions> obstacles;  ///< what the surface can touch
  /// where there are several, they touch each other
  bool bodies = true;
  bool self = false;                                ///< a body's surface touches itself
  std::vector<AttachmentOptions> attachments = {};  ///< of bodies to each other
  std::optional<double> friction = {};              ///< of these two; none: frictionless
  std::string whole_surface = "auto";               ///< of whole_surface_rules()
  double stiffness_scale = 1;                       ///< of the penalty
  double damping_scale = 1;                         ///< of the approach
  /// of the spring by which friction sticks, over the penalty's
  double friction_stiffness_scale = 1;
  double tangential_damping_scale = 1;  ///< of the damper beside that spring
};

/// What results call that obstacle.
std::string obstacle_name(const ContactOptions& contact, std::size_t obstacle);

/// A body, what acts on it, and how it is integrated.
struct Problem {
  /// Compiled in problem.cpp alone.
  /// @{
  Problem();
  Problem(const Problem&);
  Problem(Problem&&) noexcept;
  Problem& operator=(const Problem&);
  Problem& operator=(Problem&&) noexcept;
  ~Problem();
  /// @}

  /// name of the preset that these options came from; see presets()
  std::string preset = {};
  Body body;                       ///< what moves
  Point gravity = Point::Zero();   ///< [m/s^2]
  IntegrationOptions integration;  ///< in time
  ContactOptions contact;          ///< with obstacles
  /// the caller will put forces of its own on the surface: embed it in every level
  bool surface_forces = false;
};

/// Whether any of it relaxes.
bool is_viscous(const Body& body);

/// Whether its surface acts on its surface: bodies touch or hold each other, or one of them touches
/// itself.
bool has_pairs(const Problem& problem);
/// Whether it touches anything.
bool has_contact(const Problem& problem);
/// What is left of it where nothing touches: no obstacles, no pairs, no surface.
void remove_contact(Problem& problem);
/// Of what pushes it, in order: its obstacles, and where several bodies touch each other the
/// bodies.
std::vector<std::string> wrench_names(const Problem& problem);

}  // namespace plica
