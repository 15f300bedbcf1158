// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <plica/core/error.hpp>
#include <plica/core/text.hpp>
#include <plica/meshes/boundary_triangles.hpp>
#include <plica/meshes/checked.hpp>
#include <plica/meshes/embedding.hpp>
#include <plica/meshes/files/parsed_mesh.hpp>
#include <plica/meshes/files/regions.hpp>
#include <plica/meshes/files/split_second_order.hpp>
#include <plica/meshes/files/validated_mesh.hpp>
#include <set>
#include <sstream>
#include <utility>

namespace plica {

namespace {

constexpr double flat = 1e-9;  // six times the volume over the longest edge cubed

template <typename... Parts>
[[noreturn]] void refuse(const ParsedMesh& raw, const Place& place, const Parts&... parts) {
  std::ostringstream text;
  text.precision(12);
  (text << ... << parts);
  refuse(raw.file, place, text.str());
}

std::string nodes(const RawTet& tet) {
  std::string text;
  for (const std::int64_t v : tet.vertices) text += (text.empty() ? "" : " ") + std::to_string(v);
  return text;
}

std::array<int, 4> sorted(std::array<int, 4> tet) {
  std::sort(tet.begin(), tet.end());
  return tet;
}

void refuse_flat(const ParsedMesh& raw, const RawTet& tet, const std::array<Point, 4>& corners,
                 double volume) {
  double longest = 0.0;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < 4; ++j)
      longest = std::max(longest, (corners[j] - corners[i]).norm());
  if (!(std::abs(6.0 * volume) > flat * longest * longest * longest))
    refuse(raw, tet.place, "tetrahedron ", tet.tag, " (nodes ", nodes(tet),
           ") has no volume: ", volume, " for a longest edge of ", longest);
}

// Adds the tetrahedra, and turns those that are inside out. Their vertices are indices in
// raw.vertices: vertices of no tetrahedron are dropped later.
void add_tets(const ParsedMesh& raw, const VertexNumbers& numbering, Flaws flaws, TetMesh& mesh,
              MeshReport& report) {
  mesh.tets.reserve(raw.tets.size());
  for (const RawTet& tet : raw.tets) {
    std::array<int, 4> v;
    for (std::size_t k = 0; k < 4; ++k)
      v[k] = numbering.at(tet.vertices[k], tet.place,
                          [&] { return "tetrahedron " + std::to_string(tet.tag); });
    const auto ascending = sorted(v);
    if (std::adjacent_find(ascending.begin(), ascending.end()) != ascending.end()) {
      if (flaws == Flaws::refused)
        refuse(raw, tet.place, "tetrahedron ", tet.tag, " names a node twice: ", nodes(tet));
      ++report.collapsed;
      continue;
    }
    mesh.tets.push_back(v);
    const auto corners = corners_of(mesh, static_cast<int>(mesh.tets.size()) - 1);
    const double volume = tet_volume(corners[0], corners[1], corners[2], corners[3]);
    if (flaws == Flaws::refused) refuse_flat(raw, tet, corners, volume);
    if (volume < 0.0) std::swap(mesh.tets.back()[2], mesh.tets.back()[3]), ++report.flipped;
    if (!raw.region_names.empty()) mesh.region.push_back(tet.region);
    report.tet_tags.push_back(tet.tag);
  }
}

// Refuses a folded cell, whose pieces have volumes of both signs. A cell that is only inside out
// has pieces of one sign.
void refuse_folded(const ParsedMesh& raw, const VertexNumbers& numbering) {
  const auto nobody = [] { return std::string(); };
  for (std::size_t c = 0; c < raw.cut.size(); c += 2) {
    bool above = false, below = false;
    for (std::size_t t = raw.cut[c]; t < raw.cut[c + 1]; ++t) {
      const RawTet& tet = raw.tets[t];
      const auto at = [&](std::size_t k) -> const Point& {
        return raw
            .vertices[static_cast<std::size_t>(numbering.at(tet.vertices[k], tet.place, nobody))]
            .position;
      };
      (tet_volume(at(0), at(1), at(2), at(3)) < 0 ? below : above) = true;
    }
    const RawTet& first = raw.tets[raw.cut[c]];
    if (above && below)
      refuse(raw, first.place, "element ", first.tag,
             " is folded: cut into tetrahedra, some would be inside out",
             raw.second_order.empty() ? "" : "; order: linear takes its corners alone");
  }
}

void drop_repeats(TetMesh& mesh, MeshReport& report) {
  std::set<std::array<int, 4>> seen;
  std::size_t kept = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (!seen.insert(sorted(mesh.tets[t])).second) continue;
    mesh.tets[kept] = mesh.tets[t];
    if (!mesh.region.empty()) mesh.region[kept] = mesh.region[t];
    report.tet_tags[kept++] = report.tet_tags[t];
  }
  report.repeated = static_cast<int>(mesh.tets.size() - kept);
  mesh.tets.resize(kept), report.tet_tags.resize(kept);
  if (!mesh.region.empty()) mesh.region.resize(kept);
}

