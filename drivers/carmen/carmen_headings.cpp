// SPDX-License-Identifier: Apache-2.0
#include "drivers/carmen/carmen_headings.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/files/shortest_text.hpp"
#include "core/geometry/angle.hpp"

namespace deltamap::drivers::carmen {
namespace {

constexpr double kTurn_rad = 2.0 * std::numbers::pi;
constexpr double kBeyondTurn_rad = kTurn_rad + 0.3;  // wrapped headings step by a turn, and by what the robot turns
constexpr double kFarBeyond = 30.0;     // five turns: logs that do not wrap their radians have them, seldom more
constexpr double kShortestWay_m = 0.1;  // logs round their places to a centimetre
constexpr double kLongestWay_m = 2.0;   // longer ones are jumps
constexpr double kLongestTurnStep_m = 0.5;
constexpr std::size_t kFewestWays = 8;
constexpr std::size_t kFewestTurns = 3;
constexpr double kAlong = 0.7;  // a mean of cos 2(…): 1 for a robot that drives where it looks, 0 by chance
constexpr double kByChance = 0.4;
constexpr double kClearly = 0.2;

double halfway(double from_rad, double to_rad) { return from_rad + turn_between(from_rad, to_rad) / 2.0; }

}  // namespace

void HeadingCensus::add(std::size_t line, const Point2& place, double heading) {
  if (first_line_ == 0) first_line_ = line;
  largest_ = std::max(largest_, std::abs(heading));
  if (!first_beyond_line_ && std::abs(heading) > kBeyondTurn_rad) first_beyond_line_ = line;
  const Told now{place, heading};
  add_way(now);
  add_turn(now);
}

/// Forwards or backwards: twice the angle between heading and direction is the same.
void HeadingCensus::add_way(const Told& now) {
  const double way_m = way_began_ ? (now.place - way_began_->place).norm() : kLongestWay_m + 1.0;
  if (way_m < kShortestWay_m) return;
  if (way_m <= kLongestWay_m) {
    const Point2 way = now.place - way_began_->place;
    const double direction_rad = std::atan2(way.y(), way.x());
    const double as_radians = 2.0 * (direction_rad - halfway(way_began_->heading, now.heading));
    const double as_degrees = 2.0 * (direction_rad - halfway(radians(way_began_->heading), radians(now.heading)));
    ++ways_;
    along_as_radians_ += std::cos(as_radians);
    across_as_radians_ += std::sin(as_radians);
    along_as_degrees_ += std::cos(as_degrees);
  }
  way_began_ = now;
}

void HeadingCensus::add_turn(const Told& now) {
  const bool begins_anew = now.heading == 0.0 && now.place == Point2{0.0, 0.0};
  if (last_ && !begins_anew && (now.place - last_->place).norm() < kLongestTurnStep_m)
    more_than_turns_ += std::abs(now.heading - last_->heading) > kBeyondTurn_rad ? 1 : 0;
  last_ = now;
}

bool HeadingCensus::has_way() const { return ways_ >= kFewestWays; }

bool HeadingCensus::lies_along_degrees() const {
  if (!has_way() || mean(along_as_degrees_) < kAlong || along_as_degrees_ <= along_as_radians_) return false;
  if (largest_ > kFarBeyond) return true;
  // A frame that is turned against the headings leaves them at one angle to the way.
  return std::hypot(mean(along_as_radians_), mean(across_as_radians_)) < kByChance;
}

/// Small headings that only degrees make fit may also be those of a robot that turns while it is pushed along one line.
HeadingUnit HeadingCensus::unit() const {
  const bool lies_along_radians = has_way() && mean(along_as_radians_) >= kByChance;
  const bool turns_too_far = more_than_turns_ >= kFewestTurns && !lies_along_radians;
  const bool are_degrees = (lies_along_degrees() && first_beyond_line_) || turns_too_far;
  return are_degrees ? HeadingUnit::kDegree : HeadingUnit::kRadian;
}

std::string HeadingCensus::line() const {
  if (!first_beyond_line_) {
    if (!lies_along_degrees()) return "";
    return "headings lie along the way only as degrees (the first pose is in line " + std::to_string(first_line_) +
           "): CARMEN has radians, and they are read so; are they degrees?";
  }
  const std::string line = "(the first beyond a turn in line " + std::to_string(*first_beyond_line_) + ")";
  if (unit() == HeadingUnit::kDegree)
    return "headings look like degrees " + line + ", where CARMEN has radians: read as degrees";
  const bool are_radians =
      has_way() && mean(along_as_radians_) >= kAlong && mean(along_as_radians_) > mean(along_as_degrees_) + kClearly;
  if (are_radians) return "";
  return "headings of up to " + shortest_text(std::round(largest_ * 100.0) / 100.0) + " " + line +
         ": CARMEN has radians, and they are read so; are they degrees?";
}

}  // namespace deltamap::drivers::carmen
