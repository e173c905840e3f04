// SPDX-License-Identifier: Apache-2.0
#include "daemon/kept_drive.hpp"

#include <exception>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "core/replace_file.hpp"

namespace deltamap::daemon {
namespace {

using drivers::pioneer::DriveSwitch;
using Json = nlohmann::ordered_json;

constexpr std::uintmax_t kLargestFile = 4096;
constexpr const char* kKey = "drive";

std::string json_text(DriveSwitch value) {
  Json json;
  json[kKey] = drivers::pioneer::name_of(value);
  return json.dump() + "\n";
}

std::optional<DriveSwitch> switch_in(const std::filesystem::path& file) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error || size > kLargestFile) return std::nullopt;
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  const Json json = Json::parse(text.str(), nullptr, false);
  if (!json.is_object() || !json.contains(kKey) || !json[kKey].is_string()) return std::nullopt;
  return drivers::pioneer::drive_switch_named(json[kKey].get<std::string>());
}

}  // namespace

KeptDrive::KeptDrive(std::filesystem::path file) : file_{std::move(file)} {
  std::error_code error;
  const auto status = std::filesystem::symlink_status(file_, error);
  if (file_.empty() || status.type() == std::filesystem::file_type::not_found) return;
  const auto found = switch_in(file_);
  value_ = found.value_or(DriveSwitch::kUnknown);
  if (!found) why_unknown_ = file_.string() + " says nothing about driving: off";
}

std::string KeptDrive::keep(DriveSwitch value) {
  if (value == value_) return "";
  value_ = value;
  if (file_.empty()) return "";
  try {
    replace_file(file_, json_text(value));
    return "";
  } catch (const std::exception& error) {
    // Better nothing on disk than an old "on".
    std::error_code ignored;
    const bool is_gone = value != DriveSwitch::kOn && std::filesystem::remove(file_, ignored);
    return std::string("drive: not kept: ") + error.what() +
           (is_gone ? "; removed, so that the next run does not drive" : "");
  }
}

}  // namespace deltamap::daemon
