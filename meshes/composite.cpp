// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <plica/core/error.hpp>
#include <plica/core/row_ranges.hpp>
#include <plica/core/text.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/common_volume.hpp>
#include <plica/meshes/composite.hpp>
#include <plica/meshes/embedding.hpp>
#include <plica/meshes/mesh_quality.hpp>
#include <plica/meshes/part_border.hpp>
#include <plica/meshes/signed_distance.hpp>

namespace plica {

namespace {

using Triangles = std::vector<std::array<int, 3>>;

constexpr double least_part = 0.02;        // smaller parts of tetrahedra are dropped
constexpr double part_rounding = 1e-9;     // smaller parts are 0, larger ones than 1 - 1e-9 are 1
constexpr double weight_rounding = 1e-10;  // smaller weights are 0
constexpr double wrong_volume = 0.1, doubtful_volume = 0.02;  // change over the part's volume
constexpr int samples = 8;                                    // points along an edge

Box box_of(const std::array<Point, 4>& x) {
  return {x[0].cwiseMin(x[1]).cwiseMin(x[2]).cwiseMin(x[3]),
          x[0].cwiseMax(x[1]).cwiseMax(x[2]).cwiseMax(x[3])};
}

double volume_of_corners(const std::array<Point, 4>& x) {
  return tet_volume(x[0], x[1], x[2], x[3]);
}

std::string place_text(const Point& p) {
  return text("[", number(p[0], 4), ", ", number(p[1], 4), ", ", number(p[2], 4), "] m");
}

// Part of the body that a mesh covers: its tetrahedra, and what hangs over its skin
class Cover {
 public:
  Cover(const TetMesh& part, const Triangles& boundary, const std::vector<char>& inner)
      : locator_(part) {
    for (std::size_t i = 0; i < boundary.size(); ++i)
      (inner[i] != 0 ? border_ : skin_).triangles.push_back(boundary[i]);
    for (TriangleSurface* surface : {&border_, &skin_}) surface->vertices = part.vertices;
    if (!border_.triangles.empty()) from_border_.emplace(border_);
    if (!skin_.triangles.empty()) from_skin_.emplace(skin_);
  }
  Cover(const Cover&) = delete;
  Cover& operator=(const Cover&) = delete;

  bool contains(const Point& place) const { return locator_.locate(place).distance == 0; }
  // Returns whether a place outside the part is beyond its skin, by less than `reach`
  bool hangs_over_skin(const Point& place, double reach) const {
    const double skin = distance(from_skin_, place);
    return skin < reach && skin < distance(from_border_, place) - part_rounding * reach;
  }
  double distance_to_skin(const Point& place) const { return distance(from_skin_, place); }

 private:
  static double distance(const std::optional<SignedDistance>& surface, const Point& place) {
    return surface ? std::abs((*surface)(place)) : std::numeric_limits<double>::infinity();
  }

  TetLocator locator_;
  TriangleSurface border_, skin_;
  std::optional<SignedDistance> from_border_, from_skin_;
};

// Some tetrahedra of a mesh, in which points are found
struct FoundAmong {
  TetMesh mesh;
  std::vector<int> tet;  // numbers in the whole mesh
  std::optional<TetLocator> locator;

  FoundAmong(const TetMesh& of, std::vector<int> tets) : tet(std::move(tets)) {
    if (tet.empty()) return;
    mesh.vertices = of.vertices;
    for (const int t : tet) mesh.tets.push_back(of.tets[index_of(t)]);
    locator.emplace(mesh);
  }
  FoundAmong(const FoundAmong&) = delete;
  FoundAmong& operator=(const FoundAmong&) = delete;
};

// A composite mesh in the making
class Composer {
 public:
  Composer(const PartMesh& part, const TetMesh& coarser, const std::string& border)
      : part_(part.mesh), coarser_(coarser), boundary_(boundary_triangles(part.mesh)) {
    if (!part_.piece.empty()) throw InputError("the part has pieces; expected one mesh");
    if (!part_.filled.empty() || (coarser.piece.empty() && !coarser.filled.empty()))
      throw InputError("the part or the coarser level is a lattice; expected meshes that fit");
    inner_ = border_flags(part, boundary_, coarser, border);
    for (std::size_t i = 0; i < boundary_.size(); ++i)
      if (inner_[i] != 0) border_.insert(border_.end(), boundary_[i].begin(), boundary_[i].end());
    std::ranges::sort(border_);
    border_.erase(std::unique(border_.begin(), border_.end()), border_.end());
    if (border_.empty())
      throw InputError(
          "the part has no border: all of its boundary is that of the coarser level; expected a "
          "part of the body, or no covers");
    for (std::size_t c = 0; c < coarser.tets.size(); ++c) {
      left_.push_back(coarser.part(c));
      pieces_ = std::max(pieces_, 1 + piece_of(c));
    }
    covered_ = coarser.covered;
    covered_.resize(static_cast<std::size_t>(pieces_));
  }

