// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <numeric>
#include <plica/drivers/solver/set_up/element_clusters.hpp>
#include <utility>

namespace plica {

namespace {

class Bisection {
 public:
  Bisection(const TetMesh& mesh, int elements, int vertices)
      : mesh_(mesh), elements_(elements), vertices_(vertices), seen_(mesh.vertices.size(), -1) {
    centroid_.reserve(mesh.tets.size());
    for (const auto& t : mesh.tets) {
      Point sum = Point::Zero();
      for (int v : t) sum += mesh.vertices[static_cast<std::size_t>(v)];
      centroid_.push_back(sum / 4);
    }
  }

  void split(std::vector<int>::iterator first, std::vector<int>::iterator last) {
    const auto size = last - first;
    if (size == 0) return;
    if (size <= elements_ && (size == 1 || count_vertices(first, last) <= vertices_)) {
      std::sort(first, last);
      clusters.emplace_back(first, last);
      return;
    }
    Box box{centroid(*first), centroid(*first)};
    for (auto e = first; e != last; ++e) box = {box.min.cwiseMin(centroid(*e)), box.max.cwiseMax(centroid(*e))};
    int axis = 0;
    (box.max - box.min).maxCoeff(&axis);
    // whole groups on either side, so that most come out full
    const auto groups = std::max<std::ptrdiff_t>(2, (size + elements_ - 1) / elements_);
    const auto middle = first + size * (groups / 2) / groups;
    std::nth_element(first, middle, last,
                     [&](int a, int b) { return std::pair(centroid(a)[axis], a) < std::pair(centroid(b)[axis], b); });
    split(first, middle);
    split(middle, last);
  }

  std::vector<std::vector<int>> clusters;

 private:
  const TetMesh& mesh_;
  std::ptrdiff_t elements_;
  int vertices_;
  std::vector<int> seen_;
  std::vector<Point> centroid_;
  int stamp_ = 0;

  const Point& centroid(int e) const { return centroid_[static_cast<std::size_t>(e)]; }

  int count_vertices(std::vector<int>::iterator first, std::vector<int>::iterator last) {
    int count = 0;
    ++stamp_;
    for (auto e = first; e != last; ++e)
      for (int v : mesh_.tets[static_cast<std::size_t>(*e)])
        count += std::exchange(seen_[static_cast<std::size_t>(v)], stamp_) != stamp_ ? 1 : 0;
    return count;
  }
};

}  // namespace

std::vector<std::vector<int>> element_clusters(const TetMesh& mesh, int elements, int vertices) {
  std::vector<int> order(mesh.tets.size());
  std::iota(order.begin(), order.end(), 0);
  const auto region = [&](int e) { return mesh.region.empty() ? 0 : mesh.region[static_cast<std::size_t>(e)]; };
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return region(a) < region(b); });
  Bisection bisection(mesh, elements, vertices);
  for (auto first = order.begin(); first != order.end();) {
    const auto last = std::find_if(first, order.end(), [&](int e) { return region(e) != region(*first); });
    bisection.split(first, last);
    first = last;
  }
  return std::move(bisection.clusters);
}

}  // namespace plica
