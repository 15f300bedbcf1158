// SPDX-License-Identifier: BSD-3-Clause
#include <Kokkos_Profiling_ScopedRegion.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <plica/core/error.hpp>
#include <plica/core/text.hpp>
#include <plica/core/to_device.hpp>
#include <plica/drivers/body/body_parts.hpp>
#include <plica/drivers/body/embed_free.hpp>
#include <plica/drivers/body/initial_state.hpp>
#include <plica/drivers/body/masses.hpp>
#include <plica/drivers/body/selection.hpp>
#include <plica/drivers/contact/build_surface.hpp>
#include <plica/drivers/cycles/plan_steps.hpp>
#include <plica/drivers/elastic/element_bound.hpp>
#include <plica/drivers/elastic/materials.hpp>
#include <plica/drivers/level/build_level.hpp>
#include <plica/drivers/level/surface_of_part.hpp>
#include <plica/drivers/linear/make_linear_solver.hpp>
#include <plica/drivers/loads/assemble_loads.hpp>
#include <plica/drivers/loads/dead_loads.hpp>
#include <plica/drivers/methods/methods.hpp>
#include <plica/drivers/methods/rest.hpp>
#include <plica/drivers/run/build_hierarchy.hpp>
#include <plica/drivers/run/deform_start.hpp>
#include <plica/drivers/run/needs_of_systems.hpp>
#include <plica/drivers/run/rank_levels.hpp>
#include <plica/drivers/run/validate.hpp>
#include <plica/drivers/time/critical_step.hpp>
#include <plica/drivers/time/integrator_parts.hpp>
#include <plica/kernels/loads/boundary_conditions.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/compare_levels.hpp>
#include <plica/meshes/cut.hpp>
#include <plica/meshes/mesh_quality.hpp>

namespace plica {

namespace {

Outside outside_rule(const IntegrationOptions& o) {
  if (stepper_needs(o.cycle).extrapolation) return Outside::extrapolate;
  const std::string& name = o.outside;
  return name == "clamp"         ? Outside::clamp
         : name == "extrapolate" ? Outside::extrapolate
                                 : Outside::keep;
}

DampingLimit damping_limit(const LevelConstants& c) {
  const auto mass = std::minmax_element(c.mass_damping.begin(), c.mass_damping.end());
  if (c.stiffness_damping.empty()) return {*mass.first, *mass.second};
  const auto stiffness =
      std::minmax_element(c.stiffness_damping.begin(), c.stiffness_damping.end());
  // the stabilisation of nodal elements is not damped
  const double least = c.element == Element::linear ? *stiffness.first : 0;
  return {*mass.first, *mass.second, least, *stiffness.second};
}

/// Set-up in progress, with host data that several of its steps need.
template <class B>
class HierarchyBuilder {
  using Exec = typename B::Exec;

 public:
  HierarchyBuilder(const Problem& problem, const Exec& exec, Ranks* ranks)
      : problem_(problem),
        own_(ranks, !has_contact(problem) && !problem.surface_forces),
        needs_(stepper_needs(problem.integration.cycle)),
        meshes_(needs_.coarse_meshes ? problem.body.levels.size() : 1),
        levels_(integrated_levels(problem.integration.cycle, problem.body.levels.size())) {
    built_.hierarchy = std::make_unique<Hierarchy<B>>(exec);
  }

  BuiltHierarchy<B> build() {
    phase("placing the meshes", [&] { place_meshes(); });
    phase("embedding the levels in each other", [&] { embed_levels(); });
    phase("measuring the elements", [&] {
      for (std::size_t i = 0; i < meshes_; ++i) report_mesh(i);
    });
    phase("building the levels", [&] {
      for (std::size_t i = 0; i < levels_; ++i) add_level(i);
      for (std::size_t i = 1; i < levels_; ++i) connect(i);
    });
    for (std::size_t i = 0; i < levels_; ++i)
      elasticity_.push_back(
          make_elasticity<B>(problem_.body.material.model, constants_[i].element));
    if (has_contact(problem_)) phase("preparing contact", [&] { add_contact(); });
    locators_.clear();
    for (std::size_t i = 0; i < levels_; ++i)
      phase("finding the critical step of level " + std::to_string(i), [&] { add_dynamics(i); });
    phase("planning the steps", [&] { plan(); });
    if (starts_deformed(problem_.body.initial))
      deform_start<B>(problem_.body, built_.meshes.front(), constants_.front().constrained,
                      built_.hierarchy->levels.front());
    built_.stepper->start(*built_.hierarchy);
    for (const auto& level : built_.hierarchy->levels)
      follow_masters(built_.hierarchy->exec(), level.model, level.state);
    for (const auto& level : built_.hierarchy->levels) level.accept_state(0);
    return std::move(built_);
  }