  Composite made() {
    const Cover cover(part_, boundary_, inner_);
    subtract_volumes();
    subtract_overhang(cover);
    follow();
    check_volume();
    join();
    add_followers();
    add_inner_faces(cover);
    doubt_edges();
    return std::move(result_);
  }

 private:
  const TetMesh &part_, &coarser_;
  Triangles boundary_;
  std::vector<char> inner_;             // per boundary triangle: border
  std::vector<int> border_;             // vertices of the border, ascending
  std::vector<double> left_;            // per coarser tetrahedron, the part that counts
  int pieces_ = 1;                      // number of pieces of the coarser mesh
  std::vector<PieceCover> covered_;     // losses of each of these to finer ones
  std::vector<int> kept_, number_;      // kept coarser tets; per coarser vertex its new number
  std::vector<std::array<int, 4>> of_;  // per border vertex, coarser vertices
  std::vector<Weights> weights_;
  std::vector<int> followed_;  // per border vertex, the coarser tetrahedron
  Composite result_;

  int piece_of(std::size_t c) const { return coarser_.piece.empty() ? 0 : coarser_.piece[c]; }

  // Subtracts from each coarser tetrahedron what the part has in common with it. Where pieces of
  // the coarser mesh share room, the part takes it from the finer one.
  void subtract_volumes() {
    const TetLocator locator(coarser_);
    for (int f = 0; f < static_cast<int>(part_.tets.size()); ++f) {
      const auto fine = corners_of(part_, f);
      const std::vector<int> near = locator.tets_near(box_of(fine));
      double rest = 1;  // part of it that no finer piece has given
      for (int piece = 0; piece < pieces_; ++piece) {
        double given = 0;
        for (const int c : near) {
          if (piece_of(index_of(c)) != piece) continue;
          const auto coarse = corners_of(coarser_, c);
          const double volume = rest * common_volume(fine, coarse);
          left_[index_of(c)] -= volume / volume_of_corners(coarse), given += volume;
        }
        covered_[static_cast<std::size_t>(piece)].volume += given;
        rest = std::max(0., rest - given / volume_of_corners(fine));
        result_.covered_volume += given;
      }
    }
    if (result_.covered_volume == 0)
      throw InputError("the part covers nothing of the coarser level: its first vertex is at " +
                       place_text(part_.vertices.front()) + "; expected meshes at one place");
  }

  // Leaves out what hangs over the part's skin, of tetrahedra that are covered in part
  void subtract_overhang(const Cover& cover) {
    for (std::size_t c = 0; c < left_.size(); ++c) {
      const double whole = coarser_.part(c);
      if (left_[c] > whole - part_rounding) left_[c] = whole;
      if (left_[c] < whole && left_[c] > part_rounding)
        left_[c] *= 1 - hanging_part(corners_of(coarser_, static_cast<int>(c)), cover,
                                     mean_edge_length(coarser_, static_cast<int>(c)));
      if (left_[c] < part_rounding) left_[c] = 0;
    }
  }

  // Returns which part of the rest of a tetrahedron hangs over the part's skin, by a lattice of
  // points; where all of these are in the part, by the corners
  static double hanging_part(const std::array<Point, 4>& x, const Cover& cover, double edge) {
    const Point centre = (x[0] + x[1] + x[2] + x[3]) / 4;
    double radius = 0;
    for (const Point& corner : x) radius = std::max(radius, (corner - centre).norm());
    if (cover.distance_to_skin(centre) > radius + edge) return 0;
    int rest = 0, hanging = 0;
    const auto look_at = [&](const Point& place) {
      if (cover.contains(place)) return;
      ++rest, hanging += cover.hangs_over_skin(place, edge) ? 1 : 0;
    };
    for (int i = 0; i < samples; ++i)
      for (int j = 0; i + j < samples; ++j)
        for (int k = 0; i + j + k < samples; ++k) {
          const double n = samples, a = (i + 0.25) / n, b = (j + 0.25) / n, c = (k + 0.25) / n;
          look_at(weighted({1 - a - b - c, a, b, c}, x));
        }
    for (std::size_t k = 0; k < 4 && rest == 0; ++k) look_at(x[k]);
    return rest == 0 ? 0 : static_cast<double>(hanging) / rest;
  }

