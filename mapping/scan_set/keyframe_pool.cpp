// SPDX-License-Identifier: Apache-2.0
#include "mapping/scan_set/keyframe_pool.hpp"

#include <algorithm>
#include <utility>

#include "mapping/scan_set/kept_scan.hpp"
#include "mapping/scan_set/keyframe_choice.hpp"

namespace deltamap::mapping::scan_set {

bool KeyframePool::is_due(const TrackedScan& tracked) const {
  return kept_.empty() || is_next_keyframe(params_, place_of(*kept_.back().tracked), place_of(tracked));
}

void KeyframePool::keep(const TrackedScan& tracked, std::vector<std::uint32_t> blocks) {
  if (!kept_.empty() && kept_.back().tracked->odometry_epoch != tracked.odometry_epoch) kept_.clear();
  if (kept_.size() >= params_.most_kept) kept_.pop_front();
  kept_.push_back({kept_scan(tracked), std::move(blocks)});
}

KeptScans KeyframePool::that_saw(const std::vector<std::uint32_t>& blocks, Timestamp since) const {
  if (blocks.empty()) return {};
  std::vector<bool> asked(*std::max_element(blocks.begin(), blocks.end()) + 1, false);
  for (const std::uint32_t block : blocks) asked[block] = true;
  KeptScans scans;
  for (auto keyframe = kept_.rbegin(); keyframe != kept_.rend() && scans.size() < params_.most_in_set; ++keyframe) {
    if (keyframe->tracked->scan.time < since) break;
    const bool saw = std::any_of(keyframe->blocks.begin(), keyframe->blocks.end(),
                                 [&](std::uint32_t block) { return block < asked.size() && asked[block]; });
    if (saw) scans.push_back(keyframe->tracked);
  }
  std::reverse(scans.begin(), scans.end());
  return scans;
}

}  // namespace deltamap::mapping::scan_set
