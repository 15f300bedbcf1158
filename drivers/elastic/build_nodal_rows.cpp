// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <plica/drivers/elastic/build_nodal_rows.hpp>
#include <plica/drivers/elastic/vertex_shares.hpp>
#include <set>
#include <span>
#include <utility>

namespace plica {

namespace {

/// Coefficients of a domain and one neighbour; see NodalRows.
struct Pair {
  int neighbour = -1;
  Point gradient = Point::Zero(), surface = Point::Zero();  ///< C_ab, S_ab
  double coupling = 0, smoothing = 0, size = 0;  ///< size: sum of the terms' norms in S_ab
};

struct Domain {
  int vertex = -1, region = 0;
  double volume = 0;
  std::vector<Pair> pairs;
  std::ptrdiff_t surface_pairs() const {
    return std::ranges::count_if(pairs, [](const Pair& p) { return p.surface != Point::Zero(); });
  }
};

/// Domains of a mesh, by region, in each region in the order of the vertices.
/// Tetrahedra whose four vertices have a given motion have domains of their own, behind the others
/// of their region. Their strain is given, and is no part of what free vertices beside them see.
class Domains {
 public:
  Domains(const TetMesh& mesh, const std::vector<char>& given)
      : mesh_(mesh), corners_(4 * mesh.tets.size()) {
    find_corners(given);
    const GroupingOf<std::int64_t> corners(corners_, all.size());
    for_row_ranges(all.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t d = begin; d < end; ++d) measure(all[d], corners.of(d));
    });
  }

  std::vector<Domain> all;

 private:
  const TetMesh& mesh_;
  std::vector<int> corners_;  ///< [4 tetrahedra] domain of each corner

  void find_corners(const std::vector<char>& given) {
    const Grouping regions = tets_by_region(mesh_);
    std::vector<int> domain_of(mesh_.vertices.size(), -1);
    const auto moves = [&](int v) { return given.empty() || !given[index_of(v)]; };
    for (std::size_t r = 0; r < regions.groups(); ++r) {
      std::vector<int> tets(regions.of(r).begin(), regions.of(r).end());
      const auto first_given = std::ranges::stable_partition(tets, [&](int e) {
                                 return std::ranges::any_of(mesh_.tets[index_of(e)], moves);
                               }).begin();
      add_domains(static_cast<int>(r), {tets.begin(), first_given}, domain_of);
      add_domains(static_cast<int>(r), {first_given, tets.end()}, domain_of);
    }
  }

  /// Adds the domains of some tetrahedra of one region.
  /// @param domain_of  work array, one per vertex; -1 before and after
  void add_domains(int region, std::span<const int> tets, std::vector<int>& domain_of) {
    std::vector<int> vertices;
    for (const int e : tets)
      for (const int v : mesh_.tets[index_of(e)])
        if (std::exchange(domain_of[index_of(v)], 0) < 0) vertices.push_back(v);
    std::ranges::sort(vertices);
    for (const int v : vertices) {
      domain_of[index_of(v)] = static_cast<int>(all.size());
      all.push_back({v, region, 0, {}});
    }
    for (const int e : tets)
      for (std::size_t k = 0; k < 4; ++k)
        corners_[4 * index_of(e) + k] = domain_of[index_of(mesh_.tets[index_of(e)][k])];
    for (const int v : vertices) domain_of[index_of(v)] = -1;
  }

  void measure(Domain& domain, std::span<const std::int64_t> corners) const {
    for (const std::int64_t corner : corners) {
      const auto place = static_cast<std::size_t>(corner);
      add_corner(domain, place / 4, place % 4);
    }
    std::ranges::sort(domain.pairs, {}, [&](const Pair& p) {
      return std::pair(all[index_of(p.neighbour)].vertex, p.neighbour);
    });
    for (Pair& p : domain.pairs)
      if (p.surface.norm() <= 1e-9 * p.size) p.surface.setZero();  // edge inside the region
  }

  static Pair& pair(Domain& d, int neighbour) {
    for (Pair& p : d.pairs)
      if (p.neighbour == neighbour) return p;
    return d.pairs.emplace_back(Pair{.neighbour = neighbour});
  }

