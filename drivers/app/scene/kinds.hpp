// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <plica/core/mesh.hpp>
#include <plica/drivers/app/scene/scene.hpp>
#include <plica/drivers/app/scene/tree.hpp>
#include <plica/drivers/app/scene/units.hpp>
#include <plica/drivers/solver/registry.hpp>
#include <string>
#include <vector>

/// The kinds of value a scene's keys take. Each knows how to read one, how to say what is expected, and how to show one
/// as it would be written: the parser, the messages and `plica list keys` all ask the same object.
namespace plica::app {

/// A value to be read and the path that led to it.
struct Value {
  const Tree& tree;
  std::string path;

  [[noreturn]] void mismatch(const std::string& expected, const std::string& remark = {}) const;
  [[noreturn]] void error(const std::string& message) const;
  const std::string& scalar(const std::string& expected) const;  ///< its text; an error when it is no scalar
  const std::vector<Tree>& list(const std::string& expected, std::size_t size = 0) const;  ///< size 0: any
  Value item(std::size_t index) const;
};

struct Bounds {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool min_excluded = false;
  bool max_excluded = false;
  bool contains(double value) const;
  std::string text(const std::string& unit = {}) const;  ///< "> 0", "in [0, 0.5)"; empty when all values are in it
};
inline constexpr Bounds any_value{};
inline constexpr Bounds positive{.min = 0, .min_excluded = true};
inline constexpr Bounds not_negative{.min = 0};

/// A number with a unit.
struct Quantity {
  Dimension dimension;
  Bounds range = any_value;
  void read(const Value& value, double& target) const;
  void read(const Value& value, double& target, const std::string& expected) const;
  std::string expects() const;
  std::string shown(double value) const;
};

/// A quantity or `auto`.
struct AutoQuantity {
  Quantity quantity;
  void read(const Value& value, std::optional<double>& target) const;
  std::string expects() const { return quantity.expects() + ", or auto"; }
  std::string shown(const std::optional<double>& value) const { return value ? quantity.shown(*value) : "auto"; }
};

/// Three quantities of one dimension.
struct Vector {
  Dimension dimension;
  Bounds range = any_value;
  void read(const Value& value, Point& target) const;
  std::string expects() const;
  std::string shown(const Point& value) const;
};

/// A whole number.
struct Count {
  int min = 0;
  void read(const Value& value, int& target) const;
  std::string expects() const { return "a whole number >= " + std::to_string(min); }
  std::string shown(int value) const { return std::to_string(value); }
};

/// A whole number >= 1, or `auto`, which is 0.
struct AutoCount {
  void read(const Value& value, int& target) const;
  std::string expects() const { return "a whole number >= 1, or auto"; }
  std::string shown(int value) const { return value == 0 ? "auto" : std::to_string(value); }
};

/// Three whole numbers.
struct Counts {
  int min = 0;
  void read(const Value& value, std::array<int, 3>& target) const;
  std::string expects() const { return "a list of 3 whole numbers >= " + std::to_string(min); }
  std::string shown(const std::array<int, 3>& value) const;
};

/// true or false.
struct Flag {
  void read(const Value& value, bool& target) const;
  std::string expects() const { return "true or false"; }
  std::string shown(bool value) const { return value ? "true" : "false"; }
};

/// Any words.
struct Text {
  void read(const Value& value, std::string& target) const;
  std::string expects() const { return "text"; }
  std::string shown(const std::string& value) const { return value; }
};

/// One of a family's names.
struct Name {
  const char* family;                ///< "material"
  std::vector<Choice> (*choices)();  ///< what there is
  void read(const Value& value, std::string& target) const;
  std::string expects() const;
  std::string shown(const std::string& value) const { return value; }
};

/// A value that stands for an alternative with one member, which `Kind` reads.
template <class Alternative, class Member, class Kind>
struct As {
  Kind kind;
  template <class Target>
  void read(const Value& value, Target& target) const {
    Member member{};
    kind.read(value, member);
    target = Alternative{member};
  }
  std::string expects() const { return kind.expects(); }
};

/// One name for all levels, or one for each.
struct NamePerLevel {
  Name name;
  void read(const Value& value, std::vector<std::string>& target) const;
  std::string expects() const { return name.expects() + "; or a list of them, finest level first"; }
  std::string shown(const std::vector<std::string>& value) const;
};

/// One or several values of a kind.
template <class Kind>
struct ListOf {
  Kind kind;
  template <class T>
  void read(const Value& value, std::vector<T>& target) const {
    const bool one = value.tree.kind == Tree::Kind::scalar;
    target.resize(one ? 1 : value.list(expects()).size());
    if (target.empty()) value.mismatch(expects());
    for (std::size_t i = 0; i < target.size(); ++i) kind.read(one ? value : value.item(i), target[i]);
  }
  std::string expects() const { return kind.expects() + "; or a list of them"; }
  template <class T>
  std::string shown(const std::vector<T>& value) const {
    std::string text;
    for (const T& item : value) text += (text.empty() ? "" : ", ") + kind.shown(item);
    return text;
  }
};

/// One count for all levels, or one for each; `auto` is 0.
struct AutoCountPerLevel {
  void read(const Value& value, std::vector<int>& target) const;
  std::string expects() const { return "a whole number >= 1, or auto; or a list of them, finest level first"; }
  std::string shown(const std::vector<int>& value) const;
};

/// How often: in simulated time or in macro steps.
struct Every {
  void read(const Value& value, Interval& target) const;
  std::string expects() const { return "a time (s) > 0, or macro steps such as 10 steps"; }
  std::string shown(const Interval& value) const { return text_of(value); }
};

/// Which levels.
struct LevelChoice {
  void read(const Value& value, VolumeLevels& target) const;
  std::string expects() const { return "true (level 0), false, all, or a list of levels counted from 0, the finest"; }
  std::string shown(const VolumeLevels& value) const;
};

/// Points with names.
struct NamedPoints {
  void read(const Value& value, std::map<std::string, Point>& target) const;
  std::string expects() const { return "a map of names to lists of 3 lengths (m)"; }
  std::string shown(const std::map<std::string, Point>&) const { return {}; }
};

/// A rule by name, or the shares themselves.
struct Shares {
  struct Target {
    std::string& rule;
    std::vector<double>& shares;
  };
  Name name;
  void read(const Value& value, const Target& target) const;
  std::string expects() const { return name.expects() + "; or a list of shares, finest level first"; }
  std::string shown(const Target& value) const { return value.rule; }
};

}  // namespace plica::app
