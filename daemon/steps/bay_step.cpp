// SPDX-License-Identifier: Apache-2.0
#include "daemon/steps/bay_step.hpp"

namespace deltamap::daemon {

using mapping::bays::BayEvent;

BayStep::BayStep(const StartMap& start) : bays_{start.site ? start.site->bays : std::vector<mapping::bays::Bay>{}} {}

std::vector<BayEvent> BayStep::observe(const TrackedScan& tracked, bool pose_holds,
                                       const std::optional<MapRequest>& request) {
  const auto* withdraws = request ? std::get_if<WithdrawOrder>(&*request) : nullptr;
  if (withdraws != nullptr) return bays_.forget_since(withdraws->from, tracked.scan.time);
  return bays_.observe(tracked, pose_holds);
}

std::shared_ptr<const BayList> BayStep::list() const {
  return std::make_shared<const BayList>(BayList{bays_.bays(), bays_.statuses()});
}

}  // namespace deltamap::daemon