 private:
  /// Runs a phase of the set-up in a region of Kokkos' profiling interface, so that tools and
  /// programs see it.
  template <class Work>
  static void phase(const std::string& name, const Work& work) {
    const Kokkos::Profiling::ScopedRegion region("plica: " + name);
    work();
  }

  const Problem& problem_;
  // the levels as this rank has them. Contact reads surface points in all levels, so that each rank
  // has coarse levels with contact as a whole: they are small
  RankLevels<B> own_;
  BuiltHierarchy<B> built_;
  StepperNeeds needs_;
  std::size_t meshes_, levels_;  // number of meshes that are used; of levels that are integrated
  TriangleSurface surface_;      // the placed surface
  std::vector<LevelConstants> constants_;
  std::vector<std::vector<AssembledLoad>> loads_;                  // per level
  std::vector<std::vector<std::unique_ptr<ForceTerm<B>>>> terms_;  // per level
  SurfacePart part_surface_;                                       // this rank's points of level 0
  std::vector<std::unique_ptr<BodyLocator>> locators_;             // per level, see locator()
  // [i]: embedding of level i's vertices in level i-1 (down), and the reverse (up); [0] empty
  std::vector<Embedding> down_, up_;
  std::vector<int> massless_ = {0};  // [i]: number of level i's vertices that inherit no mass
  std::vector<std::shared_ptr<const Elasticity<B>>> elasticity_;  // per level
  // per level, largest_eigenvalue() at rest [1/s^2]
  std::vector<double> eigenvalues_;
  std::shared_ptr<const Contact<B>> contact_;

  const std::string& integrator_of(std::size_t i) const {
    const auto& all = problem_.integration.integrator;
    return all.size() == 1 ? all.front() : all[i];
  }

  void place_meshes() {
    const Body& body = problem_.body;
    const Box box = bounding_box(body.levels.front().vertices);
    const Point middle = 0.5 * (box.min + box.max);
    const Point shift = body.initial.position.value_or(middle) - middle;
    for (std::size_t i = 0; i < meshes_; ++i) {
      TetMesh& mesh = built_.meshes.emplace_back(body.levels[i]);
      const int level = static_cast<int>(i);
      add_regions(mesh, body.regions, level);
      constants_.push_back(level_constants(body, mesh, middle, level));
      if (i < levels_) {
        loads_.push_back(assemble_loads(body, mesh, constants_[i], level,
                                        i > 0 ? loads_[0] : std::vector<AssembledLoad>{}));
        terms_.push_back(own_.shares(i)
                             ? std::vector<std::unique_ptr<ForceTerm<B>>>()
                             : make_force_terms<B>(body, mesh, constants_[i], loads_[i], level));
        if (!own_.shares(i)) add_weight_to_rest(i, constants_[i]);
      }
      for (Point& p : mesh.vertices) p += shift;
    }
    place_supports(shift);
    locators_.resize(meshes_);
    if (body.surface) surface_ = *body.surface;
    for (Point& p : surface_.vertices) p += shift;
  }

  /// Adds gravity to a level's terms where it grows to rest.
  void add_weight_to_rest(std::size_t i, const LevelConstants& constants) {
    if (!seeks_rest(problem_.integration) || problem_.gravity.isZero(0)) return;
    terms_[i].push_back(std::make_unique<DeadLoads<B>>(std::vector{weight_load<B>(
        constants.mass, problem_.gravity, course_to_rest(problem_.integration.rest))}));
  }

  /// Returns the search for points in a level's mesh, which is made when it is first asked for.
  const BodyLocator& locator(std::size_t i) {
    if (!locators_[i])
      locators_[i] = std::make_unique<BodyLocator>(built_.meshes[i], problem_.body.parts);
    return *locators_[i];
  }

  /// Returns the tolerance of rest; 0: the body moves.
  double rest_tolerance() const {
    constexpr bool single = sizeof(typename B::Real) < sizeof(double);
    const IntegrationOptions& o = problem_.integration;
    return seeks_rest(o) ? o.rest.tolerance.value_or(single ? 1e-3 : 1e-5) : 0;
  }

  /// Finds the points that torques of held vertices are about, and that given motions turn about.
  void place_supports(const Point& shift) {
    const Body& body = problem_.body;
    std::vector<Point> turned_about;
    for (HeldSet& set : constants_.front().held) set.centre += shift;
    for (std::size_t i = 0; i < body.prescribed.size(); ++i) {
      Point& centre = constants_.front().held[body.fixed.size() + i].centre;
      if (body.prescribed[i].rotate) centre = body.prescribed[i].rotate->about.value_or(centre);
      turned_about.push_back(centre);
    }
    for (LevelConstants& level : constants_) level.turned_about = turned_about;
    built_.held = constants_.front().held;
  }

