// SPDX-License-Identifier: Apache-2.0
#include "tool/decode/frame_text.hpp"

#include <nlohmann/json.hpp>

namespace deltamap::tool {
namespace {

using FieldJson = nlohmann::ordered_json;

constexpr std::size_t kLongestText = 200;

FieldJson object_of(const NamedFields& fields) {
  FieldJson object = FieldJson::object();
  for (const auto& [name, value] : fields) {
    std::visit([&object, &key = name](const auto& v) { object[key] = v; }, value);
  }
  return object;
}

std::string shortened(const FieldJson& value, std::size_t longest_list) {
  if (value.is_string()) {
    const auto text = value.get<std::string>();
    if (text.size() <= kLongestText) return text;
    return text.substr(0, kLongestText) + "… (" + std::to_string(text.size()) + " characters)";
  }
  if (!value.is_array() || value.size() <= longest_list) return value.dump();
  const auto end = value.begin() + static_cast<std::ptrdiff_t>(longest_list);
  std::string text = FieldJson(value.begin(), end).dump();
  text.pop_back();
  return text + ",…] (" + std::to_string(value.size()) + " values)";
}

}  // namespace

std::string json_of(const NamedFields& fields) {
  return object_of(fields).dump(-1, ' ', false, FieldJson::error_handler_t::replace);
}

std::string text_of(const NamedFields& fields, std::size_t longest_list) {
  std::string text;
  const FieldJson object = object_of(fields);
  for (const auto& [name, value] : object.items()) {
    text.append("  ").append(name).append(": ").append(shortened(value, longest_list)).append("\n");
  }
  return text;
}

}  // namespace deltamap::tool
