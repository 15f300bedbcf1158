// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/core/describe.hpp>
#include <plica/core/error.hpp>
#include <plica/core/text.hpp>
#include <plica/core/time_functions.hpp>
#include <plica/drivers/body/body_parts.hpp>
#include <plica/drivers/body/masses.hpp>
#include <plica/drivers/body/selection.hpp>
#include <plica/drivers/contact/turning.hpp>
#include <plica/drivers/elastic/elements.hpp>
#include <plica/drivers/elastic/fibres.hpp>
#include <plica/drivers/elastic/materials.hpp>
#include <plica/drivers/linear/linear_solver.hpp>
#include <plica/drivers/methods/integrators.hpp>
#include <plica/drivers/methods/methods.hpp>
#include <plica/drivers/run/compose_levels.hpp>
#include <plica/drivers/run/validate.hpp>
#include <plica/drivers/spaces/coarse_spaces.hpp>
#include <plica/kernels/contact/shapes.hpp>
#include <plica/meshes/compare_levels.hpp>
#include <type_traits>

namespace plica {

namespace {

// Checks the values of one struct against each other
template <class T>
void check_together(const std::string&, const T&) {}

void check_together(const std::string& path, const Box& box) {
  for (int k = 0; k < 3; ++k)
    if (box.min[k] > box.max[k])
      throw InputError(path + ".min is " + Vector{length}.to_text(box.min) +
                       "; expected at most max, " + Vector{length}.to_text(box.max));
}

template <class Knot>
requires requires(Knot knot) { knot.time; }
void check_together(const std::string& path, const std::vector<Knot>& knots) {
  if (knots.empty()) throw InputError(path + " is empty; expected at least one time");
  const auto to_text = [&](std::size_t i) { return Quantity{duration}.to_text(knots[i].time, 9); };
  for (std::size_t i = 1; i < knots.size(); ++i)
    if (!(knots[i].time > knots[i - 1].time))
      throw InputError(path + "." + std::to_string(i) + ".time is " + to_text(i) +
                       "; expected a time after that of the entry before, " + to_text(i - 1));
}

void check_together(const std::string& path, const TwistOptions& o) {
  check_apart(path, o.from, o.to);
}

void check_together(const std::string& path, const FixedVertices& o) {
  if (!o.along.empty() && o.slide)
    throw InputError(path + " has along and slide; expected one of them, or neither");
}

void check_together(const std::string& path, const InitialOptions& o) {
  if (o.random && o.stretch != Point::Ones())
    throw InputError(path +
                     " has stretch and random, which puts vertices anywhere; expected one of them");
}

template <class T>
void check_keys(const std::string& path, T& options);

template <class Kind, class T>
void check_value(const std::string& path, const Kind& kind, T& value) {
  if constexpr (std::is_same_v<Kind, Group>)
    check_keys(path, value);
  else if constexpr (std::is_same_v<Kind, Map>)
    for (auto& [name, one] : value) check_keys(path + "." + name, one);
  else if constexpr (std::is_same_v<Kind, List>)
    for (std::size_t i = 0; i < value.size(); ++i)
      check_keys(path + "." + std::to_string(i), value[i]);
  else
    kind.check(path, value);
}

/// Walks the table of a struct and checks every value.
template <class T>
void check_keys(const std::string& path, T& options) {
  for_each_key(options, [&](const char* key, auto& member, const auto& kind, const char*) {
    auto* value = held(kind, member);
    if (value == nullptr) return;
    const std::string inside = path + "." + key;
    check_value(inside, kind, *value);
    if constexpr (std::is_same_v<decltype(kind), const List&>) check_together(inside, *value);
  });
  check_together(path, options);
}

/// Checks every value of a struct. A table takes a struct that a reader may fill; here it is only
/// read.
template <class T>
void check_values(const std::string& path, const T& options) {
  check_keys(path, const_cast<T&>(options));
}

/// Checks that an obstacle closes and opens in turns.
void check_grasp(const std::string& path, const GraspOptions& o) {
  if (o.until.size() > o.from.size() || o.until.size() + 1 < o.from.size())
    throw InputError(path + ".until has " + std::to_string(o.until.size()) + " times and " + path +
                     ".from " + std::to_string(o.from.size()) +
                     "; expected as many, or one less: the last time it stays closed");
  const auto to_text = [](double time) { return Quantity{duration}.to_text(time, 9); };
  const auto expect_after = [&](const std::string& key, double time, double before) {
    if (!(time > before))
      throw InputError(path + key + " is " + to_text(time) + "; expected a time after " +
                       to_text(before) + ": it closes and opens in turns");
  };
  for (std::size_t i = 0; i < o.from.size(); ++i) {
    if (i > 0) expect_after(".from", o.from[i], o.until[i - 1]);
    if (i < o.until.size()) expect_after(".until", o.until[i], o.from[i]);
  }
}

/// Checks the options of a tool that turns: one that has inertia.
void check_inertia(const std::string& path, const ObstacleOptions& o) {
  const bool turns = !o.inertia.empty();
  const auto expect_inertia = [&](bool given, const std::string& what) {
    if (given && !turns)
      throw InputError(path + what +
                       " is of an obstacle that turns by the torque on it; expected " + path +
                       ".inertia, too, or neither");
  };
  expect_inertia(o.mass && o.turn, ".rotate, beside mass,");
  expect_inertia(o.centre_of_mass.has_value(), ".centre_of_mass");
  expect_inertia(o.coupling.angular_stiffness > 0 || o.coupling.angular_damping,
                 ".coupling.angular_stiffness");
  if (!turns) return;
  if (!o.mass)
    throw InputError(path + ".inertia is of an obstacle with mass; expected " + path +
                     ".mass, too");
  if (o.inertia.size() != 3 && o.inertia.size() != 6)
    throw InputError(path + ".inertia has " + std::to_string(o.inertia.size()) +
                     " numbers; expected three, xx yy zz, or six, xx yy zz xy xz yz");
  const Point moments = principal_moments(o);
  const auto to_text = [](double moment) {
    return Quantity{{.mass = 1, .length = 2}}.to_text(moment);
  };
  if (!(moments[0] > 0))
    throw InputError(path + ".inertia has a moment of " + to_text(moments[0]) +
                     " about a principal axis; expected positive ones");
  if (moments[2] > moments[0] + moments[1] + 1e-9 * moments[2])
    throw InputError(path + ".inertia has the principal moments " + to_text(moments[0]) + ", " +
                     to_text(moments[1]) + " and " + to_text(moments[2]) +
                     "; expected none larger than the sum of the others, as of any solid");
}

void check_obstacle(const std::string& path, const ObstacleOptions& o) {
  const bool known = visit_shape(o.shape, [&](auto shape, const auto& options) {
    using S = decltype(shape);
    const std::string inside = path + "." + S::name;
    check_values(inside, options);
    if constexpr (requires { S::check(inside, options); }) S::check(inside, options);
  });
  if (!known)
    throw InputError(path + " has no shape; expected the options of one, such as SphereOptions");
  check_values(path, o);
  if (!o.mass && (o.coupling.stiffness > 0 || o.coupling.damping))
    throw InputError(path + ".coupling is of an obstacle with mass; expected " + path +
                     ".mass, or no coupling");
  if (o.mass && moves(o.motion) && !(o.coupling.stiffness > 0 || o.coupling.damping))
    throw InputError(path + " has mass and a motion, but nothing that makes it follow; expected " +
                     path + ".coupling, which pulls it along, or no motion");
  check_inertia(path, o);
  if (!o.grasp) return;
  check_grasp(path + ".grasp", *o.grasp);
  if (o.grasp->where) expect_without_name(*o.grasp->where, path + ".grasp.where");
}

void check_multigrid(const Body& body, const ImplicitOptions& o) {
  if (o.preconditioner != "multigrid" && o.solver != "v_cycle") return;
  if (has_coarse_levels("auto", body)) return;
  throw InputError(
      "integration.implicit.preconditioner is multigrid, or its solver v_cycle, which needs a "
      "coarser mesh, but the "
      "body has one, of too few vertices to make coarse spaces of; expected more of body.levels, "
      "or block_jacobi or "
      "chebyshev");
}

void check_regions(const Body& body) {
  const auto& all = body.levels.front().region_names;
  for (const auto& [name, region] : body.regions)
    if (!region.where && std::find(all.begin(), all.end(), name) == all.end())
      throw InputError(unknown_name("region", name, all));
}

}  // namespace

void validate_mesh(const TetMesh& mesh, int level) {
  const auto refuse = [level](const std::string& what) {
    throw InputError("body.levels: level " + std::to_string(level) + what);
  };
  const int vertices = static_cast<int>(mesh.vertices.size()),
            regions = static_cast<int>(mesh.region_names.size());
  if (mesh.tets.empty()) refuse(" has no tetrahedron");
  for (int v = 0; v < vertices; ++v)
    if (!mesh.vertices[static_cast<std::size_t>(v)].allFinite())
      refuse(": vertex " + std::to_string(v) + " is not at a finite place");
  std::vector<char> used(mesh.vertices.size(), 0);
  for (std::size_t e = 0; e < mesh.tets.size(); ++e) {
    const auto& t = mesh.tets[e];
    for (int v : t) {
      if (v < 0 || v >= vertices)
        refuse(": tetrahedron " + std::to_string(e) + " has vertex " + std::to_string(v) + " of " +
               std::to_string(vertices));
      used[static_cast<std::size_t>(v)] = 1;
    }
    const auto x = [&](std::size_t k) -> const Point& {
      return mesh.vertices[static_cast<std::size_t>(t[k])];
    };
    if (!(tet_volume(x(0), x(1), x(2), x(3)) > 0))
      refuse(": tetrahedron " + std::to_string(e) +
             " is flat or inside out; expected a positive volume");
  }
  if (const auto unused = std::find(used.begin(), used.end(), 0); unused != used.end())
    refuse(": no tetrahedron has vertex " + std::to_string(unused - used.begin()));
  for (const auto& [name, set] : mesh.vertex_sets)
    for (const int v : set)
      if (v < 0 || v >= vertices)
        refuse(": group '" + name + "' has vertex " + std::to_string(v) + " of " +
               std::to_string(vertices));
  for (const auto& [name, set] : mesh.triangle_sets)
    for (const auto& triangle : set)
      for (const int v : triangle)
        if (v < 0 || v >= vertices)
          refuse(": a triangle of group '" + name + "' has vertex " + std::to_string(v) + " of " +
                 std::to_string(vertices));
  if (!mesh.region.empty() && mesh.region.size() != mesh.tets.size())
    refuse(" has regions for " + std::to_string(mesh.region.size()) + " of " +
           std::to_string(mesh.tets.size()) + " tetrahedra; expected all or none");
  if (!mesh.filled.empty() && mesh.filled.size() != mesh.tets.size())
    refuse(" is filled for " + std::to_string(mesh.filled.size()) + " of " +
           std::to_string(mesh.tets.size()) + " tetrahedra; expected all or none");
  for (std::size_t e = 0; e < mesh.filled.size(); ++e)
    if (!(mesh.filled[e] > 0 && mesh.filled[e] <= 1))
      refuse(": tetrahedron " + std::to_string(e) + " is filled to " + number(mesh.filled[e]) +
             "; expected a part in (0, 1]");
  for (std::size_t e = 0; e < mesh.region.size(); ++e)
    if (mesh.region[e] < 0 || mesh.region[e] >= regions)
      refuse(": tetrahedron " + std::to_string(e) + " is in region " +
             std::to_string(mesh.region[e]) + " of " + std::to_string(regions));
  validate_pieces(mesh, level);
}

namespace {

void check_elements(const Body& body, std::size_t levels) {
  if (body.element.size() != 1 && body.element.size() != levels)
    throw InputError("body.element: expected one name, or one for each of " +
                     std::to_string(levels) + " levels, got a list of " +
                     std::to_string(body.element.size()));
  const MaterialInfo& material = *find_material(body.material.model);
  if (body.pressure == "smoothed" && !material.smooths_dilatation)
    throw InputError("body.volumetric_smoothing is smoothed, but material " +
                     std::string(material.name) +
                     " has no stiffness for the volume alone at finite strains; expected plain or "
                     "auto, or another material");
}

}  // namespace

namespace {

void check_coarsen(const Problem& problem, std::size_t levels) {
  if (!problem.body.coarsen) return;
  const std::vector<int>& sizes = *problem.body.coarsen;
  const std::string& cycle = problem.integration.cycle;
  if (integrates_coarse_levels(cycle))
    throw InputError("body.levels: coarsen makes spaces without elements, but cycle " + cycle +
                     " integrates its coarser levels; expected coarser meshes there, or cycle him, "
                     "auto or single");
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const std::string path = "body.levels." + std::to_string(levels + i) + ".coarsen";
    Count{fewest_points}.check(path, sizes[i]);
    if (i > 0 && sizes[i] >= sizes[i - 1])
      throw InputError(path + " is " + std::to_string(sizes[i]) + " after " +
                       std::to_string(sizes[i - 1]) +
                       "; expected fewer points from level to level");
  }
}

/// Throws InputError where the finest level covers a part of the body: every cycle would step that
/// part alone. What a cycle expects of coarse levels is checked at its set-up.
void check_finest_level(const Body& body) {
  const auto size = [&](const TetMesh& mesh) {
    return mesh_size(mesh, region_densities(body, mesh));
  };
  MeshSize finest;
  for (std::size_t i = 0; i < body.levels.size() && body.levels.size() > 1; ++i) {
    const MeshSize one = size(body.levels[i]);
    if (i == 0)
      finest = one;
    else if (covers_part(finest, one))
      throw InputError("body.levels: " + compare_levels(finest, one, i).sentence);
  }
}

/// Throws InputError where a field has no direction of fibres at an element.
void check_fibres(const Body& body) {
  for (std::size_t i = 0; i < body.levels.size() && fibres_vary(body); ++i) {
    TetMesh mesh = body.levels[i];
    add_regions(mesh, body.regions, static_cast<int>(i));
    element_fibres(body, mesh, static_cast<int>(i));
  }
}

/// Checks, once the meshes are there, that a space has no more points than the coarsest of them.
void check_points(const Body& body) {
  const auto check = [&](const std::string& path, const std::optional<std::vector<int>>& sizes,
                         std::ptrdiff_t vertices) {
    if (sizes && !sizes->empty())
      Count{fewest_points, static_cast<int>(vertices)}.check(
          path + std::to_string(body.levels.size()) + ".coarsen", sizes->front());
  };
  const TetMesh& coarsest = body.levels.back();
  check("body.levels.", body.coarsen, std::ssize(coarsest.vertices));
  const std::vector<int> part = parts_of_vertices(coarsest, body.parts);
  for (std::size_t i = 0; i < body.parts.size(); ++i)
    check("bodies." + body.parts[i].name + ".levels.", body.parts[i].coarsen,
          std::ranges::count(part, static_cast<int>(i)));
}

}  // namespace

