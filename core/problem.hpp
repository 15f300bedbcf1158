// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <limits>
#include <map>
#include <optional>
#include <plica/core/cuts.hpp>
#include <plica/core/load.hpp>
#include <plica/core/obstacles.hpp>
#include <string>
#include <type_traits>
#include <vector>

/// Description of a simulation, in SI and without files: the library's whole input. Every struct is
/// plain. A default is the value in a scene that leaves the key out. Ranges and names are in
/// describe.hpp; they are checked where the simulation is set up. Large structs have their copies
/// in problem.cpp: each takes the compiler seconds.
namespace plica {

/// Directions round a line: tangents of circles about it, turned by an angle towards it. The sheets
/// of these fibres are the cylinders about the line.
struct FibreWinding {
  Point point = Point::Zero();  ///< point on the line [m]
  Point axis = Point::UnitZ();  ///< direction of the line; its length does not matter
  /// Angle of the helix: 0 round the line, a right angle along it [rad]
  double angle = 0;
};

/// Directions of a body's fibres at rest: the same everywhere, by a rule, or of each element.
struct FibreOptions {
  Point axis = Point::UnitX();  ///< direction of the fibres; its length does not matter
  /// Direction across the fibres, in the plane of their sheets or families
  std::optional<Point> sheet = {};
  std::optional<FibreWinding> around = {};  ///< winding instead of `axis` and `sheet`
  /// Vertices of level 0 that the fibres run from, instead of `axis`. They run as heat would flow
  /// to those of `to`, see flow_directions()
  std::optional<Selection> from = {};
  std::optional<Selection> to = {};  ///< vertices of level 0 that the fibres run to
  /// Name of vectors in TetMesh::tet_vectors, instead of `axis`
  std::string field = {};
  /// Name of vectors in TetMesh::tet_vectors, instead of `sheet`
  std::string sheet_field = {};
};

/// A part of the stress of shape that relaxes. A step of strain makes it alpha times the stress at
/// once; after a time t, e^(-t/tau) of it is left.
struct PronyTerm {
  double alpha = 0;  ///< part of the stress at once
  double tau = 0;    ///< [s]
};

/// A term of the sum in Ogden's law.
struct OgdenTerm {
  double mu = 0;     ///< [Pa]
  double alpha = 0;  ///< exponent, not 0
};

/// Material of a body.
struct MaterialOptions {
  std::string model = "neo_hookean";  ///< one of materials()
  double young_modulus = 20e3;        ///< [Pa]
  double poisson_ratio = 0.4;         ///< lateral contraction
  double density = 1000;              ///< [kg/m^3]
  /// True where elements may turn inside out; none: as the material has it
  std::optional<bool> allow_inversion = {};
  /// Further values that the material declares, by name, in SI
  std::map<std::string, double> parameters = {};
  /// Energy U(J) of laws of tissue, one of volumes(); none: simo_hughes
  std::optional<std::string> volume = {};
  /// Convention for mu in `terms`, one of ogden_conventions()
  std::optional<std::string> convention = {};
  std::vector<OgdenTerm> terms = {};  ///< terms of Ogden's law, 1 to 6
  std::vector<PronyTerm> prony = {};  ///< relaxation; none: the material is elastic
  /// Fibres of laws that have them; a scene has them as body.fibres
  std::optional<FibreOptions> fibres = {};
  /// Tissue that these values came from, see tissue_material()
  std::string tissue = {};
};

/// Values of DampingOptions that a region has instead of the body's.
struct RegionDamping {
  std::optional<double> mass;       ///< [1/s]
  std::optional<double> stiffness;  ///< [s]
};

/// Options that a region has of its own; the rest is the body's.
struct RegionOptions {
  /// Elements of the region; none: those of the mesh's region of that name
  std::optional<Selection> where;
  std::optional<double> young_modulus;  ///< [Pa]
  std::optional<double> poisson_ratio;  ///< lateral contraction
  std::optional<double> density;        ///< [kg/m^3]
  RegionDamping damping;                ///< damping instead of the body's
  /// Values of the material, by name, instead of the body's
  std::map<std::string, double> parameters = {};
  /// Ogden's terms instead of the body's, where there are any
  std::vector<OgdenTerm> terms = {};
  std::vector<PronyTerm> prony = {};  ///< relaxation instead of the body's, where there is any
  std::optional<FibreOptions> fibres = {};  ///< fibres instead of the body's
};

/// Vertices that are held: in all directions, or along some, across which they slide freely.
struct FixedVertices {
  FixedVertices() = default;
  /// Holds what a selection chooses in all directions.
  template <class Where>
  requires(!std::is_same_v<Where, FixedVertices> &&
           std::is_constructible_v<Selection, const Where&>) FixedVertices(const Where& chosen)
      : where(chosen) {}

