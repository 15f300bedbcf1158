// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <plica/core/text.hpp>
#include <plica/drivers/app/scene/tree.hpp>
#include <sstream>

namespace plica::app {
namespace {

SourceLocation place(const std::string& file, const YAML::Mark& mark) {
  return {file, mark.is_null() ? 0 : mark.line + 1};
}

// Returns the text as it can be printed: U+FFFD stands for bytes that are no UTF-8, and for control
// characters, which could command a terminal. Throws InputError for NUL
std::string printable(const std::string& raw, const SourceLocation& where) {
  std::string text;
  for (const char c : valid_utf8(raw)) {
    if (c == '\0') throw InputError("a text has the character NUL; expected text to read", where);
    const bool is_control = (c > 0 && c < ' ' && c != '\n' && c != '\t' && c != '\r') || c == 0x7f;
    is_control ? text += "\xef\xbf\xbd" : text += c;
  }
  return text;
}

// Converts YAML's nodes to a tree of values. An alias may stand for a value that contains it, so
// depth and number of values are limited: without aliases, a text has fewer values than characters
class Conversion {
 public:
  Conversion(const std::string& file, const std::string& text)
      : file_(file), most_(std::max<std::size_t>(100'000, text.size())) {}
  Tree operator()(const YAML::Node& node);

 private:
  void add_entry(Tree& map, const YAML::Node& key, const YAML::Node& value);

  const std::string& file_;
  std::size_t most_, values_ = 0;
  int depth_ = 0;
};

void Conversion::add_entry(Tree& map, const YAML::Node& key, const YAML::Node& value) {
  const SourceLocation where = place(file_, key.Mark());
  if (!key.IsScalar()) throw InputError("a key must be a word", where);
  const std::string name = printable(key.Scalar(), where);
  if (const Tree* earlier = map.find(name)) {
    throw InputError("duplicate key '" + name + "'; the first is in line " +
                         std::to_string(earlier->key_where.line),
                     where);
  }
  Tree entry = (*this)(value);
  entry.key = name;
  entry.key_where = where;
  if (entry.kind == Tree::Kind::nothing) entry.where = where;
  map.items.push_back(std::move(entry));
}

Tree Conversion::operator()(const YAML::Node& node) {
  constexpr int deepest = 50;
  Tree tree;
  tree.where = tree.key_where = place(file_, node.Mark());
  if (++depth_ > deepest)
    throw InputError(fmt::format("nested more than {} deep", deepest), tree.where);
  if (++values_ > most_)
    throw InputError(fmt::format("more than {} values, aliases included", most_), tree.where);
  if (node.IsScalar()) {
    tree.kind = Tree::Kind::scalar;
    tree.text = printable(node.Scalar(), tree.where);
  } else if (node.IsSequence()) {
    tree.kind = Tree::Kind::list;
    for (const YAML::Node& item : node) tree.items.push_back((*this)(item));
  } else if (node.IsMap()) {
    tree.kind = Tree::Kind::map;
    for (const auto& entry : node) add_entry(tree, entry.first, entry.second);
  }
  --depth_;
  return tree;
}

// Returns whether the quoted text that begins at this place has an end
bool has_end_quote(const std::string& text, std::size_t at) {
  if (at >= text.size() || (text[at] != '"' && text[at] != '\'')) return true;
  const char quote = text[at];
  for (++at; at < text.size(); ++at) {
    if (quote == '"' && text[at] == '\\')
      ++at;  // the next character stands for itself
    else if (text[at] == quote && quote == '\'' && text.compare(at, 2, "''") == 0)
      ++at;  // a quote in the text
    else if (text[at] == quote)
      return true;
  }
  return false;
}

// Finds where the documents of a text begin, and its quotes. (YAML::LoadAll() of yaml-cpp 0.7 never
// returns from a stray '}'. It takes the end of the text for a quote that is missing.)
class Documents final : public YAML::EventHandler {
 public:
  // Throws InputError for a second document and for a quote that is not closed
  static void expect_one(const std::string& text, const std::string& file) {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    Documents documents;
    const bool is_another =
        parser.HandleNextDocument(documents) && parser.HandleNextDocument(documents);
    if (is_another)
      throw InputError("a second YAML document begins here; a scene is one",
                       place(file, documents.start_));
    const std::size_t mark =
        text.starts_with("\xef\xbb\xbf") ? 3 : 0;  // bytes before the text, of UTF-8
    if (!documents.quoted_.is_null() &&
        !has_end_quote(text, mark + static_cast<std::size_t>(documents.quoted_.pos)))
      throw InputError("not YAML: a quote is not closed", place(file, documents.quoted_));
  }

 private:
  using Mark = YAML::Mark;
  using Text = const std::string&;
  void OnDocumentStart(const Mark& mark) override { start_ = mark; }
  void OnDocumentEnd() override {}
  void OnNull(const Mark&, YAML::anchor_t) override {}
  void OnAlias(const Mark&, YAML::anchor_t) override {}
  void OnScalar(const Mark& mark, Text tag, YAML::anchor_t, Text) override {
    if (tag == "!") quoted_ = mark;  // the last one alone may lack its end
  }
  void OnSequenceStart(const Mark&, Text, YAML::anchor_t, YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const Mark&, Text, YAML::anchor_t, YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}

  Mark start_, quoted_ = Mark::null_mark();
};

// Returns the entry of a list by its number, or that of a map by its key; null: there is none
const Tree* entry_of(const Tree& tree, const std::string& part) {
  if (tree.kind != Tree::Kind::list) return tree.find(part);
  std::size_t index = 0;
  const char* end = part.data() + part.size();
  const auto [rest, error] = std::from_chars(part.data(), end, index);
  const bool is_entry = error == std::errc{} && rest == end && index < tree.items.size();
  return is_entry ? &tree.items[index] : nullptr;
}

// Returns the value that one part of a path leads to. The part is the number of an item of a list,
// or the key of a map; a missing key is made
Tree& stepped(Tree& tree, const std::string& part, const SourceLocation& where) {
  if (const Tree* entry = entry_of(tree, part))
    return tree.items[static_cast<std::size_t>(entry - tree.items.data())];
  if (tree.kind == Tree::Kind::list)
    throw InputError("'" + part + "' is no entry of this list, which has " +
                         std::to_string(tree.items.size()) + ", counted from 0",
                     where);
  if (tree.kind == Tree::Kind::scalar)
    throw InputError(
        "cannot set '" + part + "' inside " + tree.to_text() + ", which is a single value", where);
  tree.kind = Tree::Kind::map;
  Tree& made = tree.items.emplace_back();
  made.key = part;
  made.where = made.key_where = where;
  return made;
}

// Returns the YAML library's message about a text, after the likely cause.
std::string fault_of(const std::string& text, const YAML::Exception& error) {
  std::istringstream lines(text);
  std::string line, likely;
  for (int n = 0; n <= error.mark.line; ++n) std::getline(lines, line);
  if (line.substr(0, line.find_first_not_of(" \t")).find('\t') != line.npos)
    likely = "a tab begins the line; expected spaces";
  else if (error.msg.ends_with("flow not found"))
    likely = "a bracket is still open";
  else if (error.msg == "illegal map value")
    likely = "expected quotes around a text with ': ' in it, and all keys of a map in one column";
  return "not YAML: " + (likely.empty() ? error.msg : likely + " (" + error.msg + ")");
}

}  // namespace

const Tree* Tree::find(std::string_view name) const {
  if (kind != Kind::map) return nullptr;
  for (const Tree& item : items)
    if (item.key == name) return &item;
  return nullptr;
}

std::string Tree::to_text() const {
  constexpr std::size_t most = 80;  // maximum length of a text [bytes]
  if (kind == Kind::scalar && text.size() > most) {
    std::size_t end = most;
    // cuts at the end of a character
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
    return "'" + text.substr(0, end) + "...'";
  }
  if (kind == Kind::scalar) return "'" + text + "'";
  if (kind == Kind::list) return "a list of " + std::to_string(items.size());
  if (kind == Kind::nothing) return "nothing";
  std::string keys;
  for (const Tree& item : items) keys += (keys.empty() ? "" : ", ") + item.key;
  return keys.empty() ? "an empty map" : "a map (" + keys + ")";
}

Tree parse_tree(const std::string& text, const std::string& file) {
  try {
    const YAML::Node document = YAML::Load(text);
    Documents::expect_one(text, file);
    if (document.IsNull()) throw InputError("the scene is empty", {file});
    return Conversion(file, text)(document);
  } catch (const YAML::Exception& error) {
    throw InputError(fault_of(text, error), place(file, error.mark));
  }
}

Tree read_tree(const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file))
    throw InputError(std::filesystem::exists(file) ? "this is not a file" : "there is no such file",
                     {file.string()});
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream) throw InputError("the file cannot be read", {file.string()});
  return parse_tree(text.str(), file.string());
}

