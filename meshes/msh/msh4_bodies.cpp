// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/meshes/msh/msh_bodies.hpp>

namespace plica {

namespace {

constexpr NumberType tag_type = NumberType::int32, size_type = NumberType::uint64, real = NumberType::float64;
constexpr const char* dimension_names[] = {"point", "curve", "surface", "volume"};

std::int64_t read_dimension(Numbers& numbers) {
  const std::int64_t dimension = numbers.integer(tag_type, "the dimension of an entity");
  if (dimension < 0 || dimension > 3)
    numbers.fail("the dimension of an entity is " + std::to_string(dimension) + "; it must be 0 to 3");
  return dimension;
}

// Blocks and what they hold: their number, that of all nodes or elements, the smallest and largest tag
struct Blocks {
  std::int64_t blocks = 0, total = 0;
};
Blocks read_blocks(const std::string& what, std::int64_t fewest, Numbers& numbers) {
  numbers.begin("the number of blocks of " + what);
  Blocks header;
  header.blocks = numbers.count(size_type, "the number of blocks of " + what, tag_type, 4);
  header.total = numbers.count(size_type, "the number of " + what, tag_type, fewest);
  numbers.skip(2, size_type, "the smallest and largest tag");
  numbers.end("the number of blocks and of " + what + ", the smallest and the largest tag");
  return header;
}

// Of a block, after which `done` are read
std::int64_t read_size(const std::string& what, std::int64_t done, const Blocks& all, Numbers& numbers) {
  const std::int64_t size = numbers.integer(size_type, "the number of " + what + " of a block");
  if (size < 0 || size > all.total - done)
    numbers.fail("the number of " + what + " of a block is " + std::to_string(size) + "; it must be 0 to " +
                 std::to_string(all.total - done) + ", as there are " + std::to_string(all.total) + " in all");
  return size;
}

void check_total(const std::string& what, std::int64_t done, const Blocks& all, const Numbers& numbers) {
  if (done != all.total)
    numbers.fail("the blocks hold " + std::to_string(done) + " " + what + " and not " + std::to_string(all.total));
}

}  // namespace

void Msh4Bodies::read_entity(std::int64_t dimension, bool partitioned, Numbers& numbers,
                             std::map<Entity, std::size_t>& here) {
  numbers.begin("an entity");
  const Entity entity(dimension, numbers.integer(tag_type, "the tag of an entity"));
  const std::string who = dimension_names[dimension] + (" " + std::to_string(entity.second));
  if (!here.try_emplace(entity, here.size()).second) numbers.fail(who + " is defined again");
  if (partitioned) {
    numbers.skip(2, tag_type, "the dimension and tag of the parent");
    const auto partitions = numbers.count(size_type, "the number of partitions of an entity", tag_type, 1);
    numbers.skip(partitions, tag_type, "a partition");
  }
  for (int i = 0; i < (dimension == 0 ? 3 : 6); ++i) numbers.number(real, "a coordinate of an entity");
  std::vector<std::int64_t>& groups = groups_[entity];
  groups.clear();
  const auto count = numbers.count(size_type, "the number of physical groups of an entity", tag_type, 1);
  for (std::int64_t i = 0; i < count; ++i) groups.push_back(physical_tag(numbers));
  std::sort(groups.begin(), groups.end());
  groups.erase(std::unique(groups.begin(), groups.end()), groups.end());
  if (dimension == 3 && groups.size() > 1)
    numbers.fail(who + " belongs to the physical groups " + std::to_string(groups[0]) + " and " +
                 std::to_string(groups[1]) + "; an element belongs in one group of volumes only");
  if (dimension > 0) {
    const auto boundary = numbers.count(size_type, "the number of parts of the boundary of an entity", tag_type, 1);
    numbers.skip(boundary, tag_type, "a part of the boundary");
  }
  numbers.end("an entity");
}

void Msh4Bodies::read_entities(bool partitioned, Numbers& numbers) {
  known_ = true;
  numbers.begin("the numbers of points, curves, surfaces and volumes");
  std::int64_t counts[4];
  for (std::size_t d = 0; d < 4; ++d)
    counts[d] = numbers.count(size_type, "the number of entities", tag_type, d == 0 ? 8 : 16);
  numbers.end("the numbers of points, curves, surfaces and volumes");
  std::map<Entity, std::size_t> here;
  for (std::int64_t d = 0; d < 4; ++d)
    for (std::int64_t i = 0; i < counts[d]; ++i) read_entity(d, partitioned, numbers, here);
}

void Msh4Bodies::partitioned_entities(Numbers& numbers) {
  numbers.begin("the number of partitions");
  numbers.integer(size_type, "the number of partitions");
  numbers.end("the number of partitions");
  numbers.begin("the number of ghost entities");
  const auto ghosts = numbers.count(size_type, "the number of ghost entities", tag_type, 2);
  numbers.end("the number of ghost entities");
  for (std::int64_t i = 1; i <= ghosts; ++i) {
    numbers.begin("ghost entity", i, ghosts);
    numbers.skip(2, tag_type, "the tag and partition of a ghost entity");
    numbers.end("a ghost entity");
  }
  read_entities(true, numbers);
}

std::string Msh4Bodies::nodes(Numbers& numbers, MshGather& gather) const {
  const Blocks all = read_blocks("nodes", 4, numbers);
  std::int64_t done = 0;
  std::vector<std::pair<std::int64_t, Place>> tags;
  for (std::int64_t b = 1; b <= all.blocks; ++b) {
    numbers.begin("block of nodes", b, all.blocks);
    const std::int64_t dimension = read_dimension(numbers);
    numbers.integer(tag_type, "the tag of an entity");
    const std::int64_t parametric = numbers.integer(tag_type, "whether nodes are parametric");
    if (parametric != 0 && parametric != 1)
      numbers.fail("whether nodes are parametric is " + std::to_string(parametric) + "; it must be 0 or 1");
    const std::int64_t size = read_size("nodes", done, all, numbers);
    numbers.end("a block of nodes: dimension and tag of its entity, 0 or 1, number of nodes");
    tags.clear();
    for (std::int64_t i = 1; i <= size; ++i) {
      numbers.begin("node", done + i, all.total);
      const std::int64_t tag = msh_tag(size_type, "the tag of a node", numbers);
      tags.emplace_back(tag, numbers.place());
      numbers.end("the tag of a node");
    }
    for (const auto& [tag, place] : tags) {
      numbers.begin("the coordinates of node", ++done, all.total);
      gather.add_node(tag, numbers, place);
      if (parametric == 1) numbers.skip(dimension, real, "a parametric coordinate");
      numbers.end("the coordinates of a node");
    }
  }
  check_total("nodes", done, all, numbers);
  return std::to_string(done) + " nodes";
}

const std::vector<std::int64_t>& Msh4Bodies::groups_of(const Entity& entity, const Numbers& numbers) const {
  static const std::vector<std::int64_t> none;
  if (!known_) return none;  // a file without $Entities has no groups
  const auto found = groups_.find(entity);
  if (found == groups_.end())
    numbers.fail("a block of elements is in " +
                 (dimension_names[entity.first] + (" " + std::to_string(entity.second))) +
                 ", which the file does not define");
  return found->second;
}

std::string Msh4Bodies::elements(Numbers& numbers, MshGather& gather) const {
  const auto who = [] { return std::string("a block of elements"); };
  const Blocks all = read_blocks("elements", 2, numbers);
  std::int64_t done = 0;
  for (std::int64_t b = 1; b <= all.blocks; ++b) {
    numbers.begin("block of elements", b, all.blocks);
    const std::int64_t dimension = read_dimension(numbers);
    const std::int64_t tag = numbers.integer(tag_type, "the tag of an entity");
    const auto& groups = groups_of({dimension, tag}, numbers);
    const ElementKind& kind = taken_element(numbers.integer(tag_type, "the type of elements"), who, numbers);
    if (kind.dimension != dimension)
      numbers.fail("a block of elements of dimension " + std::to_string(kind.dimension) +
                   " is in an entity of dimension " + std::to_string(dimension));
    const std::int64_t size = read_size("elements", done, all, numbers);
    numbers.end("a block of elements: dimension and tag of its entity, type and number of elements");
    for (std::int64_t i = 0; i < size; ++i) {
      numbers.begin("element", ++done, all.total);
      const std::int64_t element = numbers.integer(size_type, "the tag of an element");
      gather.add_element(kind, element, groups, size_type, numbers, numbers.place());
    }
  }
  check_total("elements", done, all, numbers);
  return std::to_string(done) + " elements";
}

}  // namespace plica
