// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <plica/core/error.hpp>
#include <plica/core/text.hpp>
#include <plica/drivers/study/elements.hpp>
#include <plica/drivers/study/truth.hpp>
#include <plica/meshes/jitter.hpp>
#include <plica/meshes/mesh_quality.hpp>
#include <plica/meshes/refinement.hpp>
#include <plica/meshes/reordering.hpp>

namespace plica {

namespace {

using Clock = std::chrono::steady_clock;

constexpr const char* reference_integrator = "central_difference";  // order 2, one force a step
// step over the limit of its mesh
constexpr double of_limit = 0.9;
constexpr double of_budget = 0.5;  // largest part of the budget for two refinements
// growth of a run's wall time by a refinement: 8 times the elements, twice the steps, a little for
// memory
constexpr double growth = 18;
constexpr double time_converged = 1e-4;  // largest own error in time of a level
constexpr double most_tets = 4e6;        // maximum where no number of refinements is given

// Motion of level 0's vertices and of the probes, on one mesh
struct Motions {
  Trajectory vertices, probes;
  TruthMesh mesh;
};

// Meshes of one kind and the motions on them
struct Family {
  std::string name, element;
  TetMesh mesh;  // the finest so far
  std::vector<Motions> motions;
  std::optional<Motions> coarser;  // on the mesh that level 0 refines, at its own vertices
  std::vector<int> common;         // level 0's number of each vertex of that mesh

  double seconds() const { return motions.back().mesh.wall_time; }
};

Trajectory part_of(const Trajectory& all, std::size_t from, std::size_t to) {
  Trajectory part{all.times, {}, {}};
  const auto cut = [&](const std::vector<Point>& field) {
    return std::vector<Point>(field.begin() + static_cast<std::ptrdiff_t>(from),
                              field.begin() + static_cast<std::ptrdiff_t>(to));
  };
  for (const auto& u : all.u) part.u.push_back(cut(u));
  for (const auto& v : all.v) part.v.push_back(cut(v));
  return part;
}

TetMesh finer_of(const TetMesh& mesh) {
  const TetMesh fine = refined(mesh);
  return reordered(fine, locality_order(fine));
}

// Returns the problem of level 0 on another mesh. The contact scales are changed so that stiffness
// and damping, which depend on the mesh's edges, stay the same
Problem on_mesh(const Problem& problem, const std::string& element, const TetMesh& mesh) {
  Problem one = with_element(problem, element);
  const double ratio = mean_edge_length(mesh) / mean_edge_length(problem.body.levels.front());
  one.body.levels = {mesh};
  one.contact.stiffness_scale *= ratio;
  one.contact.damping_scale /= std::sqrt(ratio),
      one.contact.tangential_damping_scale /= std::sqrt(ratio);
  return one;
}

class TruthMaker {
 public:
  TruthMaker(const Problem& problem, const StudyOptions& options, std::optional<double> budget,
             const TruthWatch& watch)
      : problem_(problem), options_(options), budget_(budget), watch_(watch) {
    options_.reference_integrator = reference_integrator, options_.reference_step = of_limit;
    options_.reference_error = std::max(options.reference_error, time_converged);
    points_ = problem.body.levels.front().vertices;
    for (const auto& [name, point] : options.probes) points_.push_back(point);
  }

  StudyReference made() {
    StudyReference reference = converged_levels();
    if (!stopped_) find_limits(reference);
    if (stopped_) reference.trajectory = {};
    return reference;
  }

 private:
  std::function<bool(double)> part_of_run(const std::string& doing) {
    return [this, doing](double part) {
      return stopped_ = stopped_ || (watch_ && !watch_(doing, part)), !stopped_;
    };
  }
  double left() const {
    return *budget_ - std::chrono::duration<double>(Clock::now() - start_).count();
  }

