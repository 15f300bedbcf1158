// SPDX-License-Identifier: BSD-3-Clause
#include <plica/core/to_device.hpp>
#include <plica/drivers/run/reactions.hpp>
#include <plica/kernels/halo.hpp>
#include <plica/kernels/loads/reactions.hpp>

namespace plica {

template <class B>
void Reactions<B>::make_arrays(const Level<B>& level) {
  for (const HeldSet& set : sets_) {
    std::vector<std::array<double, 9>> shares;
    for (const Eigen::Matrix3d& W : set.share)
      shares.push_back(
          {W(0, 0), W(0, 1), W(0, 2), W(1, 0), W(1, 1), W(1, 2), W(2, 0), W(2, 1), W(2, 2)});
    Set& held = held_.emplace_back();
    held.vertex = to_device<Indices<B>>("reactions.vertex", set.vertex);
    std::vector<int> place(level.f.extent(0), -1);
    for (std::size_t i = 0; i < set.vertex.size(); ++i)
      place[static_cast<std::size_t>(set.vertex[i])] = static_cast<int>(i);
    held.place = to_device<Indices<B>>("reactions.place", place);
    held.share = to_device<decltype(held.share)>("reactions.share", shares);
  }
  force_ = zeros<Vectors<B>>("plica::reactions.force", level.f.extent(0));
  blocks_ = BlockSums<B>(level.model.vertices, ranks_of<B>(level));
  result_ = zeros<Doubles<B>>("plica::reactions.result", 6 * sets_.size());
}

template <class B>
std::vector<Reaction> Reactions<B>::at(Level<B>& level, const Vectors<B>& rest, double time,
                                       bool moves) {
  if (sets_.empty()) return {};
  if (held_.empty()) make_arrays(level);
  const auto& exec = level.exec();
  level.measure_forces(time, force_);
  if (moves && level.prescribed.count > 0)
    update_vertices<B>(
        exec, "plica::subtract_inertia", level.prescribed.count,
        SubtractInertia<B>{level.prescribed, level.model, level.state.v, force_, time});
  for (std::size_t s = 0; s < sets_.size(); ++s) {
    const Point& about = sets_[s].centre;
    reduce<B, 6>(exec, "plica::reaction", vertices_of<B>(level),
                 ReactionOfVertex<B>{held_[s].place,
                                     {held_[s].vertex,
                                      held_[s].share,
                                      force_,
                                      rest,
                                      level.state.u,
                                      {about[0], about[1], about[2]}}},
                 blocks_, Doubles<B>(result_.data() + 6 * s, 6));
  }
  const std::vector<double> sums = host_values(exec, result_);
  std::vector<Reaction> all;
  for (std::size_t s = 0; s < sets_.size(); ++s)
    all.push_back({sets_[s].name, Point(sums.data() + 6 * s), Point(sums.data() + 6 * s + 3),
                   sets_[s].centre});
  return all;
}

#define PLICA_INSTANTIATE(Real, Exec) template class Reactions<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