void validate_turn(const Turn& turn, const std::string& path) { check_values(path, turn); }

void validate_motion(const Motion& motion, const std::string& path) {
  ObstacleOptions moved;
  moved.motion = motion;
  check_values(path, moved);
}

void validate_options(const Problem& problem, std::size_t levels) {
  check_values("body", problem.body);
  check_parameters(*find_material(problem.body.material.model), problem.body);
  Vector{acceleration}.check("gravity", problem.gravity);
  check_elements(problem.body, levels);
  check_coarsen(problem, levels);
  check_values("integration", problem.integration);
  check_values("contact", problem.contact);
  for (std::size_t i = 0; i < problem.contact.obstacles.size(); ++i)
    check_obstacle("contact.obstacles." + std::to_string(i), problem.contact.obstacles[i]);
  for (std::size_t i = 0; i < problem.cuts.size(); ++i)
    check_values("cuts." + std::to_string(i), problem.cuts[i]);
  validate_cuts(problem);
  validate_methods(problem.integration, levels);
  if (problem.integration.cycle == "him")
    if (const std::string why = refused_by_him(problem); !why.empty()) throw InputError(why);
}

void validate_meshes(const Problem& problem) {
  const Body& body = problem.body;
  if (body.levels.empty())
    throw InputError("body.levels is empty; expected at least one mesh, finest first");
  for (std::size_t i = 0; i < body.levels.size(); ++i)
    validate_mesh(body.levels[i], static_cast<int>(i));
  check_regions(body);
  check_finest_level(body);
  check_points(body);
  check_fibres(body);
  check_multigrid(body, problem.integration.implicit);
  validate_parts(problem);
  validate_cut_meshes(problem);
  validate_contact(problem);
  validate_cavities(problem);
  validate_rest(problem);
  starts_in_obstacles(problem);
}

void validate(const Problem& problem) {
  if (!problem.body.covers.empty()) {
    Problem composed = problem;
    compose_levels(composed.body, composed.contact);
    return validate(composed);
  }
  validate_options(problem, problem.body.levels.size());
  validate_meshes(problem);
}

}  // namespace plica
