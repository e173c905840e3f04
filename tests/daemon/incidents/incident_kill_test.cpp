// SPDX-License-Identifier: Apache-2.0
// A process that keeps incidents is killed at any moment: what is there is whole, or not there.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <thread>

#include "core/files/grid_file.hpp"
#include "core/random.hpp"
#include "daemon/incidents/incident_keeper.hpp"
#include "daemon/incidents/incident_list.hpp"
#include "daemon/replay/replay_start.hpp"
#include "tests/support/files/temporary_folder.hpp"

namespace deltamap::daemon {
namespace {

namespace fs = std::filesystem;

constexpr Timestamp kBegins = timestamp_from_ns(1'700'000'000'000'000'000);

constexpr Duration kStep = std::chrono::milliseconds{100};

Settings keeping_in(const fs::path& folder) {
  Settings settings;
  settings.incidents.folder = folder;
  settings.incidents.max_count = 4;
  return settings;
}

/// Marks a moment each 40 s of its own time, as fast as it can, until it is killed.
[[noreturn]] void keep_for_ever(const fs::path& folder) {
  Telemetry telemetry;
  LogTail log;
  const auto say = [](const std::string&) {};
  const auto map = std::make_shared<const OccupancyGrid>(GridGeometry{100, 80, 0.05, {0.0, 0.0}}, CellState::kFree);
  IncidentKeeper keeper{{.settings = keeping_in(folder), .first_notes = {"run"}, .map = map, .began = kBegins},
                        telemetry,
                        log,
                        {say, say}};
  for (std::int64_t step = 1;; ++step) {
    const Timestamp now = kBegins + kStep * step;
    drivers::port::ByteRecord record;
    record.port = step % 2 == 0 ? drivers::port::PortId::kRobot : drivers::port::PortId::kLaser;
    record.stamp = now;
    record.bytes.assign(500, static_cast<std::uint8_t>(step));
    keeper.hear(record, now);
    if (step % 400 == 0) (void)keeper.hear(MarkOrder{"again", 1}, now);
    keeper.look(now);
  }
}

/// Throws, or fails, where something of it is missing.
void expect_whole(const StoredIncident& stored) {
  for (const char* file : {kIncidentRecording, kIncidentMap, kIncidentSettings, kIncidentLog, kIncidentWords})
    EXPECT_TRUE(fs::is_regular_file(stored.folder / file)) << stored.folder / file;
  EXPECT_EQ(read_grid(stored.folder / kIncidentMap).geometry().width, 100);
  EXPECT_NO_THROW((void)read_settings(stored.folder / kIncidentSettings, {}));
  drivers::port::ByteLogReader reader{stored.folder / kIncidentRecording};
  const Timestamp marked = stored.incident.events.front().time;
  std::optional<Timestamp> before;
  bool has_event = false;
  while (const auto record = reader.next()) {
    if (record->bytes.empty()) continue;
    EXPECT_LE(stored.incident.from, record->stamp);
    EXPECT_EQ(record->stamp - before.value_or(record->stamp - kStep), kStep) << "none is missing";
    before = record->stamp;
    has_event = has_event || record->stamp >= marked;
  }
  EXPECT_TRUE(has_event) << stored.incident.name << ": the bytes before the mark are there";
  EXPECT_FALSE(reader.faults().lacks_records) << reader.faults().lines().front();
  if (stored.incident.to) {
    EXPECT_TRUE(reader.faults().lines().empty()) << reader.faults().lines().front();
    EXPECT_GE(seconds(*before - marked), 29.0);
  }
}

TEST(IncidentKill, LeavesEachIncidentWholeOrNotThere) {
  constexpr int kKills = 60;
  double most_us = 120'000.0;  // until a kill; more on a machine on which nothing comes to be by then
  Random random{7};
  std::size_t seen = 0;
  std::size_t unfinished = 0;
  const test::TemporaryFolder folder;
  for (int kill = 0; kill < kKills; ++kill) {
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) keep_for_ever(folder.path());
    std::this_thread::sleep_for(std::chrono::microseconds{static_cast<int>(random.uniform(5'000.0, most_us))});
    ASSERT_EQ(::kill(child, SIGKILL), 0);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
    for (const auto& entry : fs::directory_iterator(folder.path())) {
      if (!entry.is_directory() || entry.path().filename().string().starts_with('.')) continue;
      EXPECT_NO_THROW((void)read_incident(entry.path())) << entry.path();
    }
    const std::vector<StoredIncident> all = incidents_in(folder.path());
    if (all.empty()) most_us = std::min(1.5 * most_us, 3e6);
    for (const StoredIncident& stored : all) {
      ++seen;
      unfinished += stored.incident.to ? 0 : 1;
      expect_whole(stored);
    }
  }
  EXPECT_GT(seen, 100u);
  EXPECT_GT(unfinished, 5u) << "some were killed in their half minute after";
}

}  // namespace
}  // namespace deltamap::daemon
