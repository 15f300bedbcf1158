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
  std::string name;     ///< in scenes and options
  std::string summary;  ///< one line
};

/// Their names alone, in the same order.
std::vector<std::string> names(const std::vector<Choice>& choices);

/// The families that names come from. Each walks its own list (drivers/run/registry.cpp).
std::vector<Choice> materials();          ///< constitutive laws
std::vector<Choice> volumes();            ///< what laws of tissue have for the volume
std::vector<Choice> ogden_conventions();  ///< of the mu in Ogden's terms
std::vector<Choice> tissues();            ///< materials by the name of a tissue
std::vector<Choice> presets();            ///< published methods, as what they consist of here
std::vector<Choice> elements();           ///< how strains follow from the vertices, and auto
std::vector<Choice> pressures();          ///< of nodal elements, and auto
std::vector<Choice> integrators();        ///< one-level ODE solvers
std::vector<Choice> cycle_choices();      ///< ways to share a macro step, and auto
std::vector<Choice> error_classes();      ///< of cycle auto
std::vector<Choice> distributions();      ///< sizes of the shares
std::vector<Choice> outside_rules();      ///< for vertices outside the other level's mesh
std::vector<Choice> relaxation_rules();   ///< how Prony series go on in time
/// which obstacles touch the surface between its points, too
std::vector<Choice> whole_surface_rules();
std::vector<Choice> linear_solver_choices();   ///< of implicit levels, and auto
std::vector<Choice> preconditioner_choices();  ///< of conjugate gradients, and auto
std::vector<Choice> matrix_choices();          ///< of linear systems, and auto
std::vector<Choice> tangents();                ///< of the elements, in their systems
std::vector<Choice> unsolved_outcomes();       ///< of steps that Newton's method does not solve

}  // namespace plica

/// What an option may be: its kind, with unit and range. The tables of describe.hpp give every
/// option one of these kinds. A kind can say what is expected, show a value as a scene would have
/// it, and check one: expects(), shown(), check(). check() throws InputError "PATH is VALUE;
/// expected WHAT".
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

/// "a pressure", "a length"; a product of SI units where the dimension has no name.
std::string name_of(const Dimension& dimension);
std::string plural_of(const Dimension& dimension);

/// "Pa", "m", "kg/m^3"; empty for a number.
std::string unit_of(const Dimension& dimension);

struct Bounds {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool min_excluded = false;
  bool max_excluded = false;
  bool contains(double value) const;  ///< never what is not finite
  /// "> 0", "in [0, 0.5)"; empty when all values are in it
  std::string text(const std::string& unit = {}) const;
};
inline constexpr Bounds any_value{};
inline constexpr Bounds positive{.min = 0, .min_excluded = true};
inline constexpr Bounds not_negative{.min = 0};
inline constexpr Bounds zero_to_one{.min = 0, .max = 1};
/// from 0
inline constexpr Bounds below_one{.min = 0, .max = 1, .max_excluded = true};
/// above 0
inline constexpr Bounds up_to_one{.min = 0, .max = 1, .min_excluded = true};
/// neither
inline constexpr Bounds inside_zero_one{
    .min = 0, .max = 1, .min_excluded = true, .max_excluded = true};

/// A number with a unit.
struct Quantity {
  Dimension dimension;
  Bounds range = any_value;
  std::string expects() const;
  std::string shown(double value, int digits = 6) const;
  void check(const std::string& path, double value) const;
};

/// A quantity or `auto`, which is none.
struct AutoQuantity {
  Quantity quantity;
  std::string expects() const { return quantity.expects() + ", or auto"; }
  std::string shown(const std::optional<double>& value) const {
    return value ? quantity.shown(*value) : "auto";
  }
  void check(const std::string& path, const std::optional<double>& value) const;
};

/// Three quantities of one dimension.
struct Vector {
  Dimension dimension;
  Bounds range = any_value;
  std::string expects() const;
  std::string shown(const Point& value) const;
  void check(const std::string& path, const Point& value) const;
};

/// Three numbers whose length does not matter, but that it is above 0.
struct Direction {
  std::string expects() const { return Vector{plain}.expects(); }
  std::string shown(const Point& value) const { return Vector{plain}.shown(value); }
  void check(const std::string& path, const Point& value) const;
};

/// A whole number.
struct Count {
  int min = 0;
  int max = std::numeric_limits<int>::max();
  std::string expects() const;
  std::string shown(int value) const { return std::to_string(value); }
  void check(const std::string& path, int value) const;
};

/// A whole number, or `auto`, which is another one.
struct AutoCount {
  int min = 1;
  int max = std::numeric_limits<int>::max();
  int automatic = 0;
  std::string expects() const { return Count{min, max}.expects() + ", or auto"; }
  std::string shown(int value) const { return value == automatic ? "auto" : std::to_string(value); }
  void check(const std::string& path, int value) const;
};