  Selection where;  ///< chosen vertices
  /// Axes along which they are held, of axis_choices(); empty: all, unless `slide` is given
  std::vector<std::string> along = {};
  /// Normal along which alone they are held: they slide in the plane across it. Its length does not
  /// matter; [0, 0, 0]: the normal of the surface at rest, of each vertex
  std::optional<Point> slide = {};

  /// Returns whether the vertices are held along some directions only.
  bool in_part() const { return !along.empty() || slide.has_value(); }
};

/// Vertices whose motion is given.
struct PrescribedMotion {
  Selection where;  ///< chosen vertices
  Motion motion;    ///< motion from where they are at rest
  /// Turn about an axis, instead of `motion`. Where it names no point on the axis, that is the
  /// centre of the bounding box of level 0's chosen vertices
  std::optional<Turn> rotate = {};
};

/// Damping by mass and damping by stiffness. The first has forces -mass M v. The second has a
/// stress against the rate of strain: that of the material at rest, times `stiffness`, see
/// kernels/elastic/damping_stress.hpp. The second acts on no motion of the whole body. Together
/// they are Rayleigh's damping near rest: there a mode of frequency w [rad/s] decays like
/// exp(-(mass + stiffness w^2) t / 2).
struct DampingOptions {
  double mass = 0;       ///< [1/s]
  double stiffness = 0;  ///< [s]
};

/// Initial velocity of a part of the body, chosen on level 0.
struct PartVelocity {
  Selection where;                 ///< vertices of the part
  Point velocity = Point::Zero();  ///< [m/s]
  /// Angular velocity about the centre of their bounding box [rad/s]
  Point angular_velocity = Point::Zero();
};

/// Initial rotation about the line between two points of the mesh at rest, before it is placed. It
/// is zero in the plane through `from` across the line and grows linearly along the line.
struct TwistOptions {
  Point from = Point::Zero();  ///< point on the line [m]
  Point to = Point::UnitX();   ///< another point on the line [m]
  /// Angular velocity at `to`; seen from there, counter-clockwise where positive [rad/s]
  double angular_velocity = 0;
};

/// State at t = 0: placed and moving, at rest in shape where nothing deforms it. Velocities add up.
/// Vertices that are fixed, or whose motion is given, keep their own places and velocities.
struct InitialOptions {
  /// Constructors and copies, compiled in problem.cpp alone.
  /// @{
  InitialOptions();
  InitialOptions(const InitialOptions&);
  InitialOptions(InitialOptions&&) noexcept;
  InitialOptions& operator=(const InitialOptions&);
  InitialOptions& operator=(InitialOptions&&) noexcept;
  ~InitialOptions();
  /// @}

