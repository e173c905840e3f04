// SPDX-License-Identifier: Apache-2.0
// What the delta thread does with each scan for the bays of the site, and what a replay does in its place.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/messages.hpp"
#include "daemon/outputs/bays_board.hpp"
#include "daemon/steps/localization_step.hpp"
#include "mapping/bays/bays.hpp"

namespace deltamap::daemon {

class BayStep {
 public:
  explicit BayStep(const StartMap& start);

  /// Other bays from the next scan on; what is known of those that stay as they were is kept.
  void set_bays(const std::vector<mapping::bays::Bay>& bays) { bays_.set(bays); }

  /// Every scan that Δ-mapping has looked at, and what came of it: where it takes back what a wrong pose has written,
  /// what that pose has seen of bays is taken back, too.
  [[nodiscard]] std::vector<mapping::bays::BayEvent> observe(const TrackedScan& tracked, bool pose_holds,
                                                             const std::optional<MapRequest>& request);
  [[nodiscard]] std::shared_ptr<const BayList> list() const;

 private:
  mapping::bays::Bays bays_;
};

}  // namespace deltamap::daemon
