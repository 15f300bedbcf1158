// SPDX-License-Identifier: BSD-3-Clause
#include <plica/meshes/raw_mesh.hpp>
#include <set>

namespace plica {

void name_regions(RawMesh& raw, const std::vector<std::int64_t>& numbers,
                  const std::function<std::string(std::int64_t)>& name_of) {
  const std::set<std::int64_t> used(numbers.begin(), numbers.end());
  if (used.empty() || (used.size() == 1 && used.contains(0))) return;
  std::map<std::string, int> index;
  std::map<std::int64_t, int> region;
  for (const std::int64_t number : used) {
    const auto [found, is_new] = index.try_emplace(name_of(number), static_cast<int>(index.size()));
    region[number] = found->second;
    if (is_new) raw.region_names.push_back(found->first);
  }
  for (std::size_t t = 0; t < raw.tets.size(); ++t) raw.tets[t].region = region.at(numbers[t]);
}

}  // namespace plica
