// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <optional>
#include <plica/core/error.hpp>
#include <plica/core/keys.hpp>
#include <plica/core/level_data.hpp>
#include <plica/core/text.hpp>
#include <plica/drivers/elastic/materials.hpp>
#include <plica/kernels/materials/list.hpp>
#include <vector>

namespace plica {

namespace {

/// Returns the constants of a material's kernels from its parameters' values.
template <class M>
auto constants_of(const std::vector<double>& values) {
  auto c = M::kernel_constants(values.data());
  if constexpr (IsochoricLaws::has<M>) c.law = IsochoricLaws::place_of<M>();
  return c;
}

/// Returns the values of a law whose energy is `share` times as large.
/// Energy is proportional to the parameters in [Pa], and the other parameters have no unit.
template <class M>
std::vector<double> scaled_values(std::vector<double> values, double share) {
  for (std::size_t k = 0; k < M::parameters.size(); ++k)
    if (M::parameters[k].kind.dimension == keys::pressure) values[k] *= share;
  TissueSettings settings = settings_at(values.data() + M::parameters.size());
  for (double& coefficient : settings.coefficient) coefficient *= share;
  const std::vector<double> list = as_list(settings);
  std::ranges::copy(list, values.begin() + static_cast<std::ptrdiff_t>(M::parameters.size()));
  return values;
}

template <class M>
std::vector<double> constants_with_shape(const std::vector<double>& values, double share,
                                         double bulk) {
  if constexpr (IsochoricLaws::has<M>) {
    auto c = constants_of<M>(scaled_values<M>(values, share));
    c.bulk = bulk;
    return as_list(c);
  } else {
    return as_list(M::with_shape(constants_of<M>(values), share, bulk));
  }
}

template <class M>
MaterialInfo describe_material() {
  MaterialInfo info{M::name,
                    M::summary,
                    M::rotation_invariant,
                    M::survives_inversion,
                    M::recovers,
                    M::allows_inversion,
                    {M::parameters.begin(), M::parameters.end()},
                    nullptr,
                    nullptr,
                    nullptr};
  info.kernel_constants = [](const std::vector<double>& values) {
    return as_list(constants_of<M>(values));
  };
  info.small_strains = [](const std::vector<double>& values) {
    return M::small_strains(M::kernel_constants(values.data()));
  };
  if constexpr (requires(typename M::template Constants<double> c) { M::with_lambda(c, 0.0); })
    info.with_lambda = [](const std::vector<double>& values, double lambda) {
      return as_list(M::with_lambda(constants_of<M>(values), lambda));
    };
  if constexpr (requires { M::splits_shape; }) info.with_shape = constants_with_shape<M>;
  info.smooths_dilatation = smooths_dilatation<M>;
  info.of_tissue = IsochoricLaws::has<M>;
  info.has_fibres = requires { M::has_fibres; };
  info.has_terms = requires { M::has_terms; };
  return info;
}

/// Returns the value that the options give for a parameter, if they do.
std::optional<double> given(const std::string& name, const MaterialOptions& body,
                            const RegionOptions& region) {
  if (name == parameter::young_modulus.name)
    return region.young_modulus.value_or(body.young_modulus);
  if (name == parameter::poisson_ratio.name)
    return region.poisson_ratio.value_or(body.poisson_ratio);
  for (const auto* values : {&region.parameters, &body.parameters})
    if (const auto found = values->find(name); found != values->end()) return found->second;
  return {};
}

void check_names(const MaterialInfo& info, const std::string& path,
                 const std::map<std::string, double>& values) {
  std::vector<std::string> known;
  for (const MaterialParameter& p : info.parameters) known.emplace_back(p.name);
  for (const auto& [name, value] : values) {
    if (std::ranges::find(known, name) == known.end())
      throw InputError(path + name + ": " +
                       unknown_name("parameter of " + std::string(info.name), name, known));
    if (name == parameter::young_modulus.name || name == parameter::poisson_ratio.name)
      throw InputError(path + name +
                       " is given twice: as an option, and among the other parameters");
  }
}

/// Returns c of a term by its convention: mu/alpha^2, mu/alpha or 2 mu/alpha^2.
double ogden_coefficient(const OgdenTerm& term, const std::string& convention) {
  if (convention == "mu_over_alpha") return term.mu / term.alpha;
  return (convention == "mu_over_alpha2" ? 1 : 2) * term.mu / (term.alpha * term.alpha);
}

TissueSettings settings_of(const MaterialOptions& body, const RegionOptions& region) {
  TissueSettings s;
  const std::vector<std::string> known = names(volumes());
  if (body.volume)
    s.volume = static_cast<double>(std::ranges::find(known, *body.volume) - known.begin());
  if (const auto& fibres = region.fibres ? region.fibres : body.fibres) {
    const Point axis = fibres->axis.normalized();
    Point sheet = fibres->sheet.value_or(axis.unitOrthogonal());
    sheet = (sheet - axis.dot(sheet) * axis).normalized();
    for (int k = 0; k < 3; ++k) s.axis[k] = axis[k], s.sheet[k] = sheet[k];
  }
  const std::vector<OgdenTerm>& terms = region.terms.empty() ? body.terms : region.terms;
  for (std::size_t i = 0; !terms.empty() && i < TissueSettings::most_terms; ++i) {
    s.coefficient[i] =
        i < terms.size() ? ogden_coefficient(terms[i], body.convention.value_or("")) : 0;
    s.exponent[i] = i < terms.size() ? terms[i].alpha : 1;
  }
  return s;
}

/// Throws InputError where terms or fibres of the body, or of a region, do not fit the material.
/// `path`: "body." or "body.regions.NAME.".
void check_structure(const MaterialInfo& info, const std::string& path,
                     const std::vector<OgdenTerm>& terms,
                     const std::optional<FibreOptions>& fibres) {
  const std::string material = path == "body." ? "body.material." : path, name(info.name);
  if (!info.has_terms && !terms.empty())
    throw InputError(material + "terms: " + name + " has none; only ogden has");
  if (terms.size() > TissueSettings::most_terms)
    throw InputError(material + "terms: " + std::to_string(terms.size()) +
                     " terms; expected 1 to " + std::to_string(TissueSettings::most_terms));
  for (std::size_t i = 0; i < terms.size(); ++i)
    if (terms[i].alpha == 0)
      throw InputError(material + "terms." + std::to_string(i) +
                       ".alpha is 0; expected a number other than 0");
  if (!info.has_fibres && fibres) throw InputError(path + "fibres: " + name + " has none");
  if (!fibres) return;
  if (fibres->around && (fibres->sheet || !fibres->sheet_field.empty()))
    throw InputError(path +
                     "fibres.sheet: fibres around a line have their sheets on cylinders about it; "
                     "remove this key");
  if (fibres->sheet && !fibres->sheet_field.empty())
    throw InputError(path + "fibres.sheet is given twice: as sheet and as sheet_field");
  if (fibres->from.has_value() != fibres->to.has_value())
    throw InputError(path + "fibres." + (fibres->from ? "to" : "from") +
                     " is missing; fibres run from one set of vertices to another, expected both");
  if (fibres->field.empty() && !fibres->around && !fibres->from && fibres->sheet &&
      fibres->axis.normalized().cross(fibres->sheet->normalized()).norm() < 1e-6)
    throw InputError(path + "fibres.sheet is along the axis; expected a direction across it");
}

/// Returns true where a law depends on the directions across the fibres.
bool needs_sheet(const MaterialInfo& info, const std::vector<double>& values) {
  bool needed = false;
  IsochoricLaws::for_each([&](auto law) {
    if constexpr (requires { law.needs_sheet(values.data()); })
      if (info.name == law.name) needed = law.needs_sheet(values.data());
  });
  return needed;
}

/// Throws InputError where a material has no stiffness at rest, or lacks fibres or a sheet.
/// `where`: "body.material" or "body.regions.NAME".
void check_at_rest(const MaterialInfo& info, const std::string& where, const MaterialOptions& body,
                   const RegionOptions& region) {
  const std::vector<double> values = parameter_values(info, body, region);
  const keys::Quantity shear{keys::pressure, keys::stiffness};
  const Lame<double> rest = info.small_strains(values);
  shear.check(where + ", as the shear stiffness of " + std::string(info.name) + " at rest,",
              rest.mu);
  const auto& fibres = region.fibres ? region.fibres : body.fibres;
  if (info.has_fibres && !fibres)
    throw InputError("body.fibres is missing; expected the direction of the fibres of " +
                     std::string(info.name) +
                     ", such as {axis: [0, 0, 1]}, of the body or of every region");
  if (fibres && !fibres->sheet && !fibres->around && fibres->sheet_field.empty() &&
      needs_sheet(info, values))
    throw InputError((region.fibres ? where : "body") + ".fibres.sheet is missing; " +
                     std::string(info.name) +
                     " differs across its fibres: expected a direction across them");
}

void check_prony(const MaterialInfo& info, const std::string& path,
                 const std::vector<PronyTerm>& terms) {
  if (terms.empty()) return;
  constexpr std::size_t most = 6;
  if (!info.with_shape) {
    std::string able;
    for (const MaterialInfo& one : material_list())
      if (one.with_shape) able += (able.empty() ? "" : ", ") + std::string(one.name);
    throw InputError(path + ": " + std::string(info.name) +
                     " does not split shape from volume, and only shape relaxes; " +
                     "expected no prony, or one of the models " + able);
  }
  if (terms.size() > most)
    throw InputError(path + ": " + std::to_string(terms.size()) + " terms; expected 1 to " +
                     std::to_string(most));
  double sum = 0;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    const std::string term = path + "." + std::to_string(i);
    keys::Quantity{keys::plain, keys::inside_zero_one}.check(term + ".alpha", terms[i].alpha);
    keys::Quantity{keys::duration, keys::positive}.check(term + ".tau", terms[i].tau);
    sum += terms[i].alpha;
  }
  if (!(sum < 1))
    throw InputError(path + ": the sum of alpha is " + number(sum, 6) +
                     "; expected one below 1: what is left of 1 is the part that never relaxes");
}

void check_tissue(const MaterialInfo& info, const Body& body) {
  const MaterialOptions& m = body.material;
  const std::string name(info.name);
  if (m.volume && !info.of_tissue)
    throw InputError("body.material.volume is " + *m.volume + "; " + name +
                     " has its own; remove this key");
  if (m.convention && !info.has_terms)
    throw InputError("body.material.convention is " + *m.convention + "; only ogden has one");
  check_structure(info, "body.", m.terms, m.fibres);
  for (const auto& [region, o] : body.regions)
    check_structure(info, "body.regions." + region + ".", o.terms, o.fibres);
  if (!info.of_tissue) return;
  if (info.has_terms && m.terms.empty())
    throw InputError(
        "body.material.terms is missing; expected those of ogden, such as [{mu: 1 kPa, alpha: 2}]");
  if (info.has_terms && !m.convention)
    throw InputError("body.material.convention is missing; ogden has no standard one, expected " +
                     keys::Name{"convention", ogden_conventions}.type_text());
  if (!info.has_fibres || m.fibres) check_at_rest(info, "body.material", m, {});
  bool all = !body.regions.empty();
  for (const auto& [region, o] : body.regions) {
    check_at_rest(info, "body.regions." + region, m, o);
    all = all && o.fibres;
  }
  if (info.has_fibres && !m.fibres && !all) check_at_rest(info, "body.material", m, {});
}

}  // namespace

