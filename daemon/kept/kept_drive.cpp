// SPDX-License-Identifier: Apache-2.0
#include "daemon/kept/kept_drive.hpp"

#include <chrono>
#include <exception>
#include <nlohmann/json.hpp>
#include <utility>

#include "daemon/kept/kept_text.hpp"

#include "core/files/replace_file.hpp"

namespace deltamap::daemon {
namespace {

namespace fs = std::filesystem;
using drivers::pioneer::DriveSwitch;
using Json = nlohmann::ordered_json;

constexpr std::uintmax_t kLargestDriveFile = 4096 + 256;  // the longest path, and the switch
constexpr std::chrono::seconds kTryAgainAfter{1};
constexpr const char* kSwitchKey = "drive";
constexpr const char* kPortKey = "robot_port";

/// The file name for a port: slashes become plus signs, plus and percent signs are escaped, so that no two paths share
/// a name.
std::string file_name_of(std::string port) {
  const std::string devices = "/dev/";
  if (port.starts_with(devices)) port.erase(0, devices.size());
  std::string name;
  for (const char c : port) {
    if (c == '/') {
      name += '+';
    } else if (c == '+' || c == '%') {
      name += c == '+' ? "%2B" : "%25";
    } else {
      name += c;
    }
  }
  return name + ".drive.json";
}

std::string json_text(DriveSwitch value, const std::string& robot_port) {
  Json json;
  json[kSwitchKey] = drivers::pioneer::name_of(value);
  json[kPortKey] = robot_port;
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::optional<std::string> text_in(const Json& json, const char* key) {
  if (!json.is_object() || !json.contains(key) || !json[key].is_string()) return std::nullopt;
  return json[key].get<std::string>();
}

}  // namespace

DrivePlace drive_place(const fs::path& store, const std::string& robot_port) {
  if (store.empty()) return {};
  std::error_code ignored;
  const std::string port = fs::absolute(robot_port, ignored).lexically_normal().string();
  return {store.parent_path() / file_name_of(port), port};
}

KeptDriveAnswer read_kept_drive(const DrivePlace& place) {
  std::error_code error;
  const auto status = fs::symlink_status(place.file, error);
  if (place.file.empty() || status.type() == fs::file_type::not_found) return {};
  const Json json = Json::parse(kept_text(place.file, kLargestDriveFile), nullptr, false);
  const auto name = text_in(json, kSwitchKey);
  const auto value = name ? drivers::pioneer::drive_switch_named(*name) : std::nullopt;
  const auto port = text_in(json, kPortKey);
  if (!value || !port) return {DriveSwitch::kUnknown, place.file.string() + " says nothing about driving: off"};
  if (*port == place.robot_port) return {*value, ""};
  return {DriveSwitch::kUnknown, place.file.string() + " is of the robot at " + *port + ": off"};
}

DriveSwitch switch_to_keep(DriveSwitch value, navigation::StopReason waits_for) {
  const bool waits = waits_for != navigation::StopReason::kNone;
  return waits && value == DriveSwitch::kOn ? DriveSwitch::kOffAtRobot : value;
}

KeptDrive::KeptDrive(DrivePlace place) : place_{std::move(place)}, known_{read_kept_drive(place_)} {
  if (known_.value != DriveSwitch::kOn) return;
  try {
    write(DriveSwitch::kOn);
  } catch (const std::exception& error) {
    known_ = {DriveSwitch::kUnknown, std::string(error.what()) + ", nor could an off be: off"};
    is_certain_ = false;
  }
}

std::string KeptDrive::keep(DriveSwitch value, Timestamp now) {
  if ((value == known_.value && is_certain_) || waits_to_try_again(value, now)) return "";
  try {
    write(value);
    is_certain_ = true;
    const bool is_late = failed_.has_value();
    failed_.reset();
    why_not_kept_.clear();
    return is_late ? "drive: kept now: " + std::string(drivers::pioneer::name_of(value)) : "";
  } catch (const std::exception& error) {
    // A switch that cannot be written leaves no old "on" on disk: without a file the next run does not drive.
    std::error_code ignored;
    const bool is_gone = value != DriveSwitch::kOn && fs::remove(place_.file, ignored);
    if (is_gone) known_.value = DriveSwitch::kUnknown;
    is_certain_ = false;
    const bool is_told = failed_ == value;
    failed_ = value;
    failed_at_ = now;
    if (is_told && !is_gone) return "";
    why_not_kept_ = error.what() + std::string(is_gone ? "; removed, so that the next run does not drive" : "");
    return "drive: not kept: " + why_not_kept_;
  }
}

bool KeptDrive::waits_to_try_again(DriveSwitch value, Timestamp now) const {
  return failed_ == value && now >= failed_at_ && now - failed_at_ < kTryAgainAfter;
}

void KeptDrive::write(DriveSwitch value) {
  const SpareDescriptor::Loan one_for_the_file{spare_};
  if (!place_.file.empty()) replace_file(place_.file, json_text(value, place_.robot_port));
  known_.value = value;
}

}  // namespace deltamap::daemon
