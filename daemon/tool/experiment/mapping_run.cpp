// SPDX-License-Identifier: Apache-2.0
#include "daemon/tool/experiment/mapping_run.hpp"

#include <cstdlib>

#include "core/grid_file.hpp"
#include "daemon/tool/experiment/localizer_drive.hpp"
#include "daemon/tool/experiment/mapping_drive.hpp"
#include "daemon/tool/experiment/mapping_watch.hpp"

namespace deltamap::daemon::tool::experiment {

Outcome outcome_of(const MappingRun& run) {
  const auto first = first_map(run.scenario);
  MappingDrive drive{run.scenario, run.drive, run.settings, first};
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
  }
  Outcome outcome;
  if (const char* dump = std::getenv("DUMP")) {
    write_grid(drive.map(), std::string(dump) + "_ours.yaml");
    write_grid(watch.truth(), std::string(dump) + "_truth.yaml");
    write_grid(watch.perfect(), std::string(dump) + "_perfect.yaml");
    write_grid(watch.ghosts(drive.map()), std::string(dump) + "_ghosts.yaml");
  }
  outcome.numbers = watch.numbers(drive.map());
  outcome.scans = watch.course();
  return outcome;
}

Settings settings_of(const Options& options, const std::string& method) {
  Settings settings;
  settings.localizer = options.localizer;
  settings.mapping = options.mapping;
  settings.mapping.store_scan.method = method == "paper" ? MappingMethod::kPaper : MappingMethod::kEvidence;
  return settings;
}

}  // namespace deltamap::daemon::tool::experiment
