// SPDX-License-Identifier: Apache-2.0
#include "simulation/scenario/yaml_section.hpp"

#include <yaml-cpp/yaml.h>

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace deltamap::simulation {

void refuse_at(const YAML::Node& node, const std::string& file, const std::string& key, const std::string& why) {
  throw std::runtime_error(file + ": line " + std::to_string(node.Mark().line + 1) + ": '" + key + "' " + why);
}

std::vector<double> numbers_of(const YAML::Node& node, std::size_t count, const std::string& file,
                               const std::string& key) {
  const auto complain = [&] { refuse_at(node, file, key, "must be a list of " + std::to_string(count) + " numbers"); };
  if (!node.IsSequence() || node.size() != count) complain();
  std::vector<double> values;
  for (const YAML::Node& item : node) {
    try {
      values.push_back(item.as<double>());
    } catch (const YAML::Exception&) {
      complain();
    }
    if (!std::isfinite(values.back())) complain();
  }
  return values;
}

YamlSection::YamlSection(const YAML::Node& node, std::string file, std::string key)
    : node_{std::make_shared<const YAML::Node>(node)}, file_{std::move(file)}, key_{std::move(key)} {
  if (!node_->IsMap()) refuse_at(*node_, file_, key_, "must hold keys and values");
  std::set<std::string> seen;
  for (const auto& entry : *node_) {
    if (!entry.first.IsScalar()) refuse_at(entry.first, file_, key_, "has a key that is not a word");
    if (!seen.insert(entry.first.Scalar()).second) refuse_at(entry.first, file_, entry.first.Scalar(), "stands twice");
  }
}

bool YamlSection::has(const std::string& key) {
  asked_.insert(key);
  return static_cast<bool>((*node_)[key]);
}

double YamlSection::number(const std::string& key, double otherwise, double least, double most) {
  if (!has(key)) return otherwise;
  double value = 0.0;
  try {
    value = (*node_)[key].as<double>();
  } catch (const YAML::Exception&) {
    refuse(key, "must be a number");
  }
  if (!(value >= least && value <= most)) {
    std::ostringstream why;
    why << "must lie from " << least << " to " << most;
    refuse(key, why.str());
  }
  return value;
}

int YamlSection::whole_number(const std::string& key, int otherwise, int least, int most) {
  const double value = number(key, otherwise, least, most);
  if (value != std::floor(value)) refuse(key, "must be a whole number");
  return static_cast<int>(value);
}

std::string YamlSection::text(const std::string& key, const std::string& otherwise) {
  if (!has(key)) return otherwise;
  if (!(*node_)[key].IsScalar()) refuse(key, "must be a word");
  return (*node_)[key].Scalar();
}

bool YamlSection::flag(const std::string& key, bool otherwise) {
  if (!has(key)) return otherwise;
  try {
    return (*node_)[key].as<bool>();
  } catch (const YAML::Exception&) {
    refuse(key, "must be true or false");
  }
}

std::vector<double> YamlSection::numbers(const std::string& key, std::size_t count) {
  if (!has(key)) refuse_at(*node_, file_, key, "is missing in '" + key_ + "'");
  return numbers_of((*node_)[key], count, file_, key);
}

std::vector<YAML::Node> YamlSection::items(const std::string& key) {
  if (!has(key)) return {};
  const YAML::Node list = (*node_)[key];
  if (!list.IsSequence()) refuse(key, "must be a list");
  return {list.begin(), list.end()};
}

YamlSection YamlSection::section(const std::string& key) {
  if (!has(key)) refuse_at(*node_, file_, key, "is missing in '" + key_ + "'");
  return {(*node_)[key], file_, key};
}

void YamlSection::expect_no_more() const {
  for (const auto& entry : *node_) {
    if (!asked_.contains(entry.first.Scalar())) {
      refuse_at(entry.first, file_, entry.first.Scalar(), "is not a key of '" + key_ + "'");
    }
  }
}

void YamlSection::refuse(const std::string& key, const std::string& why) const {
  const YAML::Node value = (*node_)[key];
  refuse_at(value ? value : *node_, file_, key, why);
}

}  // namespace deltamap::simulation