  /// Adds corner a of tetrahedron e to a domain.
  void add_corner(Domain& domain, std::size_t e, std::size_t a) const {
    const auto& t = mesh_.tets[e];
    Eigen::Matrix3d edges;
    for (int c = 0; c < 3; ++c)
      edges.col(c) = mesh_.vertices[index_of(t[index_of(c + 1)])] - mesh_.vertices[index_of(t[0])];
    const Eigen::Matrix3d inverse = edges.inverse();
    const double volume = mesh_.part(e) * edges.determinant() / 6;
    std::array<Point, 4> g;
    for (int c = 0; c < 3; ++c) g[index_of(c + 1)] = inverse.row(c).transpose();
    g[0] = -(g[1] + g[2] + g[3]);
    domain.volume += volume / 4;
    for (std::size_t b = 0; b < 4; ++b) {
      if (a == b) continue;
      Pair& p = pair(domain, corners_[4 * e + b]);
      p.gradient += volume / 4 * g[b], p.surface += volume / 4 * (g[a] + g[b]);
      p.coupling += volume * g[a].dot(g[b]), p.smoothing += volume / 16;
      p.size += volume / 4 * (g[a].norm() + g[b].norm());
    }
  }
};

/// Vertices whose domains have rows: from `first` to before `last`.
struct RowVertices {
  int first, last;
  bool has(const Domain& domain) const { return domain.vertex >= first && domain.vertex < last; }
};

/// Returns the domain of each row. Rows are sorted by block of vertices, in a block by region, and
/// in each region of a block as in `domains`, but for windows of rows: in a window domains with
/// more surface pairs come first, then those with more pairs.
/// @param own    vertices whose domains have rows; the first one begins a block
/// @param block  number of vertices of a block
std::vector<int> row_order(const std::vector<Domain>& domains, const RowVertices& own, int block,
                           int height) {
  const auto place = [&](int d) {
    const Domain& domain = domains[index_of(d)];
    return std::pair((domain.vertex - own.first) / block, domain.region);
  };
  const auto pairs = [&](int d) {
    const Domain& domain = domains[index_of(d)];
    return std::pair(domain.surface_pairs(), domain.pairs.size());
  };
  std::vector<int> sorted, order;
  for (std::size_t d = 0; d < domains.size(); ++d)
    if (own.has(domains[d])) sorted.push_back(static_cast<int>(d));
  std::ranges::stable_sort(sorted, {}, place);
  const auto window = static_cast<std::ptrdiff_t>(32 * height);
  for (auto begin = sorted.begin(); begin != sorted.end();) {
    const auto end =
        std::find_if(begin, sorted.end(), [&](int d) { return place(d) != place(*begin); });
    while (begin != end) {
      const auto next = begin + std::min(window, end - begin);
      std::stable_sort(begin, next, [&](int a, int b) { return pairs(a) > pairs(b); });
      order.insert(order.end(), begin, next);
      begin = next;
    }
    // -1: empty row that fills up a slice
    while (order.size() % index_of(height) != 0) order.push_back(-1);
  }
  return order;
}

/// Builder of the rows, slice by slice.
template <class B>
class SlicedRows {
  using Real = typename B::Real;
  using Rows = NodalRows<B>;
  static constexpr auto H = static_cast<std::size_t>(Rows::height);

 public:
  /// Makes the rows of the domains of own vertices. The slots of `others` come behind theirs.
  SlicedRows(const std::vector<Domain>& domains, const RowVertices& own,
             const std::vector<int>& others = {})
      : domains_(domains),
        order_(row_order(domains, own, vertex_block<B>, Rows::height)),
        others_(others),
        slot_of_(domains.size()) {
    for (std::size_t s = 0; s < order_.size(); ++s)
      if (order_[s] >= 0) slot_of_[index_of(order_[s])] = static_cast<int>(s);
    for (std::size_t i = 0; i < others_.size(); ++i)
      slot_of_[index_of(others_[i])] = static_cast<int>(order_.size() + i);
    for (std::size_t begin = 0; begin < order_.size(); begin += H) {
      std::ptrdiff_t pairs = 0, surface_pairs = 0;
      for (std::size_t s = begin; s < begin + H; ++s) {
        pairs = std::max(pairs, std::ssize(domain(s).pairs));
        surface_pairs = std::max(surface_pairs, domain(s).surface_pairs());
      }
      first_.push_back(first_.back() + static_cast<int>(pairs));
      first_surface_.push_back(first_surface_.back() + static_cast<int>(surface_pairs));
    }
  }

