// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <nlohmann/json.hpp>

#include "daemon/settings/settings_documents.hpp"
#include "daemon/settings/settings_sections.hpp"

namespace deltamap::daemon {
namespace {

using Json = nlohmann::ordered_json;

/// What YAML reads from an unquoted word: 9600 is a number, 180/1 and off are text.
Json as_yaml_reads(const std::string& word) {
  Json number = Json::parse(word, nullptr, false);
  return number.is_number() ? number : Json(word);
}

Json default_of(const SettingKey& key) {
  const std::string text = key.text();
  switch (key.type) {
    case SettingKey::Type::kText:
      return text.starts_with('"') ? Json::parse(text) : Json(text);
    case SettingKey::Type::kWord:
      return as_yaml_reads(text);
    default:
      return Json::parse(text);
  }
}

Json bound(const SettingKey& key, double value) {
  return key.type == SettingKey::Type::kWhole ? Json(static_cast<std::int64_t>(value)) : Json(value);
}

void add_limits(const SettingKey& key, Json& schema) {
  using Type = SettingKey::Type;
  switch (key.type) {
    case Type::kFlag:
      schema["type"] = "boolean";
      return;
    case Type::kText:
      schema["type"] = "string";
      return;
    case Type::kWord:
      for (const std::string& word : key.words) schema["enum"].push_back(as_yaml_reads(word));
      return;
    case Type::kPose:
      schema["type"] = {"array", "null"};
      schema["items"] = {{"type", "number"}};
      schema["minItems"] = 3;
      schema["maxItems"] = 3;
      return;
    case Type::kBearings:
      schema["type"] = "array";
      schema["items"] = {{"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", 2}, {"maxItems", 2}};
      return;
    case Type::kNumber:
    case Type::kWhole:
      schema["type"] = key.type == Type::kWhole ? "integer" : "number";
      if (key.low) schema["minimum"] = bound(key, *key.low);
      if (key.high) schema["maximum"] = bound(key, *key.high);
  }
}

/// What an editor shows beside the key.
std::string description_of(const SettingKey& key) {
  std::string text = key.meaning;
  if (!key.symbol.empty()) text += " (" + key.symbol + ")";
  const std::string limits = key.type == SettingKey::Type::kWord ? "" : limits_of(key);
  if (!limits.empty()) text += ". " + limits;
  return text + (key.is_live ? ". Taken by a reload" : ". Needs a restart");
}

Json schema_of(const SettingKey& key) {
  Json schema{{"description", description_of(key)}};
  add_limits(key, schema);
  schema["default"] = default_of(key);
  return schema;
}

/// A section may be empty, which YAML reads as null.
Json section_schema(const std::string& meaning) {
  return {{"description", meaning},
          {"type", {"object", "null"}},
          {"additionalProperties", false},
          {"properties", Json::object()}};
}

/// The properties that the last part of `name` belongs to; sections on the way are begun.
Json& properties_for(const std::string& name, Json& root) {
  Json* properties = &root["properties"];
  for (auto dot = name.find('.'), start = std::size_t{0}; dot != std::string::npos; dot = name.find('.', start)) {
    const std::string part = name.substr(start, dot - start);
    if (!properties->contains(part)) (*properties)[part] = section_schema(meaning_of_section(name.substr(0, dot)));
    properties = &(*properties)[part]["properties"];
    start = dot + 1;
  }
  return *properties;
}

}  // namespace

std::string settings_schema() {
  Settings settings;
  Json root = section_schema("one settings file; what it leaves out is as delivered");
  root.update({{"title", "Settings of deltamapd"}});
  for (const SettingKey& key : keys_of(settings)) {
    properties_for(key.name, root)[key.name.substr(key.name.rfind('.') + 1)] = schema_of(key);
  }
  Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
              {"$comment", "SPDX-License-Identifier: Apache-2.0. Written by deltamapd --print-schema"}};
  schema.update(root);
  return schema.dump(2) + "\n";
}

}  // namespace deltamap::daemon
