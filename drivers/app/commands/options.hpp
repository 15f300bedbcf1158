// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <algorithm>
#include <map>
#include <plica/drivers/app/scene/kinds.hpp>
#include <string>

namespace plica::app {

/// The value of an option of the command line, read and checked as a scene's would be.
template <class Kind, class Target>
void read_option(const std::string& option, const std::string& text, const Kind& kind, Target& target) {
  const Tree tree{Tree::Kind::scalar, text, {}, {}, {}, {}};
  if constexpr (requires { kind.read(Value{tree, option}, target); })
    kind.read(Value{tree, option}, target);
  else
    kind.read(Value{tree, option}, target.emplace());
}

/// "young_modulus" on the command line: "--young-modulus".
inline std::string option_of(std::string key) {
  std::ranges::replace(key, '_', '-');
  return "--" + key;
}

/// Walks a table of a scene's keys (describe.hpp) and fills its struct from options of the same names.
class OptionReader {
 public:
  explicit OptionReader(const std::map<std::string, std::string>& given) : given_(given) {}
  template <class T, class Kind>
  void operator()(const char* key, T& member, const Kind& kind, const char*) const {
    if (const auto text = given_.find(key); text != given_.end())
      read_option(option_of(key), text->second, kind, member);
  }

 private:
  const std::map<std::string, std::string>& given_;
};

/// Walks the same table and calls add(option, key, what it may be, what it means).
template <class Add>
class OptionList {
 public:
  explicit OptionList(const Add& add) : add_(add) {}
  template <class T, class Kind>
  void operator()(const char* key, const T& member, const Kind& kind, const char* help) const {
    std::string expects = kind.expects();
    if constexpr (requires { kind.shown(member); }) expects += "; default " + kind.shown(member);
    add_(option_of(key), std::string(key), expects, std::string(help));
  }

 private:
  const Add& add_;
};

}  // namespace plica::app
