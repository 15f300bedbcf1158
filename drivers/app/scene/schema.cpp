// SPDX-License-Identifier: BSD-3-Clause
#include <plica/drivers/app/scene/describe.hpp>
#include <plica/drivers/app/scene/schema.hpp>

namespace plica::app {

using Json = nlohmann::ordered_json;

namespace {

// Walks the same tables as the reader, with defaults for values
class SchemaWriter {
 public:
  template <class T, class Kind>
  void operator()(const char* key, T&& member, const Kind& kind, const char* help) {
    std::string otherwise;
    if constexpr (requires { kind.shown(member); })
      otherwise = kind.shown(member);
    else if (member)
      otherwise = kind.shown(*member);
    add(key, schema_of(kind), said(help, kind) + (otherwise.empty() ? "" : "; default " + otherwise));
  }
  template <class T, class Kind>
  void required(const char* key, T&&, const Kind& kind, const char* help) {
    add(key, schema_of(kind), said(help, kind));
    required_.push_back(key);
  }
  template <class T>
  void group(const char* key, T& member, const char* help) {
    add(key, object_of(member), help);
  }
  template <class T>
  void group(const char* key, std::optional<T>&, const char* help) {
    add(key, object_of<T>(), help);
  }
  template <class T>
  void required_group(const char* key, T& member, const char* help) {
    add(key, object_of(member), help);
    required_.push_back(key);
  }
  template <class T>
  void list(const char* key, std::vector<T>&, const char* help) {
    add(key, {{"type", "array"}, {"items", object_of<T>()}, {"minItems", 1}}, help);
  }
  template <class T>
  void required_list(const char* key, std::vector<T>& member, const char* help) {
    list(key, member, help);
    required_.push_back(key);
  }
  template <class T>
  void map(const char* key, std::map<std::string, T>&, const char* help) {
    add(key, {{"type", "object"}, {"additionalProperties", object_of<T>()}}, help);
  }
  template <class Target, class T>
  void alternative(const char* key, Target&, T alternative, const char* help) {
    add(key, object_of(alternative), help);
    alternatives_.push_back({{"required", {key}}});
  }
  template <class T, class Kind>
  void alternative_value(const char* key, T&, const Kind& kind, const char* help) {
    add(key, schema_of(kind), said(help, kind));
    alternatives_.push_back({{"required", {key}}});
  }

  Json result() const {
    Json object = {{"type", "object"}, {"properties", properties_}, {"additionalProperties", false}};
    if (!required_.empty()) object["required"] = required_;
    if (!alternatives_.empty()) object["oneOf"] = alternatives_;
    return object;
  }

 private:
  template <class Kind>
  static std::string said(const char* help, const Kind& kind) {
    return std::string(help) + "\n" + kind.expects();
  }
  void add(const char* key, Json schema, const std::string& description) {
    schema["description"] = description;
    properties_[key] = std::move(schema);
  }
  template <class T>
  static Json object_of(T& member) {
    SchemaWriter deeper;
    describe(deeper, member);
    return deeper.result();
  }
  template <class T>
  static Json object_of() {
    T member{};
    return object_of(member);
  }

  Json properties_ = Json::object(), required_ = Json::array(), alternatives_ = Json::array();
};

}  // namespace

Json scene_schema() {
  SchemaWriter writer;
  Scene scene;
  describe(writer, scene);
  Json schema = {{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", "a scene of Plica"}};
  schema.update(writer.result());
  return schema;
}

}  // namespace plica::app
