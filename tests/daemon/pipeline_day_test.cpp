// SPDX-License-Identifier: Apache-2.0
// The whole live pipeline - its threads, both ports, store, recording, files and what it keeps for the next run - over
// hours of virtual time in a hall that changes: what it holds in memory does not grow. DELTAMAP_DAY_HOURS=24 makes it
// the day that belongs to the experiment `endurance`.
#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <future>
#include <utility>

#include "daemon/pipeline.hpp"
#include "daemon/store_opening.hpp"
#include "simulation/start_map.hpp"
#include "tests/support/figure.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/virtual_ports.hpp"

namespace deltamap::daemon {
namespace {

constexpr double kHour_s = 3600.0;
constexpr double kLook_s = 5.0;  // between two looks at the heap

double hours_to_drive() {
  const char* given = std::getenv("DELTAMAP_DAY_HOURS");
  return given == nullptr ? 1.0 : std::atof(given);
}

double megabytes(double bytes) { return bytes / (1024.0 * 1024.0); }

double resident_mb() {
  long total = 0;
  long resident = 0;
  std::ifstream("/proc/self/statm") >> total >> resident;
  return megabytes(static_cast<double>(resident) * 4096.0);
}

struct Sample {
  double passed_s = 0.0;
  double heap_mb = 0.0;  ///< in use, the least since the sample before: what swings with scans on their way is left out
  double resident_mb = 0.0;  ///< of the process, the simulator included
};

double heap_mb() {
  const struct mallinfo2 heap = mallinfo2();
  return megabytes(static_cast<double>(heap.uordblks + heap.hblkhd));
}

void show(const Sample& sample) {
  std::printf("after %5.2f h: heap %6.2f MB, resident %6.2f MB\n", sample.passed_s / kHour_s, sample.heap_mb,
              sample.resident_mb);
  (void)std::fflush(stdout);
}

struct Day {
  std::vector<Sample> samples;  ///< evenly over the drive
  RunReport report;
  std::vector<std::string> warnings;
};

Day driven(const test::TemporaryFolder& folder, double hours, std::size_t samples) {
  const simulation::Scenario scenario =
      simulation::read_scenario(DELTAMAP_SOURCE_DIR "/config/scenarios/endurance.yaml");
  simulation::VirtualDriveParams params;
  params.scan_period_s = 0.5;  // a fifth of the laser's rate: a day in an hour
  params.max_range_m = 30.0;
  params.forklift = scenario.forklift;

  Day day;
  std::promise<void> over;
  const double total_s = hours * kHour_s;
  constexpr double kNone_mb = 1e9;
  double least_mb = kNone_mb;
  double next_look_s = 0.0;
  test::VirtualPorts ports{scenario, params, [&](double passed_s) {
                             if (passed_s >= next_look_s) {
                               least_mb = std::min(least_mb, heap_mb());
                               next_look_s = passed_s + kLook_s;
                             }
                             const double next_s =
                                 total_s * static_cast<double>(day.samples.size() + 1) / static_cast<double>(samples);
                             if (passed_s < next_s) return true;
                             day.samples.push_back({passed_s, std::exchange(least_mb, kNone_mb), resident_mb()});
                             show(day.samples.back());
                             if (day.samples.size() < samples) return true;
                             over.set_value();
                             return false;
                           }};
  Settings settings;
  settings.initial_pose = ports.map_from_robot();
  settings.map.store = folder.path() / "store.sqlite";
  settings.recording.file = folder.path() / "bytes.pcapng";
  settings.recording.max_gigabytes = 1.0;
  const OccupancyGrid first = simulation::start_map(scenario, 0.05);
  OpenedStore opened = open_store(settings.map.store, first);
  Pipeline::Options options;
  options.start = opened.start;
  options.first_map = grid_hash(first);
  options.store = std::move(opened.store);
  options.out = folder.path();
  options.mode = drivers::SessionMode::kListenOnly;
  options.open = [&ports](boost::asio::io_context& loop, drivers::port::PortId id, unsigned) {
    return ports.open(loop, id);
  };
  options.log = [](const std::string&) {};
  options.warn = [&day](const std::string& line) { day.warnings.push_back(line); };
  options.failed = [](const std::string& why) { ADD_FAILURE() << why; };
  Pipeline pipeline{settings, std::move(options)};
  ports.follow(pipeline.telemetry());
  over.get_future().wait();
  day.report = pipeline.stop();
  return day;
}

TEST(PipelineDay, HoldsNoMoreInMemoryInTheLastHourThanAfterTheFirstQuarter) {
  const test::TemporaryFolder folder;
  const double hours = hours_to_drive();
  const auto samples = static_cast<std::size_t>(std::max(8.0, hours));
  const Day day = driven(folder, hours, samples);
  const RunReport& report = day.report;
  std::printf(
      "scans=%lu lost=%.0f s revisions=%lu refused=%lu tracked_lost=%lu recording_lost=%lu\n",
      static_cast<unsigned long>(report.scans.localized), report.time_lost_s,
      static_cast<unsigned long>(report.changes.accepted()), static_cast<unsigned long>(report.changes.refused()),
      static_cast<unsigned long>(report.scans.tracked_lost), static_cast<unsigned long>(report.scans.recording_lost));
  EXPECT_TRUE(day.warnings.empty()) << day.warnings.front();
  EXPECT_GT(report.changes.accepted(), static_cast<std::uint64_t>(10.0 * hours)) << "something must have happened";
  EXPECT_LT(report.time_lost_s + report.time_global_s, 0.05 * hours * kHour_s);
  const auto least_heap_mb = [&](std::size_t from, std::size_t to) {
    double least_mb = day.samples[from].heap_mb;
    for (std::size_t i = from; i < to; ++i) least_mb = std::min(least_mb, day.samples[i].heap_mb);
    return least_mb;
  };
  const double early_mb = least_heap_mb(samples / 4, samples / 2);
  const double late_mb = least_heap_mb(samples - samples / 4, samples);
  test::tell_figure("growth_of_the_heap", late_mb - early_mb, "MB");
  EXPECT_LT(late_mb - early_mb, 1.5) << "growth of the heap";
  EXPECT_LT(day.samples.back().resident_mb - day.samples[samples / 2].resident_mb, 4.0);
}

}  // namespace
}  // namespace deltamap::daemon
