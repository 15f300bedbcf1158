// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <plica/drivers/elastic/build_patches.hpp>
#include <plica/drivers/elastic/vertex_shares.hpp>
#include <plica/meshes/reordering.hpp>
#include <span>
#include <utility>

namespace plica {

namespace {

/// Cutter of a list of tetrahedra into runs.
class RunCutter {
 public:
  RunCutter(const TetMesh& mesh, int elements, int vertices)
      : mesh_(mesh),
        elements_(index_of(elements)),
        vertices_(vertices),
        seen_(mesh.vertices.size(), -1) {}

  /// Adds the runs of some tetrahedra of one region. They are about equally long.
  void cut(std::span<const int> tets) {
    while (!tets.empty()) {
      const std::size_t count = (tets.size() + elements_ - 1) / elements_,
                        even = whole_packs((tets.size() + count - 1) / count + pack - 1);
      const std::size_t length = fitting(tets.first(std::min({even, elements_, tets.size()})));
      std::vector<int>& run =
          runs.emplace_back(tets.begin(), tets.begin() + static_cast<std::ptrdiff_t>(length));
      std::ranges::sort(run);
      tets = tets.subspan(length);
    }
  }

  std::vector<std::vector<int>> runs;

 private:
  static constexpr std::size_t pack = 8;  // elements that registers of a CPU hold side by side
  const TetMesh& mesh_;
  std::size_t elements_;
  int vertices_;
  std::vector<int> seen_;  // [vertices] last run that counted the vertex
  int stamp_ = 0;

  static std::size_t whole_packs(std::size_t tets) { return tets / pack * pack; }

  /// Returns how many of the first tetrahedra have few enough vertices. Where that is not all of
  /// them, it is a whole number of packs if they fill one.
  std::size_t fitting(std::span<const int> tets) {
    int count = 0;
    ++stamp_;
    for (std::size_t i = 0; i < tets.size(); ++i) {
      for (const int v : mesh_.tets[index_of(tets[i])])
        count += std::exchange(seen_[index_of(v)], stamp_) != stamp_ ? 1 : 0;
      if (count > vertices_) return i < pack ? i : whole_packs(i);
    }
    return tets.size();
  }
};

}  // namespace

std::vector<std::vector<int>> element_runs(const TetMesh& mesh, int elements, int vertices) {
  constexpr std::size_t stretch = 4096;
  std::vector<int> tets = tets_along_curve(mesh);
  RunCutter cutter(mesh, elements, vertices);
  const auto region = [&](int e) { return mesh.region.empty() ? 0 : mesh.region[index_of(e)]; };
  for (std::size_t begin = 0; begin < tets.size(); begin += stretch) {
    const std::span all = std::span(tets).subspan(begin, std::min(stretch, tets.size() - begin));
    std::ranges::stable_sort(all, {}, region);
    for (auto first = all.begin(); first != all.end();) {
      const auto last =
          std::find_if(first, all.end(), [&](int e) { return region(e) != region(*first); });
      cutter.cut({first, last});
      first = last;
    }
  }
  return std::move(cutter.runs);
}

namespace {

/// Builder of patches from runs of elements.
template <class B>
class PatchBuilder {
  using Real = typename B::Real;
  using P = Patches<B>;
  static constexpr auto W = static_cast<std::size_t>(B::lanes),
                        at_once = static_cast<std::size_t>(P::at_once);

 public:
  PatchBuilder(const TetMesh& mesh, const std::vector<std::vector<int>>& runs)
      : mesh_(mesh), runs_(runs) {
    std::vector<Vertices> of(runs.size());
    for_row_ranges(runs.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t p = begin; p < end; ++p) of[p] = vertices_of(runs[p]);
    });
    for (std::size_t p = 0; p < runs.size(); ++p) {
      vertex_.insert(vertex_.end(), of[p].vertex.begin(), of[p].vertex.end());
      first_vertex_.push_back(static_cast<int>(vertex_.size()));
      first_pack_.push_back(first_pack_.back() + static_cast<int>((runs[p].size() + W - 1) / W));
      first_sum_.push_back(first_sum_.back() + static_cast<int>(of[p].sums()));
      first_slot_.push_back(first_slot_.back() + of[p].slots());
    }
  }

