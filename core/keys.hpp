// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <any>
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <plica/core/mesh.hpp>
#include <string>
#include <type_traits>
#include <variant>
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
std::vector<Choice> axis_choices();            ///< axes of coordinates
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

/// Returns the unit of a dimension, as scenes take it: "Pa", "m", "kg*m^2/s"; empty for a number.
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
/// Stiffness of a material [Pa]: from far below foam's to far above diamond's.
inline constexpr Bounds stiffness{.min = 1e-6, .max = 1e15};
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
  static constexpr bool takes_optional = true;
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

/// The word normal, which is stored as [0, 0, 0], or a direction.
struct NormalOrDirection {
  std::string type_text() const { return "normal, or " + Direction{}.type_text(); }
  std::string to_text(const Point& value) const {
    return value.isZero(0) ? "normal" : Direction{}.to_text(value);
  }
  void check(const std::string& path, const Point& value) const {
    Vector{plain}.check(path, value);
  }
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

/// A name that stands for many options of a struct, which keeps it as `Member`.
template <auto Member>
struct NameOfAll {
  Name name;
  std::string type_text() const { return name.type_text(); }
  template <class T>
  std::string to_text(const T& of) const {
    return of.*Member;
  }
  template <class T>
  void check(const std::string&, const T&) const {}
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

inline constexpr const char* per_level = ", finest level first";

/// One or several values of a kind. `order` is per_level where each level has one.
template <class Kind>
struct ListOf {
  Kind kind;
  const char* order = "";
  std::string type_text() const { return kind.type_text() + "; or a list of them" + order; }
  template <class T>
  std::string to_text(const std::vector<T>& value) const {
    std::string text;
    for (const T& item : value) text += (text.empty() ? "" : ", ") + kind.to_text(item);
    return value.size() > 1 ? "[" + text + "]" : text;
  }
  template <class T>
  void check(const std::string& path, const std::vector<T>& value) const {
    for (std::size_t i = 0; i < value.size(); ++i)
      kind.check(*order != 0 ? path : path + "." + std::to_string(i), value[i]);
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

/// A struct with a table.
struct Group {
  static constexpr const char* words = "a map";
};
/// A vector of structs with a table, of at least so many.
struct List {
  static constexpr const char* words = "a list of maps";
  std::size_t least = 0;
};
/// A map of structs with a table, by names that the user chooses.
struct Map {
  static constexpr const char* words = "a map of maps";
};

/// Place of a value that a std::variant or std::any may hold: a T, or `Member` of it.
template <class T, class Holder, auto... Member>
struct Alternative {
  Holder& holder;
  /// Returns the value; null where another alternative is held.
  auto* get() const {
    T* held = nullptr;
    if constexpr (std::is_same_v<Holder, std::any>)
      held = std::any_cast<T>(&holder);
    else
      held = std::get_if<T>(&holder);
    return held == nullptr ? nullptr : &((*held).*....*Member);
  }
  /// Makes a value with its defaults, instead of what was held.
  auto& make() const { return (holder.template emplace<T>().*....*Member); }
};
template <class T, class Holder>
Alternative<T, Holder> as(Holder& holder) {
  return {holder};
}
template <class T, class M>
T struct_of(M T::*);
template <auto Member, class Holder>
Alternative<decltype(struct_of(Member)), Holder, Member> as(Holder& holder) {
  return {holder};
}

/// Says whether the value of a member is in an optional, and the kind is not of the optional
/// itself.
template <class Kind, class T>
concept InOptional = !requires {
  Kind::takes_optional;
}
&&requires(T member) { member.has_value(); };

/// Returns the value of a member: itself, or what an optional or an alternative holds; null: none.
template <class Kind, class T>
auto* held(const Kind&, T& member) {
  if constexpr (requires { member.make(); })
    return member.get();
  else if constexpr (InOptional<Kind, T>)
    return member ? &*member : nullptr;
  else
    return &member;
}

/// Returns the value of a member to be set; makes that of an optional or an alternative.
template <class Kind, class T>
auto& made(const Kind&, T& member) {
  if constexpr (requires { member.make(); })
    return member.make();
  else if constexpr (InOptional<Kind, T>)
    return member.emplace();
  else
    return member;
}

/// Visitor of a table for which all keys are alike.
template <class Visit>
struct EachKey {
  const Visit& visit;
  template <class T, class Kind>
  void operator()(const char* key, T&& member, const Kind& kind, const char* help) const {
    visit(key, member, kind, help);
  }
  template <class T, class Kind>
  void required(const char* key, T&& member, const Kind& kind, const char* help) const {
    visit(key, member, kind, help);
  }
  template <class T, class Kind>
  void alternative(const char* key, T&& member, const Kind& kind, const char* help) const {
    visit(key, member, kind, help);
  }
  void one_of() const {}
  void at_most_one() const {}
};

/// Calls visit(key, member, kind, help) for each key in the table of a struct.
template <class T, class Visit>
void for_each_key(T& options, const Visit& visit) {
  const EachKey<Visit> visitor{visit};
  describe(visitor, options);
}

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
