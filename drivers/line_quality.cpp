// SPDX-License-Identifier: Apache-2.0
#include "drivers/line_quality.hpp"

#include <utility>

namespace deltamap::drivers {
namespace {

constexpr int kManyDamages = 3;
constexpr Duration kWindow{5'000'000'000};
constexpr Duration kWellAgain{10'000'000'000};

}  // namespace

std::optional<LineQuality::Change> LineQuality::observe(const DecoderCounts& counts, Timestamp now) {
  const std::optional<DecoderCounts> before = std::exchange(seen_, counts);
  if (!before) return std::nullopt;
  if (counts.errors() > before->errors() && (damages_ == 0 || counts.frames > frames_at_damage_)) {
    if (damages_ > 0 && now - first_damage_ > kWindow) damages_ = 0;
    if (damages_++ == 0) first_damage_ = now;
    frames_at_damage_ = counts.frames;
    last_damage_ = now;
    if (damages_ < kManyDamages || std::exchange(is_disturbed_, true)) return std::nullopt;
    return told(" line is disturbed: damaged three times within 5 s; look at its cable, plugs and adapter");
  }
  if (is_disturbed_ && now - last_damage_ > kWellAgain) {
    is_disturbed_ = false;
    damages_ = 0;
    return told(" line is clean again");
  }
  return std::nullopt;
}

LineQuality::Change LineQuality::told(std::string_view what) const {
  std::string line{device_ == Device::kRobot ? "robot" : "laser"};
  line += what;
  return {is_disturbed_, std::move(line)};
}

}  // namespace deltamap::drivers
