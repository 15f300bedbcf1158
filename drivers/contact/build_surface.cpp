// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <map>
#include <plica/core/to_device.hpp>
#include <plica/drivers/contact/build_surface.hpp>

namespace plica {

template <class B>
Transfer<B> build_transfer(const std::string& name, const Embedding& embedding,
                           const std::vector<char>& keep) {
  using Real = typename B::Real;
  std::vector<int> target;
  std::vector<std::array<int, 4>> source;
  std::vector<std::array<Real, 4>> weight;
  for (std::size_t i = 0; i < embedding.vertices.size(); ++i) {
    const Weights& w = embedding.weights[i];
    if ((!keep.empty() && keep[i]) || w[0] + w[1] + w[2] + w[3] < 0.5) continue;
    target.push_back(static_cast<int>(i));
    source.push_back(embedding.vertices[i]);
    weight.push_back({static_cast<Real>(w[0]), static_cast<Real>(w[1]), static_cast<Real>(w[2]),
                      static_cast<Real>(w[3])});
    std::array<int, 4>& four = source.back();
    const auto greatest =
        static_cast<std::size_t>(std::max_element(four.begin(), four.end()) - four.begin());
    std::swap(four[greatest], four[3]);
    std::swap(weight.back()[greatest], weight.back()[3]);
  }
  Transfer<B> t;
  t.rows = static_cast<int>(target.size());
  t.target = to_device<decltype(t.target)>(name + ".target", target);
  t.source = to_device<decltype(t.source)>(name + ".source", source);
  t.weight = to_device<decltype(t.weight)>(name + ".weight", weight);
  return t;
}

template <class B>
EmbeddedSurface<B> build_surface(const TriangleSurface& surface, const Embedding& embedding) {
  using Real = typename B::Real;
  EmbeddedSurface<B> s;
  s.points = static_cast<int>(surface.vertices.size());
  s.embedding = build_transfer<B>("surface", embedding, {});
  std::map<int, std::vector<std::pair<int, Real>>> of_vertex;
  for (int p = 0; p < s.points; ++p) {
    const auto i = static_cast<std::size_t>(p);
    for (std::size_t c = 0; c < 4; ++c)
      if (embedding.weights[i][c] != 0)
        of_vertex[embedding.vertices[i][c]].emplace_back(
            p, static_cast<Real>(embedding.weights[i][c]));
  }
  std::vector<int> vertex, first{0}, point;
  std::vector<Real> weight;
  for (const auto& [v, list] : of_vertex) {
    vertex.push_back(v);
    for (const auto& [p, w] : list) point.push_back(p), weight.push_back(w);
    first.push_back(static_cast<int>(point.size()));
  }
  s.touched = static_cast<int>(vertex.size());
  s.rest = to_device<decltype(s.rest)>("surface.rest", rows<Real>(surface.vertices));
  s.vertex = to_device<decltype(s.vertex)>("surface.vertex", vertex);
  s.first = to_device<decltype(s.first)>("surface.first", first);
  s.point = to_device<decltype(s.point)>("surface.point", point);
  s.weight = to_device<decltype(s.weight)>("surface.weight", weight);
  return s;
}

#define PLICA_INSTANTIATE(Real, Exec)                                               \
  template Transfer<Backend<Real, Exec>> build_transfer<Backend<Real, Exec>>(       \
      const std::string&, const Embedding&, const std::vector<char>&);              \
  template EmbeddedSurface<Backend<Real, Exec>> build_surface<Backend<Real, Exec>>( \
      const TriangleSurface&, const Embedding&);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
