// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <plica/core/error.hpp>
#include <plica/core/text.hpp>
#include <plica/meshes/label_lattice.hpp>
#include <unordered_set>

namespace plica {

namespace {

constexpr double most_cubes = 2e6;

using Cube = std::array<int, 3>;

// Cubes with a vertex at each corner and one in each middle. Around the line between the middles of
// two neighbours are four tetrahedra, one for each edge of the face between them
class CentredLattice {
 public:
  CentredLattice(const Box& box, double edge) : edge_(edge) {
    double all = 1;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<int>(k);
      const double cubes = std::ceil((box.max[axis] - box.min[axis]) / edge) + 2;
      all *= cubes;
      cubes_[k] = static_cast<int>(std::min(cubes, most_cubes));
    }
    if (all > most_cubes)
      throw InputError(text("the size of tetrahedra makes a lattice of ", number(all), " cubes; ",
                            number(most_cubes), " at most"));
    low_ = (box.min + box.max - edge * Point(cubes_[0], cubes_[1], cubes_[2])) / 2;
    corners_ = count({cubes_[0] + 1, cubes_[1] + 1, cubes_[2] + 1});
  }

  int vertices() const { return corners_ + count(cubes_); }

  Point at(int vertex) const {
    const bool is_corner = vertex < corners_;
    const int more = is_corner ? 1 : 0, index = is_corner ? vertex : vertex - corners_,
              along = cubes_[0] + more, rows = cubes_[1] + more;
    return low_ + edge_ * (Point(index % along, index / along % rows, index / along / rows) +
                           Point::Constant(is_corner ? 0 : 0.5));
  }

  template <class Visit>
  void for_each_tet(const Visit& visit) const {
    for (int k = 0; k < cubes_[2]; ++k)
      for (int j = 0; j < cubes_[1]; ++j)
        for (int i = 0; i < cubes_[0]; ++i)
          for (std::size_t d = 0; d < 3; ++d) {
            const Cube cube = {i, j, k}, next = moved(cube, d), u = moved(next, (d + 1) % 3);
            if (next[d] == cubes_[d]) continue;
            const int ring[] = {corner(next), corner(u), corner(moved(u, (d + 2) % 3)),
                                corner(moved(next, (d + 2) % 3))};
            for (std::size_t m = 0; m < 4; ++m)
              visit(std::array<int, 4>{middle(cube), middle(next), ring[m], ring[(m + 1) % 4]});
          }
  }

 private:
  static int count(const Cube& c) { return c[0] * c[1] * c[2]; }
  static Cube moved(Cube cube, std::size_t axis) { return ++cube[axis], cube; }
  int corner(const Cube& c) const {
    return (c[2] * (cubes_[1] + 1) + c[1]) * (cubes_[0] + 1) + c[0];
  }
  int middle(const Cube& c) const {
    return corners_ + (c[2] * cubes_[1] + c[1]) * cubes_[0] + c[0];
  }

  double edge_;
  Cube cubes_ = {1, 1, 1};
  Point low_;
  int corners_ = 0;
};

}  // namespace

LabelledTets label_lattice(const LabelVotes& votes, const Box& box, double edge) {
  const CentredLattice lattice(box, edge);
  const auto size = static_cast<std::size_t>(lattice.vertices());
  std::vector<int> label(size);
  for (std::size_t v = 0; v < size; ++v) label[v] = votes.most(lattice.at(static_cast<int>(v)));
  const auto label_of = [&](int v) { return label[static_cast<std::size_t>(v)]; };

  std::vector<char> on_interface(size, 0);
  std::unordered_set<std::uint64_t> seen;
  const auto mark = [&](int a, int b) {
    const auto [low, high] = std::minmax(a, b);
    const int one = label_of(low), other = label_of(high);
    if (one == other ||
        !seen.insert(static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint64_t>(high))
             .second)
      return;
    const bool low_is_nearer =
        votes.margin(lattice.at(low), one, other) < votes.margin(lattice.at(high), other, one);
    on_interface[static_cast<std::size_t>(low_is_nearer ? low : high)] = 1;
  };
  lattice.for_each_tet([&](const std::array<int, 4>& tet) {
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < i; ++j) mark(tet[j], tet[i]);
  });

  LabelledTets result;
  std::vector<int> number(size, -1);
  lattice.for_each_tet([&](std::array<int, 4> tet) {
    const auto found = std::ranges::find_if(
        tet, [&](int v) { return on_interface[static_cast<std::size_t>(v)] == 0; });
    if (found == tet.end() && std::ranges::all_of(tet, [&](int v) { return label_of(v) == 0; }))
      return;
    int own = 0;
    if (found != tet.end()) {
      own = label_of(*found);
    } else {
      Point centre = Point::Zero();
      for (const int v : tet) centre += lattice.at(v) / 4;
      own = votes.most(centre);
    }
    if (own == 0) return;
    for (int& v : tet) {
      int& n = number[static_cast<std::size_t>(v)];
      if (n < 0)
        n = static_cast<int>(result.mesh.vertices.size()),
        result.mesh.vertices.push_back(lattice.at(v));
      v = n;
    }
    result.mesh.tets.push_back(tet);
    result.label.push_back(own);
  });
  return result;
}

}  // namespace plica
