// SPDX-License-Identifier: Apache-2.0
#include "daemon/replay/sequential_run.hpp"

#include <utility>

#include "daemon/telemetry/cpu_timer.hpp"

namespace deltamap::daemon {

SequentialRun::SequentialRun(const Settings& settings, const StartMap& start, const Journal* journal,
                             double map_delay_s, const RunDuties& duties)
    : localization_{settings, start},
      store_scan_{settings.mapping.store_scan, settings.seed, !start.provisional.empty()},
      bays_{start},
      map_{settings, start},
      revisions_{journal, map_delay_s, start.revision},
      transients_{journal},
      tells_times_{duties.tells_times} {
  if (start.site) store_scan_.set_zones(start.site->zones);
}

void SequentialRun::take(const Site& site) {
  localization_.set_zones(site.zones);
  store_scan_.set_zones(site.zones);
  bays_.set_bays(site.bays);
  map_.set_zones(site.zones);
}

void SequentialRun::observe(const Odometry& odometry) { localization_.observe(odometry); }

void SequentialRun::take_what_is_due(const Scan& scan) {
  const CpuTimer timer{cpu_.localization_s, tells_times_};
  while (const auto revision = revisions_.next_before(scan)) localization_.apply(*revision);
  if (auto transients = transients_.next_before(scan.number)) localization_.apply(std::move(transients));
}

TrackedScan SequentialRun::observe(Scan scan) {
  const CpuTimer timer{cpu_.localization_s, tells_times_};
  return localization_.observe(std::move(scan));
}

std::optional<MapRequest> SequentialRun::look_for_changes(const TrackedScan& tracked) {
  const CpuTimer timer{cpu_.awareness_s, tells_times_};
  std::optional<MapRequest> request = store_scan_.observe(tracked);
  transients_.push(store_scan_.transients());
  bay_events_ = bays_.observe(tracked, store_scan_.pose_holds(), request);
  return request;
}

std::optional<MapStep::Result> SequentialRun::update_map(const MapRequest& request) {
  const CpuTimer timer{cpu_.map_update_s, tells_times_};
  std::optional<MapStep::Result> result = map_.take(request);
  if (result) result = handed_on(*std::move(result));
  return result;
}

MapStep::Result SequentialRun::obey(const SetCells& wanted) {
  const CpuTimer timer{cpu_.map_update_s, tells_times_};
  return handed_on(map_.obey(wanted));
}

MapStep::Result SequentialRun::handed_on(MapStep::Result result) {
  if (result.revision) revisions_.push(*result.revision);
  return result;
}

}  // namespace deltamap::daemon