  void report_mesh(std::size_t i) {
    const TetMesh& mesh = built_.meshes[i];
    LevelReport& report = built_.reports.emplace_back();
    report.vertices = static_cast<int>(mesh.vertices.size()),
    report.tets = static_cast<int>(mesh.tets.size());
    if (!mesh.piece.empty()) {
      report.kind = LevelKind::part;
      report.pieces = piece_reports(mesh, constants_[i].density);
    } else if (!mesh.filled.empty()) {
      TetMesh whole = mesh;
      whole.filled.clear();
      report.kind = LevelKind::lattice;
      report.filled = mesh_size(mesh, constants_[i].density).volume /
                      mesh_size(whole, constants_[i].density).volume;
    }
    report.mean_edge = mean_edge_length(mesh);
    report.mass = std::accumulate(constants_[i].mass.begin(), constants_[i].mass.end(), 0.0);
    std::vector<double> steps = element_steps(mesh, constants_[i].lame, constants_[i].density);
    report.stiffest = stiffest_elements(mesh, steps, 10);
    report.element_bound = report.stiffest.front().step;
    const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
    std::nth_element(steps.begin(), middle, steps.end());
    report.typical_element = *middle;
    report.element = name_of(constants_[i].element);
    report.integrator = integrator_of(i);
    if (i == 0) return;
    report.outside_down = down_[i].misses, report.outside_up = up_[i].misses;
    report.massless = needs_.inherited_masses ? massless_[i] : 0;
    report.largest_miss =
        std::max(down_[i].largest_distance_over_edge, up_[i].largest_distance_over_edge);
  }

  /// Finds what acts on this rank's part of a level.
  void take_part(std::size_t i) {
    const RankPart& part = own_.part(i)->part;
    terms_[i] = make_force_terms<B>(problem_.body, own_.mesh(i), own_.constants(i),
                                    loads_of_part(loads_[i], part), static_cast<int>(i));
    add_weight_to_rest(i, own_.constants(i));
    if (i > 0) return;
    built_.held = held_by_part(built_.held, part);
    if (!problem_.body.surface) return;
    part_surface_ = surface_of_part(surface_, built_.meshes[i], *own_.part(i));
    built_.surface_point = part_surface_.points, built_.owned_points = part_surface_.owned;
  }

  void add_level(std::size_t i) {
    own_.add(built_.meshes[i], constants_[i], may_need_matrix(problem_, integrator_of(i)));
    const LevelPart* const part = own_.part(i);
    if (part) take_part(i);
    LevelData<B> level = build_level<B>(
        problem_.body, own_.mesh(i), own_.constants(i),
        beside_nodal(problem_, integrator_of(i), built_.meshes[i], constants_[i]), part);
    if (needs_.drift_limits && levels_ > 1) {
      std::vector<double> edges = local_edge_lengths(built_.meshes[i]);
      if (part) edges = part->part.local(edges);
      std::vector<typename B::Real> limit;
      for (double edge : edges)
        limit.push_back(
            static_cast<typename B::Real>(problem_.integration.switch_threshold * edge));
      level.drift_limit = to_device<Scalars<B>>("drift_limit", limit);
    }
    // the finest level has the surface for output; the others have it only where something acts on
    // it
    if (problem_.body.surface && (i == 0 || has_contact(problem_) || problem_.surface_forces))
      level.surface = part ? build_surface_part<B>(part_surface_)
                           : build_surface<B>(surface_, embed_surface(i));
    built_.hierarchy->levels.emplace_back(std::move(level), built_.hierarchy->clock,
                                          static_cast<int>(i));
    built_.hierarchy->levels.back().terms = std::move(terms_[i]);
  }

  /// Embeds the surface in level i. Points outside continue the tetrahedron next to them, so that
  /// they turn with it.
  Embedding embed_surface(std::size_t i) {
    if (i == 0) {
      std::vector<int> at = problem_.body.surface_vertex;
      if (at.empty()) at = vertices_at(surface_.vertices, built_.meshes.front());
      if (!at.empty()) return embed_at_vertices(built_.meshes.front(), at);
    }
    constexpr double far = 10;  // edges; a coarse mesh may lie a little inside the surface
    Embedding embedding = embed_free(built_.meshes[i], problem_.body.parts, locator(i),
                                     surface_.vertices, parts_of_points(problem_.body.parts));
    if (embedding.largest_distance_over_edge > far)
      throw InputError("body.surface: " + std::to_string(embedding.misses) + " of its " +
                       std::to_string(surface_.vertices.size()) + " points lie outside level " +
                       std::to_string(i) + ", by up to " +
                       std::to_string(std::lround(embedding.largest_distance_over_edge)) +
                       " of its edges; expected the body's own surface, in metres");
    return embedding;
  }

