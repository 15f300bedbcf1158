// SPDX-License-Identifier: BSD-3-Clause
// Cuts of a simulation between its macro steps.
//
// The mesh of level 0 is split (meshes/cut.hpp), a simulation is built of it as at set-up, and that
// one goes on from the state of the one before. So each part of a simulation is what it would be on
// the mesh that is cut from the start. What is carried over: displacements and velocities, a twin's
// from its original; relaxing stresses; grasps and tools; time and checks.
//
// A saved state has the faces that each cut has opened, and no mesh: restore() opens them again.
#include <Kokkos_Timer.hpp>
#include <algorithm>
#include <iterator>
#include <map>
#include <plica/core/archive.hpp>
#include <plica/core/pack.hpp>
#include <plica/core/row_ranges.hpp>
#include <plica/core/text.hpp>
#include <plica/core/time_functions.hpp>
#include <plica/core/to_device.hpp>
#include <plica/drivers/run/simulation_impl.hpp>
#include <plica/drivers/run/validate.hpp>
#include <plica/kernels/loads/boundary_conditions.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <utility>

namespace plica {

namespace {

/// Copies rows of vertices to a level with more of them. `twin`: of each vertex that is new, the
/// one that it was before, which may be new as well.
template <class B>
void carry_vertices(const typename B::Exec& exec, const Vectors<B>& from, const Vectors<B>& to,
                    const std::vector<int>& twin) {
  using Real = typename B::Real;
  const std::vector<Real> old = host_values(exec, from);
  std::vector<std::array<Real, 3>> now;
  now.reserve(old.size() / 3 + twin.size());
  for (std::size_t i = 0; i < old.size(); i += 3) now.push_back({old[i], old[i + 1], old[i + 2]});
  for (const int v : twin) now.push_back(now[index_of(v)]);
  copy(exec, to, to_device<Vectors<B>>("carried", now));
}

/// Domain of a nodal element: its vertex, region, and number among those of both.
using DomainName = std::array<int, 3>;

template <class B>
std::vector<DomainName> names_of_domains(const NodalRows<B>& rows) {
  const auto vertex = on_host(rows.vertex), region = on_host(rows.region);
  std::map<std::pair<int, int>, int> count;
  std::vector<DomainName> names;
  for (int slot = 0; slot < rows.slots(); ++slot) {
    const int v = vertex(slot), r = region(slot / NodalRows<B>::height);
    names.push_back({v, r, v < 0 ? 0 : count[{v, r}]++});
  }
  return names;
}

/// Returns of each slot of viscous memory the slot on the level before that it goes on from; -1:
/// none. Linear elements keep their tetrahedra; a nodal domain goes on from that of the vertex that
/// its own was before.
template <class B>
std::vector<int> former_slots(const LevelData<B>& before, const LevelData<B>& now,
                              const std::vector<int>& twin) {
  std::vector<int> slots;
  if (now.model.rows.slices == 0) {
    const auto old = on_host(before.model.patches.element),
               own = on_host(now.model.patches.element);
    std::vector<int> slot_of(static_cast<std::size_t>(before.model.tets), -1);
    for (std::size_t s = 0; s < old.extent(0); ++s)
      if (old(s) >= 0) slot_of[index_of(old(s))] = static_cast<int>(s);
    for (std::size_t s = 0; s < own.extent(0); ++s)
      slots.push_back(own(s) < 0 ? -1 : slot_of[index_of(own(s))]);
    return slots;
  }
  std::map<DomainName, int> slot_of;
  const std::vector<DomainName> old = names_of_domains<B>(before.model.rows);
  for (std::size_t s = 0; s < old.size(); ++s) slot_of[old[s]] = static_cast<int>(s);
  for (DomainName name : names_of_domains<B>(now.model.rows)) {
    while (name[0] >= before.model.vertices)
      name[0] = twin[index_of(name[0] - before.model.vertices)];
    const auto found = slot_of.find(name), first = slot_of.find({name[0], name[1], 0});
    const auto from = found == slot_of.end() ? first : found;
    slots.push_back(name[0] < 0 || from == slot_of.end() ? -1 : from->second);
  }
  return slots;
}

/// Copies the memory of relaxing stresses, whose time is that of the level before.
template <class B>
void carry_stresses(const typename B::Exec& exec, const LevelData<B>& before,
                    const LevelData<B>& now, const std::vector<int>& twin) {
  const int numbers = 6 * (1 + now.stress.terms);
  const auto old = host_values(exec, before.stress.memory);
  auto own = host_values(exec, now.stress.memory);
  const std::vector<int> former = former_slots<B>(before, now, twin);
  for (int s = 0; s < static_cast<int>(former.size()); ++s)
    for (int k = 0; k < numbers && former[index_of(s)] >= 0; ++k)
      own[index_of(packed<B>(s, k, numbers))] =
          old[index_of(packed<B>(former[index_of(s)], k, numbers))];
  copy(exec, now.stress.memory, to_device<Scalars<B>>("carried", own));
}

/// Returns of each point that a surface has gained the point at the vertex that its own was before;
/// -1: that was inside the body.
/// @param vertex    vertex at each point
/// @param points    number of points before
/// @param vertices  number of vertices before
/// @param twin      of each vertex that is new, the one that it was before, which may be new as well
std::vector<int> former_points(const std::vector<int>& vertex, int points, int vertices,
                               const std::vector<int>& twin) {
  std::map<int, int> point_at;
  for (int p = 0; p < points; ++p) point_at[vertex[index_of(p)]] = p;
  std::vector<int> former;
  for (std::size_t p = index_of(points); p < vertex.size(); ++p) {
    int v = vertex[p];
    while (v >= vertices) v = twin[index_of(v - vertices)];
    const auto found = point_at.find(v);
    former.push_back(found == point_at.end() ? -1 : found->second);
  }
  return former;
}

/// Returns the edge of a blade at a time [s].
BladeFront::Edge edge_at(const BladeOptions& blade, double time) {
  std::vector<PathKnot> knots;
  const Path path = make_path(blade.motion, knots);
  const Vec3<double> d = path_at(path, knots.data(), time).displacement;
  const Point moved(d[0], d[1], d[2]);
  return {blade.segment[0] + moved, blade.segment[1] + moved};
}

int nearest_of(const std::vector<Point>& points, const Point& to) {
  const auto nearer = [&](const Point& a, const Point& b) {
    return (a - to).squaredNorm() < (b - to).squaredNorm();
  };
  return static_cast<int>(std::ranges::min_element(points, nearer) - points.begin());
}

Faces merged(const Faces& a, const Faces& b) {
  Faces all;
  std::ranges::set_union(a, b, std::back_inserter(all));
  return all;
}

}  // namespace

template <class B>
const TetMesh& Simulation<B>::mesh() const {
  return impl_->built.meshes.front();
}
template <class B>
const std::vector<int>& Simulation<B>::twins() const {
  return impl_->twins;
}
template <class B>
CutReport Simulation<B>::cuts() const {
  return impl_->cut_so_far;
}
template <class B>
long Simulation<B>::mesh_changes() const {
  return impl_->mesh_changes;
}
template <class B>
const std::optional<TriangleSurface>& Simulation<B>::surface() const {
  return impl_->problem.body.surface;
}

template <class B>
const std::vector<int>& Simulation<B>::surface_vertices() const {
  return impl_->problem.body.surface_vertex;
}

template <class B>
Faces Simulation<B>::Impl::open_so_far() const {
  Faces all;
  for (const Faces& faces : opened) all = merged(all, faces);
  return all;
}

template <class B>
CutReport Simulation<B>::cut(const Blade& blade) {
  Impl& s = *impl_;
  s.expect_one_process("cut");
  const Kokkos::Timer timer;
  if (const std::string why = refused_by_cuts(s.problem); !why.empty())
    throw InputError("cut: " + why);
  if (const std::string why = refused_by_cuts(mesh()); !why.empty())
    throw InputError("cut: " + why);
  for (const auto& triangle : blade)
    for (const Point& p : triangle)
      if (!p.allFinite()) throw InputError("cut: expected triangles of finite numbers");
  const Faces found = faces_across(mesh().tets, positions(), blade), open = s.open_so_far();
  Faces fresh;
  std::ranges::set_difference(found, open, std::back_inserter(fresh));
  const std::size_t before = s.twins.size();
  if (!fresh.empty()) {
    OpenedBody body = s.with_open({fresh});
    if (body.twins.size() > before) {
      std::unique_ptr<Impl> next = s.rebuilt(std::move(body));
      next->go_on_from(s);
      impl_ = std::move(next);
    } else {  // no vertex has split: these faces open together with later ones
      s.opened = std::move(body.opened), s.cut_so_far = body.report;
    }
  }
  CutReport& all = impl_->cut_so_far;
  const double seconds = timer.seconds();
  all.seconds += seconds;
  return {static_cast<int>(fresh.size()), static_cast<int>(impl_->twins.size() - before),
          all.pieces, seconds};
}

/// Cuts what the blades of the problem sweep in the next macro step, along a straight way from
/// where the body has carried what they have cut. Throws InputError where no stable step is left.
template <class B>
void Simulation<B>::cut_ahead() {
  constexpr double rounding = 1e-6;  // part of the macro step
  constexpr double spacing = 0.5;    // places on a blade's edge, over the mean edge of level 0
  Impl& s = *impl_;
  const double now = s.time, end = now + s.next_span();
  if (now < s.cut_until - rounding * s.built.macro_step) return;
  s.cut_until = end;
  Blade swept;
  for (std::size_t i = 0; i < s.problem.cuts.size(); ++i) {
    const CutOptions& each = s.problem.cuts[i];
    std::optional<BladeFront>& front = s.fronts[i];
    if (now >= each.to || end <= each.from) {
      front.reset();
      continue;
    }
    const BladeFront::Edge from = edge_at(each.blade, std::max(now, each.from)),
                           to = edge_at(each.blade, std::min(end, each.to));
    if (!front) front.emplace(from, spacing * s.built.reports.front().mean_edge);
    const Blade own = front->advance(mesh().tets, positions(), from, to);
    swept.insert(swept.end(), own.begin(), own.end());
  }
  if (!swept.empty()) cut(swept);
}

template <class B>
std::optional<Diagnosis> Simulation<B>::cut_checked() {
  try {
    cut_ahead();
    return {};
  } catch (const InputError& error) {
    Diagnosis refused;
    refused.kind = "cut", refused.level = 0, refused.reason = error.what();
    Impl& s = *impl_;
    s.keep(s.kept);  // the state is good, only the next step is not
    for (std::size_t i = 0; i < s.fronts.size(); ++i) {
      if (!s.fronts[i]) continue;
      const CutOptions& each = s.problem.cuts[i];
      const BladeFront::Edge edge = edge_at(each.blade, std::min(s.cut_until, each.to));
      refused.vertex = nearest_of(positions(), (edge[0] + edge[1]) / 2);
    }
    return refused;
  }
}

/// Returns the problem of the body as it is now, without what the start alone needs, and selections
/// that have named their elements already.
template <class B>
Problem Simulation<B>::Impl::present_problem() const {
  Problem now = problem;
  now.body.initial = InitialOptions();
  for (auto& [name, region] : now.body.regions) region.where.reset();
  now.integration.macro_step = built.macro_step;
  now.body.levels = built.meshes;
  return now;
}

/// Opens more faces of the body, one cut after the other.
template <class B>
OpenedBody Simulation<B>::Impl::with_open(const std::vector<Faces>& more) const {
  OpenedBody all{present_problem(), opened, twins, cut_so_far};
  Problem& next = all.problem;
  TetMesh& mesh = next.body.levels.front();
  std::optional<TriangleSurface>& surface = next.body.surface;
  std::vector<int>& at = next.body.surface_vertex;
  TriangleSurface boundary;  // points of a body without a surface are counted all the same
  TriangleSurface& followed = surface ? *surface : boundary;
  if (at.empty())
    at = surface ? boundary_vertices_of(*surface, mesh) : boundary_surface(mesh).mesh_vertex;
  if (surface && at.empty() && !surface->vertices.empty())
    throw InputError(
        "cut: body.surface is not the boundary of level 0, whose faces would open; expected "
        "body.surface: {boundary: true}");
  Faces open = open_so_far();
  for (const Faces& faces : more) {
    open = merged(open, faces);
    all.opened.push_back(faces);
    CutMesh cut = open_faces(mesh, open);
    mesh = std::move(cut.mesh);
    all.twins.insert(all.twins.end(), cut.twin.begin(), cut.twin.end());
    follow_cut(mesh, followed, at);
    all.report.opened_faces += static_cast<int>(faces.size());
  }
  all.report.new_vertices = static_cast<int>(all.twins.size());
  all.report.pieces = count_pieces(mesh);
  return all;
}

/// Returns a simulation of a body with more open faces, at its start.
template <class B>
auto Simulation<B>::Impl::rebuilt(OpenedBody&& body) -> std::unique_ptr<Impl> {
  try {
    auto cut = std::make_unique<Impl>(body.problem, hierarchy().exec(), Validation::done);
    cut->opened = std::move(body.opened), cut->twins = std::move(body.twins);
    cut->cut_so_far = body.report;
    return cut;
  } catch (const InputError& error) {
    throw InputError(std::string("cut: of the body after it, ") + error.what());
  }
}

/// Returns a simulation with the faces open that a saved one had; none: this one has the same.
template <class B>
auto Simulation<B>::Impl::reopened(const std::vector<Faces>& saved) -> std::unique_ptr<Impl> {
  if (saved == opened) return nullptr;
  const auto count = static_cast<std::ptrdiff_t>(opened.size());
  if (saved.size() < opened.size() || !std::equal(opened.begin(), opened.end(), saved.begin()))
    throw InputError(
        "the saved state has other cuts than this simulation; expected a new simulation of the "
        "same problem");
  const std::int64_t faces = std::int64_t{4} * built.reports.front().tets;
  for (const Faces& each : saved)
    if (!each.empty() &&
        (*std::ranges::min_element(each) < 0 || *std::ranges::max_element(each) >= faces))
      throw InputError("the saved state is damaged: it has faces that the mesh does not have");
  return rebuilt(with_open(std::vector<Faces>(saved.begin() + count, saved.end())));
}

/// Carries the state of level 0 over from a simulation with fewer open faces. Returns of each point
/// that the surface has gained the one that it was before, see former_points().
template <class B>
std::vector<int> Simulation<B>::Impl::carry_over_cuts(Impl& before) {
  const Exec& exec = hierarchy().exec();
  const std::vector<int> twin(twins.begin() + static_cast<std::ptrdiff_t>(before.twins.size()),
                              twins.end());
  Level<B>&was = before.hierarchy()[0], &is = hierarchy()[0];
  carry_vertices<B>(exec, was.state.u, is.state.u, twin);
  carry_vertices<B>(exec, was.state.v, is.state.v, twin);
  if (is.viscosity) carry_stresses<B>(exec, was, is, twin), is.viscosity->set_time(before.time);
  const Contact<B>* touched = was.contact();
  if (touched == nullptr) return {};
  return former_points(problem.body.surface_vertex, touched->points(), was.model.vertices, twin);
}

/// Takes over the state and everything else from a simulation whose level 0 was another. That one
/// is not to be used after this.
template <class B>
void Simulation<B>::Impl::go_on_from(Impl& before) {
  const Exec& exec = hierarchy().exec();
  before.hierarchy().exec().fence("plica::go_on");
  before.accept_state();
  std::vector<int> former;  // points of `before` that a cut has split, see take_memory()
  if (problem.body.following)
    carry_over_part(before);
  else
    former = carry_over_cuts(before);
  Level<B>&was = before.hierarchy()[0], &is = hierarchy()[0];
  is.set_evaluations(was.evaluations());
  if (const Contact<B>* contact = is.contact()) {
    contact->take_memory(exec, *was.contact(), former);
    is.response().take_work(exec, was.response());
  }
  hierarchy().clock = before.hierarchy().clock;
  if (problem.integration.cycle == "single") {  // sub-steps that repairs have cut stay cut
    std::vector<unsigned char> bytes;
    Archive<B> saved(Archive<B>::Task::save, bytes), restored(Archive<B>::Task::restore, bytes);
    before.built.stepper->name_fields(saved), built.stepper->name_fields(restored);
  }

  time = before.time, steps = before.steps, origin = before.origin, end = before.end;
  residual = before.residual, worst_residual = before.worst_residual;
  wrench = before.wrench, wrench_shorter = before.wrench_shorter, shorter = before.shorter;
  budget_known = before.budget_known, put_in = before.put_in, drift = before.drift;
  rejected = before.rejected, unsolved = before.unsolved, control = before.control;
  cut_until = before.cut_until, fronts = before.fronts;
  part_moves = before.part_moves, looked_at = before.looked_at;
  mesh_changes = before.mesh_changes + 1;
  graphs = before.graphs, after_repeated = before.after_repeated;
  if (before.cores) cores.emplace(hierarchy().exec());
  before.motions.reset_history();
  std::swap(motions, before.motions);
  if (const Contact<B>* contact = is.contact()) motions.restore_snapshot(*contact, time);
  external = before.external;
  for (int i = 0; external && i < hierarchy().count(); ++i)
    hierarchy()[i].set_external(external, rest_positions(i));
  restart();
  if (before.step_start) keep(step_start.emplace());
  exec.fence("plica::go_on");
}

#define PLICA_INSTANTIATE(Real, Exec) template class Simulation<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