  /// Position of the centre of level 0's bounding box; none: where the mesh is [m]
  std::optional<Point> position;
  Point velocity = Point::Zero();  ///< velocity of every free vertex [m/s]
  /// Angular velocity about the centre of the bounding box [rad/s]
  Point angular_velocity = Point::Zero();
  std::optional<TwistOptions> twist;  ///< a rotation that grows along an axis
  std::vector<PartVelocity> parts;    ///< velocities of parts of the body
  /// Stretch along x, y, z about the centre of the bounding box: 0 flattens, a negative one turns
  /// inside out
  Point stretch = Point::Ones();
  /// Seed: each vertex starts anywhere in level 0's bounding box instead
  std::optional<int> random;
};

inline constexpr int fewest_points = 30;  ///< minimum number of points of a coarse space

/// One of several bodies that are stepped as one. It has the elements whose region has its name, or
/// begins with its name and a slash. See join_bodies().
struct BodyPart {
  std::string name;  ///< not empty
  /// Material where its regions have no other; contact is as stiff as this material
  MaterialOptions material;
  /// Number of points of its surface. The body's surface has the points of all parts, in their
  /// order
  int points = 0;
  /// Sizes of its own coarse spaces, see Body::coarsen
  std::optional<std::vector<int>> coarsen = {};
};

/// Choice of elements round an obstacle, wherever it moves.
struct FollowOptions {
  std::string obstacle;  ///< name of the obstacle, see obstacle_name()
  /// Distance up to which elements are chosen, by their centroids where these are now [m]
  double radius = 0;
  /// Point of the obstacle that the distance is from, where it is at t = 0 by the shape's options
  /// [m]; none: the origin of its shape
  std::optional<Point> at = {};
};

/// A part of the body that a level covers; elsewhere the next coarser level counts.
struct LevelCover {
  /// Elements that are taken, by their centroids: of its mesh, which then is one of the whole body,
  /// or where `refined` is true of the next coarser level's. None: all of its mesh
  std::optional<Selection> where = {};
  /// True: the level has no mesh. It has the elements of the next coarser one, each cut in eight
  bool refined = false;
  /// Set of vertices or triangles of its mesh that is its border inside the body; empty: found
  std::string border = {};
  /// Elements round an obstacle, chosen anew as it moves: in place of `where`, with `refined`.
  /// None: the part stays where it is
  std::optional<FollowOptions> follows = {};
};

/// Part of level 0 that follows an obstacle, in a body that is ready to be stepped.
struct FollowingPart {
  FollowOptions follows;     ///< obstacle and radius
  TetMesh coarser;           ///< mesh of the whole body that the part is made of
  std::vector<int> refined;  ///< tetrahedra of it that are cut in eight at present, ascending
};

/// A deformable body.
struct Body {
  /// Constructors and copies, compiled in problem.cpp alone.
  /// @{
  Body();
  Body(const Body&);
  Body(Body&&) noexcept;
  Body& operator=(const Body&);
  Body& operator=(Body&&) noexcept;
  ~Body();
  /// @}