  void embed_levels() {
    const Outside rule = outside_rule(problem_.integration);
    down_.resize(1), up_.resize(1);
    for (std::size_t i = 1; i < meshes_; ++i) {
      const auto in = [&](std::size_t points, std::size_t mesh) {
        const TetMesh& of = built_.meshes[points];
        return locator(mesh).embed(of.vertices, parts_of_vertices(of, problem_.body.parts), rule);
      };
      down_.push_back(in(i, i - 1));
      up_.push_back(in(i - 1, i));
      expect_overlap(i);
      expect_same_body(i);
      std::vector<double>& mass = constants_[i].mass;
      if (needs_.inherited_masses)
        mass = inherited_masses(up_[i], constants_[i - 1].mass, mass, massless_.emplace_back());
    }
  }

  void expect_overlap(std::size_t i) {
    const auto &coarse = built_.meshes[i].vertices, &fine = built_.meshes[i - 1].vertices;
    if (down_[i].misses < static_cast<int>(coarse.size()) ||
        up_[i].misses < static_cast<int>(fine.size()))
      return;
    double distance = std::numeric_limits<double>::infinity();
    for (const Point& p : coarse) distance = std::min(distance, locator(i - 1).distance(p));
    for (const Point& p : fine) distance = std::min(distance, locator(i).distance(p));
    throw InputError(text("body.levels: levels ", i - 1, " and ", i, " do not overlap, they are ",
                          number(distance, 4), " m apart; expected meshes of one body"));
  }

  void expect_same_body(std::size_t i) const {
    const auto size = [&](std::size_t l) {
      return mesh_size(built_.meshes[l], constants_[l].density);
    };
    if (const LevelComparison found = compare_levels(size(0), size(i), i);
        found.same == SameBody::no)
      throw InputError("body.levels: " + found.sentence);
  }

  void connect(std::size_t i) {
    const Outside rule = outside_rule(problem_.integration);
    LevelData<B>& level = built_.hierarchy->levels[i];
    const Embedding &down = down_[i], &up = up_[i];
    if (rule == Outside::keep && down.misses + up.misses > 0)
      throw InputError("integration.outside is keep, but " + std::to_string(down.misses) +
                       " vertices of level " + std::to_string(i) + " lie outside level " +
                       std::to_string(i - 1) + " and " + std::to_string(up.misses) +
                       " the other way: they would move in their own level's share of the step "
                       "only; use clamp or extrapolate");
    if (needs_.inherited_masses) {
      level.adjoint = own_.restriction(restriction_rows(up, constants_[i - 1].mass, down), i - 1, i,
                                       level.of_finer);
      const Scalars<B>& inverse = built_.hierarchy->levels[i - 1].model.inverse_mass;
      level.finer_inverse_mass =
          level.of_finer ? (*level.of_finer)(built_.hierarchy->exec(), inverse) : inverse;
    } else {
      level.from_finer = own_.interpolation("restriction", down, i - 1, i, level.of_finer);
    }
    level.to_finer = own_.interpolation("interpolation", up, i, i - 1, level.for_finer);
  }

  void add_contact() {
    const Problem& p = problem_;
    ContactOptions options = p.contact;
    if (options.whole_surface == "auto" && !needs_matrix(p.integration).empty())
      options.whole_surface = "never";
    TouchingSurface touching{
        .surface = surface_,
        .parts = {},
        .body = parts_of_points(p.body.parts),
        .attached = attached_points(p.contact.attachments, surface_, p.body.parts),
        .held = holdable(),
        .edge = contact_edge(),
        .size = body_size()};
    for (std::size_t b = 0; b < p.body.parts.size(); ++b)
      touching.parts.push_back({&p.body.parts[b].material, locator(0).mean_edge(b)});
    if (touching.parts.empty()) touching.parts.push_back({&p.body.material, touching.edge});
    if (p.contact.bodies && has_pairs(p)) expect_apart(surface_, p.body.parts, touching.edge);
    contact_ = std::make_shared<const Contact<B>>(options, touching, has_pairs(p));
    if (own_.ranks() && contact_->whole() > 0)
      throw InputError("contact.whole_surface is " + options.whole_surface +
                       ", and an obstacle is so small that it touches between points, which runs "
                       "on one process alone; expected never, or one process");
  }