std::vector<double> parameter_values(const MaterialInfo& info, const MaterialOptions& body,
                                     const RegionOptions& region) {
  std::vector<double> values;
  for (const MaterialParameter& p : info.parameters)
    values.push_back(given(p.name, body, region).value_or(p.standard));
  if (info.of_tissue) {
    const std::vector<double> settings = as_list(settings_of(body, region));
    values.insert(values.end(), settings.begin(), settings.end());
  }
  return values;
}

std::vector<std::string> materials_of_two_constants() {
  std::vector<std::string> list;
  for (const MaterialInfo& info : material_list())
    if (info.parameters.front().name == std::string_view(parameter::young_modulus.name))
      list.emplace_back(info.name);
  return list;
}

void check_parameters(const MaterialInfo& info, const Body& body) {
  check_names(info, "body.material.", body.material.parameters);
  for (const auto& [name, region] : body.regions)
    check_names(info, "body.regions." + name + ".", region.parameters);
  const auto check = [&](const std::string& path, const RegionOptions& region) {
    for (const MaterialParameter& p : info.parameters)
      if (const auto value = given(p.name, body.material, region))
        p.kind.check(path + p.name, *value);
  };
  check("body.material.", {});
  for (const auto& [name, region] : body.regions) check("body.regions." + name + ".", region);
  check_prony(info, "body.material.prony", body.material.prony);
  for (const auto& [name, region] : body.regions)
    check_prony(info, "body.regions." + name + ".prony", region.prony);
  check_tissue(info, body);
}

