// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <plica/core/text.hpp>
#include <plica/drivers/elastic/materials.hpp>
#include <plica/drivers/run/diagnose.hpp>
#include <plica/drivers/run/registry.hpp>
#include <plica/drivers/run/whole.hpp>

namespace plica {

namespace {

bool is_finite(const Point& p) {
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

Eigen::Matrix3d edges(const TetMesh& mesh, const std::array<int, 4>& t,
                      const std::vector<Point>* moved) {
  const auto at = [&](std::size_t k) {
    const auto v = static_cast<std::size_t>(t[k]);
    return moved ? Point(mesh.vertices[v] + (*moved)[v]) : mesh.vertices[v];
  };
  Eigen::Matrix3d m;
  for (int c = 0; c < 3; ++c) m.col(c) = at(static_cast<std::size_t>(c + 1)) - at(0);
  return m;
}

/// Returns the names of materials that push inverted elements back: "neo_hookean, corotational".
std::string recovering_materials() {
  std::string names;
  for (const MaterialInfo& material : material_list())
    if (material.recovers) names += (names.empty() ? "" : ", ") + std::string(material.name);
  return names;
}

/// Fills in what follows from level and element: region, sub-step, remedy.
template <class B>
void complete(Diagnosis& d, const BuiltHierarchy<B>& built) {
  const auto i = static_cast<std::size_t>(d.level);
  const LevelReport& report = built.reports[i];
  const TetMesh& mesh = built.meshes[i];
  if (d.element >= 0 && !mesh.region.empty())
    d.region = mesh.region_names[static_cast<std::size_t>(
        mesh.region[static_cast<std::size_t>(d.element)])];
  if (report.critical_step > 0 && std::isfinite(report.critical_step))
    d.substep_over_critical = report.share * built.macro_step /
                              (report.substeps * built.stepper->parts()) / report.critical_step;
  if (report.explicit_integrator && d.substep_over_critical > 1)
    d.remedy = "a macro_step or sub-steps within the critical step of that level";
  else if (built.reports.size() > 1)
    d.remedy = "cycle: single, which steps level 0 alone, a shorter macro_step, or more sub-steps";
  else if (report.explicit_integrator)
    d.remedy =
        "a smaller macro_step, or integration.on_failure.halvings: the critical step is that of "
        "the body at rest, and "
        "large strain stiffens it";
  else
    d.remedy =
        "a smaller macro_step, integration.implicit.newton_iterations above 1, or more of "
        "integration.on_failure.halvings";
  if (d.kind == "inverted")
    d.remedy +=
        "; or let elements be inverted (body.material.allow_inversion) in a material that pushes "
        "them back (" +
        recovering_materials() + ")";
  if (d.kind == "contact")
    d.remedy =
        "a smaller macro_step, contact.stiffness_scale above 1, or an obstacle that is not thinner "
        "than what a "
        "point moves in a step";
  if ((*built.hierarchy)[d.level].asks_caller())
    d.remedy +=
        "; or smaller or softer forces of your own (set_external_forces, the mouse of a live "
        "view): no step is made shorter for them";
}

}  // namespace

std::vector<Choice> diagnosis_kinds() {
  return {{"non_finite", "a value is not finite"},
          {"inverted", "an element is inside out"},
          {"energy", "kinetic energy exceeds the work done on the body: the step is unstable"},
          {"speed", "a vertex leaves the body faster than its elements can follow"},
          {"contact", "a point is deeper in an obstacle than the body is large"},
          {"solver", "the solver failed"},
          {"stability", "the cycle lost its stability"},
          {"cut", "no step is stable after a cut"}};
}

std::string Diagnosis::text() const {
  std::string what = "a value is not finite";
  for (const Choice& one : diagnosis_kinds())
    if (one.name == kind) what = one.summary;
  if (kind == "inverted" && element < 0) what = "the elements around a vertex are inside out";
  std::string all = plica::text(what, ": level ", level);
  if (element >= 0) all += plica::text(", element ", element);
  if (!region.empty()) all += plica::text(" (region ", region, ")");
  if (vertex >= 0) all += plica::text(", vertex ", vertex);
  if (element >= 0 || kind == "inverted") all += " with J = " + number(J, 3);
  if (!reason.empty()) all += "; " + reason;
  if (motion_over_edge > 0.1)
    all += plica::text("; ", number(motion_over_edge, 3), " edges moved in a sub-step");
  if (substep_over_critical > 0)
    all += plica::text("; sub-step ", number(substep_over_critical, 3),
                       " times its critical step at rest");
  if (!remedy.empty()) all += "; try " + remedy;
  return all;
}

WorstElement worst_element(const TetMesh& mesh, const std::vector<Point>& displacement) {
  WorstElement worst;
  for (std::size_t e = 0; e < mesh.tets.size(); ++e) {
    const double J = edges(mesh, mesh.tets[e], &displacement).determinant() /
                     edges(mesh, mesh.tets[e], nullptr).determinant();
    if (std::isfinite(J) && (worst.element < 0 || J < worst.J)) worst = {static_cast<int>(e), J};
  }
  return worst;
}

template <class B>
std::vector<Point> to_host(const typename B::Exec& exec, const Vectors<B>& field) {
  const auto numbers = host_values(exec, field);
  std::vector<Point> points(field.extent(0));
  for (std::size_t a = 0; a < points.size(); ++a)
    for (std::size_t k = 0; k < 3; ++k)
      points[a][static_cast<Eigen::Index>(k)] = static_cast<double>(numbers[3 * a + k]);
  return points;
}

template <class B>
std::optional<Diagnosis> find_inverted(const BuiltHierarchy<B>& built) {
  for (int i = built.hierarchy->count() - 1; i >= 0; --i) {  // coarsest first, as levels act
    const Level<B>& level = (*built.hierarchy)[i];
    if (!level.flags.raised.data()) continue;
    const auto copy = [](const auto& view) {
      return Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), view);
    };
    double raised = copy(level.flags.raised)();
    if (level.ranks) level.ranks->ranks->most({&raised, 1});
    if (raised == 0) continue;
    const bool nodal = level.model.rows.slices > 0;
    const auto evaluation = copy(level.flags.evaluation),
               map = copy(nodal ? level.model.rows.vertex : level.model.patches.element);
    const auto word = copy(level.flags.word);
    struct Flagged {
      int evaluation;
      float J;
      int item;  // number of the vertex or element in the level's mesh
    };
    std::vector<Flagged> all;  // patch by patch
    for (std::size_t p = 0; p < evaluation.extent(0); ++p)
      if (evaluation(p) > 0)
        all.push_back({evaluation(p), ElementFlags<B>::J(word(p)),
                       map(static_cast<std::size_t>(ElementFlags<B>::slot(word(p))))});
    if (level.ranks) {
      const RankPart& part = level.ranks->part;
      for (Flagged& one : all)
        one.item = (nodal ? part.vertex : part.tet)[static_cast<std::size_t>(one.item)];
      all = joined(*level.ranks->ranks, all);
    }
    const auto worst = std::ranges::min_element(all, [](const Flagged& a, const Flagged& b) {
      return a.evaluation < b.evaluation || (a.evaluation == b.evaluation && a.J < b.J);
    });
    if (worst == all.end()) continue;
    Diagnosis d;
    d.kind = std::isfinite(worst->J) ? "inverted" : "non_finite";
    (built.reports[static_cast<std::size_t>(i)].element == name_of(Element::nodal) ? d.vertex
                                                                                   : d.element) =
        worst->item;
    d.level = i, d.J = std::isfinite(worst->J) ? static_cast<double>(worst->J) : 0.0;
    complete(d, built);
    return d;
  }
  return {};
}

