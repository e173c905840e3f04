// SPDX-License-Identifier: Apache-2.0
// Every key of the configuration with every kind of bad value: exactly one line each, that names place, key and rule.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <string>
#include <vector>

#include "daemon/settings/former_keys.hpp"
#include "daemon/settings/settings.hpp"
#include "tests/support/daemon/settings_lines.hpp"

namespace deltamap::daemon {
namespace {

using test::errors_of;
using test::Lines;
using Type = SettingKey::Type;

/// The key alone in a file, each part on a line of its own; `value` stands behind the last colon.
std::string nested(const std::string& key, const std::string& value) {
  std::string yaml;
  std::size_t start = 0;
  int depth = 0;
  for (auto dot = key.find('.'); dot != std::string::npos; dot = key.find('.', start), ++depth) {
    yaml += std::string(2 * static_cast<std::size_t>(depth), ' ') + key.substr(start, dot - start) + ":\n";
    start = dot + 1;
  }
  return yaml + std::string(2 * static_cast<std::size_t>(depth), ' ') + key.substr(start) + ":" +
         (value.empty() ? "" : " " + value) + "\n";
}

long depth_of(const std::string& key) { return std::count(key.begin(), key.end(), '.'); }

/// Where nested() puts the value.
std::string place_of_value(const std::string& key) {
  const auto leaf = key.size() - (key.rfind('.') == std::string::npos ? 0 : key.rfind('.') + 1);
  const auto column = 2 * static_cast<std::size_t>(depth_of(key)) + leaf + 3;
  return "f:" + std::to_string(depth_of(key) + 1) + ":" + std::to_string(column);
}

std::string place_of_key(const std::string& key) {
  return "f:" + std::to_string(depth_of(key) + 1) + ":" + std::to_string(2 * depth_of(key) + 1);
}

std::string number_text(const SettingKey& key, double value) {
  if (key.type == Type::kWhole) return std::to_string(static_cast<long long>(value));
  char text[40];
  (void)std::snprintf(text, sizeof text, "%.12g", value);
  return text;
}

struct BadValue {
  std::string yaml;
  std::string found;  // as the line quotes it
};

std::vector<BadValue> of_the_wrong_type(const SettingKey& key) {
  std::vector<BadValue> bad;
  const auto word = [&bad](const std::string& text) { bad.push_back({text, "'" + text + "'"}); };
  if (key.type != Type::kText) {
    word("nonsense");
    bad.push_back({"\"1\"", key.type == Type::kWord ? "'1'" : "'1' in quotes"});
    word("2026-11-23");
  }
  if (key.type != Type::kText && key.type != Type::kNumber && key.type != Type::kWhole) word("1.25");
  if (key.type == Type::kNumber || key.type == Type::kWhole) {
    for (const char* text : {"true", "0x10", "1,5", ".inf", ".nan", "1e", "--1", "+-1", "1 m"}) word(text);
  }
  if (key.type == Type::kWhole) word("1.5");
  if (key.type == Type::kPose) bad.push_back({"[1, 2]", "a list of 2"});
  if (key.type != Type::kPose) bad.push_back({"[1, 2, 3]", "a list"});
  return bad;
}

TEST(EveryKey, OfTheWrongTypeIsNamedWithItsPlaceAndWhatItNeeds) {
  Settings settings;
  int tried = 0;
  for (const SettingKey& key : keys_of(settings)) {
    for (const BadValue& bad : of_the_wrong_type(key)) {
      const Lines lines = errors_of(nested(key.name, bad.yaml));
      ASSERT_EQ(lines.size(), 1u) << key.name << ": " << bad.yaml;
      EXPECT_TRUE(lines[0].starts_with(place_of_value(key.name) + ": " + key.name + ": needs ")) << lines[0];
      EXPECT_TRUE(lines[0].ends_with(", not " + bad.found)) << lines[0];
      ++tried;
    }
  }
  EXPECT_GT(tried, 800);
}

TEST(EveryKey, TakesNoKeysBelowItself) {
  Settings settings;
  for (const SettingKey& key : keys_of(settings)) {
    EXPECT_EQ(errors_of(nested(key.name, "{a: 1}")),
              Lines{place_of_value(key.name) + ": " + key.name + ": takes one value, not keys"});
  }
}

TEST(EveryKey, OutsideItsRangeIsNamedWithTheRange) {
  Settings settings;
  int tried = 0;
  for (const SettingKey& key : keys_of(settings)) {
    std::vector<double> outside;
    if (key.low) outside.push_back(*key.low - std::max(1.0, std::abs(*key.low)));
    if (key.high) outside.push_back(*key.high + std::max(1.0, std::abs(*key.high)));
    for (const double value : outside) {
      const std::string text = number_text(key, value);
      const std::string number = key.type == Type::kWhole ? "a whole number" : "a number";
      EXPECT_EQ(errors_of(nested(key.name, text)),
                Lines{place_of_value(key.name) + ": " + key.name + ": needs " + number + " in its range (" +
                      limits_of(key) + "), not '" + text + "'"});
      ++tried;
    }
  }
  EXPECT_GT(tried, 100);
}

TEST(EveryKey, WithoutAValueIsNamedAtItself) {
  Settings settings;
  for (const SettingKey& key : keys_of(settings)) {
    for (const char* nothing : {"", "null", "~"}) {
      const Lines lines = errors_of(nested(key.name, nothing));
      if (key.type == Type::kPose) {
        EXPECT_EQ(lines, Lines{}) << "null is a value of it";
        continue;
      }
      ASSERT_EQ(lines.size(), 1u) << key.name;
      EXPECT_TRUE(lines[0].starts_with(place_of_key(key.name) + ": " + key.name + ": needs ")) << lines[0];
      EXPECT_TRUE(lines[0].ends_with(", not nothing")) << lines[0];
    }
  }
}

TEST(EveryKey, GivenTwiceIsNamedNestedOrDotted) {
  Settings settings;
  for (const SettingKey& key : keys_of(settings)) {
    const std::string once = nested(key.name, key.text());
    const auto line = std::to_string(depth_of(key.name) + 1);
    const std::string dotted = key.name + ": " + key.text() + "\n";
    const auto next = std::to_string(depth_of(key.name) + 2);
    EXPECT_EQ(errors_of(once + dotted),
              Lines{"f:" + next + ":1: " + key.name + ": given twice, first in line " + line});
    const std::string leaf = once.substr(once.rfind('\n', once.size() - 2) + 1);
    const std::string column = std::to_string(2 * depth_of(key.name) + 1);
    EXPECT_EQ(errors_of(once + leaf),
              Lines{"f:" + next + ":" + column + ": " + key.name + ": given twice, first in line " + line});
  }
}

TEST(EveryKey, ThatIsAbsentHasItsDefault) {
  Settings settings = parse_settings("", "f");
  Settings delivered;
  const auto read = keys_of(settings);
  const auto expected = keys_of(delivered);
  for (std::size_t i = 0; i < read.size(); ++i) EXPECT_EQ(read[i].text(), expected[i].text()) << read[i].name;
}

TEST(EveryKey, MisspeltIsFoundAgain) {
  Settings settings;
  for (const SettingKey& key : keys_of(settings)) {
    if (key.name.size() - key.name.rfind('.') < 4) continue;  // too short to be misspelt and known
    std::string wrong = key.name;
    std::swap(wrong[wrong.size() - 1], wrong[wrong.size() - 2]);
    if (wrong == key.name) wrong += 'x';
    const Lines lines = errors_of(nested(wrong, "1"));
    ASSERT_EQ(lines.size(), 1u) << wrong;
    EXPECT_TRUE(lines[0].starts_with(place_of_key(key.name) + ": " + wrong + ": unknown key (nearest key "))
        << lines[0];
    EXPECT_NE(lines[0].find(key.name.substr(0, key.name.rfind('.'))), std::string::npos) << lines[0];
  }
}

TEST(EveryKey, AllAtOnceAreToldByLine) {
  Settings settings;
  std::string yaml;
  int line = 0;
  Lines expected;
  for (const SettingKey& key : keys_of(settings)) {
    if (key.type != Type::kNumber || expected.size() == 50) continue;
    yaml += key.name + ": far\n";
    expected.push_back("f:" + std::to_string(++line) + ":" + std::to_string(key.name.size() + 3) + ": " + key.name +
                       ": needs a number (" + limits_of(key) + "), not 'far'");
  }
  EXPECT_EQ(errors_of(yaml), expected);
}

TEST(EveryKey, IsNoFormerOne) {
  Settings settings;
  auto former = former_keys();
  std::set<std::string> names;
  for (const SettingKey& key : keys_of(settings)) {
    EXPECT_FALSE(former.contains(key.name)) << key.name;
    names.insert(key.name);
  }
  for (const auto& [name, new_name] : former)
    EXPECT_TRUE(new_name.empty() || names.contains(new_name)) << name << " -> " << new_name;
}

}  // namespace
}  // namespace deltamap::daemon