  Rows on_device(std::size_t vertices, bool smoothed) const {
    Rows rows;
    rows.slices = static_cast<int>(order_.size() / H),
    rows.domains = static_cast<int>(domains_.size() - others_.size());
    rows.first = to_device<Indices<B>>("rows.first", first_);
    rows.first_surface = to_device<Indices<B>>("rows.first_surface", first_surface_);
    add_slots(rows, vertices);
    const auto pairs = index_of(first_.back()), surface_pairs = index_of(first_surface_.back());
    const HostWritten<B, decltype(rows.neighbour)> neighbour("rows.neighbour", pairs),
        surface_neighbour("rows.surface_neighbour", surface_pairs);
    const HostWritten<B, decltype(rows.gradient)> gradient("rows.gradient", pairs),
        surface_gradient("rows.surface_gradient", surface_pairs);
    const HostWritten<B, decltype(rows.coupling)> coupling("rows.coupling", pairs),
        smoothing("rows.smoothing", smoothed ? pairs : 0);
    const Columns all{neighbour.data(), gradient.data(), coupling.data(),
                      smoothed ? smoothing.data() : nullptr};
    const Columns surface{surface_neighbour.data(), surface_gradient.data(), nullptr, nullptr};
    for_row_ranges(order_.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t s = begin; s < end; ++s) add_pairs(s, all, surface);
    });
    rows.neighbour = neighbour.upload(), rows.gradient = gradient.upload(),
    rows.coupling = coupling.upload();
    if (smoothed) rows.smoothing = smoothing.upload();
    rows.surface_neighbour = surface_neighbour.upload(),
    rows.surface_gradient = surface_gradient.upload();
    return rows;
  }

  int slots() const { return static_cast<int>(order_.size()); }
  int slot_of(int domain) const { return slot_of_[index_of(domain)]; }

 private:
  const std::vector<Domain>& domains_;
  std::vector<int> order_, others_, slot_of_;
  std::vector<int> first_{0}, first_surface_{0};  // [slices + 1] first column of each slice

  /// Arrays of pairs: each pair of a row stands in a column of its slice.
  struct Columns {
    int* neighbour;
    Real *gradient, *coupling, *smoothing;  ///< the last two may be left out

    void put(std::size_t column, std::size_t row, int slot, const Point& g,
             const Pair& pair) const {
      neighbour[column * H + row] = slot;
      for (std::size_t k = 0; k < 3; ++k)
        gradient[(3 * column + k) * H + row] = static_cast<Real>(g[static_cast<int>(k)]);
      if (coupling) coupling[column * H + row] = static_cast<Real>(pair.coupling);
      if (smoothing) smoothing[column * H + row] = static_cast<Real>(pair.smoothing);
    }
  };

  const Domain& domain(std::size_t slot) const {
    static const Domain none;
    return order_[slot] >= 0 ? domains_[index_of(order_[slot])] : none;
  }

  /// Adds the pairs of a slot's domain, in the order of the neighbours' vertices.
  /// A row with fewer pairs than others of its slice is filled up with zeros for the row itself.
  void add_pairs(std::size_t slot, const Columns& all, const Columns& surface) const {
    const std::size_t slice = slot / H, row = slot % H;
    auto column = index_of(first_[slice]), surface_column = index_of(first_surface_[slice]);
    for (const Pair& pair : domain(slot).pairs) {
      const int other = slot_of_[index_of(pair.neighbour)];
      all.put(column++, row, other, pair.gradient, pair);
      if (pair.surface != Point::Zero())
        surface.put(surface_column++, row, other, pair.surface, pair);
    }
    const auto self = static_cast<int>(slot);
    while (column < index_of(first_[slice + 1])) all.put(column++, row, self, Point::Zero(), {});
    while (surface_column < index_of(first_surface_[slice + 1]))
      surface.put(surface_column++, row, self, Point::Zero(), {});
  }

  /// Fills the arrays with one value per slot or per slice.
  void add_slots(Rows& rows, std::size_t vertices) const {
    std::vector<int> region, vertex;
    std::vector<Real> volume, inverse;
    for (std::size_t s = 0; s < order_.size(); ++s) {
      const Domain& d = domain(s);
      if (s % H == 0) region.push_back(d.region);
      vertex.push_back(d.vertex);
      volume.push_back(static_cast<Real>(d.volume));
      inverse.push_back(d.vertex >= 0 ? static_cast<Real>(1 / d.volume) : Real(0));
    }
    rows.region = to_device<Indices<B>>("rows.region", region);
    rows.shares = vertex_shares<B>(vertex, vertices);
    for (const int d : others_) vertex.push_back(domains_[index_of(d)].vertex);
    rows.vertex = to_device<Indices<B>>("rows.vertex", vertex);
    rows.volume = to_device<Scalars<B>>("rows.volume", volume);
    rows.inverse_volume = to_device<Scalars<B>>("rows.inverse_volume", inverse);
  }
};

}  // namespace

