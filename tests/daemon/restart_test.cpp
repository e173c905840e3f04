// SPDX-License-Identifier: Apache-2.0
// A daemon that is started again on what its last run has left, and the replay of that second run from its recording
// and M_0 alone.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "daemon/kept/kept_stability.hpp"
#include "daemon/settings/memory_places.hpp"
#include "drivers/port/port_clock.hpp"
#include "mapping/store/map_store.hpp"
#include "tests/support/daemon/control_fixture.hpp"

namespace deltamap::daemon {
namespace {

namespace fs = std::filesystem;

class RestartTest : public test::PipelineFixture {
 protected:
  /// A whole round, in which the box becomes map; then the daemon starts again where it ended.
  RestartTest() {
    settings_.map.store = folder_.path() / "store.sqlite";
    record_drive(kRound_s);
    (void)run_live(std::chrono::microseconds(1500));
    fs::rename(folder_.path() / "live", folder_.path() / "first");
    settings_.initial_pose.reset();
    record_drive(kDrive_s);
    prepare_ = [this](Pipeline::Options& options) { begin_where_it_ended(options); };
    live_ = run_live(std::chrono::microseconds(1500));
  }

  static constexpr double kRound_s = 30.0;
  static constexpr double kKeptM = 0.5;  // how far off a kept pose is taken to be; the box is gone again

  void record_drive(double drive_s) {
    test::write_drive(folder_.path() / "drive.log", drive_s);
    (void)tool::import_carmen(folder_.path() / "drive.log", folder_.path() / "drive.pcapng", std::nullopt);
  }

  /// As run_daemon() does.
  void begin_where_it_ended(Pipeline::Options& options) {
    const mapping::store::MapStore store{folder_.path() / "first/map_store.sqlite"};
    ASSERT_GE(store.newest(), 1u) << "the box must have become map";
    const MemoryPlaces places = memory_places(settings_.map.store);
    const auto pose = read_kept_pose(places.pose, options.first_map);
    auto stability = read_kept_stability(places.stability, options.first_map);
    ASSERT_TRUE(pose.pose) << pose.why_not;
    ASSERT_TRUE(stability.kept) << stability.why_not;
    options.start = {.map = std::make_shared<const OccupancyGrid>(store.grid(store.newest())),
                     .revision = store.newest()};
    for (const std::uint32_t number : store.provisional()) {
      options.start.provisional.push_back({number, store.changes(number)});
    }
    ASSERT_FALSE(options.start.provisional.empty()) << "the drive is too short to settle anything";
    options.start.remembered = pose.pose->map_from_robot;
    options.start.stability = stability.kept->record;
    ASSERT_TRUE(pose.calibration);
    options.start.calibration = pose.calibration;
    options.memory = pose.fingerprint ^ stability.fingerprint;
  }

  [[nodiscard]] std::string first_pose_of(const std::string& run) const {
    const std::string trajectory = test::content_of(folder_.path() / run / "trajectory.tum");
    return trajectory.substr(0, trajectory.find('\n'));
  }
  [[nodiscard]] double starts_off_m(const std::string& run) const {
    double t = 0.0;
    double x = 0.0;
    double y = 0.0;
    std::istringstream{first_pose_of(run)} >> t >> x >> y;
    return std::hypot(x - test::pose_on_drive(0.0).x, y - test::pose_on_drive(0.0).y);
  }

