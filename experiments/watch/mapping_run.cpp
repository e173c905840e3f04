// SPDX-License-Identifier: Apache-2.0
#include "experiments/watch/mapping_run.hpp"

#include "experiments/drive/first_map.hpp"
#include "experiments/drive/mapping_drive.hpp"
#include "experiments/report/svg_map.hpp"
#include "experiments/watch/mapping_watch.hpp"

namespace deltamap::experiments {

Outcome outcome_of(const MappingRun& run) {
  const auto first = first_map(run.scenario);
  MappingDrive drive{run.scenario, run.drive, run.settings, {first}};
  MappingWatch watch{run.scenario, first, {.range_m = run.drive.max_range_m}};
  const double restart_every_s = 60.0 * run.minutes / (run.restarts + 1);
  double next_restart_s = restart_every_s;
  for (double passed_s = 0.0; passed_s < 60.0 * run.minutes;) {
    const Mapped scan = drive.next();
    passed_s = scan.passed_s;
    watch.observe(scan, drive.map());
    if (passed_s < next_restart_s || passed_s >= 60.0 * run.minutes) continue;
    next_restart_s += restart_every_s;
    drive.restart();
    watch.restarted();
  }
  Outcome outcome;
  outcome.numbers = watch.numbers(drive.map());
  outcome.scans = watch.course();
  outcome.pictures = {{"the map at the end; blue: only there, orange: only in the truth",
                       svg_of_difference(drive.map(), watch.truth())}};
  return outcome;
}

daemon::Settings settings_of(const Options& options, const std::string& method) {
  daemon::Settings settings;
  settings.localizer = options.localizer;
  settings.mapping = options.mapping;
  settings.mapping.store_scan.method = method == "paper" ? MappingMethod::kPaper : MappingMethod::kEvidence;
  return settings;
}

}  // namespace deltamap::experiments
