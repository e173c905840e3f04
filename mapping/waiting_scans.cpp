// SPDX-License-Identifier: Apache-2.0
#include "mapping/waiting_scans.hpp"

#include <utility>

#include "mapping/awareness/keyframe_choice.hpp"

namespace deltamap::mapping {

void WaitingScans::keep(const TrackedScan& tracked) {
  const auto place = awareness::place_of(tracked);
  if (!scans_.empty() && !awareness::is_next_keyframe(keyframes_, awareness::place_of(scans_.back()), place)) return;
  if (scans_.size() >= most_) scans_.pop_front();
  scans_.push_back(tracked);
  scans_.back().estimate.map.reset();
}

std::optional<TrackedScan> WaitingScans::next(const Estimate& now) {
  if (scans_.empty()) return std::nullopt;
  TrackedScan scan = std::move(scans_.front());
  scans_.pop_front();
  scan.estimate.map = now.map;
  scan.estimate.revision = now.revision;
  return scan;
}

}  // namespace deltamap::mapping