template <class B>
Diagnosis locate_failure(const std::string& kind, const BuiltHierarchy<B>& built,
                         const std::vector<State<B>>& kept, int level, const std::string& reason) {
  Diagnosis d;
  d.kind = kind, d.level = std::max(level, 0), d.reason = reason;
  for (int i = built.hierarchy->count() - 1; i >= 0 && d.vertex < 0 && level < 0; --i) {
    const auto u = whole_field<B>((*built.hierarchy)[i], (*built.hierarchy)[i].state.u);
    const auto bad = std::find_if(u.begin(), u.end(), [](const Point& p) { return !is_finite(p); });
    if (bad != u.end()) d.level = i, d.vertex = static_cast<int>(bad - u.begin());
  }
  const auto i = static_cast<std::size_t>(d.level);
  const Vectors<B>& u = d.vertex < 0 ? (*built.hierarchy)[d.level].state.u : kept[i].u;
  const WorstElement worst =
      worst_element(built.meshes[i], whole_field<B>((*built.hierarchy)[d.level], u));
  d.element = worst.element, d.J = worst.J;
  const bool forbidden = (*built.hierarchy)[d.level].flags.raised.data() != nullptr;
  // repairs of a cycle have cleared the flag
  if (d.vertex >= 0 && forbidden && d.J <= 0) d.kind = "inverted";
  complete(d, built);
  return d;
}

#define PLICA_TO_HOST(Real, Exec)                                       \
  template std::vector<Point> to_host<Backend<Real, Exec>>(const Exec&, \
                                                           const Vectors<Backend<Real, Exec>>&);
PLICA_FOR_EACH_PRECISION(PLICA_TO_HOST)

#define PLICA_INSTANTIATE(Real, Exec)                                   \
  template std::optional<Diagnosis> find_inverted<Backend<Real, Exec>>( \
      const BuiltHierarchy<Backend<Real, Exec>>&);                      \
  template Diagnosis locate_failure<Backend<Real, Exec>>(               \
      const std::string&, const BuiltHierarchy<Backend<Real, Exec>>&,   \
      const std::vector<State<Backend<Real, Exec>>>&, int, const std::string&);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
