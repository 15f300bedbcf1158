// SPDX-License-Identifier: BSD-3-Clause
// What a simulation carries from one macro step to the next, saved and restored; and what its elements feel now.
#include <plica/drivers/solver/simulation_inside.hpp>
#include <plica/drivers/solver/state_archive.hpp>

namespace plica {

namespace {

template <class B, class Inside>
void persist(Inside& s, StateArchive<B>& archive) {
  archive.same("the precision", sizeof(typename B::Real));
  archive.same("the macro step", s.built.macro_step);
  archive.same("the number of levels", s.kept.size());
  for (double* value : {&s.time, &s.kept_time, &s.residual, &s.worst_residual, &s.start, &s.put_in, &s.kept_put_in,
                        &s.drift[0], &s.drift[1], &s.drift[2], &s.kept_drift[0], &s.kept_drift[1], &s.kept_drift[2]})
    archive.number(*value);
  for (long* value : {&s.steps, &s.kept_steps, &s.halvings, &s.rejected}) archive.number(*value);
  archive.number(s.budget_opens);
  for (std::size_t i = 0; i < s.kept.size(); ++i) {
    HierarchyLevel<B>& part = s.hierarchy().levels[i];
    const std::string name = "level " + std::to_string(i) + "'s ";
    archive.state(name + "state", part.level.state);
    archive.state(name + "start", part.level.start);
    archive.state(name + "previous", part.level.previous);
    archive.state(name + "kept", s.kept[i]);
    part.forces->persist(archive);
    part.integrator->persist(archive);
  }
  s.built.cycle->persist(archive);
  archive.finish();
}

}  // namespace

template <class B>
SavedState Simulation<B>::save() const {
  using Archive = StateArchive<B>;
  inside_->hierarchy().exec().fence("plica::save");
  SavedState saved;
  Archive archive(Archive::Task::save, saved.bytes);
  persist<B>(*inside_, archive);
  return saved;
}

template <class B>
void Simulation<B>::restore(const SavedState& saved) {
  using Archive = StateArchive<B>;
  inside_->hierarchy().exec().fence("plica::restore");
  std::vector<unsigned char> bytes = saved.bytes;
  for (const auto task : {Archive::Task::check, Archive::Task::restore}) {
    Archive archive(task, bytes);
    persist<B>(*inside_, archive);
  }
  for (auto& part : inside_->hierarchy().levels) part.level.flags.clear(inside_->hierarchy().exec());
}

template <class B>
ElementFields Simulation<B>::element_fields(int level) const {
  const Level<B>& of = inside_->level(level);
  const auto& exec = inside_->hierarchy().exec();
  const Scalars<B> von_mises("plica::von_mises", of.model.tets), J("plica::J", of.model.tets);
  inside_->hierarchy()[level].forces->elasticity().stress(exec, of.model.patches, of.state.u, von_mises, J);
  exec.fence("plica::element_fields");
  const auto values = [](const Scalars<B>& field) {
    const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), field);
    return std::vector<double>(host.data(), host.data() + host.extent(0));
  };
  return {values(von_mises), values(J)};
}

#define PLICA_INSTANTIATE(Real, Exec) template class Simulation<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
