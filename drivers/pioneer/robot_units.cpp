// SPDX-License-Identifier: Apache-2.0
#include "drivers/pioneer/robot_units.hpp"

#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <utility>

namespace deltamap::drivers::pioneer {
namespace {

constexpr double kSameUnit = 1e-6;  // share

RobotModel model_or_throw(const std::string& name) {
  const std::optional<RobotModel> model = model_named(name);
  if (!model) throw std::invalid_argument("robot model \"" + name + "\" is unknown: p3dx or p3dx-sh");
  return *model;
}

std::string millimetres(double metres) {
  char text[32];
  (void)std::snprintf(text, sizeof text, "%g mm", 1e3 * metres);
  return text;
}

/// The subtype in quotes for a log line; bytes that cannot be printed, which a controller may send, become '?'.
std::string quoted(const std::string& subtype) {
  std::string text;
  for (const char c : subtype) text += c >= ' ' && c <= '~' ? c : '?';
  return "\"" + text + "\"";
}

}  // namespace

RobotUnits::RobotUnits(std::string configured, const RobotByHand& by_hand)
    : configured_{std::move(configured)}, by_hand_{by_hand}, model_{model_or_throw(configured_)} {
  if (by_hand.metres_per_unit) model_.metres_per_unit = *by_hand.metres_per_unit;
}

RobotUnits::Line RobotUnits::hear(const std::string& subtype) {
  if (told_ == subtype) return {};
  const std::optional<std::string> before = std::exchange(told_, subtype);
  const std::optional<RobotModel> model = model_named(subtype);
  Line line = model ? hear_known(subtype, *model) : hear_unknown(subtype);
  if (before && model_named(*before) != model) {
    return never_driven("it calls itself " + quoted(*before) + " and " + quoted(subtype) +
                        ": set one subtype in its controller");
  }
  return line;
}

RobotUnits::Line RobotUnits::hear_known(const std::string& subtype, const RobotModel& model) {
  why_never_driven_.clear();
  model_ = model;
  if (by_hand_.metres_per_unit && std::abs(*by_hand_.metres_per_unit / model.metres_per_unit - 1.0) > kSameUnit) {
    return never_driven("it is a " + quoted(subtype) + " of " + millimetres(model.metres_per_unit) +
                        " a unit, robot.distance_unit_mm says " + millimetres(*by_hand_.metres_per_unit) +
                        ": leave that key out, or set the right subtype in its controller");
  }
  if (model == model_named(configured_)) return {};
  return {"robot subtype " + quoted(subtype) + " counts in units of " + millimetres(model.metres_per_unit) +
          ": that is used, not robot.model=" + configured_};
}

RobotUnits::Line RobotUnits::hear_unknown(const std::string& subtype) {
  why_never_driven_.clear();
  model_ = model_or_throw(configured_);
  model_.turn_rate_per_speed = 0.0;
  if (by_hand_.metres_per_unit) model_.metres_per_unit = *by_hand_.metres_per_unit;
  if (by_hand_.metres_per_unit && by_hand_.hull_m) {
    char numbers[96];
    (void)std::snprintf(numbers, sizeof numbers, "hull radius %g m, %g mm a unit", *by_hand_.hull_m,
                        1e3 * *by_hand_.metres_per_unit);
    return {"robot subtype " + quoted(subtype) + " is unknown: taken for what is set by hand: " + numbers, true};
  }
  std::string missing = by_hand_.hull_m ? "" : "its hull (navigation.safety.robot_radius_m)";
  if (!by_hand_.metres_per_unit) {
    missing += (missing.empty() ? "" : " and ") + std::string("its unit (robot.distance_unit_mm)");
  }
  return never_driven("its subtype " + quoted(subtype) + " is unknown: set " + missing + " by hand");
}

RobotUnits::Line RobotUnits::never_driven(std::string why) {
  why_never_driven_ = std::move(why);
  return {"robot is not driven: " + why_never_driven_, true};
}

}  // namespace deltamap::drivers::pioneer
