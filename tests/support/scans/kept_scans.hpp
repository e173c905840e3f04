// SPDX-License-Identifier: Apache-2.0
// Scans as a set S(k) holds them.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "core/messages.hpp"

namespace deltamap::test {

[[nodiscard]] inline KeptScans kept(std::vector<TrackedScan> scans) {
  KeptScans kept;
  for (TrackedScan& scan : scans) kept.push_back(std::make_shared<const TrackedScan>(std::move(scan)));
  return kept;
}

/// `change(TrackedScan&)` on each scan of the set; with whomever it shares them, they stay as they were.
template <typename Change>
void change_each(KeptScans& scans, Change&& change) {
  for (std::shared_ptr<const TrackedScan>& scan : scans) {
    const auto changed = std::make_shared<TrackedScan>(*scan);
    change(*changed);
    scan = changed;
  }
}

}  // namespace deltamap::test