  RunReport live_;
};

TEST_F(RestartTest, ItsRecordingGivesTheSameBytesFromTheFirstMapAlone) {
  EXPECT_EQ(live_.scans.recording_lost, 0u);
  for (const char* left : {"store.pose.json", "store.stability"}) fs::remove(folder_.path() / left);
  const RunReport again = replay("live.pcapng", "replayed");
  EXPECT_EQ(again.began.find("what the recorded run began from: revision="), 0u) << again.began;
  EXPECT_NE(again.began.find(" provisional), kept pose, stability, wheels and mount"), std::string::npos)
      << again.began;
  EXPECT_EQ(again.journal, "obeyed");
  EXPECT_EQ(again.journal_differences, 0u);
  expect_same_files("live", "replayed");
  EXPECT_LT(starts_off_m("replayed"), kKeptM);
}

TEST_F(RestartTest, WhatItBeganFromIsUsedWithOtherSettingsToo) {
  settings_.seed = 2;
  const RunReport again = replay("live.pcapng", "replayed");
  EXPECT_EQ(again.journal, "not obeyed: other settings or map");
  EXPECT_EQ(again.began.find("what the recorded run began from: revision="), 0u) << again.began;
  EXPECT_LT(starts_off_m("replayed"), kKeptM);

  settings_.initial_pose = Pose2{2.0, 2.0, 0.0};
  const RunReport elsewhere = replay("live.pcapng", "elsewhere");
  EXPECT_EQ(elsewhere.journal, "not obeyed: other settings or map");
  EXPECT_GT(starts_off_m("elsewhere"), 3.0) << "a pose that is given takes precedence";
}

TEST_F(RestartTest, OnAnotherMapNothingOfItIsUsedAndThatIsSaid) {
  write_grid(test::small_room(true), folder_.path() / "room.yaml");
  const RunReport again = replay("live.pcapng", "replayed");
  EXPECT_EQ(again.began.find("the map alone: the recorded run began from another one, with revision="), 0u)
      << again.began;
  EXPECT_EQ(again.journal.find("not obeyed: "), 0u);
}

class BaysRestartTest : public test::ControlDeskTest {
 protected:
  BaysRestartTest() {
    settings_.map.store = folder_.path() / "store.sqlite";
    settings_.bays.file =
        folder_.write("bays.yaml", "bays:\n  - {id: B1, polygon: [[6.2, 3.4], [7.2, 3.4], [7.2, 4.4], [6.2, 4.4]]}\n")
            .string();
  }
  [[nodiscard]] nlohmann::json bay() const { return asked({control::Request::Kind::kBays, {}})["bays"][0]; }
};

TEST_F(BaysRestartTest, WhatTheRunBeforeHasSeenOfABayIsShownWithItsAgeAndJudgesNothing) {
  constexpr std::int64_t kThreeHours_ns = 3 * 3'600'000'000'000;
  nlohmann::json before;
  (void)run_live(std::chrono::microseconds(3000), [&](const Pipeline&) {
    EXPECT_TRUE(test::comes_true([&] { return bay()["state"] != "unknown"; }));
    before = bay();
  });
  EXPECT_FALSE(before.contains("remembered"));
  const fs::path left = folder_.path() / "store.bays-seen.json";
  auto kept = nlohmann::json::parse(test::content_of(left));
  ASSERT_EQ(kept["bays"].size(), 1u) << kept;
  EXPECT_EQ(kept["bays"][0]["state"], before["state"]);
  for (const char* key : {"seen_ns", "since_ns"})  // the drive is played faster than it was driven
    kept["bays"][0][key] = unix_ns(drivers::port::port_clock_now()) - kThreeHours_ns;
  std::ofstream{left} << kept;
  nlohmann::json after;
  (void)run_live(std::chrono::microseconds(1000), [&](const Pipeline&) { after = bay(); });
  EXPECT_EQ(after["remembered"], true) << after;
  EXPECT_EQ(after["state"], before["state"]);
  EXPECT_GE(after["age_s"].get<double>(), 10'800.0) << "never younger";
  EXPECT_LT(after["age_s"].get<double>(), 10'920.0);
  const std::string first = test::content_of(folder_.path() / "live/bays.jsonl");
  EXPECT_EQ(nlohmann::json::parse(first.substr(0, first.find('\n')))["before"], "unknown") << first;
  fs::remove(left);
  (void)run_live(std::chrono::microseconds(1000), [&](const Pipeline&) { after = bay(); });
  EXPECT_EQ(after["state"], "unknown") << "nobody has told";
  EXPECT_EQ(after["last_seen"], nullptr);
}

}  // namespace
}  // namespace deltamap::daemon
