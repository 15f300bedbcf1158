// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <plica/core/mesh.hpp>
#include <string>
#include <vector>

namespace plica {

/// A member of a family, such as a material.
struct Choice {
  std::string name;     ///< name in scenes and options
  std::string summary;  ///< one line
};

/// Returns the names of choices, in their order.
std::vector<std::string> names(const std::vector<Choice>& choices);

// The families that names come from. Each walks its own list (drivers/run/registry.cpp).
std::vector<Choice> materials();          ///< constitutive laws
std::vector<Choice> volumes();            ///< volume energies of laws of tissue
std::vector<Choice> ogden_conventions();  ///< conventions for mu in Ogden's terms
std::vector<Choice> tissues();            ///< materials by the name of a tissue
std::vector<Choice> presets();            ///< published methods, as options of this library
std::vector<Choice> elements();           ///< kinds of elements, and auto
std::vector<Choice> pressures();          ///< pressures of nodal elements, and auto
std::vector<Choice> integrators();        ///< one-level ODE solvers
std::vector<Choice> cycle_choices();      ///< ways to share a macro step, and auto
std::vector<Choice> error_classes();      ///< error classes of cycle auto
std::vector<Choice> distributions();      ///< rules for the sizes of the shares
std::vector<Choice> outside_rules();      ///< rules for vertices outside the other level's mesh
std::vector<Choice> relaxation_rules();   ///< integration of Prony series in time
/// Rules for which obstacles touch the surface between its points, too
std::vector<Choice> whole_surface_rules();
std::vector<Choice> linear_solver_choices();   ///< linear solvers of implicit levels, and auto
std::vector<Choice> preconditioner_choices();  ///< preconditioners of conjugate gradients, and auto
std::vector<Choice> matrix_choices();          ///< storage of linear systems, and auto
std::vector<Choice> tangents();                ///< tangents of the elements in linear systems
std::vector<Choice> unsolved_outcomes();  ///< outcomes of steps that Newton's method does not solve

}  // namespace plica