double stiffness_at_rest(const MaterialOptions& material) {
  const MaterialInfo& info = *find_material(material.model);
  for (const MaterialParameter& p : info.parameters)
    if (p.name == std::string_view(parameter::young_modulus.name)) return material.young_modulus;
  const Lame<double> c = info.small_strains(parameter_values(info, material, {}));
  return c.mu * (3 * c.lambda + 2 * c.mu) / (c.lambda + c.mu);
}

double p_wave_modulus(const MaterialOptions& material) {
  const MaterialInfo& info = *find_material(material.model);
  const Lame<double> c = info.small_strains(parameter_values(info, material, {}));
  return c.lambda + 2 * c.mu;
}

const std::vector<MaterialInfo>& material_list() {
  static const std::vector<MaterialInfo> list = [] {
    std::vector<MaterialInfo> all;
    Materials::for_each(
        [&](auto material) { all.push_back(describe_material<decltype(material)>()); });
    return all;
  }();
  return list;
}

const MaterialInfo* find_material(std::string_view name) {
  const auto found = std::ranges::find(material_list(), name, &MaterialInfo::name);
  return found == material_list().end() ? nullptr : &*found;
}

std::vector<MaterialParameter> material_parameters() {
  std::vector<MaterialParameter> all;
  const auto has = [&](std::string_view name) {
    return name == parameter::young_modulus.name || name == parameter::poisson_ratio.name ||
           std::ranges::any_of(all, [&](const MaterialParameter& p) { return p.name == name; });
  };
  for (const MaterialInfo& one : material_list())
    for (const MaterialParameter& p : one.parameters)
      if (!has(p.name)) all.push_back(p);
  return all;
}