  // Finds the tetrahedra that border vertices follow: of several those that are kept anyway
  void follow() {
    std::vector<std::unique_ptr<FoundAmong>> among;  // finest piece first; of each, kept ones first
    for (int piece = 0; piece < pieces_; ++piece)
      for (const double least : {least_part, -1.}) {
        std::vector<int> tets;
        for (std::size_t c = 0; c < left_.size(); ++c)
          if (piece_of(c) == piece && left_[c] >= least) tets.push_back(static_cast<int>(c));
        among.push_back(std::make_unique<FoundAmong>(coarser_, std::move(tets)));
      }
    std::vector<char> on_boundary(part_.vertices.size(), 0);
    for (const auto& t : boundary_)
      for (const int v : t) on_boundary[index_of(v)] = 1;
    for (const int v : border_) {
      const Located found = located(among, v);
      Weights weights = found.weights;
      double sum = 0;
      for (double& w : weights) sum += w = std::abs(w) < weight_rounding ? 0 : w;
      for (double& w : weights) w /= sum;
      of_.push_back(coarser_.tets[index_of(found.tet)]), weights_.push_back(weights);
      followed_.push_back(found.tet), on_boundary[index_of(v)] = 0;
      double& left = left_[index_of(found.tet)];
      left = std::max(left, least_part);
    }
    for (std::size_t v = 0; v < on_boundary.size(); ++v)
      if (on_boundary[v] != 0) located(among, static_cast<int>(v));
    expect_free_masters();
  }

  // Returns where a vertex of the part is in the coarser mesh
  Located located(const std::vector<std::unique_ptr<FoundAmong>>& among, int v) const {
    const Point& place = part_.vertices[index_of(v)];
    Located nearest;
    nearest.distance = std::numeric_limits<double>::infinity();
    for (const auto& some : among) {
      if (!some->locator) continue;
      Located found = some->locator->locate(place);
      found.tet = some->tet[index_of(found.tet)];
      if (found.distance < nearest.distance) nearest = found;
      if (found.distance == 0) break;
    }
    const double edges = nearest.distance / mean_edge_length(coarser_, nearest.tet);
    if (edges > 1)
      throw InputError("the part sticks out of the coarser level: its vertex at " +
                       place_text(place) + " is " + number(edges, 3) +
                       " of the coarser edges outside; expected 1 at most");
    return nearest;
  }

  // Throws InputError where a master follows another vertex: the next border is too near. A master
  // of no weight is replaced by another one.
  void expect_free_masters() {
    const std::vector<char> follows = follows_others(coarser_);
    if (follows.empty()) return;
    for (std::size_t i = 0; i < border_.size(); ++i) {
      const auto heaviest = std::ranges::max_element(weights_[i]) - weights_[i].begin();
      for (std::size_t k = 0; k < 4; ++k) {
        if (follows[index_of(of_[i][k])] == 0) continue;
        if (weights_[i][k] != 0) refuse_chain(i);
        of_[i][k] = of_[i][static_cast<std::size_t>(heaviest)];
      }
    }
  }

  [[noreturn]] void refuse_chain(std::size_t i) const {
    const Point& place = part_.vertices[index_of(border_[i])];
    double least = std::numeric_limits<double>::infinity();
    for (const int v : coarser_.followers.vertex)
      least = std::min(least, (coarser_.vertices[index_of(v)] - place).norm());
    throw InputError("the part's border at " + place_text(place) + " is " +
                     number(least / mean_edge_length(coarser_, followed_[i]), 2) +
                     " edges from the border of the next level; expected 1 or more");
  }

