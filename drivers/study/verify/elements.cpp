// SPDX-License-Identifier: BSD-3-Clause
#include <plica/core/text.hpp>
#include <plica/drivers/study/direct_solves.hpp>
#include <plica/drivers/study/sample_bodies.hpp>
#include <plica/drivers/study/verify/box_meshes.hpp>
#include <plica/drivers/study/verify/list.hpp>
#include <plica/kernels/materials/parameters.hpp>

// Accuracy of elements where linear tetrahedra are known to be too stiff: in bending, and near
// nu = 0.5. Each problem is solved with both kinds of elements, on regular meshes and on irregular
// ones, which hide less of an error.
namespace plica {

namespace {

constexpr const char* by_quadratic_elements =
    "quadratic elements with linear pressures (Q2/P1, Taylor-Hood P2/P1), extrapolated";

/// Sets element, rule and tolerance of a row. Values of linear elements are shown, not judged: the
/// row documents their error.
void judge_by(VerifyRow& row, const std::string& element, Judged judged, double tolerance) {
  row.element = element;
  row.judged = element == "nodal" ? judged : Judged::nothing, row.tolerance = tolerance;
}

// Beam clamped at x = 0 with a uniform traction on the end face. The load does work on the mean
// deflection of that face.
struct Beam {
  const char* name;
  double side;
  int per_side;  ///< cells along the beam per cell across it
  double accepted[4];
};
constexpr double beam_nu[] = {0.3, 0.45, 0.49, 0.4999};
constexpr Beam beams[] = {
    {"slender beam, 1 x 0.05 x 0.05", 0.05, 20, {6.3884e-4, 6.3560e-4, 6.3438e-4, 6.3405e-4}},
    {"stubby beam, 1 x 0.25 x 0.25", 0.25, 4, {1.0557e-6, 1.0364e-6, 1.0288e-6, 1.0267e-6}}};

double deflection(const Beam& beam, const std::string& kind, const std::string& element, double nu,
                  int n) {
  constexpr double E = 1e7, load = 0.01;
  const double side = beam.side;
  Problem p = verify_body(box_of(kind, {{0, 0, 0}, {1, side, side}}, {beam.per_side * n, n, n}, 0),
                          {"st_venant_kirchhoff", E, nu, 1000});
  p.body.element = {element};
  p.body.fixed = {HalfSpaceSelection{{0, 0, 0}, {1, 0, 0}}};
  p.body.loads = {
      {HalfSpaceSelection{{1, 0, 0}, {-1, 0, 0}}, Traction{{0, 0, -load / (side * side)}}, {}}};
  LevelProbe<HostBackend> probe(p);
  const SparseStiffness K(probe);
  const auto force = probe.force(probe.zero()), u = K.equilibrium(force);
  double work = 0;
  for (std::size_t a = 0; a < u.size(); ++a) work += force[a].dot(u[a]);
  return work / load;
}

}  // namespace

VerifyRows bending(const VerifyContext& context) {
  VerifyRows rows;
  for (const Beam& beam : beams)
    for (const std::string kind : mesh_kinds)
      for (const std::string element : {"linear", "nodal"})
        for (std::size_t i = 0; i < std::size(beam_nu); ++i) {
          VerifyRow row{.quantity = text(beam.name, ": mean deflection of the end, nu ",
                                         number(beam_nu[i], 4)),
                        .unit = "m",
                        .accepted = beam.accepted[i],
                        .source = by_quadratic_elements};
          row.mesh = kind;
          judge_by(row, element, Judged::finest,
                   context.small        ? 0.25
                   : kind == "delaunay" ? 0.08
                                        : 0.035);
          std::vector<int> across = context.small ? std::vector{1, 2} : std::vector{2, 4};
          if (!context.small && beam.per_side < 10) across.push_back(8);
          for (const int n : across) {
            if (!has_box(kind, {beam.per_side * n, n, n})) continue;
            context.proceed();
            row.add(cells_text(beam.per_side * n, n, n), 1.0 / n,
                    deflection(beam, kind, element, beam_nu[i], n));
          }
          if (element == "linear")
            row.note = "linear tetrahedra are too stiff in bending, and lock near nu = 0.5";
          if (!row.ours.empty()) rows.push_back(row);
        }
  return rows;
}

namespace {

// Maps the unit cube to Cook's membrane, with the corners (0,0) (48,44) (48,60) (0,44) mm
Point in_cook(const Point& s, double thickness) {
  const double low = 44 * s[0], high = 44 + 16 * s[0];
  return 1e-3 * Point(48 * s[0], low + (high - low) * s[1], thickness * s[2]);
}

TetMesh cook_mesh(const std::string& kind, const std::array<int, 3>& cells, double thickness) {
  TetMesh mesh = box_of(kind, {{0, 0, 0}, {1, 1, 1}}, cells, 0);
  for (Point& x : mesh.vertices) x = in_cook(x, thickness);
  return mesh;
}

Problem cook(TetMesh mesh, const std::string& element, double mu, double nu, double traction) {
  Problem p = verify_body(std::move(mesh), {"neo_hookean", 2 * mu * (1 + nu), nu, 1000});
  p.body.element = {element};
  p.body.fixed = {HalfSpaceSelection{{0, 0, 0}, {1, 0, 0}}};
  p.body.loads = {{HalfSpaceSelection{{48e-3, 0, 0}, {-1, 0, 0}}, Traction{{0, traction, 0}},
                   PolygonCourse{{{0, 0}, {1, 1}}}}};
  return p;
}

}  // namespace

VerifyRows cook_incompressible(const VerifyContext& context) {
  VerifyRows rows;
  for (const std::string kind : mesh_kinds)
    for (const std::string element : {"linear", "nodal"}) {
      VerifyRow flat{.quantity = "plane strain, nu 0.4999, 1 N: u_y at (48, 52) mm",
                     .unit = "mm",
                     .accepted = 11.98};
      VerifyRow thick{.quantity = "10 mm thick, nu 0.4999, 6.25 MPa: mean u_y of the loaded face",
                      .unit = "mm",
                      .accepted = 8.46};
      flat.source = by_quadratic_elements,
      thick.source = "two independent programs with quadratic elements";
      flat.mesh = thick.mesh = kind;
      judge_by(flat, element, Judged::finest, context.small ? 0.5 : 0.2);
      judge_by(thick, element, Judged::finest, context.small ? 0.4 : 0.15);
      for (const int n : context.small ? std::vector{4} : std::vector{4, 8}) {
        if (!has_box(kind, {n, n, 1})) continue;
        context.proceed();
        const Problem p =
            cook(cook_mesh(kind, {n, n, 1}, 1), element, 422.5e3, 0.4999, 1 / (16e-3 * 1e-3));
        LevelProbe<HostBackend> probe(p);
        StaticOptions options;
        options.held = [](const Point&, int axis) { return axis == 2; };
        options.load_steps = element == "nodal" ? 24 : 8;
        const auto u = static_equilibrium(probe, options);
        double sum = 0;
        for (const double z : {0.0, 1e-3})
          sum += u[vertex_at(p.body.levels[0], {48e-3, 52e-3, z})][1] / 2;
        flat.add(cells_text(n, n, 1), 1.0 / n, 1e3 * sum);
      }
      for (const int n : context.small ? std::vector{4} : std::vector{4, 8}) {
        context.proceed();
        const double E = 240.565e6, nu = 0.4999;
        const Problem p = cook(cook_mesh(kind, {n, n, std::max(2, n / 4)}, 10), element,
                               E / (2 * (1 + nu)), nu, 6.25e6);
        LevelProbe<HostBackend> probe(p);
        StaticOptions options;
        options.load_steps = element == "nodal" ? 24 : 8;
        const auto u = static_equilibrium(probe, options);
        // at rest the force is the load alone
        const auto full = probe.force(probe.zero(), probe.zero(), 1);
        double work = 0, load = 0;
        for (std::size_t a = 0; a < u.size(); ++a) work += full[a][1] * u[a][1], load += full[a][1];
        thick.add(cells_text(n, n, std::max(2, n / 4)), 1.0 / n, 1e3 * work / load);
      }
      if (!flat.ours.empty()) rows.push_back(flat);
      rows.push_back(thick);
    }
  return rows;
}

// Solves a quarter of a punched block, 1 mm high. Points of the top move vertically only, and a
// quarter of the top is loaded.
VerifyRows punch(const VerifyContext& context) {
  VerifyRows rows;
  constexpr double mm = 1e-3, mu = 80.194e6, lambda = 400889.8e6, pressure = 320e6;
  const double nu = lambda / (2 * (lambda + mu));
  for (const std::string kind : {"regular", "jittered"}) {
    VerifyRow row{.quantity = "vertical displacement under the middle of the punch",
                  .unit = "mm",
                  .accepted = -0.70};
    row.source =
        "Zorrilla, Rossi & Scovazzi 2023, after Reese & Wriggers 2000; -0.696 by another program";
    row.mesh = kind;
    judge_by(row, "nodal", Judged::finest, 0.12);
    for (const int n : context.small ? std::vector{4} : std::vector{3, 4}) {
      context.proceed();
      Problem p = verify_body(box_of(kind, {{0, 0, 0}, {mm, mm, mm}}, {n, n, n}, 2),
                              {"neo_hookean", 2 * mu * (1 + nu), nu, 1000});
      p.body.element = {"nodal"};
      p.body.loads = {{Box{{-mm, -mm, mm}, {0.5 * mm, 0.5 * mm, mm}}, Traction{{0, 0, -pressure}},
                       PolygonCourse{{{0, 0}, {1, 1}}}}};
      LevelProbe<HostBackend> probe(p);
      StaticOptions options;
      options.load_steps = 32;
      options.held = [](const Point& X, int axis) {
        if (axis == 2) return X[2] < 1e-9;
        return X[axis] < 1e-9 || X[2] > mm - 1e-9;
      };
      const auto u = static_equilibrium(probe, options);
      row.add(cells_text(n, n, n), 1.0 / n, 1e3 * u[vertex_at(p.body.levels[0], {0, 0, mm})][2]);
    }
    rows.push_back(row);
  }
  return rows;
}

}  // namespace plica