void refuse_repeats(const ParsedMesh& raw, const TetMesh& mesh) {
  std::vector<std::pair<std::array<int, 4>, std::size_t>> keys;
  keys.reserve(mesh.tets.size());
  for (const auto& tet : mesh.tets) keys.emplace_back(sorted(tet), keys.size());
  std::sort(keys.begin(), keys.end());
  std::size_t first = 0, again = keys.size();  // the first repeat in the file
  for (std::size_t k = 1; k < keys.size(); ++k)
    if (keys[k].first == keys[k - 1].first && keys[k].second < again)
      first = keys[k - 1].second, again = keys[k].second;
  if (again == keys.size()) return;
  const RawTet &one = raw.tets[first], &other = raw.tets[again];
  refuse(raw, other.place, "tetrahedron ", other.tag, " repeats tetrahedron ", one.tag, " ",
         to_text(one.place), " (nodes ", nodes(one),
         "); an element belongs in one group of volumes only");
}

/// Refuses tetrahedra that overlap at a face. Call it after refuse_repeats(), while the tetrahedra
/// of the mesh are those of the file, in its order.
void refuse_overlaps(const ParsedMesh& raw, const TetMesh& mesh) {
  const std::vector<std::size_t> found = overlap_at_a_face(mesh);
  if (found.empty()) return;
  const RawTet &one = raw.tets[found[0]], &two = raw.tets[found[1]];
  if (found.size() == 2)
    refuse(raw, two.place, "tetrahedron ", two.tag,
           " lies on the same side of a face as tetrahedron ", one.tag, " ", to_text(one.place),
           ", which has it too; expected tetrahedra that do not overlap: a vertex may be out of "
           "place");
  const RawTet& three = raw.tets[found[2]];
  refuse(raw, three.place, "tetrahedron ", three.tag, " shares a face with tetrahedra ", one.tag,
         " and ", two.tag, ", which share it already; expected tetrahedra that do not overlap");
}

void add_sets(const ParsedMesh& raw, const VertexNumbers& numbering, TetMesh& mesh,
              MeshReport& report) {
  const auto element = [] { return "an element"; };
  for (const RawTriangle& triangle : raw.triangles)
    for (const std::int64_t v : triangle.vertices) numbering.at(v, triangle.place, element);
  for (const RawPolygon& polygon : raw.polygons)
    for (const std::int64_t v : polygon.corners) numbering.at(v, polygon.place, element);
  for (const RawMention& mention : raw.others) numbering.at(mention.vertex, mention.place, element);
  for (const RawGroup& raw_group : raw.groups) {
    ElementGroup& group = report.groups.sets.emplace_back(
        ElementGroup{raw_group.name, raw_group.dimension, raw_group.tag, {}});
    std::vector<int>& set = mesh.vertex_sets[group.name];
    for (const RawTriangle& raw_element : raw_group.elements) {
      std::array<int, 3>& v = group.elements.emplace_back(std::array<int, 3>{-1, -1, -1});
      for (std::size_t k = 0; k <= static_cast<std::size_t>(group.dimension); ++k)
        set.push_back(v[k] = numbering.at(raw_element.vertices[k], raw_element.place, element));
    }
  }
  for (auto& [name, set] : mesh.vertex_sets) {
    std::sort(set.begin(), set.end());
    set.erase(std::unique(set.begin(), set.end()), set.end());
  }
}

// Counts the middles of edges and faces that no tetrahedron of the mesh uses: they are not reported
// as unreferenced, as elements of the file use them
int count_middles(const ParsedMesh& raw, const VertexNumbers& numbering,
                  const std::vector<int>& number) {
  std::set<int> middles;
  for (const RawMention& mention : raw.middles) {
    const int v =
        numbering.at(mention.vertex, mention.place, [] { return std::string("an element"); });
    if (number[static_cast<std::size_t>(v)] < 0) middles.insert(v);
  }
  return static_cast<int>(middles.size());
}

