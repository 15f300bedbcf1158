// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <plica/core/error.hpp>
#include <plica/drivers/solver/set_up/add_regions.hpp>
#include <plica/drivers/solver/set_up/selection.hpp>

namespace plica {

void add_regions(TetMesh& mesh, const std::map<std::string, RegionOptions>& regions, int level) {
  if (std::none_of(regions.begin(), regions.end(), [](const auto& entry) { return entry.second.where.has_value(); }))
    return;
  const TetMesh given = mesh;
  std::vector<const std::string*> owner(mesh.tets.size(), nullptr);
  for (const auto& [name, options] : regions) {
    if (!options.where) continue;
    const std::string option = "body.regions." + name;
    if (std::find(mesh.region_names.begin(), mesh.region_names.end(), name) != mesh.region_names.end())
      throw InputError(option + ".where: the mesh of level " + std::to_string(level) +
                       " has a region of that name; leave `where` out, or choose another name");
    if (mesh.region.empty()) mesh.region.assign(mesh.tets.size(), 0), mesh.region_names = {""};
    const int number = static_cast<int>(mesh.region_names.size());
    mesh.region_names.push_back(name);
    for (int e : select_elements(given, *options.where, {option + ".where", level})) {
      const auto i = static_cast<std::size_t>(e);
      if (owner[i])
        throw InputError(option + ".where: element " + std::to_string(e) + " of level " + std::to_string(level) +
                         " belongs to region '" + *owner[i] + "' as well; regions must not overlap");
      owner[i] = &name;
      mesh.region[i] = number;
    }
  }
}

}  // namespace plica
