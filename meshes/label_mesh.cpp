// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/LU>  // determinant()
#include <algorithm>
#include <cmath>
#include <plica/core/error.hpp>
#include <plica/meshes/checked.hpp>
#include <plica/meshes/embedding.hpp>
#include <plica/meshes/label_lattice.hpp>
#include <plica/meshes/label_mesh.hpp>
#include <plica/meshes/lattice.hpp>
#include <plica/meshes/repair_mesh.hpp>
#include <set>

namespace plica {

namespace {

// Mean edge of a body-centred lattice over the edge of its cubes: at each vertex are six edges of
// one cube and eight of half a diagonal
const double mean_edge_of_lattice = (6 + 8 * std::sqrt(0.75)) / 14;
constexpr double ball_of_edge = 0.6;   // radius of the balls for votes, over the edge of a cube
constexpr double ball_of_voxel = 1.2;  // least radius over the longest edge of a voxel
constexpr double worst_height = 5;     // height ratio that no tetrahedron may pass
constexpr int relax_rounds = 8;
constexpr double tried_steps[] = {1, 0.5, 0.25};  // tried parts of a move
constexpr double part_of_gap = 0.7;               // part of a lacking volume that a round adds
constexpr double most_offset = 0.1;               // largest offset_ over the edge of a cube

double volume_of_tet(const TetMesh& mesh, std::size_t tet) {
  const auto x = corners_of(mesh, static_cast<int>(tet));
  return tet_volume(x[0], x[1], x[2], x[3]);
}

void insert_sorted(std::vector<int>& set, int value) {
  const auto place = std::ranges::lower_bound(set, value);
  if (place == set.end() || *place != value) set.insert(place, value);
}

// Moves the vertices of interfaces onto those of the image, and others between their neighbours
class InterfaceRelaxation {
 public:
  InterfaceRelaxation(LabelledTets& tets, const LabelVotes& votes, double edge, double volume)
      : mesh_(tets.mesh), votes_(votes), edge_(edge), volume_(volume) {
    const std::size_t size = mesh_.vertices.size();
    star_.resize(size), labels_.resize(size), beside_.resize(size);
    for (std::size_t t = 0; t < mesh_.tets.size(); ++t)
      for (const int v : mesh_.tets[t]) star_[static_cast<std::size_t>(v)].push_back(t);
    find_interfaces(tets.label);
    for (std::size_t v = 0; v < size; ++v)
      if (labels_[v].empty())
        for (const std::size_t t : star_[v])
          for (const int other : mesh_.tets[t])
            if (other != static_cast<int>(v)) insert_sorted(beside_[v], other);
  }

  void run() {
    for (int round = 0; round < relax_rounds; ++round) {
      for (std::size_t v = 0; v < mesh_.vertices.size(); ++v) move(v);
      double volume = 0;
      for (std::size_t t = 0; t < mesh_.tets.size(); ++t) volume += volume_of_tet(mesh_, t);
      if (outer_area_ > 0) offset_ += part_of_gap * (volume_ - volume) / outer_area_;
      offset_ = std::clamp(offset_, -most_offset * edge_, most_offset * edge_);
    }
  }

 private:
  using Face = std::pair<std::array<int, 3>, int>;  // vertices, ascending, and a label beside

  void find_interfaces(const std::vector<int>& label) {
    std::vector<Face> faces;
    for (std::size_t t = 0; t < mesh_.tets.size(); ++t)
      for (std::size_t k = 0; k < 4; ++k) {
        const auto& tet = mesh_.tets[t];
        std::array<int, 3> face = {tet[(k + 1) % 4], tet[(k + 2) % 4], tet[(k + 3) % 4]};
        std::ranges::sort(face);
        faces.emplace_back(face, label[t]);
      }
    std::ranges::sort(faces);
    for (std::size_t f = 0; f < faces.size(); ++f) {
      const bool inner = f + 1 < faces.size() && faces[f + 1].first == faces[f].first;
      const int one = faces[f].second, other = inner ? faces[f + 1].second : 0;
      if (one != other) add_interface(faces[f].first, one, other);
      if (inner) ++f;
    }
  }

  void add_interface(const std::array<int, 3>& face, int one, int other) {
    for (const int v : face) {
      const auto i = static_cast<std::size_t>(v);
      insert_sorted(labels_[i], one), insert_sorted(labels_[i], other);
      for (const int w : face)
        if (w != v) insert_sorted(beside_[i], w);
    }
    const auto x = [&](std::size_t k) { return mesh_.vertices[static_cast<std::size_t>(face[k])]; };
    if (other == 0) outer_area_ += (x(1) - x(0)).cross(x(2) - x(0)).norm() / 2;
  }

