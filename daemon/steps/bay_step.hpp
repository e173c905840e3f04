// SPDX-License-Identifier: Apache-2.0
// What the delta thread does with each scan for the bays of the site, and what a replay does in its place.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/messages.hpp"
#include "daemon/outputs/bays_board.hpp"
#include "daemon/settings/settings.hpp"
#include "mapping/bays/bays.hpp"

namespace deltamap::daemon {

class BayStep {
 public:
  /// Throws std::runtime_error: one line that names file and bay.
  BayStep(const Settings& settings, const GridGeometry& map);

  /// Every scan that Δ-mapping has looked at, and what came of it: where it takes back what a wrong pose has written,
  /// what that pose has seen of bays is taken back, too.
  [[nodiscard]] std::vector<mapping::bays::BayEvent> observe(const TrackedScan& tracked, bool pose_holds,
                                                             const std::optional<MapRequest>& request);
  [[nodiscard]] std::shared_ptr<const BayList> list() const;

 private:
  mapping::bays::Bays bays_;
};

}  // namespace deltamap::daemon