  // Runs every level with every kind of elements, converged in time. Returns the reference of the
  // first, which has the wall time of an evaluation
  StudyReference converged_levels() {
    StudyReference first;
    const auto& levels = problem_.body.levels;
    for (const std::string& element : element_families())
      for (std::size_t l = 0; l < levels.size() && !stopped_; ++l) {
        StudyCase alone;
        alone.element = element, alone.level = static_cast<int>(l);
        const Problem one = problem_of(problem_, alone);
        const double critical = study_levels(one).front().critical_step;
        StudyReference found = make_reference(
            one, options_, critical, part_of_run("reference of level " + std::to_string(l)));
        if (stopped_) break;
        Trajectory there = l == 0
                               ? found.trajectory
                               : interpolated(found.trajectory,
                                              embed(levels[0].vertices, levels[l], Outside::clamp));
        meshes_.push_back({element, static_cast<int>(l), found.own_error, 0, std::move(there)});
        if (meshes_.size() == 1) first = std::move(found);
      }
    return first;
  }

  Motions run(const Family& family, const TetMesh& mesh, const std::vector<Point>& points) {
    const Problem one = on_mesh(problem_, family.element, mesh);
    const double critical = study_levels(one).front().critical_step;
    const Embedding at = embed(points, mesh, Outside::clamp);
    const auto go_on = part_of_run(text(family.name, ", ", mesh.tets.size(), " tetrahedra"));
    const StudyRun found =
        run_to_samples(one, options_, reference_integrator, of_limit * critical, go_on, &at);
    if (stopped_) return {};
    const std::size_t vertices =
        std::min(points.size(), problem_.body.levels.front().vertices.size());
    return {part_of(found.trajectory, 0, vertices),
            part_of(found.trajectory, vertices, points.size()),
            {static_cast<long>(mesh.tets.size()), found.macro_step, found.wall_time, 0}};
  }

  void refine(Family& family) {
    if (!family.motions.empty()) family.mesh = finer_of(family.mesh);
    Motions motions = run(family, family.mesh, points_);
    if (!stopped_) family.motions.push_back(std::move(motions));
  }

  std::vector<Family> families() {
    const std::string element = element_families().back(), other = element_families().front();
    const TetMesh& mesh = problem_.body.levels.front();
    std::vector<Family> both;
    both.push_back({element, element, mesh, {}, {}, {}});
    if (options_.truth->jitter)
      both.push_back(
          {element + ", jittered", element, jittered(mesh, *options_.truth->jitter), {}, {}, {}});
    else
      both.push_back({other, other, mesh, {}, {}, {}});
    return both;
  }

  // Returns whether both families can be refined once more
  bool affordable(const std::vector<Family>& both, int refinements) const {
    const auto& asked = options_.truth->refinements;
    if (asked) return refinements < *asked;
    if (refinements == 2) return false;
    const double seconds = growth * (both[0].seconds() + both[1].seconds());
    const double tets = 8.0 * static_cast<double>(both[0].mesh.tets.size());
    if (refinements == 0) {
      if (budget_ && seconds > left())
        throw InputError(text("study.truth: the motion on a mesh twice as fine, of ", number(tets),
                              " tetrahedra, and on a second one would take about ",
                              number(seconds, 2), " s, with ", number(std::max(0.0, left()), 2),
                              " s left of the budget; give more, or a coarser level 0"));
      return true;
    }
    return tets <= most_tets && (!budget_ || seconds <= left() - (1 - of_budget) * *budget_);
  }

