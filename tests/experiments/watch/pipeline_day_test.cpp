// SPDX-License-Identifier: Apache-2.0
// What the daemon's pipeline holds in memory over hours of virtual time does not grow. DELTAMAP_DAY_HOURS=24 makes it
// the day that belongs to the experiment `endurance`.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "experiments/watch/pipeline_day.hpp"
#include "tests/support/files/figure.hpp"
#include "tests/support/files/source_tree.hpp"

namespace deltamap::experiments {
namespace {

constexpr double kHour_s = 3600.0;

double hours_to_drive() {
  const char* given = std::getenv("DELTAMAP_DAY_HOURS");
  return given == nullptr ? 1.0 : std::atof(given);
}

MappingRun run_of(double hours) {
  MappingRun run{.scenario = simulation::read_scenario(test::source_path("config/scenarios/endurance.yaml")),
                 .drive = {},
                 .settings = {},
                 .minutes = 60.0 * hours};
  run.drive.scan_period_s = 0.5;
  run.drive.max_range_m = 30.0;
  run.drive.forklift = run.scenario.forklift;
  return run;
}

double least_heap_mb(const PipelineDay& day, std::size_t from, std::size_t to) {
  double least_mb = day.samples[from].heap_mb;
  for (std::size_t i = from; i < to; ++i) least_mb = std::min(least_mb, day.samples[i].heap_mb);
  return least_mb;
}

void show(const MemorySample& sample) {
  std::printf("after %5.2f h: heap %6.2f MB, resident %6.2f MB\n", sample.passed_s / kHour_s, sample.heap_mb,
              sample.resident_mb);
  (void)std::fflush(stdout);
}

void show(const daemon::RunReport& report) {
  std::printf("scans=%lu lost=%.0f s revisions=%lu refused=%lu sets_lost=%lu tracked_lost=%lu recording_lost=%lu\n",
              static_cast<unsigned long>(report.scans.localized), report.time_lost_s,
              static_cast<unsigned long>(report.changes.accepted()),
              static_cast<unsigned long>(report.changes.refused()), static_cast<unsigned long>(report.scans.sets_lost),
              static_cast<unsigned long>(report.scans.tracked_lost),
              static_cast<unsigned long>(report.scans.recording_lost));
}

TEST(PipelineDay, HoldsNoMoreInMemoryInTheLastHourThanOnceItHasSettled) {
  const double hours = hours_to_drive();
  const PipelineDay day = pipeline_day(run_of(hours), [](const MemorySample& sample) { show(sample); });
  show(day.report);
  EXPECT_TRUE(day.warnings.empty()) << day.warnings.front();
  EXPECT_GT(day.report.changes.accepted(), static_cast<std::uint64_t>(10.0 * hours)) << "something must have happened";
  EXPECT_LT(day.report.time_lost_s + day.report.time_global_s, 0.05 * hours * kHour_s);
  if (hours >= kSettling_h + 1.0) {
    test::tell_figure("growth_of_the_heap", day.heap_growth_mb(), "MB");
    EXPECT_LT(day.heap_growth_mb(), kMostHeapGrowth_mb);
    EXPECT_LT(day.resident_growth_mb(), 4.0);
    return;
  }
  // In the second half, while parts of the hall are still seen for the first time.
  const std::size_t quarter = day.samples.size() / 4;
  const double growth_mb =
      least_heap_mb(day, 3 * quarter, day.samples.size()) - least_heap_mb(day, 2 * quarter, 3 * quarter);
  test::tell_figure("growth_of_the_heap", growth_mb, "MB");
  EXPECT_LT(growth_mb, 0.5);
}

}  // namespace
}  // namespace deltamap::experiments
