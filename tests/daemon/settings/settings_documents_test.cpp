// SPDX-License-Identifier: Apache-2.0
// What is written from the list of keys: config/default.yaml, the JSON schema, docs/configuration.md.
#include "daemon/settings/settings_documents.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "daemon/settings/reader/nearest_key.hpp"
#include "daemon/settings/settings_sections.hpp"
#include "tests/support/files/source_tree.hpp"
#include "tests/support/files/text_file.hpp"

namespace deltamap::daemon {
namespace {

using Json = nlohmann::json;

std::string document(const std::string& file) { return test::content_of(test::source_path(file)); }

bool has_type(const Json& value, const std::string& type) {
  if (type == "integer") return value.is_number_integer();
  if (type == "number") return value.is_number();
  return type == value.type_name();
}

bool is_in(const Json& value, const Json& list) { return std::find(list.begin(), list.end(), value) != list.end(); }

bool has_one_type(const Json& value, const Json& types) {
  if (types.is_string()) return has_type(value, types);
  return std::any_of(types.begin(), types.end(), [&](const Json& one) { return has_type(value, one); });
}

/// Judges a leaf by each keyword of its schema, as JSON Schema 2020-12 has them; fails on one that it does not know.
bool is_valid(const Json& value, const Json& schema) {
  for (const auto& [keyword, rule] : schema.items()) {
    bool holds = true;
    if (keyword == "type") {
      holds = has_one_type(value, rule);
    } else if (keyword == "enum") {
      holds = is_in(value, rule);
    } else if (keyword == "minimum") {
      holds = !value.is_number() || value.get<double>() >= rule.get<double>();
    } else if (keyword == "maximum") {
      holds = !value.is_number() || value.get<double>() <= rule.get<double>();
    } else if (keyword == "minItems") {
      holds = !value.is_array() || value.size() >= rule.get<std::size_t>();
    } else if (keyword == "maxItems") {
      holds = !value.is_array() || value.size() <= rule.get<std::size_t>();
    } else if (keyword == "items") {
      holds = !value.is_array() || std::all_of(value.begin(), value.end(),
                                               [&, &each = rule](const Json& one) { return is_valid(one, each); });
    } else {
      EXPECT_TRUE(keyword == "description" || keyword == "default") << keyword;
    }
    if (!holds) return false;
  }
  return true;
}

/// As the YAML reader hands it over.
SettingValue setting_value(const Json& value) {
  const auto text = [](const Json& one) { return one.is_string() ? one.get<std::string>() : one.dump(); };
  if (value.is_null()) return {};
  if (!value.is_array()) return {SettingValue::Kind::kScalar, {text(value)}};
  SettingValue list{SettingValue::Kind::kList, {}};
  for (const Json& one : value) list.items.push_back(text(one));
  return list;
}

/// Values of every type, at and beyond both ends of the key's range.
std::vector<Json> probes_for(const SettingKey& key) {
  std::vector<Json> probes{nullptr,
                           true,
                           false,
                           0,
                           1,
                           -1,
                           1.5,
                           "some words",
                           Json::array(),
                           Json::array({1, 2}),
                           Json::array({1, -2.5, 90}),
                           Json::array({1, 2, "x"}),
                           Json::array({1, 2, 3, 4})};
  for (const auto& end : {key.low, key.high}) {
    if (!end) continue;
    const bool is_whole = key.type == SettingKey::Type::kWhole;
    const double step = is_whole ? 1.0 : std::max(1e-9, 1e-3 * std::abs(*end));
    for (const double value : {*end - step, *end, *end + step}) {
      probes.push_back(is_whole ? Json(static_cast<std::int64_t>(value)) : Json(value));
    }
  }
  for (const std::string& word : key.words) {
    const Json number = Json::parse(word, nullptr, false);
    probes.push_back(number.is_number() ? number : Json(word));
  }
  return probes;
}

const Json& schema_of(const std::string& key, const Json& schema) {
  const auto dot = key.find('.');
  const Json& below = schema.at("properties").at(key.substr(0, dot));
  return dot == std::string::npos ? below : schema_of(key.substr(dot + 1), below);
}

std::size_t leaves_of(const Json& schema) {
  if (!schema.contains("properties")) return 1;
  EXPECT_EQ(schema.at("additionalProperties"), false) << schema.at("description");
  EXPECT_FALSE(schema.at("description").get<std::string>().empty());
  std::size_t leaves = 0;
  for (const Json& one : schema.at("properties")) leaves += leaves_of(one);
  return leaves;
}

TEST(SettingsDocuments, NumbersAreSuchToReadersOfYaml11) {
  Settings settings;
  settings.initial_pose = Pose2{1e-5, -1e5, 0.0};
  const std::string yaml = settings_as_yaml(settings);
  EXPECT_FALSE(std::regex_search(yaml, std::regex{R"([:,[] ?-?\d+e[-+]?\d)"})) << "without a point it is a word there";
  EXPECT_NE(yaml.find("kidnapping_prior: 1.0e-05 "), std::string::npos);
}

TEST(SettingsDocuments, TheWrittenFilesAreWhatTheProgramWrites) {
  EXPECT_EQ(document("config/default.yaml"), settings_as_yaml(Settings{}))
      << "write it anew: deltamapd --config /dev/null --print-config > config/default.yaml";
  EXPECT_EQ(document("config/deltamap.schema.json"), settings_schema())
      << "write it anew: deltamapd --print-schema > config/deltamap.schema.json";
  EXPECT_EQ(document("docs/configuration.md"), settings_page())
      << "write it anew: deltamapd --print-configuration-md > docs/configuration.md";
}

TEST(SettingsDocuments, EverySectionHasItsHeadingAndNoHeadingIsLeftOver) {
  Settings settings;
  const auto sections = sections_of(keys_of(settings));
  std::set<std::string> headed;
  for (const SettingSection& one : setting_sections()) {
    EXPECT_FALSE(one.meaning.empty()) << one.name;
    EXPECT_TRUE(headed.insert(one.name).second) << one.name << " has two";
  }
  EXPECT_EQ(headed, std::set<std::string>(sections.begin(), sections.end()));
}

TEST(SettingsDocuments, EveryMeaningStandsAlone) {
  Settings settings;
  for (const SettingKey& key : keys_of(settings)) {
    EXPECT_GE(key.meaning.size(), 12u) << key.name;
    EXPECT_EQ(key.meaning.find('\n'), std::string::npos) << key.name;
    EXPECT_EQ(key.meaning.find("likewise"), std::string::npos) << key.name;
    for (const char* leaning : {"of ", "or ", "and ", "likewise", "the same ", "such ", "… "}) {
      EXPECT_FALSE(key.meaning.starts_with(leaning)) << key.name << ": " << key.meaning;
    }
  }
}

TEST(SettingsDocuments, NumbersHaveTheUnitThatTheirNameTells) {
  Settings settings;
  const std::vector<std::pair<std::string, std::string>> units{
      {"_m_per_s", "m/s"},         {"_m_per_s2", "m/s^2"},
      {"_deg_per_s", "degrees/s"}, {"_deg_per_s2", "degrees/s^2"},
      {"_deg", "degrees"},         {"_s", "s"}};
  int told = 0;
  for (const SettingKey& key : keys_of(settings)) {
    const auto* unit = &units.front();
    std::size_t longest = 0;
    for (const auto& one : units) {
      if (key.name.ends_with(one.first) && one.first.size() > longest) {
        longest = one.first.size();
        unit = &one;
      }
    }
    if (longest == 0) continue;
    EXPECT_EQ(key.unit, unit->second) << key.name;
    ++told;
  }
  EXPECT_GT(told, 15);
}

TEST(SettingsSchema, HoldsEveryKeyAndNoOther) {
  const Json schema = Json::parse(settings_schema());
  Settings settings;
  const auto keys = keys_of(settings);
  EXPECT_EQ(schema.at("$schema"), "https://json-schema.org/draft/2020-12/schema");
  EXPECT_EQ(leaves_of(schema), keys.size());
  for (const SettingKey& key : keys) {
    const Json& one = schema_of(key.name, schema);
    EXPECT_TRUE(one.at("description").get<std::string>().starts_with(key.meaning)) << key.name;
    EXPECT_TRUE(is_valid(one.at("default"), one)) << key.name << ": " << one;
  }
}

TEST(SettingsSchema, IsOfOneMindWithTheStrictReader) {
  const Json schema = Json::parse(settings_schema());
  Settings settings;
  std::size_t taken = 0;
  std::size_t refused = 0;
  for (const SettingKey& key : keys_of(settings)) {
    for (const Json& value : probes_for(key)) {
      // The reader takes an unquoted number for a text, or for a word, where one is wanted.
      if (key.type == SettingKey::Type::kText && value.is_primitive() && !value.is_null() && !value.is_string())
        continue;
      const bool is_taken = !key.assign(setting_value(value));
      EXPECT_EQ(is_valid(value, schema_of(key.name, schema)), is_taken) << key.name << ": " << value;
      ++(is_taken ? taken : refused);
    }
  }
  EXPECT_GT(taken, 300u);
  EXPECT_GT(refused, 800u);
}

}  // namespace
}  // namespace deltamap::daemon