  // Joins the two meshes, all but their followers
  void join() {
    number_.assign(coarser_.vertices.size(), -1);
    for (std::size_t c = 0; c < left_.size(); ++c) {
      if (left_[c] < least_part) {
        ++covered_[static_cast<std::size_t>(piece_of(c))].dropped;
        continue;
      }
      kept_.push_back(static_cast<int>(c));
      if (left_[c] < coarser_.part(c)) ++result_.cut;
      for (const int v : coarser_.tets[c]) number_[index_of(v)] = 0;
    }
    result_.dropped = static_cast<int>(coarser_.tets.size() - kept_.size());
    TetMesh& mesh = result_.mesh = part_;
    for (std::size_t v = 0; v < number_.size(); ++v) {
      if (number_[v] < 0) continue;
      number_[v] = static_cast<int>(mesh.vertices.size());
      mesh.vertices.push_back(coarser_.vertices[v]);
    }
    bool whole = true;
    mesh.piece.assign(part_.tets.size(), 0), mesh.filled.assign(part_.tets.size(), 1);
    for (const int c : kept_) {
      mesh.tets.push_back(renumbered_tet(coarser_.tets[index_of(c)]));
      mesh.piece.push_back(1 + piece_of(index_of(c)));
      mesh.filled.push_back(left_[index_of(c)]), whole = whole && left_[index_of(c)] == 1;
    }
    if (whole) mesh.filled.clear();
    mesh.covered = covered_, mesh.covered.insert(mesh.covered.begin(), PieceCover{});
    join_regions(mesh);
    join_names(mesh);
  }

  std::array<int, 4> renumbered_tet(std::array<int, 4> tet) const {
    for (int& v : tet) v = number_[index_of(v)];
    return tet;
  }

  void join_regions(TetMesh& mesh) const {
    if (part_.region.empty() && coarser_.region.empty()) return;
    if (part_.region.empty()) mesh.region.assign(part_.tets.size(), 0), mesh.region_names = {""};
    const auto number_of = [&](const std::string& name) {
      const auto known = std::ranges::find(mesh.region_names, name);
      const auto number = static_cast<int>(known - mesh.region_names.begin());
      if (known == mesh.region_names.end()) mesh.region_names.push_back(name);
      return number;
    };
    std::vector<int> numbers;
    for (const std::string& name : coarser_.region_names) numbers.push_back(number_of(name));
    if (coarser_.region.empty()) numbers = {number_of("")};
    for (const int c : kept_)
      mesh.region.push_back(
          numbers[coarser_.region.empty() ? 0 : index_of(coarser_.region[index_of(c)])]);
  }

  void join_names(TetMesh& mesh) const {
    const std::size_t count = mesh.tets.size();
    for (const auto& [name, vectors] : coarser_.tet_vectors) mesh.tet_vectors.try_emplace(name);
    for (auto& [name, vectors] : mesh.tet_vectors) {
      vectors.resize(part_.tets.size(), Point::Zero());
      if (const auto own = coarser_.tet_vectors.find(name); own != coarser_.tet_vectors.end())
        for (const int c : kept_) vectors.push_back(own->second[index_of(c)]);
      vectors.resize(count, Point::Zero());
    }
    for (const auto& [name, set] : coarser_.vertex_sets)
      for (const int v : set)
        if (number_[index_of(v)] >= 0) mesh.vertex_sets[name].push_back(number_[index_of(v)]);
    for (const auto& [name, set] : coarser_.triangle_sets)
      for (auto triangle : set) {
        for (int& v : triangle) v = number_[index_of(v)];
        if (std::ranges::min(triangle) >= 0) mesh.triangle_sets[name].push_back(triangle);
      }
  }

  void add_followers() {
    Followers& all = result_.mesh.followers;
    all.vertex = border_, all.weight = weights_;
    for (const auto& masters : of_) all.of.push_back(renumbered_tet(masters));
    const Followers& before = coarser_.followers;
    for (std::size_t i = 0; i < before.vertex.size(); ++i) {
      const int own = number_[index_of(before.vertex[i])];
      if (own < 0) continue;
      all.vertex.push_back(own), all.weight.push_back(before.weight[i]);
      all.of.push_back(renumbered_tet(before.of[i]));
      if (std::ranges::min(all.of.back()) < 0)
        throw InputError("the part's border crosses that of the next level near " +
                         place_text(coarser_.vertices[index_of(before.vertex[i])]) +
                         "; expected it inside, an edge or more from it");
    }
    std::vector<double> volumes(result_.mesh.vertices.size(), 0);
    for (std::size_t t = 0; t < result_.mesh.tets.size(); ++t)
      for (const int v : result_.mesh.tets[t])
        volumes[index_of(v)] +=
            result_.mesh.part(t) * volume_of_corners(corners_of(result_.mesh, static_cast<int>(t)));
    give_to_masters(all, volumes);
    const std::vector<char> follows = follows_others(result_.mesh);
    for (std::size_t v = 0; v < volumes.size(); ++v)
      if (follows[v] == 0 && !(volumes[v] > 0))
        throw InputError("the part's border outside the coarser level leaves its vertex at " +
                         place_text(result_.mesh.vertices[v]) +
                         " without mass; expected a border inside it");
  }