/// Three whole numbers.
struct Counts {
  int min = 0;
  std::string expects() const { return "a list of 3 whole numbers >= " + std::to_string(min); }
  std::string shown(const std::array<int, 3>& value) const;
};

/// true or false.
struct Flag {
  std::string expects() const { return "true or false"; }
  std::string shown(bool value) const { return value ? "true" : "false"; }
  void check(const std::string&, bool) const {}
};

/// Any words.
struct Text {
  std::string expects() const { return "text"; }
  std::string shown(const std::string& value) const { return value; }
  void check(const std::string&, const std::string&) const {}
};

/// One of a family's names.
struct Name {
  const char* family;                ///< "material"
  std::vector<Choice> (*choices)();  ///< what there is
  std::string expects() const;
  std::string shown(const std::string& value) const { return value; }
  void check(const std::string& path, const std::string& value) const;
};

/// A name of tissues(), which stands for a whole material.
struct TissueName {
  Name name{"tissue", tissues};
  std::string expects() const { return name.expects(); }
  template <class Material>
  std::string shown(const Material& of) const {
    return of.tissue;
  }
  template <class Material>
  void check(const std::string&, const Material&) const {}
};

/// A name of presets(), which stands for options of a whole problem.
struct PresetName {
  Name name{"preset", presets};
  std::string expects() const { return name.expects(); }
  template <class Problem>
  std::string shown(const Problem& of) const {
    return of.preset;
  }
  template <class Problem>
  void check(const std::string&, const Problem&) const {}
};

/// One name for all levels, or one for each.
struct NamePerLevel {
  Name name;
  std::string expects() const { return name.expects() + "; or a list of them, finest level first"; }
  std::string shown(const std::vector<std::string>& value) const;
  void check(const std::string& path, const std::vector<std::string>& value) const;
};

/// One count for all levels, or one for each; `auto` is 0.
struct AutoCountPerLevel {
  std::string expects() const {
    return AutoCount{}.expects() + "; or a list of them, finest level first";
  }
  std::string shown(const std::vector<int>& value) const;
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
  std::string expects() const {
    return name.expects() + "; or a list of shares, finest level first";
  }
  std::string shown(const Target& value) const { return value.rule; }
  void check(const std::string& path, const Target& value) const;
};

/// One or several values of a kind.
template <class Kind>
struct ListOf {
  Kind kind;
  std::string expects() const { return kind.expects() + "; or a list of them"; }
  template <class T>
  std::string shown(const std::vector<T>& value) const {
    std::string text;
    for (const T& item : value) text += (text.empty() ? "" : ", ") + kind.shown(item);
    return text;
  }
  template <class T>
  void check(const std::string& path, const std::vector<T>& value) const {
    for (std::size_t i = 0; i < value.size(); ++i)
      kind.check(path + "." + std::to_string(i), value[i]);
  }
};

/// An entry of a map of numbers, where it is given.
struct Entry {
  const char* name;
  Quantity quantity;
  using Map = std::map<std::string, double>;
  std::string expects() const { return quantity.expects(); }
  std::string shown(const Map& values) const {
    return values.contains(name) ? quantity.shown(values.at(name)) : "";
  }
  void check(const std::string& path, const Map& values) const {
    if (values.contains(name)) quantity.check(path, values.at(name));
  }
};

// Kinds of options that have options of their own.

/// A struct with a table, or an optional one.
struct Group {};
/// A vector of such.
struct List {};
/// Such by names of one's own.
struct Map {};
/// A struct with a table that a variant or an optional may hold.
template <class T>
struct Case {};

/// "Type::Member" from &Type::Member.
template <auto Member>
struct MemberOf;
template <class T, class M, M T::*Member>
struct MemberOf<Member> {
  using Type = T;
  using Value = M;
};
/// A value that stands for an alternative of a variant: that with this member, which has the kind.
template <auto Member, class Kind>
struct As : MemberOf<Member> {
  Kind kind;
  explicit As(const Kind& of_member) : kind(of_member) {}
  std::string expects() const { return kind.expects(); }
};
/// A list that stands for an alternative of a variant, in this member.
template <auto Member>
struct CaseList : MemberOf<Member> {};

}  // namespace plica::keys

namespace plica {

/// A number that a material asks for: body.material.NAME in a scene, and body.regions.REGION.NAME
/// for a region of its own.
struct MaterialParameter {
  const char* name;
  keys::Quantity kind;  ///< its unit and range
  const char* help;     ///< one line
  double standard;      ///< where nothing is given, in SI
};

/// What materials declare beyond the options that every body has.
std::vector<MaterialParameter> material_parameters();

}  // namespace plica