  /// Returns for each obstacle the surface points that it may grasp; empty: all of them.
  std::vector<std::vector<int>> holdable() const {
    std::vector<std::vector<int>> points;
    for (const ObstacleOptions& o : problem_.contact.obstacles) {
      const std::string option = text("contact.obstacles.", points.size(), ".grasp.where");
      const bool chooses = o.grasp && o.grasp->where;
      points.push_back(chooses ? select_points(surface_.vertices, *o.grasp->where, option)
                               : std::vector<int>{});
    }
    return points;
  }

  /// Returns the edge that contact is as stiff as [m]: where a part follows an obstacle that of the
  /// part, wherever it is.
  double contact_edge() const {
    const auto& part = problem_.body.following;
    return part ? mean_edge_length(part->coarser) / 2 : built_.reports.front().mean_edge;
  }

  double body_size() const {
    const Box box = bounding_box(built_.meshes.front().vertices);
    return (box.max - box.min).norm();
  }

  /// Finds level i's critical step, and makes its integrator and the forces on it.
  void add_dynamics(std::size_t i) {
    LevelReport& report = built_.reports[i];
    Level<B>& level = built_.hierarchy->levels[i];
    // not the level's state, in which a given motion may start elsewhere
    const auto rest =
        zeros<Vectors<B>>("plica::rest", static_cast<std::size_t>(level.model.vertices));
    const StiffnessAt<B> K{level, *elasticity_[i], rest};
    eigenvalues_.push_back(largest_eigenvalue<B>(level.exec(), K));
    Integrators::visit(report.integrator, [&](auto integrator) {
      using Kind = decltype(integrator);
      report.explicit_integrator = Kind::is_explicit;
      report.critical_step = critical_step<B>(
          level.exec(), K, Kind::is_explicit ? Kind::limit : SymplecticEuler::limit,
          damping_limit(constants_[i]), eigenvalues_[i], level.term_frequency());
      ImplicitOptions implicit = problem_.integration.implicit;
      implicit.newton_iterations = newton_iterations(implicit, report.integrator);
      implicit.rho_infinity = rho_infinity(implicit, contact_ != nullptr);
      const auto make_solver = [&] {
        std::string solver = implicit.solver;
        if constexpr (requires { Kind::linear_solver; }) solver = Kind::linear_solver;
        if (solver == "auto" && contact_ && contact_->couples()) solver = "conjugate_gradients";
        const auto parts = linear_solver_parts(problem_, i, B::on_host && !level.ranks, solver,
                                               report.critical_step);
        report.linear_solver = describe(parts);
        return make_linear_solver<B>(parts, level);
      };
      level.integrator = Kind::template make<B>(
          level, {implicit, contact_ != nullptr, allows_inversion(problem_.body.material),
                  problem_.integration.on_failure.unsolved == "stop",
                  conserves_energy(implicit, report.integrator), report.mean_edge, make_solver,
                  rest_tolerance(), report.critical_step});
    });
    const Point gravity = rest_tolerance() > 0 ? Point(Point::Zero()) : problem_.gravity;
    level.set_forces(elasticity_[i], gravity, contact_, !report.explicit_integrator);
    if (is_viscous(problem_.body))
      level.viscosity = std::make_unique<Viscosity<B>>(
          constants_[i].shape, problem_.integration.relaxation, own_.mesh(i), level);
  }

  /// Makes the stepper, and lets it plan the steps of the levels.
  void plan() {
    const std::string& cycle = problem_.integration.cycle;
    Steppers::visit(seeks_rest(problem_.integration) ? Single::name : cycle,
                    [&](auto stepper) { built_.stepper = decltype(stepper)::template make<B>(); });
    StepperSetup<B> setup{problem_,       *built_.hierarchy, built_.meshes, constants_,    up_,
                          elasticity_[0], eigenvalues_[0],   contact_,      built_.reports};
    setup.goes_on = !problem_.body.surface_vertex.empty();
    built_.stepper->plan(setup);
    built_.macro_step = setup.macro_step, built_.him = setup.him;
  }
};

}  // namespace

template <class B>
BuiltHierarchy<B> build_hierarchy(const Problem& problem, const typename B::Exec& exec,
                                  Ranks* ranks) {
  return HierarchyBuilder<B>(problem, exec, ranks && ranks->count() > 1 ? ranks : nullptr).build();
}

#define PLICA_INSTANTIATE(Real, Exec)                                                \
  template BuiltHierarchy<Backend<Real, Exec>> build_hierarchy<Backend<Real, Exec>>( \
      const Problem&, const Exec&, Ranks*);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