  P on_device() const {
    P patches;
    patches.count = static_cast<int>(runs_.size());
    patches.vertices = static_cast<int>(mesh_.vertices.size());
    patches.packs = first_pack_.back();
    patches.first_pack = to_device<Indices<B>>("patches.first_pack", first_pack_);
    patches.first_vertex = to_device<Indices<B>>("patches.first_vertex", first_vertex_);
    patches.vertex = to_device<Indices<B>>("patches.vertex", vertex_);
    patches.first_sum = to_device<Indices<B>>("patches.first_sum", first_sum_);
    const auto packs = index_of(first_pack_.back());
    const HostWritten<B, decltype(P::corner)> corner("patches.corner", packs);
    const HostWritten<B, decltype(P::shape)> shape("patches.shape", packs);
    const HostWritten<B, Indices<B>> element("patches.element", packs * W);
    const HostWritten<B, decltype(P::summed)> summed("patches.summed", vertex_.size());
    const HostWritten<B, Indices<B>> first_slot("patches.first_slot",
                                                index_of(first_sum_.back()) + 1);
    const HostWritten<B, decltype(P::slot)> slot("patches.slot", first_slot_.back());
    const Elements elements{corner.data(), shape.data(), element.data()};
    const Sums sums{summed.data(), first_slot.data(), slot.data()};
    sums.first_slot[0] = 0;
    for_row_ranges(runs_.size(), [&](std::size_t begin, std::size_t end) {
      std::vector<int> local(mesh_.vertices.size());  // [vertices] place in the patch
      for (std::size_t p = begin; p < end; ++p) add_patch(p, local, elements, sums);
    });
    patches.corner = corner.upload(), patches.shape = shape.upload(),
    patches.element = element.upload();
    patches.summed = summed.upload(), patches.first_slot = first_slot.upload(),
    patches.slot = slot.upload();
    patches.shares = vertex_shares<B>(vertex_, mesh_.vertices.size());
    return patches;
  }

  /// Copies the values of each patch's region to the device, one patch after the other.
  template <class Values>
  Scalars<B> of_regions(const std::string& name, const Values& values) const {
    std::vector<Real> all;
    for (const std::vector<int>& run : runs_)
      for (const double value : std::span<const double>(
               values(index_of(mesh_.region.empty() ? 0 : mesh_.region[index_of(run.front())]))))
        all.push_back(static_cast<Real>(value));
    return to_device<Scalars<B>>(name, all);
  }

 private:
  const TetMesh& mesh_;
  const std::vector<std::vector<int>>& runs_;
  std::vector<int> first_pack_{0}, first_vertex_{0}, vertex_, first_sum_{0};
  std::vector<std::size_t> first_slot_{0};  // [patches + 1]

  struct Elements {
    std::uint16_t* corner;
    Real* shape;
    int* element;
  };
  struct Sums {
    std::uint16_t* summed;
    int* first_slot;
    std::uint16_t* slot;
  };

  struct Vertices {
    std::vector<int> vertex;
    std::vector<std::size_t> elements;  // number of elements around a vertex, ascending

    std::size_t sums() const { return (vertex.size() + at_once - 1) / at_once; }
    std::size_t slots() const {  // each sum has the length that its last vertex needs
      std::size_t count = 0;
      for (std::size_t i = 1; i <= sums(); ++i)
        count += at_once * elements[std::min(i * at_once, vertex.size()) - 1];
      return count;
    }
  };

