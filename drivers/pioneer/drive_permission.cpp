// SPDX-License-Identifier: Apache-2.0
#include "drivers/pioneer/drive_permission.hpp"

#include <array>

namespace deltamap::drivers::pioneer {

std::string_view name_of(DriveSwitch value) {
  switch (value) {
    case DriveSwitch::kUnknown:
      break;
    case DriveSwitch::kOn:
      return "on";
    case DriveSwitch::kOffAtRobot:
      return "off at the robot";
    case DriveSwitch::kOffByOperator:
      return "off by the operator";
  }
  return "unknown";
}

std::optional<DriveSwitch> drive_switch_named(std::string_view name) {
  constexpr std::array kAll{DriveSwitch::kUnknown, DriveSwitch::kOn, DriveSwitch::kOffAtRobot,
                            DriveSwitch::kOffByOperator};
  for (const DriveSwitch value : kAll) {
    if (name == name_of(value)) return value;
  }
  return std::nullopt;
}

void DrivePermission::switch_off_at_robot() {
  if (switch_ != DriveSwitch::kOffByOperator) switch_ = DriveSwitch::kOffAtRobot;
}

/// In a left-over connection motors that are off count as switched off, unless they were off when the link was lost: a
/// client that drives and dies leaves them on. Motors that are on there tell nothing, another client may have enabled
/// them.
void DrivePermission::observe(const MotorReport& report) {
  using From = MotorReport::From;
  const bool was_on = motors_on_.value_or(report.from == From::kLeftOver && holds());
  const bool went_off = !report.motors_on && was_on;
  const bool came_on = report.motors_on && motors_on_ == false;
  if (!report.motors_on || report.from == From::kOpening) came_on_late_ = false;
  if (report.stop_button) {
    switch_off_at_robot();
  } else if (went_off && report.from != From::kOpening && !report.may_be_our_disable) {
    switch_off_at_robot();
  } else if (came_on && report.from == From::kConnection) {
    if (report.may_be_our_enable) {
      came_on_late_ = !holds();
    } else if (is_configured_ && switch_ != DriveSwitch::kOffByOperator) {
      switch_ = DriveSwitch::kOn;
    }
  }
  // A robot that goes on telling so has not heard our CLOSE: then it was a button. After OPEN it has.
  if (went_off && report.may_be_our_disable && report.from != From::kOpening) return;
  // This SIP may be older than our ENABLE 1: whether it was obeyed stays open.
  const bool is_older = !motors_on_ && !report.motors_on && report.may_be_our_enable && holds();
  if (is_older && report.from == From::kConnection) return;
  motors_on_ = report.motors_on;
}

}  // namespace deltamap::drivers::pioneer
