// SPDX-License-Identifier: Apache-2.0
// The stages of a run one after another in one thread and in the run's own time: localizer, Δ-mapping, map, and what
// they hand back to the localizer. A replay does so with recorded bytes, a simulated drive with a virtual robot; the
// threads of pipeline.cpp run the same steps.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "core/messages.hpp"
#include "daemon/outputs/outputs.hpp"
#include "daemon/records/journal.hpp"
#include "daemon/records/map_order.hpp"
#include "daemon/replay/revision_queue.hpp"
#include "daemon/replay/transients_queue.hpp"
#include "daemon/settings/settings.hpp"
#include "daemon/steps/bay_step.hpp"
#include "daemon/steps/localization_step.hpp"
#include "daemon/steps/map_step.hpp"
#include "mapping/store_scan.hpp"

namespace deltamap::daemon {

/// What a run does beside its results, for those who look at it.
struct RunDuties {
  bool tells_times = true;  ///< cpu() is measured: a twentieth of the run's time
};

class SequentialRun {
 public:
  /// The journal says before which scan the localizer takes what; null: a revision when `map_delay_s` of the run have
  /// passed since its set ended, all else before the next scan.
  SequentialRun(const Settings& settings, const StartMap& start, const Journal* journal, double map_delay_s,
                const RunDuties& duties = {});

  void observe(const Odometry& odometry);
  /// The localizer takes what is due before this scan.
  void take_what_is_due(const Scan& scan);
  [[nodiscard]] TrackedScan observe(Scan scan);
  /// What is to be handed to update_map().
  [[nodiscard]] std::optional<MapRequest> look_for_changes(const TrackedScan& tracked);
  /// What the newest scan has told of the bays.
  [[nodiscard]] const std::vector<mapping::bays::BayEvent>& bay_events() const { return bay_events_; }
  /// As MapStep::take().
  [[nodiscard]] std::optional<MapStep::Result> update_map(const MapRequest& request);
  [[nodiscard]] MapStep::Result obey(const SetCells& wanted);
  /// Other bays and zones from the next scan on.
  void take(const Site& site);

  [[nodiscard]] LocalizationStep& localization() { return localization_; }
  [[nodiscard]] const LocalizationStep& localization() const { return localization_; }
  [[nodiscard]] const mapping::StoreScan& store_scan() const { return store_scan_; }
  [[nodiscard]] const MapStep& map() const { return map_; }
  [[nodiscard]] const BayStep& bays() const { return bays_; }
  /// CPU time of this thread so far, by stage; 0 where the duties leave it out.
  [[nodiscard]] const StageCpu& cpu() const { return cpu_; }

 private:
  /// Its revision waits for the localizer.
  [[nodiscard]] MapStep::Result handed_on(MapStep::Result result);

  LocalizationStep localization_;
  mapping::StoreScan store_scan_;
  BayStep bays_;
  std::vector<mapping::bays::BayEvent> bay_events_;
  MapStep map_;
  RevisionQueue revisions_;
  TransientsQueue transients_;
  bool tells_times_;
  StageCpu cpu_;
};

}  // namespace deltamap::daemon