std::vector<Choice> materials() {
  std::vector<Choice> list;
  for (const MaterialInfo& one : material_list())
    list.push_back({std::string(one.name), std::string(one.summary)});
  return list;
}

std::vector<Choice> volumes() {
  return {{"simo_hughes", "kappa/4 (J^2 - 1 - 2 ln J)"},
          {"logarithmic", "kappa/2 (ln J)^2; SOFA, FEBio"},
          {"quadratic", "kappa/2 (J - 1)^2; NiftySim: weak where J is near 0"}};
}

std::vector<Choice> ogden_conventions() {
  return {{"mu_over_alpha2", "c = mu/alpha^2: SOFA, FEBio; mu at rest is the sum of mu/2"},
          {"mu_over_alpha", "c = mu/alpha: Ogden, Holzapfel; the sum of mu alpha/2"},
          {"two_mu_over_alpha2", "c = 2 mu/alpha^2: Miller & Chinzei, Abaqus; the sum of mu"}};
}

bool allows_inversion(const MaterialOptions& material) {
  const MaterialInfo* info = find_material(material.model);
  return material.allow_inversion.value_or(info != nullptr && info->allows_inversion);
}

bool recovers(std::string_view material) {
  const MaterialInfo* info = find_material(material);
  return info != nullptr && info->recovers;
}

}  // namespace plica
