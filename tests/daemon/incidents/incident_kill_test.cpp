// SPDX-License-Identifier: Apache-2.0
// A process that keeps incidents is killed at any moment: what is there is whole, or not there.
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <new>
#include <stdexcept>
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

/// Marks a moment each 40 s of its own time, as fast as it can, until it is killed. `heard`: how many steps it has
/// worked off.
[[noreturn]] void keep_for_ever(const fs::path& folder, Timestamp begins, std::atomic<std::int64_t>& heard) {
  Telemetry telemetry;
  LogTail log;
  const auto say = [](const std::string&) {};
  const auto map = std::make_shared<const OccupancyGrid>(GridGeometry{100, 80, 0.05, {0.0, 0.0}}, CellState::kFree);
  IncidentKeeper keeper{{.settings = keeping_in(folder), .first_notes = {"run"}, .map = map, .began = begins},
                        telemetry,
                        log,
                        {say, say}};
  for (std::int64_t step = 1;; ++step) {
    const Timestamp now = begins + kStep * step;
    drivers::port::ByteRecord record;
    record.port = step % 2 == 0 ? drivers::port::PortId::kRobot : drivers::port::PortId::kLaser;
    record.stamp = now;
    record.bytes.assign(500, static_cast<std::uint8_t>(step));
    keeper.hear(record, now);
    if (step % 400 == 0) (void)keeper.hear(MarkOrder{"again", 1}, now);
    keeper.look(now);
    heard = step;
  }
}

/// Memory that a child shares.
std::atomic<std::int64_t>& shared_count() {
  void* place =
      ::mmap(nullptr, sizeof(std::atomic<std::int64_t>), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (place == MAP_FAILED) throw std::runtime_error("no shared memory");
  return *new (place) std::atomic<std::int64_t>{0};
}

void kill_after(pid_t child, double us) {
  std::this_thread::sleep_for(std::chrono::microseconds{static_cast<int>(us)});
  ASSERT_EQ(::kill(child, SIGKILL), 0);
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
}

bool has_ended(const Incident& incident) { return incident.events.back().kind == IncidentKind::kDaemonEnded; }

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
  // Of one that was half written the bytes of the mark's own moment may be lost.
  const bool ends_before = has_ended(stored.incident) && stored.incident.events.back().time < marked;
  EXPECT_TRUE(has_event || ends_before) << stored.incident.name << ": the bytes before the mark are there";
  EXPECT_FALSE(reader.faults().lacks_records) << reader.faults().lines().front();
  if (stored.incident.to) {
    EXPECT_TRUE(reader.faults().lines().empty()) << reader.faults().lines().front();
    if (!has_ended(stored.incident)) {
      EXPECT_GE(seconds(*before - marked), 29.0);
    }
  }
}

/// The next start, which ends at once as it should.
void keep_left_of(const fs::path& folder, std::vector<std::string>& lines) {
  Telemetry telemetry;
  const LogTail log;
  const auto log_line = [](const std::string&) {};
  const auto warn = [&](const std::string& line) { lines.push_back(line); };
  const auto map = std::make_shared<const OccupancyGrid>(GridGeometry{10, 10, 0.05, {0.0, 0.0}}, CellState::kFree);
  const Timestamp now = kBegins + std::chrono::hours{24};
  IncidentKeeper keeper{{.settings = keeping_in(folder), .first_notes = {"run"}, .map = map, .began = now},
                        telemetry,
                        log,
                        {log_line, warn}};
  keeper.look(now);
  keeper.close(now);
}

TEST(IncidentKill, LeavesEachIncidentWholeOrNotThere) {
  constexpr int kKills = 60;
  double most_us = 120'000.0;  // until a kill; more on a machine on which nothing comes to be by then
  Random random{7};
  std::size_t seen = 0;
  std::size_t unfinished = 0;
  const test::TemporaryFolder folder;
  std::atomic<std::int64_t>& heard = shared_count();
  for (int kill = 0; kill < kKills; ++kill) {
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) keep_for_ever(folder.path(), kBegins + std::chrono::hours{24 * kill}, heard);
    kill_after(child, random.uniform(5'000.0, most_us));
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
  EXPECT_GT(unfinished, 2u) << "some were killed in their half minute after";
}

TEST(IncidentKill, LosesNothingThatTheNextStartDoesNotKeep) {
  constexpr int kKills = 40;
  constexpr std::int64_t kLost = 2;  // steps: what had come since the ring was last handed to the kernel
  double most_us = 120'000.0;
  Random random{11};
  std::size_t completed = 0;
  std::size_t as_new = 0;
  std::atomic<std::int64_t>& heard = shared_count();
  for (int kill = 0; kill < kKills; ++kill) {
    const test::TemporaryFolder folder;
    heard = 0;
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) keep_for_ever(folder.path(), kBegins, heard);
    kill_after(child, random.uniform(1'000.0, most_us));
    if (heard < 400) most_us = std::min(1.5 * most_us, 3e6);
    std::vector<std::string> lines;
    keep_left_of(folder.path(), lines);
    if (heard < kLost) continue;  // nothing had come
    std::vector<StoredIncident> ended = incidents_in(folder.path());
    for (const StoredIncident& stored : ended) {
      expect_whole(stored);
      EXPECT_TRUE(stored.incident.is_complete()) << stored.incident.lacks;
    }
    std::erase_if(ended, [](const StoredIncident& stored) { return !has_ended(stored.incident); });
    ASSERT_EQ(ended.size(), 1u) << "kill " << kill << " behind step " << heard;
    ASSERT_EQ(lines.size(), 1u) << lines.front() << "\n" << lines.back();
    EXPECT_NE(lines.front().find(ended.front().incident.name), std::string::npos) << lines.front();
    EXPECT_GE(ended.front().incident.to, kBegins + kStep * (heard - kLost));
    (ended.front().incident.events.size() > 1 ? completed : as_new) += 1;
  }
  EXPECT_GT(completed, 3u);
  EXPECT_GT(as_new, 3u);
}

}  // namespace
}  // namespace deltamap::daemon
