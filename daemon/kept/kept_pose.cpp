// SPDX-License-Identifier: Apache-2.0
#include "daemon/kept/kept_pose.hpp"

#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <vector>

#include "daemon/kept/kept_text.hpp"
#include "daemon/settings/fingerprint.hpp"

namespace deltamap::daemon {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uintmax_t kLargestPoseFile = 4096;

std::optional<double> number_in(const Json& json, const char* key) {
  const auto found = json.find(key);
  if (found == json.end() || !found->is_number()) return std::nullopt;
  const double number = found->get<double>();
  return std::isfinite(number) ? std::optional{number} : std::nullopt;
}

/// The calibration in a kept pose; nullopt where it is missing or malformed.
std::optional<localization::motion::DriveCalibration> calibration_in(const Json& json) {
  const auto found = json.find("calibration");
  if (found == json.end() || !found->is_array()) return std::nullopt;
  std::vector<double> numbers;
  for (const Json& number : *found) {
    if (number.is_number()) numbers.push_back(number.get<double>());
  }
  return localization::motion::calibration_of(numbers);
}

/// The pose in a file of json_text(); nullopt where the JSON has another form.
std::optional<KeptPose> pose_in(const Json& json, std::uint64_t first_map) {
  if (!json.is_object()) return std::nullopt;
  const auto x = number_in(json, "x_m");
  const auto y = number_in(json, "y_m");
  const auto heading = number_in(json, "heading_rad");
  const auto sure = json.find("sure");
  const auto revision = json.find("revision");
  const auto time = json.find("time_ns");
  if (!x || !y || !heading || sure == json.end() || !sure->is_boolean()) return std::nullopt;
  if (revision == json.end() || !revision->is_number_unsigned()) return std::nullopt;
  if (time == json.end() || !time->is_number_integer()) return std::nullopt;
  KeptPose pose;
  pose.first_map = first_map;
  pose.revision = revision->get<std::uint32_t>();
  pose.time = timestamp_from_ns(time->get<std::int64_t>());
  pose.map_from_robot = {*x, *y, wrapped_angle(*heading)};
  pose.is_sure = sure->get<bool>();
  pose.calibration = calibration_in(json);
  return pose;
}

}  // namespace

KeptPose kept_pose_of(const LocalizationRow& row, std::uint64_t first_map,
                      std::optional<localization::motion::DriveCalibration> calibration) {
  return {.first_map = first_map,
          .revision = row.revision,
          .time = row.time,
          .map_from_robot = row.map_from_robot,
          .covariance = row.covariance,
          .is_sure = row.is_sure(),
          .calibration = calibration};
}

std::string json_text(const KeptPose& pose) {
  Json json;
  json["map"] = hex_of(pose.first_map);
  json["revision"] = pose.revision;
  json["time_ns"] = unix_ns(pose.time);
  json["x_m"] = pose.map_from_robot.x;
  json["y_m"] = pose.map_from_robot.y;
  json["heading_rad"] = pose.map_from_robot.theta;
  const PoseCovariance& c = pose.covariance;
  json["covariance"] = {c(0, 0), c(0, 1), c(0, 2), c(1, 1), c(1, 2), c(2, 2)};
  json["sure"] = pose.is_sure;
  if (pose.calibration) json["calibration"] = localization::motion::numbers_of(*pose.calibration);
  return json.dump() + "\n";
}

KeptPoseAnswer read_kept_pose(const std::filesystem::path& file, std::uint64_t first_map) {
  KeptPoseAnswer answer;
  std::error_code error;
  if (!std::filesystem::exists(std::filesystem::status(file, error))) return answer;
  const auto refused = [&](const std::string& why) {
    answer.why_not = file.string() + ": " + why;
    return answer;
  };
  const std::string text = kept_text(file, kLargestPoseFile);
  const Json json = Json::parse(text, nullptr, false);
  const auto pose = pose_in(json, first_map);
  if (!pose) return refused("holds no pose");
  answer.calibration = pose->calibration;
  if (answer.calibration) answer.fingerprint = fingerprint_of(text);
  const auto map = json.find("map");
  if (map == json.end() || *map != hex_of(first_map)) return refused("the pose belongs to another map");
  answer.revision = pose->revision;
  if (!pose->is_sure) return refused("the robot did not know where it was");
  answer.pose = pose;
  answer.fingerprint = fingerprint_of(text);
  return answer;
}

std::string begin_line(const KeptPose& pose) {
  char text[128];
  (void)std::snprintf(text, sizeof text, "begins at the pose that was kept: x=%.2f y=%.2f heading=%.0f map=%" PRIu32,
                      pose.map_from_robot.x, pose.map_from_robot.y, degrees(pose.map_from_robot.theta), pose.revision);
  return text;
}

}  // namespace deltamap::daemon