  void find_limits(StudyReference& reference) {
    std::vector<Family> both = families();
    for (int refinements = 0; !stopped_; ++refinements) {
      for (Family& family : both)
        if (!stopped_) refine(family);
      if (stopped_ || !affordable(both, refinements)) break;
    }
    if (!stopped_ && both[0].motions.size() == 2) add_coarser(both);
    if (stopped_) return;
    const Limit limit = limit_of(both[0], 2), other = limit_of(both[1], limit.used_order);
    Truth truth{report(both[0], limit, limit), report(both[1], other, limit), 0, 0};
    truth.difference = difference(other.trajectory, limit.trajectory, limit.trajectory);
    // Steps shrink like edges and the integrator is of order 2: a refinement divides the error in
    // time by 4. A difference from half the step is 3/4 of the error
    const auto converged = std::ranges::find_if(meshes_, [&](const MeshReference& m) {
      return m.element == both[0].element && m.level == 0;
    });
    const double on_level_0 =
        difference(both[0].motions[0].vertices, converged->trajectory, limit.trajectory);
    truth.time_error =
        4.0 / 3 * on_level_0 / std::exp2(2.0 * static_cast<double>(both[0].motions.size() - 1));
    fill(reference, truth, both[0], limit);
  }

  // Adds level 1 as the third mesh of a family of two, where level 0 is a refinement of it
  void add_coarser(std::vector<Family>& both) {
    const auto& levels = problem_.body.levels;
    if (levels.size() < 2 || !is_refinement_of(levels[0], levels[1])) return;
    const Embedding there = embed(levels[1].vertices, levels[0], Outside::clamp);
    std::vector<int> common;
    for (std::size_t a = 0; a < there.vertices.size(); ++a) {
      const auto largest = std::ranges::max_element(there.weights[a]) - there.weights[a].begin();
      common.push_back(there.vertices[a][static_cast<std::size_t>(largest)]);
    }
    Body coarser = problem_.body;
    keep_levels(coarser, 1, 1);
    for (Family& family : both) {
      if (family.name != family.element || stopped_) continue;  // jittered meshes are others
      family.common = common;
      family.coarser = run(family, coarser.levels[0], levels[1].vertices);
    }
  }

  static Limit limit_of(const Family& family, double assumed) {
    const auto& m = family.motions;
    const std::size_t n = m.size();
    if (n == 2)
      return richardson_limit(m[1].vertices, m[0].vertices,
                              family.coarser ? &family.coarser->vertices : nullptr, family.common,
                              assumed);
    std::vector<int> all(m[0].vertices.u.front().size());
    std::iota(all.begin(), all.end(), 0);
    return richardson_limit(m[n - 1].vertices, m[n - 2].vertices, &m[n - 3].vertices, all, assumed);
  }

  static TruthFamily report(const Family& family, const Limit& limit, const Limit& truth) {
    TruthFamily said{family.name,    {}, limit.order, limit.used_order, limit.correction,
                     limit.own_error};
    for (const Motions& motions : family.motions) {
      said.meshes.push_back(motions.mesh);
      said.meshes.back().error = errors_of(motions.vertices, truth.trajectory).displacement;
    }
    return said;
  }

  void fill(StudyReference& reference, const Truth& truth, const Family& family,
            const Limit& limit) {
    const auto& m = family.motions;
    reference.method = "truth";
    reference.macro_step = m.back().mesh.macro_step;
    reference.own_error = truth.error();
    reference.own_error_velocity = limit.own_error_velocity;
    reference.wall_time = std::chrono::duration<double>(Clock::now() - start_).count();
    reference.trajectory = limit.trajectory;
    reference.probes = extrapolated(m.back().probes, m[m.size() - 2].probes, limit.used_order);
    reference.truth = truth;
    reference.meshes = std::move(meshes_);
    for (MeshReference& mesh : reference.meshes)
      mesh.error_space = errors_of(mesh.trajectory, reference.trajectory).displacement;
  }

  const Problem& problem_;
  StudyOptions options_;
  std::optional<double> budget_;
  const TruthWatch& watch_;
  Clock::time_point start_ = Clock::now();
  std::vector<Point> points_;
  std::vector<MeshReference> meshes_;
  bool stopped_ = false;
};

}  // namespace

StudyReference make_truth(const Problem& problem, const StudyOptions& options,
                          std::optional<double> budget, const TruthWatch& watch) {
  return TruthMaker(problem, options, budget, watch).made();
}

}  // namespace plica