void override_value(Tree& root, const std::string& assignment, const std::string& label) {
  const SourceLocation where{label, 0};
  const std::size_t equals = assignment.find('=');
  if (equals == 0 || equals == std::string::npos)
    throw InputError("expected key.path=value", where);
  Tree value;
  try {
    const std::string text = assignment.substr(equals + 1);
    value = Conversion(where.file, text)(YAML::Load(text));
    Documents::expect_one(text, where.file);
  } catch (const YAML::Exception& error) {
    throw InputError(fault_of(assignment.substr(equals + 1), error), where);
  }
  Tree* target = &root;
  std::istringstream path(valid_utf8(assignment.substr(0, equals)));
  for (std::string part; std::getline(path, part, '.');) target = &stepped(*target, part, where);
  const auto place_all = [&where](Tree& tree, const auto& self) -> void {
    tree.where = tree.key_where = where;  // a line number within the argument has no use
    for (Tree& item : tree.items) self(item, self);
  };
  place_all(value, place_all);
  value.key = target->key;
  *target = std::move(value);
}

SourceLocation place_of(const Tree& root, std::string_view path) {
  const Tree* tree = &root;
  std::istringstream parts{std::string(path)};
  for (std::string part; std::getline(parts, part, '.');) {
    const Tree* next = entry_of(*tree, part);
    if (next == nullptr) break;
    tree = next;
  }
  return tree->key_where;
}

