// SPDX-License-Identifier: Apache-2.0
#include "localization/odometer/wheel_lag.hpp"

#include <algorithm>
#include <cmath>

#include "core/geometry/angle.hpp"

namespace deltamap::localization::odometer {
namespace {

constexpr double kShiftS = 0.02;
constexpr double kMostLagS = 0.5;
constexpr double kLeastTurnRad = 0.01;
constexpr double kForgetting = 0.999;
constexpr std::size_t kEnoughTurns = 60;
constexpr double kKnownS = 0.01;
constexpr std::size_t kMostWaiting = 256;

}  // namespace

void WheelLag::observe(Timestamp from, Timestamp to, double turned_rad, const motion::OdometryBuffer& reports) {
  if (waiting_.size() == kMostWaiting || (!waiting_.empty() && from < waiting_.back().from)) waiting_.clear();
  waiting_.push_back({from, to, turned_rad});
  while (!waiting_.empty() && reports.newest_time() &&
         *reports.newest_time() >= waiting_.front().to + duration_from_seconds(kMostLagS)) {
    weigh(waiting_.front(), reports);
    waiting_.pop_front();
  }
}

void WheelLag::weigh(const Turn& turn, const motion::OdometryBuffer& reports) {
  std::array<double, kShifts> counted{};
  double most = std::abs(turn.turned_rad);
  for (int i = 0; i < kShifts; ++i) {
    const Duration shift = duration_from_seconds(kShiftS * i - kMostLagS);
    const std::optional<double> turned = reports.turned_between(turn.from + shift, turn.to + shift);
    if (!turned) return;
    counted[static_cast<std::size_t>(i)] = *turned;
    most = std::max(most, std::abs(*turned));
  }
  if (most < kLeastTurnRad) return;
  laser2_ = kForgetting * laser2_ + turn.turned_rad * turn.turned_rad;
  weight_ = kForgetting * weight_ + 1.0;
  for (std::size_t i = 0; i < counted.size(); ++i) {
    both_[i] = kForgetting * both_[i] + turn.turned_rad * counted[i];
    wheels2_[i] = kForgetting * wheels2_[i] + counted[i] * counted[i];
  }
  ++turns_;
}

std::optional<double> WheelLag::lag_s() const {
  if (turns_ < kEnoughTurns) return std::nullopt;
  std::array<double, kShifts> rest{};  // rad², with the wheels' scale fitted
  for (std::size_t i = 0; i < rest.size(); ++i)
    rest[i] = laser2_ - (wheels2_[i] > 0.0 ? both_[i] * both_[i] / wheels2_[i] : 0.0);
  const auto least = static_cast<std::size_t>(std::min_element(rest.begin(), rest.end()) - rest.begin());
  if (least == 0 || least + 1 == rest.size()) return std::nullopt;
  const double bend = (rest[least - 1] - 2.0 * rest[least] + rest[least + 1]) / (kShiftS * kShiftS);
  if (!(bend > 0.0)) return std::nullopt;
  const double variance_rad2 = std::max(rest[least], 0.0) / weight_;
  if (std::sqrt(2.0 * variance_rad2 / bend) > kKnownS) return std::nullopt;
  const double apart = 0.5 * (rest[least - 1] - rest[least + 1]) / (kShiftS * bend * kShiftS);
  return kShiftS * (static_cast<double>(least) + std::clamp(apart, -0.5, 0.5)) - kMostLagS;
}

}  // namespace deltamap::localization::odometer