void drop_unreferenced(const ParsedMesh& raw, const VertexNumbers& numbering, TetMesh& mesh,
                       MeshReport& report) {
  std::vector<int> number(mesh.vertices.size(), -1);
  for (const auto& tet : mesh.tets)
    for (const int v : tet) number[static_cast<std::size_t>(v)] = 0;
  std::size_t kept = 0;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] < 0) continue;
    number[v] = static_cast<int>(kept);
    mesh.vertices[kept++] = mesh.vertices[v];
    report.vertex_tags.push_back(raw.vertices[v].tag);
  }
  report.unreferenced =
      static_cast<int>(mesh.vertices.size() - kept) - count_middles(raw, numbering, number);
  report.groups = renumbered(report.groups, number);
  mesh.vertices.resize(kept);
  for (auto& tet : mesh.tets)
    for (int& v : tet) v = number[static_cast<std::size_t>(v)];
  for (auto& [name, set] : mesh.vertex_sets) {
    for (int& v : set) v = number[static_cast<std::size_t>(v)];
    std::erase(set, -1);
  }
}

// Adds the named vectors: each tetrahedron gets that of its cell, or the mean of its corners. Of
// two fields with one name the first is used. Call it after all numbers are final.
void add_vectors(const ParsedMesh& raw, TetMesh& mesh, const MeshReport& report) {
  for (const RawVectors& field : raw.vectors) {
    const auto [place, is_new] = mesh.tet_vectors.try_emplace(field.name);
    for (std::size_t t = 0; is_new && t < mesh.tets.size(); ++t) {
      Point mean = Point::Zero();
      for (const int v : mesh.tets[t])
        mean += field.at(field.of_vertices ? report.vertex_tags[static_cast<std::size_t>(v)]
                                           : report.tet_tags[t]);
      place->second.push_back(mean / 4);
    }
  }
}

// Adds the parts of the tetrahedra that are body. Call it after all numbers are final.
void add_filled(const ParsedMesh& raw, TetMesh& mesh, const MeshReport& report) {
  if (raw.filled.values.empty()) return;
  for (const std::int64_t tag : report.tet_tags) {
    const double part = raw.filled.at(tag).x();
    if (!(part > 0 && part <= 1))
      refuse(raw, {}, "tetrahedron ", tag, " is filled to ", part, "; expected a part in (0, 1]");
    mesh.filled.push_back(part);
  }
}

// Names the triangles of the groups that have some. Call it after all names and numbers are final.
void add_triangle_sets(const MeshGroups& groups, TetMesh& mesh) {
  for (const ElementGroup& group : groups.sets)
    if (group.dimension == 2) {
      auto& set = mesh.triangle_sets[group.name];
      set.insert(set.end(), group.elements.begin(), group.elements.end());
    }
  std::erase_if(mesh.triangle_sets, [](const auto& set) { return set.second.empty(); });
}

// Converts the names of groups to UTF-8: files have them in any encoding. A name that a region and
// a set share stays a shared one.
void name_in_utf8(TetMesh& mesh, MeshGroups& groups) {
  std::vector<std::string> names = mesh.region_names;
  for (const auto& [name, set] : mesh.vertex_sets) names.push_back(name);
  const std::map<std::string, std::string> valid = valid_names(names);
  for (std::string& name : mesh.region_names) name = valid.at(name);
  std::map<std::string, std::vector<int>> sets;
  for (auto& [name, set] : mesh.vertex_sets) sets[valid.at(name)] = std::move(set);
  mesh.vertex_sets = std::move(sets);
  for (ElementGroup& group : groups.sets) group.name = valid.at(group.name);
}

}  // namespace

TetMesh validated_mesh(ParsedMesh raw, MeshReport& report, const ReadOptions& options) {
  if (raw.tets.empty()) refuse(raw, {}, "the file holds no tetrahedron");
  choose_regions(raw, options.regions, report);
  leave_out_regions(raw, options.leave_out, report);
  if (options.order == SecondOrder::split) split_second_order(raw, report);
  checked_count("the number of vertices", static_cast<double>(raw.vertices.size()));
  checked_count("the number of tetrahedra", static_cast<double>(raw.tets.size()));

  const VertexNumbers numbering(raw);
  const Flaws flaws = options.flaws;
  TetMesh mesh;
  mesh.region_names = raw.region_names;
  mesh.vertices.reserve(raw.vertices.size());
  for (const RawVertex& vertex : raw.vertices) mesh.vertices.push_back(vertex.position);
  report.groups.region_tags = raw.region_tags;
  add_tets(raw, numbering, flaws, mesh, report);
  refuse_folded(raw, numbering);
  flaws == Flaws::refused ? refuse_repeats(raw, mesh) : drop_repeats(mesh, report);
  if (flaws == Flaws::refused) refuse_overlaps(raw, mesh);
  add_sets(raw, numbering, mesh, report);
  drop_unreferenced(raw, numbering, mesh, report);
  add_vectors(raw, mesh, report);
  add_filled(raw, mesh, report);
  name_in_utf8(mesh, report.groups);
  add_triangle_sets(report.groups, mesh);
  return mesh;
}

}  // namespace plica
