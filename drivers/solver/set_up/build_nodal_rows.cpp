// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <plica/drivers/solver/set_up/build_nodal_rows.hpp>
#include <plica/drivers/solver/set_up/to_device.hpp>
#include <plica/drivers/solver/spaces/index_of.hpp>

namespace plica {

namespace {

/// What a domain has with a neighbour; see NodalRows.
struct Pair {
  int neighbour = -1;
  Point gradient = Point::Zero(), surface = Point::Zero();  ///< C_ab, S_ab
  double coupling = 0, smoothing = 0, size = 0;             ///< size: of what cancels in S_ab
};

struct Domain {
  int vertex = -1, region = 0;
  double volume = 0;
  std::vector<Pair> pairs;
  std::ptrdiff_t surface_pairs() const {
    return std::ranges::count_if(pairs, [](const Pair& p) { return p.surface != Point::Zero(); });
  }
};

/// The domains of a mesh, those of region 0 first, in each region in the order of the vertices.
class Domains {
 public:
  explicit Domains(const TetMesh& mesh) : mesh_(mesh) {
    find_corners();
    for (std::size_t e = 0; e < mesh.tets.size(); ++e) add_tet(e);
    for (Domain& d : all) {
      std::ranges::sort(d.pairs, {}, &Pair::neighbour);
      for (Pair& p : d.pairs)
        if (p.surface.norm() <= 1e-9 * p.size) p.surface.setZero();  // an edge inside the region
    }
  }

  std::vector<Domain> all;

 private:
  const TetMesh& mesh_;
  std::vector<std::array<int, 4>> corners_;  ///< per tetrahedron its domains

  int region_of(std::size_t e) const { return mesh_.region.empty() ? 0 : mesh_.region[e]; }

  void find_corners() {
    std::vector<std::pair<int, int>> keys;  // region, vertex
    for (std::size_t e = 0; e < mesh_.tets.size(); ++e)
      for (int v : mesh_.tets[e]) keys.emplace_back(region_of(e), v);
    std::vector<std::pair<int, int>> unique = keys;
    std::ranges::sort(unique);
    unique.erase(std::unique(unique.begin(), unique.end()), unique.end());
    for (const auto& [region, vertex] : unique) all.push_back({vertex, region, 0, {}});
    corners_.resize(mesh_.tets.size());
    for (std::size_t k = 0; k < keys.size(); ++k)
      corners_[k / 4][k % 4] = static_cast<int>(std::ranges::lower_bound(unique, keys[k]) - unique.begin());
  }

  static Pair& pair(Domain& d, int neighbour) {
    for (Pair& p : d.pairs)
      if (p.neighbour == neighbour) return p;
    return d.pairs.emplace_back(Pair{.neighbour = neighbour});
  }

