// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <map>
#include <plica/core/error.hpp>
#include <plica/meshes/files/read_options.hpp>
#include <plica/meshes/files/split_second_order.hpp>

namespace plica {

namespace {

constexpr std::size_t edges[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

// Pieces of a tetrahedron by its corners 0 to 3 and the nodes 4 to 9 on the edges above
using Pieces = std::array<std::array<std::size_t, 4>, 4>;
constexpr Pieces at_corners = {{{0, 4, 5, 6}, {4, 1, 7, 8}, {5, 7, 2, 9}, {6, 8, 9, 3}}};
struct Diagonal {
  std::size_t begin, end;
  Pieces around;
};
constexpr Diagonal diagonals[] = {
    {4, 9, {{{4, 9, 6, 8}, {4, 9, 8, 7}, {4, 9, 7, 5}, {4, 9, 5, 6}}}},
    {5, 8, {{{5, 8, 7, 9}, {5, 8, 9, 6}, {5, 8, 6, 4}, {5, 8, 4, 7}}}},
    {6, 7, {{{6, 7, 5, 9}, {6, 7, 9, 8}, {6, 7, 8, 4}, {6, 7, 4, 5}}}}};

using Edge = std::pair<std::int64_t, std::int64_t>;
Edge edge_of(std::int64_t a, std::int64_t b) { return {std::min(a, b), std::max(a, b)}; }

class SecondOrderSplitter {
 public:
  explicit SecondOrderSplitter(ParsedMesh& raw) : raw_(raw), numbering_(raw) {}

  void split() {
    std::vector<RawTet> tets;
    tets.reserve(8 * raw_.tets.size());
    for (std::size_t t = 0; t < raw_.tets.size(); ++t) {
      raw_.cut.push_back(tets.size());
      split_tet(raw_.tets[t], raw_.second_order[t].second, tets);
      raw_.cut.push_back(tets.size());
    }
    raw_.tets = std::move(tets);
    for (RawGroup& group : raw_.groups)
      if (group.dimension > 0) split_group(group);
  }

 private:
  const Point& at(std::int64_t node, const RawTet& tet) const {
    const int v =
        numbering_.at(node, tet.place, [&] { return "tetrahedron " + std::to_string(tet.tag); });
    return raw_.vertices[static_cast<std::size_t>(v)].position;
  }

  void split_tet(const RawTet& tet, const std::array<std::int64_t, 6>& nodes,
                 std::vector<RawTet>& pieces) {
    std::array<std::int64_t, 10> all = {};
    std::copy_n(tet.vertices.begin(), 4, all.begin());
    for (const std::int64_t node : nodes) {
      std::array<double, 6> distance;
      for (std::size_t e = 0; e < 6; ++e)
        distance[e] =
            (at(node, tet) -
             (at(tet.vertices[edges[e][0]], tet) + at(tet.vertices[edges[e][1]], tet)) / 2)
                .norm();
      const auto nearest = std::min_element(distance.begin(), distance.end()) - distance.begin();
      const auto e = static_cast<std::size_t>(nearest);
      if (taken_[e])
        refuse(raw_.file, tet.place,
               "tetrahedron " + std::to_string(tet.tag) + " has the nodes " +
                   std::to_string(all[4 + e]) + " and " + std::to_string(node) +
                   " nearest to the middle of one edge; expected one at each edge, or order: "
                   "linear, which takes the corners alone");
      taken_[e] = true;
      all[4 + e] = node;
      if (!raw_.groups.empty())
        middle_[edge_of(tet.vertices[edges[e][0]], tet.vertices[edges[e][1]])] = node;
    }
    taken_ = {};
    const auto length = [&](const Diagonal& d) {
      return (at(all[d.begin], tet) - at(all[d.end], tet)).norm();
    };
    const Diagonal& shortest = *std::ranges::min_element(diagonals, {}, length);
    for (const Pieces* some : {&at_corners, &shortest.around})
      for (const auto& corners : *some) {
        RawTet& piece = pieces.emplace_back(tet);
        for (std::size_t k = 0; k < 4; ++k) piece.vertices[k] = all[corners[k]];
      }
  }

  // Returns the node on an edge; -1: it has none
  std::int64_t middle(std::int64_t a, std::int64_t b) const {
    const auto found = middle_.find(edge_of(a, b));
    return found == middle_.end() ? -1 : found->second;
  }

  void split_group(RawGroup& group) const {
    std::vector<RawTriangle> pieces;
    for (const RawTriangle& element : group.elements) {
      const auto [a, b, c] = element.vertices;
      const auto add = [&](std::int64_t i, std::int64_t j, std::int64_t k) {
        pieces.push_back(element);
        pieces.back().vertices = {i, j, k};
      };
      const std::int64_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      if (group.dimension == 1 && ab >= 0)
        add(a, ab, ab), add(ab, b, b);
      else if (group.dimension == 2 && ab >= 0 && bc >= 0 && ca >= 0)
        add(a, ab, ca), add(ab, b, bc), add(ca, bc, c), add(ab, bc, ca);
      else
        pieces.push_back(element);
    }
    group.elements = std::move(pieces);
  }

  ParsedMesh& raw_;
  const VertexNumbers numbering_;
  std::map<Edge, std::int64_t> middle_;
  std::array<bool, 6> taken_ = {};
};

}  // namespace

SecondOrder second_order_named(const std::string& name) {
  if (name == "split") return SecondOrder::split;
  if (name == "linear") return SecondOrder::linear;
  throw InputError("order: " +
                   unknown_name("treatment of second-order tetrahedra", name, {"split", "linear"}));
}

void split_second_order(ParsedMesh& raw, MeshReport& report) {
  if (raw.second_order.empty() || raw.second_order.size() != raw.tets.size()) return;
  report.split = static_cast<int>(raw.tets.size());
  report.linearised.clear();
  SecondOrderSplitter(raw).split();
}

}  // namespace plica