  Vertices vertices_of(const std::vector<int>& elements) const {
    std::vector<int> corners;
    for (const int e : elements)
      for (const int v : mesh_.tets[index_of(e)]) corners.push_back(v);
    std::ranges::sort(corners);
    Vertices of;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      if (i == 0 || corners[i] != corners[i - 1])
        of.vertex.push_back(corners[i]), of.elements.push_back(0);
      ++of.elements.back();
    }
    std::ranges::sort(of.elements);
    return of;
  }

  void add_patch(std::size_t p, std::vector<int>& local, const Elements& to,
                 const Sums& sums) const {
    const auto v0 = index_of(first_vertex_[p]), v1 = index_of(first_vertex_[p + 1]);
    for (std::size_t i = v0; i < v1; ++i) local[index_of(vertex_[i])] = static_cast<int>(i - v0);
    std::vector<std::vector<std::uint16_t>> slots(v1 - v0);
    const std::size_t begin = index_of(first_pack_[p]) * W, end = index_of(first_pack_[p + 1]) * W;
    for (std::size_t i = begin; i < end; ++i) {
      const bool padding = i - begin >= runs_[p].size();
      const int e = padding ? -1 : runs_[p][i - begin];
      to.element[i] = e;
      for (std::size_t c = 0; c < 4; ++c) {
        const int v = padding ? 0 : local[index_of(mesh_.tets[index_of(e)][c])];
        to.corner[(i / W * 4 + c) * W + i % W] = static_cast<std::uint16_t>(v);
        if (!padding) slots[index_of(v)].push_back(slot_of((i - begin) / W, c, i % W));
      }
      const std::array<double, 10> shape =
          padding ? std::array<double, 10>{} : shape_of(index_of(e));
      for (std::size_t k = 0; k < 10; ++k)
        to.shape[(i / W * 10 + k) * W + i % W] = static_cast<Real>(shape[k]);
    }
    add_sums(slots, sums.summed + v0, sums.first_slot + first_sum_[p] + 1, sums.slot,
             first_slot_[p]);
  }

  static std::uint16_t slot_of(std::size_t pack, std::size_t corner, std::size_t lane) {
    return static_cast<std::uint16_t>((pack * 4 + corner) * 3 * W + lane);
  }

  /// Returns the inverse of the edges' matrix, row by row, and the volume.
  std::array<double, 10> shape_of(std::size_t e) const {
    const auto& t = mesh_.tets[e];
    Eigen::Matrix3d edges;
    for (int c = 0; c < 3; ++c)
      edges.col(c) = mesh_.vertices[index_of(t[index_of(c + 1)])] - mesh_.vertices[index_of(t[0])];
    const Eigen::Matrix3d inverse = edges.inverse();
    std::array<double, 10> shape;
    for (int k = 0; k < 9; ++k) shape[index_of(k)] = inverse(k / 3, k % 3);
    shape[9] = mesh_.part(e) * edges.determinant() / 6;
    return shape;
  }

  static void add_sums(const std::vector<std::vector<std::uint16_t>>& slots, std::uint16_t* summed,
                       int* end_of_sum, std::uint16_t* slot, std::size_t to) {
    const std::span order(summed, slots.size());
    std::iota(order.begin(), order.end(), std::uint16_t{0});
    std::ranges::stable_sort(order, {}, [&](std::uint16_t i) { return slots[i].size(); });
    for (std::size_t first = 0; first < order.size(); first += at_once) {
      const std::span together = order.subspan(first, std::min(at_once, order.size() - first));
      for (std::size_t s = 0; s < slots[together.back()].size(); ++s)
        for (std::size_t j = 0; j < at_once; ++j) {
          const bool has = j < together.size() && s < slots[together[j]].size();
          slot[to++] = has ? slots[together[j]][s] : std::uint16_t{P::nothing};
        }
      *end_of_sum++ = static_cast<int>(to);
    }
  }
};

}  // namespace

template <class B>
Patches<B> build_patches(const TetMesh& mesh, const std::vector<std::vector<double>>& constants,
                         const std::vector<double>& damping,
                         const std::vector<std::vector<int>>* runs) {
  std::vector<std::vector<int>> all;
  if (!runs) all = element_runs(mesh, Patches<B>::capacity, Patches<B>::vertex_capacity);
  const PatchBuilder<B> builder(mesh, runs ? *runs : all);
  Patches<B> patches = builder.on_device();
  patches.constants = builder.of_regions("patches.constants",
                                         [&](std::size_t r) { return std::span(constants[r]); });
  if (!damping.empty())
    patches.damping = builder.of_regions("patches.damping",
                                         [&](std::size_t r) { return std::span(&damping[r], 1); });
  return patches;
}

#define PLICA_INSTANTIATE(Real, Exec)                                                      \
  template Patches<Backend<Real, Exec>> build_patches<Backend<Real, Exec>>(                \
      const TetMesh&, const std::vector<std::vector<double>>&, const std::vector<double>&, \
      const std::vector<std::vector<int>>*);
PLICA_FOR_EACH_BACKEND(PLICA_INSTANTIATE)

}  // namespace plica
