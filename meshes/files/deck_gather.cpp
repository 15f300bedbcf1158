// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/meshes/files/deck_gather.hpp>
#include <set>

namespace plica {

void DeckGather::add_node(std::int64_t tag, const Point& position, const Place& place) {
  raw_.vertices.push_back({tag, position, place});
  defined_.insert(tag);
}

std::size_t DeckGather::add_element(DeckElement element) {
  const auto [found, is_new] = index_.try_emplace(element.tag, elements_.size());
  if (!is_new)
    refuse(raw_.file, element.place,
           "element " + std::to_string(element.tag) + " is defined again (first " +
               to_text(elements_[found->second].place) + ")");
  elements_.push_back(std::move(element));
  return elements_.size() - 1;
}

std::size_t DeckGather::element(std::int64_t tag, const std::string& who,
                                const Place& place) const {
  const auto found = index_.find(tag);
  if (found == index_.end())
    refuse(raw_.file, place,
           who + " names element " + std::to_string(tag) + ", which the file does not define");
  return found->second;
}

RawGroup& DeckGather::group(const std::string& name, int dimension) {
  for (RawGroup& one : raw_.groups)
    if (one.name == name && one.dimension == dimension) return one;
  return raw_.groups.emplace_back(RawGroup{name, dimension, 0, {}});
}

void DeckGather::add_nodes(const std::string& set, const std::vector<std::int64_t>& nodes,
                           const Place& place) {
  RawGroup& points = group(set, 0);
  for (const std::int64_t node : nodes) {
    if (!defined_.contains(node))
      refuse(raw_.file, place,
             "the node set " + shown(set) + " names node " + std::to_string(node) +
                 ", which the file does not define");
    points.elements.push_back({node, {node, node, node}, 0, place});
  }
}

void DeckGather::add_face(const std::string& set, std::span<const std::int64_t> corners,
                          const Place& place) {
  const auto size = static_cast<int>(corners.size());
  const int dimension = size == 2 ? 1 : 2;
  add_to_group({0, "face", dimension, size, size}, 0, corners, place, group(set, dimension));
}

void DeckGather::add_elements(const std::string& set, std::vector<std::size_t> elements,
                              bool has_material) {
  for (const std::size_t e : elements) {
    const DeckElement& one = elements_[e];
    if (one.kind->dimension < 3)
      add_to_group(*one.kind, one.tag, one.nodes, one.place, group(set, one.kind->dimension));
  }
  std::erase_if(elements, [this](std::size_t e) { return !is_cell(e); });
  if (!elements.empty()) sets_.push_back({set, std::move(elements), has_material});
}

// Finds the sets that can be regions together, and gives their cells numbers from 1
std::vector<const DeckGather::Set*> DeckGather::regions(bool with_material, std::size_t cells,
                                                        std::vector<std::int64_t>& region_of,
                                                        std::string& unused) const {
  const bool smaller = std::ranges::any_of(sets_, [&](const Set& set) {
    return set.has_material == with_material && set.elements.size() < cells;
  });
  std::vector<const Set*> taken;
  region_of.assign(elements_.size(), 0);
  for (const Set& set : sets_) {
    if (set.has_material != with_material) continue;
    const bool shares =
        std::ranges::any_of(set.elements, [&](std::size_t e) { return region_of[e] != 0; });
    if (shares || (smaller && set.elements.size() == cells)) {
      unused += (unused.empty() ? "" : ", ") + shown(set.name);
      continue;
    }
    taken.push_back(&set);
    for (const std::size_t e : set.elements) region_of[e] = static_cast<std::int64_t>(taken.size());
  }
  return taken;
}

// Takes the sets that become regions, and offers their numbers for the regions
void DeckGather::choose_sets(ParsedMesh& raw) {
  std::size_t cells = 0;
  for (std::size_t e = 0; e < elements_.size(); ++e) cells += is_cell(e);
  std::vector<std::int64_t> region_of, of_others;
  std::string unused, unused_others;
  std::vector<const Set*> taken = regions(true, cells, region_of, unused),
                          others = regions(false, cells, of_others, unused_others);
  const auto count_regions = [&](const std::vector<std::int64_t>& numbers) {
    std::set<std::int64_t> used;
    for (std::size_t e = 0; e < elements_.size(); ++e)
      if (is_cell(e)) used.insert(numbers[e]);
    return used.size();
  };
  if (taken.empty() || (count_regions(region_of) < 2 && count_regions(of_others) > 1))
    taken = others, region_of = of_others, unused = unused_others;
  if (!unused.empty())
    report_.notes.push_back("element sets that share cells with other regions are no regions: " +
                            unused);
  if (taken.empty()) return;
  std::vector<std::string> names = {"unassigned"};
  for (const Set* set : taken) names.push_back(set->name);
  RawNumbers numbers;
  numbers.name = "element sets", numbers.own = true;
  numbers.name_of = [names](std::int64_t number) {
    return names[static_cast<std::size_t>(number)];
  };
  for (const RawTet& tet : raw.tets) numbers.values.push_back(region_of[index_.at(tet.tag)]);
  raw.numbers.push_back(std::move(numbers));
}

ParsedMesh DeckGather::take() {
  for (const DeckElement& one : elements_)
    plica::add_element(*one.kind, one.tag, one.nodes, one.place, raw_, report_);
  choose_sets(raw_);
  return std::move(raw_);
}

}  // namespace plica
