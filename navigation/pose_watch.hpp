// SPDX-License-Identifier: Apache-2.0
// Whether the pose that the localizer believes is good enough to drive by. A state or a verdict changes late, so fit
// and covariance are asked as well.
#pragma once

#include <optional>

#include "core/messages.hpp"
#include "navigation/stop_reason.hpp"

namespace deltamap::navigation {

struct PoseNow {
  const Estimate& estimate;
  std::optional<double> fit;  ///< share of the scan's beams that the map explains; nothing: none ended where it knows
  bool start_fits = true;     ///< no pose was given, or scans have supported it
};

class PoseWatch {
 public:
  /// After each scan. kNone where the pose is tracked, is known to a metre, and explains what the laser sees.
  [[nodiscard]] StopReason observe(const PoseNow& pose);

 private:
  [[nodiscard]] bool is_unfit(const PoseNow& pose);

  std::optional<Timestamp> last_;
  double mean_fit_ = 1.0;  // running mean
};

}  // namespace deltamap::navigation
