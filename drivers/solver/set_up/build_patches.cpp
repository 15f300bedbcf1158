// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <plica/drivers/solver/set_up/build_patches.hpp>
#include <plica/drivers/solver/set_up/to_device.hpp>
#include <plica/drivers/solver/spaces/row_ranges.hpp>
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

namespace {

/// The host's copy of Patches, filled patch by patch.
template <class B>
class PatchBuilder {
  using Real = typename B::Real;
  static constexpr int W = B::lanes;
  template <class T>
  using Lanes = std::array<T, index_of(W)>;

 public:
  PatchBuilder(const TetMesh& mesh, const std::vector<std::vector<double>>& constants,
               const std::vector<double>& damping)
      : mesh_(mesh),
        constants_(constants),
        damping_(damping),
        local_(mesh.vertices.size(), -1),
        copies_(mesh.vertices.size()) {}

  void add(const std::vector<int>& elements) {
    const std::size_t v0 = vertex_.size(), q0 = shape_.size();
    add_vertices(elements);
    const std::size_t packs = (elements.size() + W - 1) / W;
    corner_.resize(q0 + packs), shape_.resize(q0 + packs), element_.resize((q0 + packs) * W, -1);
    std::vector<std::vector<std::uint16_t>> slots(vertex_.size() - v0);
    for (std::size_t i = 0; i < elements.size(); ++i) add_element(elements[i], i / W, i % W, q0, slots);
    add_sums(slots);
    first_pack_.push_back(static_cast<int>(shape_.size()));
    first_vertex_.push_back(static_cast<int>(vertex_.size()));
    const int region = mesh_.region.empty() ? 0 : mesh_.region[index_of(elements.front())];
    for (const double c : constants_[index_of(region)]) device_constants_.push_back(static_cast<Real>(c));
    if (!damping_.empty()) device_damping_.push_back(static_cast<Real>(damping_[index_of(region)]));
    for (std::size_t i = v0; i < vertex_.size(); ++i) local_[index_of(vertex_[i])] = -1;
  }

  Patches<B> finish() {
    Patches<B> p;
    p.count = static_cast<int>(first_pack_.size()) - 1;
    p.vertices = static_cast<int>(mesh_.vertices.size());
    p.packs = static_cast<int>(shape_.size());
    p.first_pack = to_device<Indices<B>>("patches.first_pack", first_pack_);
    p.first_vertex = to_device<Indices<B>>("patches.first_vertex", first_vertex_);
    p.vertex = to_device<Indices<B>>("patches.vertex", vertex_);
    p.corner = to_device<decltype(p.corner)>("patches.corner", corner_);
    p.shape = to_device<decltype(p.shape)>("patches.shape", shape_);
    p.constants = to_device<Scalars<B>>("patches.constants", device_constants_);
    if (!damping_.empty()) p.damping = to_device<Scalars<B>>("patches.damping", device_damping_);
    p.summed = to_device<decltype(p.summed)>("patches.summed", summed_);
    p.first_slot = to_device<Indices<B>>("patches.first_slot", first_slot_);
    p.slot = to_device<decltype(p.slot)>("patches.slot", slot_);
    p.element = to_device<Indices<B>>("patches.element", element_);
    std::vector<int> first_copy{0}, copy;
    for (const auto& of_vertex : copies_) {
      copy.insert(copy.end(), of_vertex.begin(), of_vertex.end());
      first_copy.push_back(static_cast<int>(copy.size()));
    }
    p.shares.rows = static_cast<int>(vertex_.size());
    p.shares.first = to_device<Indices<B>>("shares.first", first_copy);
    p.shares.row = to_device<Indices<B>>("shares.row", copy);
    return p;
  }

 private:
  const TetMesh& mesh_;
  const std::vector<std::vector<double>>& constants_;
  const std::vector<double>& damping_;
  std::vector<int> local_;  // a mesh vertex's place in the patch being added
  std::vector<std::vector<int>> copies_;
  std::vector<int> first_pack_{0}, first_vertex_{0}, vertex_, first_slot_{0}, element_;
  std::vector<std::array<Lanes<std::uint16_t>, 4>> corner_;
  std::vector<std::array<Lanes<Real>, 10>> shape_;
  std::vector<Real> device_constants_;
  std::vector<Real> device_damping_;
  std::vector<std::uint16_t> summed_, slot_;

  void add_vertices(const std::vector<int>& elements) {
    const std::size_t v0 = vertex_.size();
    for (int e : elements)
      for (int v : mesh_.tets[index_of(e)])
        if (std::exchange(local_[index_of(v)], 0) < 0) vertex_.push_back(v);
    std::sort(vertex_.begin() + static_cast<std::ptrdiff_t>(v0), vertex_.end());
    for (std::size_t i = v0; i < vertex_.size(); ++i) {
      local_[index_of(vertex_[i])] = static_cast<int>(i - v0);
      copies_[index_of(vertex_[i])].push_back(static_cast<int>(i));
    }
  }

  void add_element(int e, std::size_t pack, std::size_t lane, std::size_t q0,
                   std::vector<std::vector<std::uint16_t>>& slots) {
    const auto& t = mesh_.tets[index_of(e)];
    Eigen::Matrix3d edges;
    for (int c = 0; c < 3; ++c)
      edges.col(c) = mesh_.vertices[index_of(t[index_of(c + 1)])] - mesh_.vertices[index_of(t[0])];
    const Eigen::Matrix3d inverse = edges.inverse();
    auto& shape = shape_[q0 + pack];
    for (int k = 0; k < 9; ++k) shape[index_of(k)][lane] = static_cast<Real>(inverse(k / 3, k % 3));
    shape[9][lane] = static_cast<Real>(mesh_.part(index_of(e)) * edges.determinant() / 6);
    for (std::size_t c = 0; c < 4; ++c) {
      const int v = local_[index_of(t[c])];
      corner_[q0 + pack][c][lane] = static_cast<std::uint16_t>(v);
      slots[index_of(v)].push_back(static_cast<std::uint16_t>((pack * 4 + c) * 3 * W + lane));
    }
    element_[(q0 + pack) * W + lane] = e;
  }

  void add_sums(const std::vector<std::vector<std::uint16_t>>& slots) {
    std::vector<std::uint16_t> order(slots.size());
    std::iota(order.begin(), order.end(), std::uint16_t{0});
    std::ranges::stable_sort(order, {}, [&](std::uint16_t i) { return slots[i].size(); });
    for (const std::uint16_t i : order) {
      summed_.push_back(i);
      slot_.insert(slot_.end(), slots[i].begin(), slots[i].end());
      first_slot_.push_back(static_cast<int>(slot_.size()));
    }
  }
};

}  // namespace

template <class B>
Patches<B> build_patches(const TetMesh& mesh, const std::vector<std::vector<double>>& constants,
                         const std::vector<double>& damping) {
  PatchBuilder<B> builder(mesh, constants, damping);
  for (const auto& cluster : element_clusters(mesh, Patches<B>::capacity, Patches<B>::vertex_capacity))
    builder.add(cluster);
  return builder.finish();
}

#define PLICA_INSTANTIATE(Real, Exec)                                       \
  template Patches<Backend<Real, Exec>> build_patches<Backend<Real, Exec>>( \
      const TetMesh&, const std::vector<std::vector<double>>&, const std::vector<double>&);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
