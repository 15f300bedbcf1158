// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/meshes/files/raw_mesh.hpp>
#include <set>
#include <sstream>

namespace plica {

Point RawVectors::at(std::int64_t tag) const {
  if (place.empty()) return values[static_cast<std::size_t>(tag)];
  const auto found = place.find(tag);
  return found == place.end() ? Point(Point::Zero()) : values[found->second];
}

void name_regions(RawMesh& raw, const std::vector<std::int64_t>& numbers,
                  const std::function<std::string(std::int64_t)>& name_of) {
  const std::set<std::int64_t> used(numbers.begin(), numbers.end());
  if (used.empty() || (used.size() == 1 && used.contains(0))) return;
  std::map<std::string, int> index;
  std::map<std::int64_t, int> region;
  for (const std::int64_t number : used) {
    const auto [found, is_new] = index.try_emplace(name_of(number), static_cast<int>(index.size()));
    region[number] = found->second;
    if (is_new) raw.region_names.push_back(found->first), raw.region_tags.push_back(number);
  }
  for (std::size_t t = 0; t < raw.tets.size(); ++t) raw.tets[t].region = region.at(numbers[t]);
}

VertexNumbers::VertexNumbers(const RawMesh& raw) : raw_(raw) {
  const std::string& file = raw.vertex_file.empty() ? raw.file : raw.vertex_file;
  index_.reserve(raw.vertices.size());
  for (std::size_t v = 0; v < raw.vertices.size(); ++v) {
    const RawVertex& vertex = raw.vertices[v];
    const auto who = [&] { return "node " + std::to_string(vertex.tag); };
    if (!vertex.position.allFinite()) {
      std::ostringstream where;
      where << vertex.position.transpose();
      refuse(file, vertex.place, who() + " is at " + where.str() + "; it must be finite");
    }
    const auto [first, is_new] = index_.try_emplace(vertex.tag, static_cast<int>(v));
    if (is_new) continue;
    const std::string before = to_text(raw.vertices[static_cast<std::size_t>(first->second)].place);
    refuse(file, vertex.place, who() + " is defined again" + (before.empty() ? "" : " (first " + before + ")"));
  }
}

int VertexNumbers::at(std::int64_t tag, const Place& place, const std::function<std::string()>& who) const {
  const int found = find(tag);
  if (found < 0)
    refuse(raw_.file, place, who() + " names node " + std::to_string(tag) + ", which the file does not define");
  return found;
}

int VertexNumbers::find(std::int64_t tag) const {
  const auto found = index_.find(tag);
  return found == index_.end() ? -1 : found->second;
}

const ElementKind& taken_kind(std::span<const ElementKind> kinds, std::int64_t type,
                              const std::function<std::string()>& who, const std::string& file, const Place& place) {
  const auto kind = std::find_if(kinds.begin(), kinds.end(), [&](const ElementKind& k) { return k.type == type; });
  if (kind != kinds.end() && kind->corners != not_taken) return *kind;
  refuse(file, place,
         who() + " has type " + std::to_string(type) + (kind != kinds.end() ? ", a " + std::string(kind->name) : "") +
             "; supported are tetrahedra, hexahedra, prisms, pyramids and elements of lower dimension");
}

void BadFaces::add(const Place& where, const std::string& what) {
  if (count++ == 0) place = where, message = what;
}

MeshGroups renumbered(const MeshGroups& groups, const std::vector<int>& renumbered) {
  MeshGroups result = groups;
  for (ElementGroup& group : result.sets) {
    const auto corners = static_cast<std::size_t>(group.dimension) + 1;
    std::erase_if(group.elements, [&](std::array<int, 3>& element) {
      for (std::size_t k = 0; k < corners; ++k) {
        element[k] = renumbered[static_cast<std::size_t>(element[k])];
        if (element[k] < 0 || std::count(element.begin(), element.begin() + k, element[k]) > 0) return true;
      }
      return false;
    });
  }
  return result;
}

}  // namespace plica
