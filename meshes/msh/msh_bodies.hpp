// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <map>
#include <plica/meshes/msh/msh_gather.hpp>
#include <string>
#include <utility>
#include <vector>

namespace plica {

/// The nodes of MSH 2.2, the same in text and in binary: `count` times tag, x, y, z.
void msh2_nodes(std::int64_t count, Numbers& numbers, MshGather& gather);
/// The elements of MSH 2.2: in text each with its type and number of tags, in binary in blocks of one type.
void msh2_elements(std::int64_t count, bool binary, Numbers& numbers, MshGather& gather);

/// The sections of MSH 4.1, the same in text and in binary. Entities are parts of the geometry, or of one partition of
/// it; blocks of elements lie in one entity, and so in its physical groups.
class Msh4Bodies {
 public:
  void entities(Numbers& numbers) { read_entities(false, numbers); }
  void partitioned_entities(Numbers& numbers);
  /// Returns how many, as "5 nodes"
  std::string nodes(Numbers& numbers, MshGather& gather) const;
  std::string elements(Numbers& numbers, MshGather& gather) const;

 private:
  using Entity = std::pair<std::int64_t, std::int64_t>;  // dimension, tag
  void read_entities(bool partitioned, Numbers& numbers);
  void read_entity(std::int64_t dimension, bool partitioned, Numbers& numbers, std::map<Entity, std::size_t>& here);
  const std::vector<std::int64_t>& groups_of(const Entity& entity, const Numbers& numbers) const;

  bool known_ = false;
  std::map<Entity, std::vector<std::int64_t>> groups_;
};

}  // namespace plica