  void add_tet(std::size_t e) {
    const auto& t = mesh_.tets[e];
    Eigen::Matrix3d edges;
    for (int c = 0; c < 3; ++c)
      edges.col(c) = mesh_.vertices[index_of(t[index_of(c + 1)])] - mesh_.vertices[index_of(t[0])];
    const Eigen::Matrix3d inverse = edges.inverse();
    const double volume = mesh_.part(e) * edges.determinant() / 6;
    std::array<Point, 4> g;
    for (int c = 0; c < 3; ++c) g[index_of(c + 1)] = inverse.row(c).transpose();
    g[0] = -(g[1] + g[2] + g[3]);
    for (std::size_t a = 0; a < 4; ++a) {
      Domain& domain = all[index_of(corners_[e][a])];
      domain.volume += volume / 4;
      for (std::size_t b = 0; b < 4; ++b) {
        if (a == b) continue;
        Pair& p = pair(domain, corners_[e][b]);
        p.gradient += volume / 4 * g[b], p.surface += volume / 4 * (g[a] + g[b]);
        p.coupling += volume * g[a].dot(g[b]), p.smoothing += volume / 16;
        p.size += volume / 4 * (g[a].norm() + g[b].norm());
      }
    }
  }
};

/// Which domain stands in which row: by region, then in windows of rows, those with the most surface pairs first, of these the longest.
std::vector<int> row_order(const std::vector<Domain>& domains, int height) {
  std::vector<int> order;  // -1: fills up a slice
  const auto window = static_cast<std::size_t>(32 * height);
  for (std::size_t begin = 0; begin < domains.size();) {
    std::size_t end = begin;
    while (end < domains.size() && end < begin + window && domains[end].region == domains[begin].region) ++end;
    const std::size_t first = order.size();
    for (std::size_t d = begin; d < end; ++d) order.push_back(static_cast<int>(d));
    std::stable_sort(order.begin() + static_cast<std::ptrdiff_t>(first), order.end(), [&](int a, int b) {
      const Domain &x = domains[index_of(a)], &y = domains[index_of(b)];
      return std::pair(x.surface_pairs(), x.pairs.size()) > std::pair(y.surface_pairs(), y.pairs.size());
    });
    if (end == domains.size() || domains[end].region != domains[begin].region)
      while (order.size() % index_of(height) != 0) order.push_back(-1);
    begin = end;
  }
  return order;
}

}  // namespace

template <class B>
NodalRows<B> build_nodal_rows(const TetMesh& mesh, const NodalConstants& constants) {
  using Real = typename B::Real;
  using Rows = NodalRows<B>;
  constexpr auto H = static_cast<std::size_t>(Rows::height);
  using Integers = std::array<int, H>;
  using Numbers = std::array<Real, H>;
  using Gradients = std::array<Numbers, 3>;
  const std::vector<Domain> domains = Domains(mesh).all;
  const std::vector<int> order = row_order(domains, Rows::height);
  std::vector<int> slot_of(domains.size());
  for (std::size_t s = 0; s < order.size(); ++s)
    if (order[s] >= 0) slot_of[index_of(order[s])] = static_cast<int>(s);

  std::vector<int> first{0}, first_surface{0}, region, vertex;
  std::vector<Real> volume, inverse;
  std::vector<Integers> neighbour, surface_neighbour;
  std::vector<Gradients> gradient, surface_gradient;
  std::vector<Numbers> coupling, smoothing;
  std::vector<std::vector<int>> slots(mesh.vertices.size());
  for (std::size_t begin = 0; begin < order.size(); begin += H) {
    Integers self;
    for (std::size_t row = 0; row < H; ++row) self[row] = static_cast<int>(begin + row);
    std::size_t entries = 0, surface = 0;
    for (std::size_t row = 0; row < H; ++row) {
      const int d = order[begin + row];
      const Domain domain = d >= 0 ? domains[index_of(d)] : Domain{};
      std::vector<Pair> pairs = domain.pairs;
      std::ranges::sort(pairs, {}, [&](const Pair& p) { return slot_of[index_of(p.neighbour)]; });
      const std::size_t e0 = index_of(first.back()), s0 = index_of(first_surface.back());
      entries = std::max(entries, pairs.size());
      neighbour.resize(std::max(neighbour.size(), e0 + entries), self);
      gradient.resize(neighbour.size(), {}), coupling.resize(neighbour.size(), {});
      smoothing.resize(neighbour.size(), {});
      std::size_t on_surface = 0;
      for (std::size_t i = 0; i < pairs.size(); ++i) {
        const Pair& p = pairs[i];
        neighbour[e0 + i][row] = slot_of[index_of(p.neighbour)];
        for (std::size_t k = 0; k < 3; ++k)
          gradient[e0 + i][k][row] = static_cast<Real>(p.gradient[static_cast<int>(k)]);
        coupling[e0 + i][row] = static_cast<Real>(p.coupling), smoothing[e0 + i][row] = static_cast<Real>(p.smoothing);
        if (p.surface == Point::Zero()) continue;
        const std::size_t s = s0 + on_surface++;
        if (s >= surface_neighbour.size()) surface_neighbour.push_back(self), surface_gradient.push_back({});
        surface_neighbour[s][row] = slot_of[index_of(p.neighbour)];
        for (std::size_t k = 0; k < 3; ++k)
          surface_gradient[s][k][row] = static_cast<Real>(p.surface[static_cast<int>(k)]);
      }
      surface = std::max(surface, on_surface);
      vertex.push_back(domain.vertex);
      volume.push_back(static_cast<Real>(domain.volume));
      inverse.push_back(d >= 0 ? static_cast<Real>(1 / domain.volume) : Real(0));
      if (d >= 0) slots[index_of(domain.vertex)].push_back(static_cast<int>(begin + row));
    }
    region.push_back(domains[index_of(order[begin])].region);
    first.push_back(static_cast<int>(neighbour.size()));
    first_surface.push_back(static_cast<int>(surface_neighbour.size()));
  }

  Rows rows;
  rows.slices = static_cast<int>(region.size()), rows.domains = static_cast<int>(domains.size());
  const auto reals = [](const std::vector<double>& values) { return std::vector<Real>(values.begin(), values.end()); };
  std::vector<Real> material;
  for (const std::vector<double>& of_region : constants.material)
    material.insert(material.end(), of_region.begin(), of_region.end());
  rows.first = to_device<Indices<B>>("rows.first", first);
  rows.region = to_device<Indices<B>>("rows.region", region);
  rows.vertex = to_device<Indices<B>>("rows.vertex", vertex);
  rows.volume = to_device<Scalars<B>>("rows.volume", volume);
  rows.inverse_volume = to_device<Scalars<B>>("rows.inverse_volume", inverse);
  rows.neighbour = to_device<decltype(rows.neighbour)>("rows.neighbour", neighbour);
  rows.gradient = to_device<decltype(rows.gradient)>("rows.gradient", gradient);
  rows.coupling = to_device<decltype(rows.coupling)>("rows.coupling", coupling);
  if (!constants.excess.empty()) rows.smoothing = to_device<decltype(rows.smoothing)>("rows.smoothing", smoothing);
  rows.first_surface = to_device<Indices<B>>("rows.first_surface", first_surface);
  rows.surface_neighbour = to_device<decltype(rows.neighbour)>("rows.surface_neighbour", surface_neighbour);
  rows.surface_gradient = to_device<decltype(rows.gradient)>("rows.surface_gradient", surface_gradient);
  rows.constants = to_device<Scalars<B>>("rows.constants", material);
  rows.stabiliser = to_device<Scalars<B>>("rows.stabiliser", reals(constants.stabiliser));
  if (!constants.excess.empty()) rows.excess = to_device<Scalars<B>>("rows.excess", reals(constants.excess));
  if (!constants.damping.empty()) rows.damping = to_device<Scalars<B>>("rows.damping", reals(constants.damping));
  std::vector<int> first_share{0}, share;
  for (const std::vector<int>& of_vertex : slots) {
    share.insert(share.end(), of_vertex.begin(), of_vertex.end());
    first_share.push_back(static_cast<int>(share.size()));
  }
  rows.shares.rows = rows.slots();
  rows.shares.first = to_device<Indices<B>>("shares.first", first_share);
  rows.shares.row = to_device<Indices<B>>("shares.row", share);
  return rows;
}

template <class B>
NodalWork<B> make_nodal_work(const NodalRows<B>& rows) {
  NodalWork<B> work;
  const auto n = static_cast<std::size_t>(rows.slots());
  work.near = zeros<Scalars<B>>("plica::nodal.near", 8 * n);
  work.records = zeros<Scalars<B>>("plica::nodal.records", 12 * n);
  if (rows.excess.extent(0) == 0) return work;
  work.ratio = zeros<Scalars<B>>("plica::nodal.ratio", 2 * n);
  work.pressure = zeros<Scalars<B>>("plica::nodal.pressure", 2 * n);
  return work;
}

#define PLICA_INSTANTIATE(Real, Exec)                                                                   \
  template NodalRows<Backend<Real, Exec>> build_nodal_rows<Backend<Real, Exec>>(const TetMesh&,         \
                                                                                const NodalConstants&); \
  template NodalWork<Backend<Real, Exec>> make_nodal_work<Backend<Real, Exec>>(const NodalRows<Backend<Real, Exec>>&);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
