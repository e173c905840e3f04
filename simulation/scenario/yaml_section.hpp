// SPDX-License-Identifier: Apache-2.0
// A part of a YAML file that is read strictly: what is asked for must have the right type and range, and what nobody
// asked for is an error. Every complaint is one line with file, line and key.
#pragma once

#include <memory>
#include <set>
#include <string>
#include <vector>

namespace YAML {
class Node;
}

namespace deltamap::simulation {

inline constexpr double kSmallest_m = 0.01;  ///< of a length that must not be zero

class YamlSection {
 public:
  /// `key` names the section in messages.
  YamlSection(const YAML::Node& node, std::string file, std::string key);

  [[nodiscard]] bool has(const std::string& key);
  [[nodiscard]] double number(const std::string& key, double otherwise, double least, double most);
  [[nodiscard]] int whole_number(const std::string& key, int otherwise, int least, int most);
  [[nodiscard]] std::string text(const std::string& key, const std::string& otherwise);
  [[nodiscard]] bool flag(const std::string& key, bool otherwise);
  /// Exactly `count` numbers.
  [[nodiscard]] std::vector<double> numbers(const std::string& key, std::size_t count);
  /// The items of a list; none where the key is absent.
  [[nodiscard]] std::vector<YAML::Node> items(const std::string& key);
  [[nodiscard]] YamlSection section(const std::string& key);

  /// Throws for the first key that nothing has asked for.
  void expect_no_more() const;

  [[noreturn]] void refuse(const std::string& key, const std::string& why) const;
  [[nodiscard]] const std::string& file() const { return file_; }

 private:
  std::shared_ptr<const YAML::Node> node_;
  std::string file_;
  std::string key_;
  std::set<std::string> asked_;
};

/// The numbers of a list node; throws with file, line and key where it is no list of `count` finite numbers.
[[nodiscard]] std::vector<double> numbers_of(const YAML::Node& node, std::size_t count, const std::string& file,
                                             const std::string& key);

[[noreturn]] void refuse_at(const YAML::Node& node, const std::string& file, const std::string& key,
                            const std::string& why);

}  // namespace deltamap::simulation