/// Kinds of options, with unit and range. The tables of describe.hpp give every option one of these
/// kinds. expects() says what is expected, shown() shows a value as a scene would have it, and
/// check() checks one. check() throws InputError "PATH is VALUE; expected WHAT".
namespace plica::keys {

/// Exponents of kilogram, metre, second and radian. An angle counts as a dimension of its own, so
/// that a frequency is not taken for an angular velocity.
struct Dimension {
  int mass = 0, length = 0, time = 0, angle = 0;
  bool operator==(const Dimension&) const = default;
};

inline constexpr Dimension plain{};  ///< a number without unit
inline constexpr Dimension length{.length = 1};
inline constexpr Dimension duration{.time = 1};
inline constexpr Dimension rate{.time = -1};
inline constexpr Dimension velocity{.length = 1, .time = -1};
inline constexpr Dimension acceleration{.length = 1, .time = -2};
inline constexpr Dimension angular_velocity{.time = -1, .angle = 1};
inline constexpr Dimension pressure{.mass = 1, .length = -1, .time = -2};
inline constexpr Dimension density{.mass = 1, .length = -3};
inline constexpr Dimension force{.mass = 1, .length = 1, .time = -2};
inline constexpr Dimension angle{.angle = 1};

/// Returns the name of a dimension: "a pressure", "a length". Without a name it is a product of SI
/// units.
std::string name_of(const Dimension& dimension);
/// Returns the name of a dimension in the plural: "pressures", "lengths".
std::string plural_of(const Dimension& dimension);

/// Returns the unit of a dimension: "Pa", "m", "kg/m^3"; empty for a number.
std::string unit_of(const Dimension& dimension);

/// Range of a number.
struct Bounds {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool min_excluded = false;
  bool max_excluded = false;
  bool contains(double value) const;  ///< false for what is not finite
  /// Returns the range as text: "> 0", "in [0, 0.5)"; empty when it contains all values.
  std::string text(const std::string& unit = {}) const;
};
inline constexpr Bounds any_value{};
inline constexpr Bounds positive{.min = 0, .min_excluded = true};
inline constexpr Bounds not_negative{.min = 0};
inline constexpr Bounds zero_to_one{.min = 0, .max = 1};
/// Range [0, 1)
inline constexpr Bounds below_one{.min = 0, .max = 1, .max_excluded = true};
/// Range (0, 1]
inline constexpr Bounds up_to_one{.min = 0, .max = 1, .min_excluded = true};
/// Range (0, 1)
inline constexpr Bounds inside_zero_one{
    .min = 0, .max = 1, .min_excluded = true, .max_excluded = true};

/// A number with a unit.
struct Quantity {
  Dimension dimension;
  Bounds range = any_value;
  std::string type_text() const;
  std::string to_text(double value, int digits = 6) const;
  void check(const std::string& path, double value) const;
};

/// A quantity or `auto`, which is no value.
struct AutoQuantity {
  Quantity quantity;
  std::string type_text() const { return quantity.type_text() + ", or auto"; }
  std::string to_text(const std::optional<double>& value) const {
    return value ? quantity.to_text(*value) : "auto";
  }
  void check(const std::string& path, const std::optional<double>& value) const;
};

/// Three quantities of one dimension.
struct Vector {
  Dimension dimension;
  Bounds range = any_value;
  std::string type_text() const;
  std::string to_text(const Point& value) const;
  void check(const std::string& path, const Point& value) const;
};

/// Three numbers that give a direction: their length is above 0 and does not matter otherwise.
struct Direction {
  std::string type_text() const { return Vector{plain}.type_text(); }
  std::string to_text(const Point& value) const { return Vector{plain}.to_text(value); }
  void check(const std::string& path, const Point& value) const;
};

/// A whole number.
struct Count {
  int min = 0;
  int max = std::numeric_limits<int>::max();
  std::string type_text() const;
  std::string to_text(int value) const { return std::to_string(value); }
  void check(const std::string& path, int value) const;
};

/// A whole number, or `auto`, which is stored as the number `automatic`.
struct AutoCount {
  int min = 1;
  int max = std::numeric_limits<int>::max();
  int automatic = 0;
  std::string type_text() const { return Count{min, max}.type_text() + ", or auto"; }
  std::string to_text(int value) const {
    return value == automatic ? "auto" : std::to_string(value);
  }
  void check(const std::string& path, int value) const;
};

/// Three whole numbers.
struct Counts {
  int min = 0;
  std::string type_text() const { return "a list of 3 whole numbers >= " + std::to_string(min); }
  std::string to_text(const std::array<int, 3>& value) const;
};

/// true or false.
struct Flag {
  std::string type_text() const { return "true or false"; }
  std::string to_text(bool value) const { return value ? "true" : "false"; }
  void check(const std::string&, bool) const {}
};

/// Any words.
struct Text {
  std::string type_text() const { return "text"; }
  std::string to_text(const std::string& value) const { return value; }
  void check(const std::string&, const std::string&) const {}
};

/// One of a family's names.
struct Name {
  const char* family;                ///< "material"
  std::vector<Choice> (*choices)();  ///< names to choose from
  std::string type_text() const;
  std::string to_text(const std::string& value) const { return value; }
  void check(const std::string& path, const std::string& value) const;
};

/// A name of tissues(), which stands for a whole material.
struct TissueName {
  Name name{"tissue", tissues};
  std::string type_text() const { return name.type_text(); }
  template <class Material>
  std::string to_text(const Material& of) const {
    return of.tissue;
  }
  template <class Material>
  void check(const std::string&, const Material&) const {}
};

/// A name of presets(), which stands for options of a whole problem.
struct PresetName {
  Name name{"preset", presets};
  std::string type_text() const { return name.type_text(); }
  template <class Problem>
  std::string to_text(const Problem& of) const {
    return of.preset;
  }
  template <class Problem>
  void check(const std::string&, const Problem&) const {}
};

/// One name for all levels, or one for each.
struct NamePerLevel {
  Name name;
  std::string type_text() const {
    return name.type_text() + "; or a list of them, finest level first";
  }
  std::string to_text(const std::vector<std::string>& value) const;
  void check(const std::string& path, const std::vector<std::string>& value) const;
};

/// One count for all levels, or one for each; `auto` is 0.
struct AutoCountPerLevel {
  std::string type_text() const {
    return AutoCount{}.type_text() + "; or a list of them, finest level first";
  }
  std::string to_text(const std::vector<int>& value) const;
  void check(const std::string& path, const std::vector<int>& value) const;
};

/// A rule by name, or the shares themselves.
struct Shares {
  struct Target {
    std::string& rule;
    std::vector<double>& shares;
  };
  Name name;
  static constexpr Quantity share{plain, positive};
  std::string type_text() const {
    return name.type_text() + "; or a list of shares, finest level first";
  }
  std::string to_text(const Target& value) const { return value.rule; }
  void check(const std::string& path, const Target& value) const;
};

/// One or several values of a kind.
template <class Kind>
struct ListOf {
  Kind kind;
  std::string type_text() const { return kind.type_text() + "; or a list of them"; }
  template <class T>
  std::string to_text(const std::vector<T>& value) const {
    std::string text;
    for (const T& item : value) text += (text.empty() ? "" : ", ") + kind.to_text(item);
    return text;
  }
  template <class T>
  void check(const std::string& path, const std::vector<T>& value) const {
    for (std::size_t i = 0; i < value.size(); ++i)
      kind.check(path + "." + std::to_string(i), value[i]);
  }
};

/// An entry of a map of numbers; it may be missing.
struct Entry {
  const char* name;
  Quantity quantity;
  using Map = std::map<std::string, double>;
  std::string type_text() const { return quantity.type_text(); }
  std::string to_text(const Map& values) const {
    return values.contains(name) ? quantity.to_text(values.at(name)) : "";
  }
  void check(const std::string& path, const Map& values) const {
    if (values.contains(name)) quantity.check(path, values.at(name));
  }
};

// Kinds of options that have options of their own.

/// A struct with a table, or an optional such struct.
struct Group {};
/// A vector of structs with a table.
struct List {};
/// A map of structs with a table, by names that the user chooses.
struct Map {};
/// A struct with a table that a variant or an optional may hold.
template <class T>
struct Case {};

/// Types of a member pointer &Type::Member: the struct and the value.
template <auto Member>
struct MemberOf;
template <class T, class M, M T::*Member>
struct MemberOf<Member> {
  using Type = T;
  using Value = M;
};
/// A value that stands for an alternative of a variant. `Member` is the member of that alternative,
/// and has the kind.
template <auto Member, class Kind>
struct As : MemberOf<Member> {
  Kind kind;
  explicit As(const Kind& of_member) : kind(of_member) {}
  std::string type_text() const { return kind.type_text(); }
};
/// A list that stands for an alternative of a variant. `Member` is the list in that alternative.
template <auto Member>
struct CaseList : MemberOf<Member> {};

}  // namespace plica::keys

namespace plica {

/// A number that a material asks for. In a scene it is body.material.NAME, and
/// body.regions.REGION.NAME for a region of its own.
struct MaterialParameter {
  const char* name;
  keys::Quantity kind;  ///< kind with unit and range
  const char* help;     ///< one line
  double standard;      ///< value where nothing is given, in SI
};

/// Returns the parameters that materials declare beyond the options of every body.
std::vector<MaterialParameter> material_parameters();

}  // namespace plica