  // Finds the faces of one tetrahedron that are no skin: the border, and those of coarser
  // tetrahedra whose neighbour is dropped, or that the part covers
  void add_inner_faces(const Cover& cover) {
    Triangles& faces = result_.mesh.inner_faces;
    for (std::size_t i = 0; i < boundary_.size(); ++i)
      if (inner_[i] != 0) faces.push_back(boundary_[i]);
    const Triangles skin = sorted_triangles(boundary_triangles(coarser_));
    TetMesh kept;
    kept.vertices = coarser_.vertices;
    std::vector<char> cut(coarser_.vertices.size(), 0);  // vertices of tetrahedra that are cut
    for (const int c : kept_) {
      kept.tets.push_back(coarser_.tets[index_of(c)]);
      if (left_[index_of(c)] < coarser_.part(index_of(c)))
        for (const int v : kept.tets.back()) cut[index_of(v)] = 1;
    }
    for (auto face : boundary_triangles(kept)) {
      auto key = face;
      std::ranges::sort(key);
      const bool may_be = std::ranges::all_of(face, [&](int v) { return cut[index_of(v)] != 0; });
      if (std::ranges::binary_search(skin, key) && !(may_be && is_covered(face, cover))) continue;
      for (int& v : face) v = number_[index_of(v)];
      faces.push_back(face);
    }
    faces = sorted_triangles(std::move(faces));
  }

  // Returns whether the part covers more than half of a face of the coarser mesh
  bool is_covered(const std::array<int, 3>& face, const Cover& cover) const {
    const Point &a = coarser_.vertices[index_of(face[0])],
                &b = coarser_.vertices[index_of(face[1])],
                &c = coarser_.vertices[index_of(face[2])];
    const double edge = ((b - a).norm() + (c - b).norm() + (a - c).norm()) / 3;
    int all = 0, covered = 0;
    for (int i = 0; i < samples; ++i)
      for (int j = 0; i + j < samples; ++j) {
        const double u = (i + 1 / 3.) / samples, v = (j + 1 / 3.) / samples;
        const Point place = a + u * (b - a) + v * (c - a);
        ++all, covered += cover.contains(place) || cover.hangs_over_skin(place, edge) ? 1 : 0;
      }
    return 2 * covered > all;
  }

  // Compares the volume of the composite mesh with that of the coarser one
  void check_volume() {
    double part = 0, change = 0;
    for (int f = 0; f < static_cast<int>(part_.tets.size()); ++f)
      part += volume_of_corners(corners_of(part_, f));
    change = part;
    for (std::size_t c = 0; c < left_.size(); ++c)
      change += ((left_[c] < least_part ? 0 : left_[c]) - coarser_.part(c)) *
                volume_of_corners(corners_of(coarser_, static_cast<int>(c)));
    const std::string sentence =
        "the part changes the volume by " + number(100 * change / part, 3) + " % of its own, " +
        number(part, 4) + " m^3: its skin is not that of the coarser level";
    if (std::abs(change) > wrong_volume * part)
      throw InputError(
          sentence +
          "; expected 10 % at most: meshes with one skin, or with border, the group of "
          "the part's vertices or triangles that is its border inside the body");
    if (std::abs(change) > doubtful_volume * part) result_.doubts.push_back(sentence);
  }

  void doubt_edges() {
    constexpr double most = 4;
    double coarse = 0;
    for (const int c : followed_)
      coarse += mean_edge_length(coarser_, c) / static_cast<double>(followed_.size());
    const double ratio = coarse / mean_edge_length(part_);
    if (ratio < 1 || ratio > most)
      result_.doubts.push_back("the part has edges of " + number(mean_edge_length(part_), 3) +
                               " m and its border lies in coarser ones of " + number(coarse, 3) +
                               " m; expected coarser ones 1 to 4 times as long");
  }
};

}  // namespace

Composite compose(const PartMesh& part, const TetMesh& coarser, const std::string& border) {
  return Composer(part, coarser, border).made();
}

}  // namespace plica