namespace {

template <class B>
void add_constants(NodalRows<B>& rows, const NodalConstants& constants) {
  using Real = typename B::Real;
  const auto on_device = [](const char* name, const std::vector<double>& values) {
    return to_device<Scalars<B>>(name, std::vector<Real>(values.begin(), values.end()));
  };
  std::vector<double> material;
  for (const std::vector<double>& of_region : constants.material)
    material.insert(material.end(), of_region.begin(), of_region.end());
  rows.constants = on_device("rows.constants", material);
  rows.stabiliser = on_device("rows.stabiliser", constants.stabiliser);
  if (!constants.bulk_excess.empty())
    rows.bulk_excess = on_device("rows.excess", constants.bulk_excess);
  if (!constants.damping.empty()) rows.damping = on_device("rows.damping", constants.damping);
}

/// Returns which slots go to each rank: those of own domains with a neighbour there.
template <class B>
HaloRows halo_of_slots(const std::vector<Domain>& domains, const std::vector<int>& others,
                       const SlicedRows<B>& rows, const RankPart& part) {
  const auto owner = [&](int d) { return part.owner[index_of(domains[index_of(d)].vertex)]; };
  const RowVertices own{part.first_owned, part.last_owned};
  std::map<int, std::vector<int>> sent;
  std::map<int, int> received;
  for (std::size_t d = 0; d < domains.size(); ++d) {
    if (!own.has(domains[d])) continue;
    std::set<int> users;
    for (const Pair& pair : domains[d].pairs)
      if (!own.has(domains[index_of(pair.neighbour)])) users.insert(owner(pair.neighbour));
    for (const int q : users) sent[q].push_back(rows.slot_of(static_cast<int>(d)));
  }
  for (const int d : others) ++received[owner(d)];
  HaloRows halo;
  halo.own = rows.slots();
  for (const auto& [q, slots] : sent) {  // ranks that receive are those that send
    halo.rank.push_back(q);
    halo.sent.insert(halo.sent.end(), slots.begin(), slots.end());
    halo.first_sent.push_back(static_cast<int>(halo.sent.size()));
    halo.first_received.push_back(halo.first_received.back() + received[q]);
  }
  return halo;
}

}  // namespace

template <class B>
NodalRows<B> build_nodal_rows(const TetMesh& mesh, const NodalConstants& constants,
                              const std::vector<char>& given) {
  const std::vector<Domain> domains = Domains(mesh, given).all;
  const SlicedRows<B> sliced(domains, {0, static_cast<int>(mesh.vertices.size())});
  NodalRows<B> rows = sliced.on_device(mesh.vertices.size(), !constants.bulk_excess.empty());
  add_constants(rows, constants);
  return rows;
}

template <class B>
NodalPart<B> build_nodal_part(const TetMesh& mesh, const NodalConstants& constants,
                              const std::vector<char>& given, const RankPart& part) {
  const std::vector<Domain> domains = Domains(mesh, given).all;
  const RowVertices own{part.first_owned, part.last_owned};
  std::vector<int> others, owner;  // domains of other ranks; rank of each domain
  for (std::size_t d = 0; d < domains.size(); ++d) {
    if (!own.has(domains[d])) others.push_back(static_cast<int>(d));
    owner.push_back(part.owner[index_of(domains[d].vertex)]);
  }
  std::ranges::stable_sort(others, {}, [&owner](int d) { return owner[index_of(d)]; });
  const SlicedRows<B> sliced(domains, own, others);
  NodalPart<B> made{sliced.on_device(mesh.vertices.size(), !constants.bulk_excess.empty()),
                    halo_of_slots<B>(domains, others, sliced, part)};
  add_constants(made.rows, constants);
  return made;
}

template <class B>
NodalWork<B> make_nodal_work(const NodalRows<B>& rows) {
  NodalWork<B> work;
  const auto n = rows.vertex.extent(0);  // with those of other ranks
  work.near = zeros<Scalars<B>>("plica::nodal.near", 8 * n);
  work.records = zeros<Scalars<B>>("plica::nodal.records", 12 * n);
  if (rows.bulk_excess.extent(0) == 0) return work;
  work.ratio = zeros<Scalars<B>>("plica::nodal.ratio", 2 * n);
  work.pressure =
      zeros<Scalars<B>>("plica::nodal.pressure", 2 * static_cast<std::size_t>(rows.slots()));
  return work;
}

#define PLICA_INSTANTIATE(Real, Exec)                                                    \
  template NodalRows<Backend<Real, Exec>> build_nodal_rows<Backend<Real, Exec>>(         \
      const TetMesh&, const NodalConstants&, const std::vector<char>&);                  \
  template NodalPart<Backend<Real, Exec>> build_nodal_part<Backend<Real, Exec>>(         \
      const TetMesh&, const NodalConstants&, const std::vector<char>&, const RankPart&); \
  template NodalWork<Backend<Real, Exec>> make_nodal_work<Backend<Real, Exec>>(          \
      const NodalRows<Backend<Real, Exec>>&);
PLICA_FOR_EACH_PRECISION(PLICA_INSTANTIATE)

}  // namespace plica
