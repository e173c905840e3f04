// SPDX-License-Identifier: Apache-2.0
// One run of `verdict`: a robot that knows where it is drives; then, at one moment, containers change and something
// befalls it; then it drives on. Does it notice, and does it say so?
#pragma once

#include "experiments/drive/lived_in.hpp"
#include "experiments/drive/pose_event.hpp"
#include "experiments/scan_table.hpp"
#include "experiments/verdict/ambiguity.hpp"

namespace deltamap::experiments {

struct VerdictRun {
  std::uint64_t seed = 1;
  PoseEvent event = PoseEvent::kNothing;
  double changed_share = 0.0;  ///< of the containers, at the moment of the event
  double max_range_m = 80.0;
  double before_s = 10.0;
  double after_driving_s = 60.0;  ///< of driving: in which the robot moves or turns
};

struct VerdictPlace {
  simulation::Scenario scenario;
  std::vector<simulation::PersonParams> people;
  std::shared_ptr<const OccupancyGrid> map;  ///< M_0
  localization::LocalizerParams localizer;
  std::shared_ptr<const AmbiguityOracle> oracle;  ///< of that map
};

struct VerdictScans {
  ScanTable scans;
  Ambiguity path;               ///< of the first 30 s of driving after the event
  double unique_after_s = 0.0;  ///< of them, from which on it is unambiguous; NaN where it is not
};

/// A row for every scan; `since_event_s` is negative before it. The run ends after so much driving since the event, or
/// after twice that time. `driven_s`: seconds since the event in which the robot went faster than 0.05 m/s or turned
/// faster than 3°/s. `map_is_wrong`: more than 5 % of the beams truly end
/// where M_0's world would not have ended them, people left aside.
[[nodiscard]] VerdictScans verdict_scans(const VerdictPlace& place,
                                         const localization::belief::StabilityRecord& lived_in, const VerdictRun& run);

}  // namespace deltamap::experiments
