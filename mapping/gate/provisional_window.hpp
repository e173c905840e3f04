// SPDX-License-Identifier: Apache-2.0
// How far back what was written is still provisional: until the robot has driven some metres and some seconds have
// passed in which its pose was not in doubt. Both: a robot that stands sees nothing new that could prove its pose
// wrong, so time alone settles nothing.
#pragma once

#include <deque>
#include <optional>

#include "core/time.hpp"

namespace deltamap::mapping::gate {

struct ProvisionalParams {
  double way_m = 10.0;   ///< m; >= 0
  double time_s = 30.0;  ///< s; >= 0
};

class ProvisionalWindow {
 public:
  explicit ProvisionalWindow(const ProvisionalParams& params) : params_{params} {}

  /// Seconds that have passed and metres that were driven since the scan before; none while the pose is in doubt.
  void observe(Timestamp now, double passed_s, double driven_m);

  /// What was written before is settled; nothing where all of it is provisional.
  [[nodiscard]] std::optional<Timestamp> settled() const;

 private:
  struct Milestone {
    double passed = 0.0;  // m or s
    Timestamp left;       // the last instant at which no more had passed
  };

  ProvisionalParams params_;
  std::deque<Milestone> way_;   // of the metres that count
  std::deque<Milestone> time_;  // of the seconds that count
  double driven_m_ = 0.0;
  double passed_s_ = 0.0;
};

}  // namespace deltamap::mapping::gate
