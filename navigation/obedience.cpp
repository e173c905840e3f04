// SPDX-License-Identifier: Apache-2.0
#include "navigation/obedience.hpp"

#include <algorithm>
#include <cmath>

namespace deltamap::navigation {
namespace {

// A command waits for a controller cycle, its effect for a SIP, and a SIP for the line (protocols.md A6).
constexpr double kLatestS = 0.4;
constexpr double kExcessS = 0.5;
constexpr double kIdleS = 2.0;
constexpr double kSpeedSlack = 0.1;           // m/s: of a wheel's measured speed, and of a controller's regulation
constexpr double kTurnSlack = radians(20.0);  // per s: the same of two wheels
constexpr double kSlowerShare = 0.7;          // of the set acceleration, by a loaded robot
constexpr double kIdleShare = 0.1;            // of the least that it should do by now: it stands
constexpr double kFasterShare = 0.2;          // of what it was told, by a controller's regulation
// Slower than these it stands. 0.1 m is about the margin beside the hull; 30° more than a castor turns it by.
constexpr ExcessWay::Tolerance kWay{.creep = 0.005, .most = 0.1};  // m
constexpr ExcessWay::Tolerance kTurn{.creep = radians(0.5), .most = radians(30.0)};

/// Faster than anything that it was told, or the other way. Slower is no danger.
bool exceeds(double measured, const SpeedRange& range, double slack) {
  return measured > std::max(0.0, range.high()) + slack || measured < std::min(0.0, range.low()) - slack;
}

/// It should go by now, and stands or goes the other way.
bool is_idle(double measured, const SpeedRange& range, double slack) {
  if (range.low() > slack) return measured < kIdleShare * range.low();
  return range.high() < -slack && measured > kIdleShare * range.high();
}

/// Whether something has held without a break for so long.
bool holds_for(std::optional<Timestamp>& since, bool holds, Timestamp now, double least_s) {
  if (!holds) {
    since.reset();
    return false;
  }
  if (!since) since = now;
  return seconds(now - *since) >= least_s;
}

}  // namespace

void SpeedRange::advance(double least, double most, const Gathering& gathering, double dt_s) {
  // Towards what it was told at once, or as slowly as it may: both are obedience.
  const auto slowly = [&](double now, double target) {
    const bool is_slowing = std::abs(target) < std::abs(now) || now * target < 0.0;
    const double step = kSlowerShare * (is_slowing ? gathering.deceleration : gathering.acceleration) * dt_s;
    return now + std::clamp(target - now, -step, step);
  };
  high_ = most > high_ ? most : slowly(high_, most);
  low_ = least < low_ ? least : slowly(low_, least);
}

void ExcessWay::advance(double measured, const SpeedRange& range, const Tolerance& tolerance, double dt_s) {
  const double most = (1.0 + kFasterShare) * std::max(0.0, range.high()) + tolerance.creep;
  const double least = (1.0 + kFasterShare) * std::min(0.0, range.low()) - tolerance.creep;
  ahead_ = std::max(0.0, ahead_ + (measured - most) * dt_s);
  behind_ = std::max(0.0, behind_ + (least - measured) * dt_s);
  is_too_far_ = std::max(ahead_, behind_) > tolerance.most;
  // Once it is back at what it was told, it owes nothing.
  if (is_too_far_ && measured <= most && measured >= least) *this = {};
}

void Obedience::told(const Motion& motion, Timestamp now) {
  told_.push_back({now, motion});
  // The last that is older than the latest is what it may still act on.
  while (told_.size() > 1 && seconds(now - told_[1].at) > kLatestS) told_.pop_front();
}

void Obedience::forget() {
  told_.clear();
  last_.reset();
  excess_since_.reset();
  idle_since_.reset();
  disobeys_ = false;
}

void Obedience::begin(const Odometry& odometry) {
  excess_way_ = excess_turn_ = {};
  speed_.begin(odometry.speed_m_per_s);
  turn_rate_.begin(odometry.turn_rate_rad_per_s);
  excess_since_.reset();
  idle_since_.reset();
  disobeys_ = false;
}

void Obedience::observe(const Odometry& odometry, const StoppingBehaviour& stopping) {
  const bool follows = last_ && last_->epoch == odometry.epoch && odometry.time > last_->time;
  const bool is_asked = odometry.motors_enabled && !told_.empty();
  const double dt_s = follows ? seconds(odometry.time - last_->time) : 0.0;
  last_ = odometry;
  if (!follows || !is_asked || dt_s > kExcessS) return begin(odometry);
  const auto [least_speed, most_speed] =
      std::minmax_element(told_.begin(), told_.end(),
                          [](const Told& a, const Told& b) { return a.motion.speed_m_per_s < b.motion.speed_m_per_s; });
  const auto [least_turn, most_turn] = std::minmax_element(
      told_.begin(), told_.end(),
      [](const Told& a, const Told& b) { return a.motion.turn_rate_rad_per_s < b.motion.turn_rate_rad_per_s; });
  speed_.advance(least_speed->motion.speed_m_per_s, most_speed->motion.speed_m_per_s,
                 {stopping.deceleration_m_per_s2, stopping.deceleration_m_per_s2}, dt_s);
  turn_rate_.advance(least_turn->motion.turn_rate_rad_per_s, most_turn->motion.turn_rate_rad_per_s,
                     {stopping.turn_deceleration_rad_per_s2, stopping.turn_deceleration_rad_per_s2}, dt_s);
  const bool exceeds_told = exceeds(odometry.speed_m_per_s, speed_, kSpeedSlack) ||
                            exceeds(odometry.turn_rate_rad_per_s, turn_rate_, kTurnSlack);
  const bool idles = is_idle(odometry.speed_m_per_s, speed_, kSpeedSlack) ||
                     is_idle(odometry.turn_rate_rad_per_s, turn_rate_, kTurnSlack);
  // A robot that stands endangers nobody: it gets more time.
  const bool is_idle_long = holds_for(idle_since_, idles, odometry.time, kIdleS);
  const bool is_excess_long = holds_for(excess_since_, exceeds_told, odometry.time, kExcessS);
  excess_way_.advance(odometry.speed_m_per_s, speed_, kWay, dt_s);
  excess_turn_.advance(odometry.turn_rate_rad_per_s, turn_rate_, kTurn, dt_s);
  disobeys_ = is_idle_long || is_excess_long || excess_way_.is_too_far() || excess_turn_.is_too_far();
}

}  // namespace deltamap::navigation
