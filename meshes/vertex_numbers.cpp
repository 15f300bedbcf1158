// SPDX-License-Identifier: BSD-3-Clause
#include <plica/meshes/vertex_numbers.hpp>
#include <sstream>

namespace plica {

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
  const auto found = index_.find(tag);
  if (found == index_.end())
    refuse(raw_.file, place, who() + " names node " + std::to_string(tag) + ", which the file does not define");
  return found->second;
}

}  // namespace plica