  std::vector<TetMesh> levels;  ///< finest first, at least one
  /// Levels that cover a part of the body, by their numbers; not the last one. They and the next
  /// level that covers the whole make one level, see compose_levels(): numbers of levels in other
  /// options are those after that
  std::map<std::size_t, LevelCover> covers = {};
  /// Part of level 0 that follows an obstacle. Made of `covers` by compose_levels(); none: no part
  /// of it does
  std::optional<FollowingPart> following = {};
  /// Numbers of points of coarse spaces that are made of the last mesh, finest first. They are for
  /// methods that need coarse levels but no coarse elements (him, multigrid). Empty: as many as it
  /// takes. None: as many as it takes, where a method needs them
  std::optional<std::vector<int>> coarsen = {};
  /// Kinds of elements, from elements(): one for all levels, or one each, finest first
  std::vector<std::string> element = {"auto"};
  double stabilisation = 0.4;                    ///< beta of nodal elements
  std::string pressure = "auto";                 ///< pressure of nodal elements, one of pressures()
  MaterialOptions material;                      ///< material where a region has no other
  std::map<std::string, RegionOptions> regions;  ///< regions by name
  std::vector<FixedVertices> fixed;              ///< vertices that are held where they are
  std::vector<PrescribedMotion> prescribed;      ///< vertices whose motion is given
  std::vector<LoadOptions> loads;                ///< forces from outside
  DampingOptions damping;                        ///< damping of the whole body
  InitialOptions initial;                        ///< state at t = 0
  /// Surface that is embedded in every level; contact acts on its vertices
  std::optional<TriangleSurface> surface;
  /// Vertex of level 0 at each of the surface's points, or at each point of the boundary where
  /// there is no surface, after a cut; empty: there was none, and points are found by their places
  std::vector<int> surface_vertex = {};
  std::vector<BodyPart> parts = {};  ///< bodies, where there are several; empty: one
};

/// Returns true where a part of the body is damped in proportion to its mass.
bool damps_by_mass(const Body& body);
/// Returns true where a part of the body is damped in proportion to its stiffness.
bool damps_by_stiffness(const Body& body);

/// Options by which an implicit level is solved.
struct ImplicitOptions {
  std::string solver = "auto";          ///< one of linear_solver_choices()
  std::string preconditioner = "auto";  ///< one of preconditioner_choices()
  std::string matrix = "auto";          ///< one of matrix_choices()
  /// Degree of chebyshev, and of what smooths before and after in multigrid
  int polynomial_degree = 3;
  double relative_residual = 1e-6;  ///< |r|/|b| at which the conjugate gradients end
  int iterations = 0;               ///< above 0: exactly so many iterations per solve
  /// Maximum number of iterations; a solve that has not converged by then is counted as a miss
  int max_iterations = 2000;
  /// Maximum number of iterations per stage; 1: linearly implicit; 0: auto, see newton_iterations()
  int newton_iterations = 0;
  /// Part of the forces that may be unbalanced; none: see StageSolver
  std::optional<double> newton_tolerance = {};
  double newton_residual = 0;    ///< residual that is small enough in any case [N]
  std::string tangent = "auto";  ///< one of tangents()
  /// Part of the fastest modes that generalized_alpha leaves after a step; none: see rho_infinity()
  std::optional<double> rho_infinity = {};
};

/// Options of the cycle `him`.
struct HimOptions {
  double sigma = 0.8;  ///< part of the stability limit that steps use at rest
  /// Dissipation of slowed motion, per step; none: 1e-4 where the body turns
  std::optional<double> dissipation;
  bool smoothing = true;  ///< whether its transfers are smoothed
};

/// Outcome of a macro step that does not pass its checks, or that Newton's method does not solve.
struct FailureOptions {
  static constexpr int automatic = -1;  ///< value that leaves it to most_halvings()
  /// Maximum number of halvings of a macro step; 0: none, and nothing is repaired
  int halvings = automatic;
  /// Outcome of the shortest part that is not solved, one of unsolved_outcomes()
  std::string unsolved = "accept";
};

/// Options of the cycle `rest`: equilibrium by load steps.
struct RestOptions {
  /// Norm of the forces that are not balanced, over that of all forces, at which a load step is at
  /// rest; none: 1e-5, in float 1e-3
  std::optional<double> tolerance;
  /// Time in which gravity, and loads without a time function, grow from zero [s]; none: 1 s
  std::optional<double> ramp;
};

/// Integration of a body in time.
struct IntegrationOptions {
  /// Constructors and copies, compiled in problem.cpp alone.
  /// @{
  IntegrationOptions();
  IntegrationOptions(const IntegrationOptions&);
  IntegrationOptions(IntegrationOptions&&) noexcept;
  IntegrationOptions& operator=(const IntegrationOptions&);
  IntegrationOptions& operator=(IntegrationOptions&&) noexcept;
  ~IntegrationOptions();
  /// @}

