// SPDX-License-Identifier: BSD-3-Clause
#include <plica/meshes/msh/msh_bodies.hpp>

namespace plica {

namespace {

void read_element(const ElementKind& kind, std::int64_t tag, std::int64_t tags, const Place& place, Numbers& numbers,
                  MshGather& gather) {
  const std::int64_t group = tags > 0 ? physical_tag(numbers) : 0;
  for (std::int64_t t = 1; t < tags; ++t) numbers.integer(NumberType::int32, "a tag of an element");
  gather.add_element(kind, tag, {&group, 1}, NumberType::int32, numbers, place);
}

std::int64_t read_tags(Numbers& numbers) {
  return numbers.count(NumberType::int32, "the number of tags of an element", NumberType::int32, 1);
}

}  // namespace

void msh2_nodes(std::int64_t count, Numbers& numbers, MshGather& gather) {
  for (std::int64_t i = 1; i <= count; ++i) {
    numbers.begin("node", i, count);
    const std::int64_t tag = msh_tag(NumberType::int32, "the tag of a node", numbers);
    gather.add_node(tag, numbers, numbers.place());
    numbers.end("a node: its tag and three coordinates");
  }
}

void msh2_elements(std::int64_t count, bool binary, Numbers& numbers, MshGather& gather) {
  constexpr NumberType type = NumberType::int32;
  for (std::int64_t done = 0; done < count;) {
    numbers.begin("element", done + 1, count);
    std::int64_t tag = binary ? 0 : numbers.integer(type, "the tag of an element");
    const Place place = numbers.place();
    const std::int64_t code = numbers.integer(type, "the type of an element");
    const auto who = [&] { return binary ? "a block of elements" : "element " + std::to_string(tag); };
    const ElementKind& kind = taken_element(code, who, numbers);
    if (!binary) {
      read_element(kind, tag, read_tags(numbers), place, numbers, gather);
      ++done;
      continue;
    }
    const std::int64_t block = numbers.integer(type, "the number of elements of a block");
    if (block < 1 || block > count - done)
      numbers.fail("the number of elements of a block is " + std::to_string(block) + "; it must be 1 to " +
                   std::to_string(count - done) + ", as there are " + std::to_string(count) + " in all");
    const std::int64_t tags = read_tags(numbers);
    for (std::int64_t i = 0; i < block; ++i, ++done) {
      tag = numbers.integer(type, "the tag of an element");
      read_element(kind, tag, tags, numbers.place(), numbers, gather);
    }
  }
}

}  // namespace plica
