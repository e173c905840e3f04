// SPDX-License-Identifier: Apache-2.0
#include "mapping/scan_set/waiting_scans.hpp"

#include <utility>

#include "mapping/scan_set/keyframe_choice.hpp"

namespace deltamap::mapping::scan_set {

void WaitingScans::keep(const TrackedScan& tracked) {
  const auto place = place_of(tracked);
  if (!scans_.empty() && !is_next_keyframe(keyframes_, place_of(scans_.back()), place)) return;
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

}  // namespace deltamap::mapping::scan_set