  std::string cycle = "single";          ///< one of cycle_choices()
  std::string error_class = "balanced";  ///< class of cycle auto, one of error_classes()
  /// [s]; none: 0.9 of the predicted limit. With cycle him 8 critical steps of the finest level, or
  /// 4 with contact; halved until an inertia fits
  std::optional<double> macro_step;
  std::string distribution = "critical";  ///< one of distributions()
  /// Shares of the macro step with `custom`, finest first; their sum is 1 to 1e-12
  std::vector<double> shares;
  /// Part of every finer level's share that goes to the coarsest
  double shift_to_coarsest = 0;
  /// Integrators: one for all levels, or one each, finest first
  std::vector<std::string> integrator = {"symplectic_euler"};
  /// Numbers of sub-steps: one for all levels, or one each; 0: as many as the level's limit asks
  /// for
  std::vector<int> substeps = {0};
  /// Part of the limit that automatic sub-steps keep
  double safety = 0.9;
  bool allow_unstable = false;    ///< whether explicit sub-steps may exceed the limit
  double switch_threshold = 0.1;  ///< epsilon of the switched mappings
  /// Rule for vertices outside the other mesh, one of outside_rules()
  std::string outside = "clamp";
  /// Rule for how Prony series go on, one of relaxation_rules()
  std::string relaxation = "exponential";
  ImplicitOptions implicit;   ///< solution of implicit levels
  HimOptions him;             ///< options of the hierarchical inverse mass
  RestOptions rest;           ///< options of the cycle `rest`
  FailureOptions on_failure;  ///< outcome of a bad macro step
};

/// Attachment of points of one body to another one's surface. Springs without length hold each
/// point at the place on that surface that is nearest at the start.
struct AttachmentOptions {
  std::string body;  ///< body whose points are attached
  std::string to;    ///< the body that they are attached to
  /// Points of the body's surface that are attached, by where they start; none: all of them
  std::optional<Selection> where = {};
  /// Maximum distance of an attached point from the other's surface [m]
  double reach = 0;
  /// Stiffness of each point's spring [N/m]; none: that of contact
  std::optional<double> stiffness = {};
  /// Force at which a point's spring tears [N]; none: it never does
  std::optional<double> strength = {};
};

/// Penalty contact of the embedded surface's vertices with obstacles and with the surface's
/// triangles. See cmake/docs/explanation/contact.md. For each surface point, the scales multiply
/// the stiffness k = 64 E A / h and the damping 2 * 0.5 * sqrt(k rho A h). A is the surface's area
/// per point and h the finest level's mean edge. Between two bodies, the stiffness is that of both
/// layers in series.
struct ContactOptions {
  /// Constructors and copies, compiled in problem.cpp alone.
  /// @{
  ContactOptions();
  ContactOptions(const ContactOptions&);
  ContactOptions(ContactOptions&&) noexcept;
  ContactOptions& operator=(const ContactOptions&);
  ContactOptions& operator=(ContactOptions&&) noexcept;
  ~ContactOptions();
  /// @}

  std::vector<ObstacleOptions> obstacles;           ///< obstacles that the surface can touch
  bool bodies = true;                               ///< whether several bodies touch each other
  bool self = false;                                ///< whether a body's surface touches itself
  std::vector<AttachmentOptions> attachments = {};  ///< attachments of bodies to each other
  /// Coulomb's coefficient of bodies with each other and with themselves; none: frictionless
  std::optional<double> friction = {};
  std::string whole_surface = "auto";  ///< one of whole_surface_rules()
  double stiffness_scale = 1;          ///< scale of the penalty stiffness
  double damping_scale = 1;            ///< scale of the damping of the approach
  /// Stiffness of the spring by which friction sticks, over the penalty's
  double friction_stiffness_scale = 1;
  /// Scale of the damper beside the spring by which friction sticks
  double tangential_damping_scale = 1;
};

/// Returns the name of an obstacle in results.
std::string obstacle_name(const ContactOptions& contact, std::size_t obstacle);

/// A body, what acts on it, and how it is integrated.
struct Problem {
  /// Constructors and copies, compiled in problem.cpp alone.
  /// @{
  Problem();
  Problem(const Problem&);
  Problem(Problem&&) noexcept;
  Problem& operator=(const Problem&);
  Problem& operator=(Problem&&) noexcept;
  ~Problem();
  /// @}

  /// Name of the preset that these options came from; see presets()
  std::string preset = {};
  Body body;                          ///< body that moves
  Point gravity = Point::Zero();      ///< [m/s^2]
  IntegrationOptions integration;     ///< integration in time
  ContactOptions contact;             ///< contact with obstacles and between bodies
  std::vector<CutOptions> cuts = {};  ///< cuts of the body while the run goes on
  /// True where the caller will put forces of its own on the surface; it is then embedded in every
  /// level
  bool surface_forces = false;
};

/// Returns true where a part of the body relaxes.
bool is_viscous(const Body& body);

/// Returns true where surface acts on surface: bodies touch or are attached, or one of them touches
/// itself.
bool has_pairs(const Problem& problem);
/// Returns true where the body touches anything: obstacles or surface.
bool has_contact(const Problem& problem);
/// Removes all that touches from a problem: obstacles, pairs and the surface.
void remove_contact(Problem& problem);
/// Returns the names of what pushes the body, in order. These are its obstacles and, where several
/// bodies touch each other, the bodies.
std::vector<std::string> wrench_names(const Problem& problem);

}  // namespace plica
