// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cctype>
#include <plica/core/error.hpp>
#include <plica/meshes/files/reading.hpp>
#include <plica/meshes/files/regions.hpp>
#include <set>

namespace plica {

namespace {

constexpr std::string_view no_regions = "none";
constexpr std::size_t many_cells = 32;  // a region for each of so many cells is a mistake

// Names of arrays that programs write for regions, without case, signs and a plural's 's'; the most
// telling ones first
constexpr std::string_view usual_names[] = {
    "region",    "regionid", "gmshphysical", "physical",       "physicalgroup", "meditref",
    "reference", "label",    "labelmap",     "material",       "materialid",    "mat",
    "matid",     "tissue",   "tissueid",     "cellentityid",   "subdomain",     "subdomainid",
    "domain",    "domainid", "part",         "partid",         "attribute",     "cellmarker",
    "marker",    "celltag",  "tag",          "gmshgeometrical"};

bool has_number(const RawNumbers& numbers) {
  return numbers.wrong.empty() &&
         std::ranges::any_of(numbers.values, [](std::int64_t value) { return value != 0; });
}

bool differ(const RawNumbers& numbers) {
  return numbers.wrong.empty() && std::ranges::any_of(numbers.values, [&](std::int64_t value) {
           return value != numbers.values.front();
         });
}

std::size_t count_cells(const ParsedMesh& raw) {
  std::size_t cells = 0;
  for (std::size_t t = 0; t < raw.tets.size(); ++t)
    cells += t == 0 || raw.tets[t].tag != raw.tets[t - 1].tag;
  return cells;
}

void refuse_reals(const ParsedMesh& raw, const RawNumbers& numbers) {
  if (numbers.wrong.empty()) return;
  refuse(raw.file, numbers.place,
         shown(numbers.name) + " has the value " + numbers.wrong +
             "; expected integers, the numbers of regions, or regions: none");
}

const RawNumbers* wanted_numbers(const ParsedMesh& raw, const std::string& wanted) {
  std::vector<std::string> names;
  for (const RawNumbers& one : raw.numbers) {
    if (one.name == wanted) return &one;
    names.push_back(one.name);
  }
  names.emplace_back(no_regions);
  refuse(raw.file, {}, unknown_name("array of cells for the regions", wanted, names));
}

const RawNumbers* usual_numbers(const ParsedMesh& raw) {
  const RawNumbers* found = nullptr;
  for (const RawNumbers& one : raw.numbers) {
    if (one.own) return &one;
    if (!has_number(one) || rank_as_regions(one.name) < 0) continue;
    if (!found || rank_as_regions(one.name) < rank_as_regions(found->name)) found = &one;
  }
  return found;
}

void note_choice(const ParsedMesh& raw, const RawNumbers* taken, MeshReport& report) {
  std::string others;
  for (const RawNumbers& one : raw.numbers)
    if (&one != taken && (differ(one) || (!one.wrong.empty() && rank_as_regions(one.name) >= 0)))
      others += (others.empty() ? "" : ", ") + shown(one.name);
  if (others.empty()) return;
  report.notes.push_back((taken ? "regions are the " +
                                      std::string(taken->own ? "file's " : "array ") +
                                      shown(taken->name)
                                : "no array is taken for the regions") +
                         "; not used: " + others);
}

}  // namespace

int rank_as_regions(const std::string& array) {
  std::string plain;
  for (const char c : lower_case(array))
    if (std::isalnum(static_cast<unsigned char>(c))) plain += c;
  const auto rank_of = [](std::string_view name) {
    const auto found = std::ranges::find(usual_names, name);
    return found == std::end(usual_names) ? -1 : static_cast<int>(found - usual_names);
  };
  if (const int rank = rank_of(plain); rank >= 0 || !plain.ends_with('s')) return rank;
  return rank_of(std::string_view(plain).substr(0, plain.size() - 1));
}

void choose_regions(ParsedMesh& raw, const std::string& wanted, MeshReport& report) {
  if (wanted == no_regions) return;
  const RawNumbers* taken = wanted.empty() ? usual_numbers(raw) : wanted_numbers(raw, wanted);
  if (wanted.empty()) note_choice(raw, taken, report);
  if (taken) refuse_reals(raw, *taken);
  if (!taken || !has_number(*taken)) return;
  const std::set<std::int64_t> used(taken->values.begin(), taken->values.end());
  if (used.size() >= many_cells && used.size() == count_cells(raw))
    refuse(raw.file, {},
           shown(taken->name) + " has a region of its own for each of " +
               std::to_string(used.size()) +
               " cells; expected the numbers of regions: name another array by regions, or none");
  std::map<std::string, int> index;
  std::map<std::int64_t, int> region;
  for (const std::int64_t number : used) {
    const auto [found, is_new] =
        index.try_emplace(taken->name_of(number), static_cast<int>(index.size()));
    region[number] = found->second;
    if (is_new) raw.region_names.push_back(found->first), raw.region_tags.push_back(number);
  }
  for (std::size_t t = 0; t < raw.tets.size(); ++t)
    raw.tets[t].region = region.at(taken->values[t]);
}

void leave_out_regions(ParsedMesh& raw, const std::vector<std::string>& regions,
                       MeshReport& report) {
  if (regions.empty()) return;
  std::vector<bool> out(raw.region_names.size(), false);
  for (const std::string& one : regions) {
    std::size_t r = 0;
    while (r < out.size() && raw.region_names[r] != one &&
           std::to_string(raw.region_tags[r]) != one)
      ++r;
    if (r == out.size())
      refuse(raw.file, {}, "leave_out: " + unknown_name("region", one, raw.region_names));
    out[r] = true;
  }
  const auto is_out = [&](std::size_t t) {
    return out[static_cast<std::size_t>(raw.tets[t].region)];
  };
  std::vector<std::size_t> place(raw.tets.size() + 1, 0);  // index of each tetrahedron that stays
  for (std::size_t t = 0; t < raw.tets.size(); ++t) place[t + 1] = place[t] + (is_out(t) ? 0 : 1);
  std::vector<std::size_t> cut;
  for (std::size_t c = 0; c < raw.cut.size(); c += 2)
    if (!is_out(raw.cut[c])) cut.insert(cut.end(), {place[raw.cut[c]], place[raw.cut[c + 1]]});
  raw.cut = std::move(cut);
  std::erase_if(raw.second_order, [&](auto& one) { return is_out(one.first); });
  for (auto& [tet, nodes] : raw.second_order) tet = place[tet];
  for (std::size_t t = 0; t < raw.tets.size(); ++t) {
    const RawTet tet = raw.tets[t];
    if (is_out(t)) {
      ++report.left_out[raw.region_names[static_cast<std::size_t>(tet.region)]];
      for (const std::int64_t v : tet.vertices) raw.middles.push_back({v, tet.place});
    } else {
      raw.tets[place[t]] = tet;
    }
  }
  raw.tets.resize(place.back());
  if (raw.tets.empty()) refuse(raw.file, {}, "leave_out leaves no tetrahedron");
  std::vector<int> renumbered(out.size(), 0);
  int kept = 0;
  for (std::size_t r = 0; r < out.size(); ++r) {
    renumbered[r] = kept;
    if (out[r]) continue;
    std::swap(raw.region_names[static_cast<std::size_t>(kept)], raw.region_names[r]);
    std::swap(raw.region_tags[static_cast<std::size_t>(kept++)], raw.region_tags[r]);
  }
  raw.region_names.resize(static_cast<std::size_t>(kept));
  raw.region_tags.resize(static_cast<std::size_t>(kept));
  for (RawTet& tet : raw.tets) tet.region = renumbered[static_cast<std::size_t>(tet.region)];
}

}  // namespace plica