  // Returns the middle of the neighbours with all labels of a vertex, so that lines between several
  // interfaces move along themselves
  Point middle(std::size_t v) const {
    Point sum = Point::Zero();
    int count = 0;
    for (const int w : beside_[v])
      if (const auto i = static_cast<std::size_t>(w); std::ranges::includes(labels_[i], labels_[v]))
        sum += mesh_.vertices[i], ++count;
    return count > 0 ? Point(sum / count) : mesh_.vertices[v];
  }

  void move(std::size_t v) {
    const Point from = mesh_.vertices[v];
    Point to = (from + middle(v)) / 2;
    if (!labels_[v].empty())
      if (const auto place = votes_.beside(to, labels_[v])) {
        const double outwards = place->inside == 0 ? 1 : place->other == 0 ? -1 : 0;
        to += (outwards * offset_ - place->distance) * place->normal;
      }
    for (const double step : tried_steps) {
      mesh_.vertices[v] = from + step * (to - from);
      if (std::ranges::all_of(star_[v], [&](std::size_t t) {
            return height_ratio(mesh_, mesh_.tets[t]) <= worst_height;
          }))
        return;
    }
    mesh_.vertices[v] = from;
  }

  TetMesh& mesh_;
  const LabelVotes& votes_;
  double edge_, volume_;  // volume that the body has in the image
  double outer_area_ = 0;
  double offset_ = 0;                           // distance that the outer interface is moved by
  std::vector<std::vector<std::size_t>> star_;  // tetrahedra of each vertex
  std::vector<std::vector<int>> labels_;        // labels beside the interfaces of each vertex
  std::vector<std::vector<int>> beside_;  // neighbours; of a vertex on interfaces, those on them
};

// Returns the box around the voxels with a label above 0
Box box_of_labels(const LabelImage& image) {
  std::vector<Point> corners;
  std::array<int, 3> low = image.size, high = {-1, -1, -1}, at = {0, 0, 0};
  for (const int label : image.labels) {
    if (label > 0)
      for (std::size_t k = 0; k < 3; ++k)
        low[k] = std::min(low[k], at[k]), high[k] = std::max(high[k], at[k]);
    for (std::size_t k = 0; k < 3 && ++at[k] == image.size[k]; ++k) at[k] = k < 2 ? 0 : at[k];
  }
  if (high[0] < 0) throw InputError("the image has no voxel with a label above 0");
  for (int corner = 0; corner < 8; ++corner) {
    Point place;
    for (int k = 0; k < 3; ++k) {
      const auto i = static_cast<std::size_t>(k);
      place[k] = (corner >> k & 1) != 0 ? high[i] + 0.5 : low[i] - 0.5;
    }
    corners.emplace_back(image.origin + image.axes * place);
  }
  return bounding_box(corners);
}

}  // namespace

LabelMesh fill_labels(const LabelImage& image, double size) {
  checked_size("the size of tetrahedra", size);
  const Box box = box_of_labels(image);
  check_cell_size({box.min, box.max}, size);
  const double edge = size / mean_edge_of_lattice, voxel = image.axes.colwise().norm().maxCoeff(),
               voxel_volume = std::abs(image.axes.determinant());
  const LabelVotes votes(image, std::max(ball_of_edge * edge, ball_of_voxel * voxel));
  LabelledTets tets = label_lattice(votes, box, edge);
  if (tets.mesh.tets.empty())
    throw InputError("all labels are thinner than the tetrahedra; expected a smaller size");
  std::map<int, double> volumes;
  double volume = 0;
  for (const int label : image.labels)
    if (label > 0) volumes[label] += voxel_volume, volume += voxel_volume;
  InterfaceRelaxation(tets, votes, edge, volume).run();

  LabelMesh result;
  const std::set<int> used(tets.label.begin(), tets.label.end());
  result.labels.assign(used.begin(), used.end());
  std::set<std::string> taken;
  for (const int label : result.labels) {
    const auto name = image.names.find(label);
    const std::string plain = "label_" + std::to_string(label);
    const bool named = name != image.names.end() && taken.insert(name->second).second;
    tets.mesh.region_names.push_back(named ? name->second : plain);
  }
  for (std::size_t t = 0; t < tets.label.size(); ++t) {
    tets.mesh.region.push_back(static_cast<int>(
        std::ranges::lower_bound(result.labels, tets.label[t]) - result.labels.begin()));
    result.filled_part[tets.label[t]] += volume_of_tet(tets.mesh, t);
  }
  for (const auto& [label, of_voxels] : volumes) result.filled_part[label] /= of_voxels;
  result.mesh = std::move(tets.mesh);
  return result;
}

}  // namespace plica
