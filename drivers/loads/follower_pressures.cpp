// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <plica/core/row_ranges.hpp>
#include <plica/core/time_functions.hpp>
#include <plica/drivers/loads/follower_pressures.hpp>
#include <plica/kernels/vectors.hpp>
#include <utility>
#include <vector>

namespace plica {

template <class B>
FollowerPressures<B>::FollowerPressures(std::vector<FollowerLoad<B>> loads)
    : loads_(std::move(loads)) {
  int most = 0;
  for (const FollowerLoad<B>& load : loads_)
    if (load.volume.extent(0) > 0) most = std::max(most, load.count);
  if (most > 0) volumes_ = BlockSums<B>(most), rate_ = zeros<Doubles<B>>("plica::volume_rate", 1);
}

template <class B>
GivenPressure<B> FollowerPressures<B>::given_pressure(const FollowerLoad<B>& load,
                                                      double time) const {
  return {static_cast<typename B::Real>(load.pressure * load_factor(load.course, time))};
}

template <class B>
FluidPressure<B> FollowerPressures<B>::last_pressure(const FollowerLoad<B>& load,
                                                     double time) const {
  return {load.volume, volume_given(load, time), load.cavity->stiffness()};
}

template <class B>
void FollowerPressures<B>::measure(const Exec& exec, const FollowerLoad<B>& load,
                                   const Vectors<B>& u) const {
  reduce<B, 1>(exec, "plica::enclosed_volume", load.count, VolumeOfCorner<B>{{load, u}}, volumes_,
               load.volume);
}

template <class B>
double FollowerPressures<B>::enclosed_volume(const Exec& exec, const FollowerLoad<B>& load,
                                             const Vectors<B>& u) const {
  measure(exec, load, u);
  return host_values(exec, load.volume)[0];
}

template <class B>
double FollowerPressures<B>::volume_given(const FollowerLoad<B>& load, double time) const {
  return load.cavity->goal(load_factor(load.course, time)) - load.cavity->caps;
}

template <class B>
void FollowerPressures<B>::add_force(const Exec& exec, const State<B>& at, double time,
                                     const Vectors<B>& f) {
  time_ = time;
  const auto add = [&]<class Pressure>(const FollowerLoad<B>& load, const Pressure& pressure) {
    update_vertices<B>(exec, "plica::follower_pressure", load.count,
                       AddFollowerPressure<B, Pressure>{{load, at.u}, f, pressure});
  };
  for (const FollowerLoad<B>& load : loads_) {
    if (load.cavity) {
      measure(exec, load, at.u);
      add(load, last_pressure(load, time));
    } else {
      add(load, given_pressure(load, time));
    }
  }
}

template <class B>
void FollowerPressures<B>::add_product(const Exec& exec, const State<B>& at, const Vectors<B>& p,
                                       double scale, bool projected, const Vectors<B>& q) const {
  const auto add = [&]<class Pressure>(const FollowerPlaces<B>& place, const Pressure& pressure) {
    update_vertices<B>(exec, "plica::follower_product", place.load.count,
                       AddFollowerProduct<B, Pressure>{place, p, q, pressure,
                                                       static_cast<typename B::Real>(scale)});
  };
  for (const FollowerLoad<B>& load : loads_) {
    const FollowerPlaces<B> place{load, at.u};
    if (!load.cavity) {
      if (!projected) add(place, given_pressure(load, time_));
      continue;
    }
    const FluidPressure<B> fluid = last_pressure(load, time_);
    if (!projected) add(place, fluid);
    reduce<B, 1>(exec, "plica::volume_rate", load.count, VolumeRateOfCorner<B>{place, p}, volumes_,
                 rate_);
    update_vertices<B>(exec, "plica::fluid_product", load.count,
                       AddFluidProduct<B>{place, q, rate_, fluid.stiffness, scale});
  }
}

template <class B>
double FollowerPressures<B>::energy(const Exec& exec, const State<B>& at, double time) const {
  double sum = 0;
  for (const FollowerLoad<B>& load : loads_) {
    if (load.volume.extent(0) == 0) continue;
    const double volume = enclosed_volume(exec, load, at.u),
                 pressure = load.pressure * load_factor(load.course, time);
    if (!load.cavity)
      sum -= pressure * volume;
    else
      sum += load.cavity->stiffness() / 2 * std::pow(volume_given(load, time) - volume, 2);
  }
  return sum;
}

namespace {

/// Returns per vertex its masters and their weights, where it follows others; empty: none does.
template <class B>
std::vector<std::vector<std::pair<int, double>>> masters_of_vertices(const Model<B>& model) {
  std::vector<std::vector<std::pair<int, double>>> parts;
  const Transfer<B>& place = model.followers.place;
  if (place.rows == 0) return parts;
  parts.resize(index_of(model.vertices));
  const auto target = on_host(place.target);
  const auto source = on_host(place.source);
  const auto weight = on_host(place.weight);
  for (int i = 0; i < place.rows; ++i)
    for (int c = 0; c < 4; ++c)
      parts[index_of(target(i))].emplace_back(source(i, c), static_cast<double>(weight(i, c)));
  return parts;
}

}  // namespace

template <class B>
double FollowerPressures<B>::squared_frequency(const LevelData<B>& level) const {
  const auto inverse_mass = on_host(level.model.inverse_mass);
  const auto parts = masters_of_vertices(level.model);
  double sum = 0;
  for (const FollowerLoad<B>& load : loads_) {
    if (!load.cavity) continue;
    const double stiffness =
        load.cavity->stiffness() * std::pow(std::max(1.0, load.cavity->ratio), 4.0 / 3);
    const auto vertex = on_host(load.vertex), first = on_host(load.first),
               second = on_host(load.second), third = on_host(load.third);
    const auto rest = on_host(load.rest);
    const auto at = [&](int i) { return Point(rest(i, 0), rest(i, 1), rest(i, 2)); };
    std::map<int, Point> beside;  // areas of followers, by their masters
    for (int i = 0; i < load.count; ++i) {
      Point a = Point::Zero();
      for (int t = first(i); t < first(i + 1); ++t)
        a += (at(second(t)) - at(i)).cross(at(third(t)) - at(i)) / 6;
      if (!parts.empty() && !parts[index_of(vertex(i))].empty())
        for (const auto& [master, weight] : parts[index_of(vertex(i))])
          beside.try_emplace(master, Point::Zero()).first->second += weight * a;
      sum += stiffness * a.squaredNorm() * static_cast<double>(inverse_mass(vertex(i)));
    }
    // |a + b|^2 <= 2 |a|^2 + 2 |b|^2, where a vertex has an area of its own
    if (!beside.empty()) sum *= 2;
    for (const auto& [master, a] : beside)
      sum += 2 * stiffness * a.squaredNorm() * static_cast<double>(inverse_mass(master));
  }
  return sum;
}

template <class B>
std::vector<CavityState> FollowerPressures<B>::cavities(const Exec& exec, const State<B>& at,
                                                        double time) const {
  std::vector<CavityState> all;
  for (const FollowerLoad<B>& load : loads_) {
    if (!load.cavity) continue;
    const double volume = enclosed_volume(exec, load, at.u),
                 lacking = volume_given(load, time) - volume;
    all.push_back(
        {load.cavity->load, volume + load.cavity->caps, load.cavity->stiffness() * lacking});
  }
  return all;
}

template <class B>
void FollowerPressures<B>::name_fields(Archive<B>& archive) const {
  for (const FollowerLoad<B>& load : loads_)
    archive.owns(load.vertex, load.rest, load.first, load.second, load.third, load.volume);
  archive.owns(volumes_.view(), rate_);
}

#define PLICA_INSTANTIATE(Real, Exec) template class FollowerPressures<Backend<Real, Exec>>;
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