using Json = nlohmann::ordered_json;

Json json_of(const Tree& tree) {
  if (tree.kind == Tree::Kind::scalar) return tree.text;
  if (tree.kind == Tree::Kind::nothing) return nullptr;
  Json json = tree.kind == Tree::Kind::list ? Json::array() : Json::object();
  for (const Tree& item : tree.items) {
    if (tree.kind == Tree::Kind::list)
      json.push_back(json_of(item));
    else
      json[item.key] = json_of(item);
  }
  return json;
}

Tree tree_of(const Json& json, const std::string& file) {
  Tree tree;
  tree.where.file = tree.key_where.file = file;
  if (json.is_string()) {
    tree.kind = Tree::Kind::scalar;
    tree.text = printable(json.get<std::string>(), tree.where);
  } else if (json.is_structured()) {
    tree.kind = json.is_array() ? Tree::Kind::list : Tree::Kind::map;
    for (const auto& [key, value] : json.items()) {
      tree.items.push_back(tree_of(value, file));
      if (json.is_object()) tree.items.back().key = printable(key, tree.where);
    }
  }
  return tree;
}

namespace {

std::string below(const std::string& path, const std::string& key) {
  return path.empty() ? key : path + "." + key;
}

std::string difference(const Tree& before, const Tree& now, const std::string& path,
                       const std::string& but_for) {
  const bool map = before.kind == Tree::Kind::map;
  if (before.kind != now.kind || before.text != now.text ||
      (!map && before.items.size() != now.items.size()))
    return path + ": " + before.to_text() + " became " + now.to_text();
  for (std::size_t i = 0; i < before.items.size(); ++i) {
    const Tree& item = before.items[i];
    if (map && item.key == but_for) continue;
    const std::string inside = below(path, map ? item.key : std::to_string(i));
    const Tree* other = map ? now.find(item.key) : &now.items[i];
    if (other == nullptr) return inside + ": " + item.to_text() + " is not there any more";
    if (std::string found = difference(item, *other, inside, {}); !found.empty()) return found;
  }
  for (const Tree& item : now.items)
    if (map && item.key != but_for && before.find(item.key) == nullptr)
      return below(path, item.key) + ": is new";
  return {};
}

}  // namespace

std::string first_difference(const Tree& before, const Tree& now, const std::string& but_for) {
  return difference(before, now, {}, but_for);
}

}  // namespace plica::app
