// SPDX-License-Identifier: Apache-2.0
#include "drivers/carmen/carmen_bytes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "drivers/carmen/carmen_words.hpp"
#include "drivers/lms200/command.hpp"
#include "drivers/lms200/status.hpp"
#include "drivers/pioneer/config_packet.hpp"
#include "drivers/pioneer/extra_packets.hpp"
#include "drivers/pioneer/odometry.hpp"
#include "drivers/pioneer/status.hpp"
#include "drivers/received_bytes.hpp"

namespace deltamap::drivers::carmen {
namespace {

namespace lms200 = drivers::lms200;
namespace pioneer = drivers::pioneer;
using drivers::port::ByteRecord;
using drivers::port::Direction;
using drivers::port::PortId;

constexpr Duration kLongestPoseGap = std::chrono::milliseconds(100);  // the controller's cycle
constexpr Duration kLongestFilledGap = std::chrono::hours(1);  // another session: filling it would only take room
constexpr Duration kGreetingBefore = std::chrono::milliseconds(100);
constexpr std::uint8_t kBatteryDecivolts = 125;

ByteRecord record_of(PortId port, Timestamp first_byte, std::vector<std::uint8_t> bytes) {
  const Timestamp last_byte = first_byte + drivers::line_time(bytes.size() - 1, kImportBaud);
  return {port, Direction::kIn, last_byte, std::move(bytes), "", kImportBaud};
}

std::int16_t wheel_mm_per_s(double speed_m_per_s) {
  return static_cast<std::int16_t>(std::lround(std::clamp(speed_m_per_s * 1000.0, -32767.0, 32767.0)));
}

pioneer::Sip sip_of(const Pose2& pose, double speed_m_per_s, double turn_rate_rad_per_s) {
  constexpr double kUnitsPerRad = pioneer::kHeadingUnitsPerTurn / (2.0 * std::numbers::pi);
  const pioneer::RobotModel model{};  // p3dx-sh
  const auto wrapped_units = [&](double metres) {
    return static_cast<std::uint16_t>(std::llround(metres / model.metres_per_unit) & 0x7FFF);
  };
  const double half_difference_m_per_s = turn_rate_rad_per_s / model.turn_rate_per_speed * 0.001;
  pioneer::Sip sip;
  sip.x_units = wrapped_units(pose.x);
  sip.y_units = wrapped_units(pose.y);
  sip.heading_units = static_cast<std::int16_t>(std::lround(wrapped_angle(pose.theta) * kUnitsPerRad));
  sip.left_mm_per_s = wheel_mm_per_s(speed_m_per_s - half_difference_m_per_s);
  sip.right_mm_per_s = wheel_mm_per_s(speed_m_per_s + half_difference_m_per_s);
  sip.moving = sip.left_mm_per_s != 0 || sip.right_mm_per_s != 0;
  sip.battery_decivolts = kBatteryDecivolts;
  sip.control_units = sip.heading_units;
  sip.flags = pioneer::sip_flag::kMotorsEnabled;
  return sip;
}

}  // namespace

lms200::Measurement measurement_of(const CarmenScan& scan, const CarmenSurvey& survey) {
  const lms200::ScanVariant variant = nearest_variant(scan);
  const CarmenWords words{scan, survey};
  lms200::Measurement measurement;
  measurement.unit_code = static_cast<std::uint8_t>(survey.units);
  measurement.words.assign(variant.values(), words.not_valid());
  const double first_rad = radians(variant.first_angle_deg() - 90.0);
  const double step_rad = radians(variant.resolution_centideg * 0.01);
  for (std::size_t i = 0; i < measurement.words.size(); ++i) {
    const double bearing_rad = first_rad + static_cast<double>(i) * step_rad;
    const double nearest = std::round((bearing_rad - scan.first_bearing_rad) / scan.bearing_step_rad);
    if (nearest < 0.0 || nearest >= static_cast<double>(scan.ranges_m.size())) continue;
    measurement.words[i] = words.encoded(scan.ranges_m[static_cast<std::size_t>(nearest)]);
  }
  return measurement;
}

CarmenBytes::CarmenBytes(const CarmenSurvey& survey, Sink sink) : survey_{survey}, sink_{std::move(sink)} {}

/// What a live start would have heard before the first odometry: SYNC2, CONFIGpac, B1h, F4h.
void CarmenBytes::greet(Timestamp first_time) {
  greeted_ = true;
  const Timestamp at = std::max(Timestamp{}, first_time - kGreetingBefore);
  lms200::DeviceStatus status;
  status.operating_mode = lms200::mode::kStreamAll;
  status.measuring_mode = survey_.measuring_mode;
  status.scan_angle_deg = survey_.variant.angle_deg;
  status.resolution_centideg = survey_.variant.resolution_centideg;
  status.baud_code = lms200::baud_code(kImportBaud).value_or(0);
  status.units = static_cast<std::uint8_t>(survey_.units);
  lms200::Configuration configuration;
  configuration.set_measuring_mode(survey_.measuring_mode);
  configuration.set_units(survey_.units);

  pioneer::ConfigPacket config;
  config.name = "carmen";
  for (auto& [port, bytes] : std::vector<std::pair<PortId, std::vector<std::uint8_t>>>{
           {PortId::kRobot, pioneer::encoded_identity({config.name, config.type, config.subtype})},
           {PortId::kRobot, pioneer::encoded_config(config)},
           {PortId::kLaser, lms200::status_reply(status)},
           {PortId::kLaser, lms200::encoded_reply(lms200::response::kConfiguration, configuration.bytes)}}) {
    sink_({port, Direction::kIn, at, std::move(bytes), "", kImportBaud});
  }
}

void CarmenBytes::send_scans_until(Timestamp stamp) {
  auto next = waiting_scans_.begin();
  for (; next != waiting_scans_.end() && next->stamp <= stamp; ++next) sink_(*next);
  waiting_scans_.erase(waiting_scans_.begin(), next);
}

void CarmenBytes::send_pose(Timestamp time, const Pose2& pose, double speed_m_per_s, double turn_rate_rad_per_s) {
  ByteRecord record =
      record_of(PortId::kRobot, time, pioneer::encoded_sip(sip_of(pose, speed_m_per_s, turn_rate_rad_per_s)));
  send_scans_until(record.stamp);
  sink_(record);
  ++poses_;
}

void CarmenBytes::add_pose(Timestamp time, const Pose2& odom_from_robot) {
  if (!greeted_) greet(time);
  double speed_m_per_s = 0.0;
  double turn_rate_rad_per_s = 0.0;
  if (last_pose_ && time < last_pose_->time) {  // the log went back in time: what it has said so far comes first
    send_scans_until(Timestamp::max());
  } else if (last_pose_ && time > last_pose_->time) {
    const Duration gap = time - last_pose_->time;
    const Pose2 motion = motion_between(last_pose_->odom_from_robot, odom_from_robot);
    speed_m_per_s = std::copysign(std::hypot(motion.x, motion.y), motion.x) / seconds(gap);
    turn_rate_rad_per_s = motion.theta / seconds(gap);
    const std::int64_t steps = gap > kLongestFilledGap ? 1 : (gap - Duration{1}) / kLongestPoseGap + 1;
    gaps_ += gap > kLongestFilledGap ? 1 : 0;
    for (std::int64_t i = 1; i < steps; ++i) {
      const Pose2 between = interpolated(last_pose_->odom_from_robot, odom_from_robot,
                                         static_cast<double>(i) / static_cast<double>(steps));
      send_pose(last_pose_->time + gap * i / steps, between, speed_m_per_s, turn_rate_rad_per_s);
    }
  }
  send_pose(time, odom_from_robot, speed_m_per_s, turn_rate_rad_per_s);
  last_pose_ = TimedPose{time, odom_from_robot};
}

void CarmenBytes::add_scan(const CarmenScan& scan) {
  const Timestamp first_byte = scan.time + duration_from_seconds(nearest_variant(scan).scan_duration_s());
  waiting_scans_.push_back(
      record_of(PortId::kLaser, first_byte, lms200::encoded_measurement(measurement_of(scan, survey_))));
}

void CarmenBytes::finish() { send_scans_until(Timestamp::max()); }

}  // namespace deltamap::drivers::carmen
