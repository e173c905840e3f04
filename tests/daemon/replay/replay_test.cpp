// SPDX-License-Identifier: Apache-2.0
// What `deltamap replay` does with inputs that are not what they should be: one line that names file and place, and
// nothing left behind.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/files/grid_file.hpp"
#include "daemon/replay/replay_run.hpp"
#include "daemon/replay/revision_queue.hpp"
#include "daemon/replay/transients_queue.hpp"
#include "mapping/store/map_store.hpp"
#include "tests/support/files/temporary_folder.hpp"
#include "tests/support/files/text_file.hpp"
#include "tests/support/scans/scripted_drive.hpp"
#include "tests/support/worlds/padded.hpp"
#include "tool/import_carmen.hpp"
#include "tool/run_tool.hpp"

namespace deltamap::daemon {
namespace {

namespace fs = std::filesystem;

using test::content_of;

class ReplayTest : public testing::Test {
 protected:
  ReplayTest() {
    record_drive(3.0);
    write_grid(test::small_room(false), folder_.path() / "room.yaml");
    (void)folder_.write("config.yaml", "seed: 3\n");
  }

  void record_drive(double for_s) const {
    test::write_drive(folder_.path() / "drive.log", for_s);
    (void)tool::import_carmen(folder_.path() / "drive.log", folder_.path() / "drive.pcapng", std::nullopt);
  }

  [[nodiscard]] ReplayJob job() const {
    ReplayJob job;
    job.recording = folder_.path() / "drive.pcapng";
    job.map = folder_.path() / "room.yaml";
    job.settings.initial_pose = test::pose_on_drive(0.0);
    job.out = folder_.path() / "out";
    return job;
  }

  /// The one line of the error, without the folder; "" where there was none.
  std::string error_of(const ReplayJob& job) {
    try {
      (void)run_replay(job, [](double) { return true; });
    } catch (const std::runtime_error& error) {
      std::string line = error.what();
      EXPECT_EQ(line.find('\n'), std::string::npos);
      const std::string prefix = folder_.path().string() + "/";
      return line.starts_with(prefix) ? line.substr(prefix.size()) : line;
    }
    return "";
  }

  void expect_nothing_left() {
    EXPECT_FALSE(fs::exists(folder_.path() / "out"));
    for (const auto& entry : fs::directory_iterator(folder_.path())) {
      EXPECT_FALSE(entry.is_directory()) << "left behind: " << entry.path();
    }
  }

  test::TemporaryFolder folder_;
};

TEST_F(ReplayTest, NeverOverwritesTheMapThatItBeginsWith) {
  fs::create_directories(folder_.path() / "out");
  write_grid(test::small_room(false), folder_.path() / "out/map.yaml");
  ReplayJob over_its_map = job();
  over_its_map.map = folder_.path() / "out/map.yaml";
  EXPECT_EQ(error_of(over_its_map), "out/map.yaml: --out would overwrite it; give another folder");
  EXPECT_FALSE(fs::exists(folder_.path() / "out/trajectory.tum"));
}

TEST_F(ReplayTest, WritesEveryFileOfTheContract) {
  EXPECT_EQ(error_of(job()), "");
  for (const char* name :
       {"trajectory.tum", "map.yaml", "map.pgm", "changes.jsonl", "report.json", "map_store.sqlite"}) {
    EXPECT_TRUE(fs::exists(folder_.path() / "out" / name)) << name;
  }
  EXPECT_EQ(mapping::store::MapStore{folder_.path() / "out/map_store.sqlite"}.grid(0), test::small_room(false));
}

TEST_F(ReplayTest, SaysWhatALiveRunWouldSayOfPoseAndMount) {
  record_drive(24.0);
  std::string said;
  ReplayJob wrong = job();
  wrong.warn = [&](const std::string& line) { said += line + "\n"; };
  EXPECT_EQ(error_of(wrong), "");
  EXPECT_EQ(said.find(" s: "), std::string::npos) << "of the drive: " << said;
  wrong.settings.laser.session.is_upside_down = true;  // and it is not
  wrong.settings.initial_pose->theta += radians(100.0);
  EXPECT_EQ(error_of(wrong), "");
  EXPECT_NE(said.find(" s: the start pose does not fit: "), std::string::npos) << said;
  EXPECT_NE(said.find("'laser.mount.upside_down: false'"), std::string::npos) << said;
}

TEST_F(ReplayTest, TheReportNamesWhatReallyRan) {
  ReplayJob told = job();
  told.settings.map.file = "/etc/deltamap/other.yaml";
  told.settings.map.store = "/var/lib/deltamap/other.sqlite";
  told.settings.robot.port = "/dev/other";
  EXPECT_EQ(error_of(told), "");
  const auto report = nlohmann::json::parse(content_of(folder_.path() / "out/report.json"));
  EXPECT_EQ(report["recording"]["file"], (folder_.path() / "drive.pcapng").string());
  EXPECT_EQ(report["settings"]["changed"]["map.file"], (folder_.path() / "room.yaml").string());
  for (const char* of_a_live_run : {"map.store", "robot.port"}) {
    EXPECT_FALSE(report["settings"]["changed"].contains(of_a_live_run)) << of_a_live_run;
  }
}

TEST_F(ReplayTest, FindsTheSameChangesHoweverMuchUnknownSpaceLiesAroundTheMap) {
  record_drive(34.0);
  EXPECT_EQ(error_of(job()), "");
  const OccupancyGrid changed = read_grid(folder_.path() / "out/map.yaml");
  const std::string trajectory = content_of(folder_.path() / "out/trajectory.tum");
  ASSERT_FALSE(changed == test::small_room(false)) << "the box";
  for (const test::Padding& by :
       {test::Padding{.left = 301, .low = 7, .right = 0, .high = 90}, test::Padding{.right = 1}}) {
    write_grid(test::padded(test::small_room(false), by), folder_.path() / "room.yaml");
    EXPECT_EQ(error_of(job()), "");
    EXPECT_EQ(read_grid(folder_.path() / "out/map.yaml"), test::padded(changed, by));
    EXPECT_EQ(content_of(folder_.path() / "out/trajectory.tum"), trajectory);
  }
}

TEST_F(ReplayTest, AnEmptyOrForeignRecordingOrOneWithoutAScanIsNamedAndLeavesNothing) {
  const std::string whole = content_of(folder_.path() / "drive.pcapng");
  ReplayJob wrong = job();
  wrong.recording = folder_.write("empty.pcapng", "");
  EXPECT_TRUE(error_of(wrong).starts_with("empty.pcapng: byte 0: ")) << error_of(wrong);
  wrong.recording = folder_.write("cut.pcapng", whole.substr(0, 600));
  EXPECT_TRUE(error_of(wrong).starts_with("cut.pcapng: byte ")) << error_of(wrong);
  EXPECT_TRUE(error_of(wrong).ends_with("; no scan lies before that")) << error_of(wrong);
  wrong.recording = folder_.write("foreign.pcapng", "FLASER 180 1 2 3\n");
  EXPECT_TRUE(error_of(wrong).starts_with("foreign.pcapng: byte 0: ")) << error_of(wrong);
  wrong.recording = folder_.path() / "missing.pcapng";
  EXPECT_TRUE(error_of(wrong).starts_with("missing.pcapng: ")) << error_of(wrong);
  expect_nothing_left();
}

TEST_F(ReplayTest, TheReportCountsWhatLiesOutsideOfTheWindow) {
  const auto outside = [&] {
    const auto report = nlohmann::json::parse(content_of(folder_.path() / "out/report.json"));
    return std::pair{report["recording"]["outside_window"], report["scans"].get<std::uint64_t>()};
  };
  EXPECT_EQ(error_of(job()), "");
  const auto [none, all_scans] = outside();
  EXPECT_EQ(none, (nlohmann::json{{"packets_before", 0}, {"scans_before", 0}, {"packets_after", 0}}));
  ReplayJob part = job();
  part.from_s = 1.0;
  EXPECT_EQ(error_of(part), "");
  const auto [before, later_scans] = outside();
  EXPECT_EQ(before["scans_before"].get<std::uint64_t>() + later_scans, all_scans);
  EXPECT_GT(before["scans_before"], 0);
  EXPECT_GT(before["packets_before"], before["scans_before"]);
  EXPECT_EQ(before["packets_after"], 0);
  part.from_s = 0.0;
  part.to_s = 2.0;
  EXPECT_EQ(error_of(part), "");
  const auto [after, earlier_scans] = outside();
  EXPECT_LT(earlier_scans, all_scans);
  EXPECT_GE(after["packets_after"].get<std::uint64_t>(), all_scans - earlier_scans);
}

TEST_F(ReplayTest, AWindowWithoutAScanIsRefused) {
  ReplayJob late = job();
  late.from_s = 1000.0;
  EXPECT_EQ(error_of(late), "drive.pcapng: holds no scan in this window");
  expect_nothing_left();
}

TEST_F(ReplayTest, AForeignMapIsNamedAndLeavesNothing) {
  ReplayJob wrong = job();
  wrong.map = folder_.write("wrong.yaml", "hello\n");
  EXPECT_TRUE(error_of(wrong).starts_with("wrong.yaml: ")) << error_of(wrong);
  expect_nothing_left();
}

TEST_F(ReplayTest, AStartPoseOffTheMapIsWrongUsage) {
  ReplayJob off = job();
  for (const double far : {500.0, 1e300, std::nan("")}) {
    off.settings.initial_pose = Pose2{far, 500.0, 0.0};
    EXPECT_THROW((void)run_replay(off, [](double) { return true; }), SettingsError) << far;
  }
  expect_nothing_left();
}

TEST_F(ReplayTest, SaysHowFarItsFirstEstimateLiesFromThePoseThatWasGiven) {
  const Pose2 right = test::pose_on_drive(0.0);
  const auto told_of = [&](const std::optional<Pose2>& given) {
    ReplayJob given_one = job();
    given_one.settings.initial_pose = given;
    std::vector<std::string> lines;
    given_one.warn = [&](const std::string& line) { lines.push_back(line); };
    EXPECT_EQ(error_of(given_one), "");
    std::erase_if(lines, [](const std::string& line) { return !line.starts_with("the first estimate lies "); });
    return lines;
  };
  EXPECT_TRUE(told_of(right).empty());
  EXPECT_TRUE(told_of(std::nullopt).empty()) << "none was given";
  for (const Pose2& off : {Pose2{0.5, 0.3, 0.0}, Pose2{0.0, 0.0, radians(-25.0)}}) {
    const auto lines = told_of(right * off);
    ASSERT_EQ(lines.size(), 1u) << off.x << " " << off.theta;
    double away_m = 0.0;
    double turned_deg = 0.0;
    ASSERT_EQ(std::sscanf(lines[0].c_str(), "the first estimate lies %lf m and %lf degrees from 'localization.initial_",
                          &away_m, &turned_deg),
              2)
        << lines[0];
    EXPECT_NEAR(away_m, off.position().norm(), 0.3);
    EXPECT_NEAR(turned_deg, degrees(std::abs(off.theta)), 15.0);
  }
}

TEST_F(ReplayTest, AnInterruptedReplayLeavesTheOldFilesAlone) {
  fs::create_directory(folder_.path() / "out");
  (void)folder_.write("out/trajectory.tum", "old");
  EXPECT_THROW((void)run_replay(job(), [](double) { return false; }), std::runtime_error);
  EXPECT_EQ(content_of(folder_.path() / "out/trajectory.tum"), "old");
}

TEST_F(ReplayTest, TheCommandEndsWithTheContractsExitCodes) {
  const std::string recording = (folder_.path() / "drive.pcapng").string();
  const std::string map = (folder_.path() / "room.yaml").string();
  const std::string config = (folder_.path() / "config.yaml").string();
  const std::string out = (folder_.path() / "out").string();
  const auto exit_code = [&](const char* recorded, const char* set) {
    const char* argv[] = {"deltamap",   "replay",       recorded, "--map",     map.c_str(),
                          "--config",   config.c_str(), "--out",  out.c_str(), "--initial-pose",
                          "7.6,4.6,90", "--set",        set};
    return tool::run_tool(static_cast<int>(std::size(argv)), argv);
  };
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  EXPECT_EQ(exit_code(recording.c_str(), "localization.beams=60"), 0);
  EXPECT_EQ(exit_code("/nowhere.pcapng", "localization.beams=60"), 1);
  EXPECT_EQ(exit_code(recording.c_str(), "localization.beems=60"), 2);
  (void)testing::internal::GetCapturedStdout();
  const std::string errors = testing::internal::GetCapturedStderr();
  EXPECT_NE(errors.find("localization.beems: unknown key"), std::string::npos) << errors;
}

TEST(RevisionQueue, WithoutAJournalARevisionIsTakenSomeTimeAfterItsPhase) {
  RevisionQueue queue{nullptr, 1.0};
  MapRevision revision;
  revision.number = 1;
  revision.time = timestamp_from_ns(10'000'000'000);
  queue.push(revision);
  Scan scan;
  scan.time = timestamp_from_ns(10'999'999'999);
  EXPECT_FALSE(queue.next_before(scan));
  scan.time = timestamp_from_ns(11'000'000'000);
  EXPECT_EQ(queue.next_before(scan)->number, 1u);
  EXPECT_FALSE(queue.next_before(scan));
}

TEST(RevisionQueue, AJournalDecidesBeforeWhichScanARevisionIsTaken) {
  Journal journal;
  journal.read("revision 2 before scan 7");
  RevisionQueue queue{&journal, 0.0};
  for (const std::uint32_t number : {1u, 2u, 3u}) {
    MapRevision revision;
    revision.number = number;
    queue.push(revision);
  }
  Scan scan;
  scan.number = 6;
  EXPECT_FALSE(queue.next_before(scan));
  scan.number = 7;
  EXPECT_EQ(queue.next_before(scan)->number, 1u);
  EXPECT_EQ(queue.next_before(scan)->number, 2u);
  EXPECT_FALSE(queue.next_before(scan));
}

std::shared_ptr<const TransientObstacles> snapshot(std::uint32_t number) {
  return std::make_shared<const TransientObstacles>(
      TransientObstacles{.number = number, .time = {}, .blocks = {}, .standing = {}, .gone = {}});
}

TEST(TransientsQueue, WithoutAJournalTheNewestSnapshotIsTakenBeforeTheNextScan) {
  TransientsQueue queue{nullptr};
  EXPECT_EQ(queue.next_before(1), nullptr);
  for (const std::uint32_t number : {1u, 2u, 2u}) queue.push(snapshot(number));
  EXPECT_EQ(queue.next_before(2)->number, 2u);
  EXPECT_EQ(queue.next_before(3), nullptr);
}

TEST(TransientsQueue, AJournalDecidesBeforeWhichScanASnapshotIsTaken) {
  Journal journal;
  journal.read("temporary 2 before scan 7");
  TransientsQueue queue{&journal};
  for (const std::uint32_t number : {1u, 2u, 3u}) queue.push(snapshot(number));
  EXPECT_EQ(queue.next_before(6), nullptr);
  EXPECT_EQ(queue.next_before(7)->number, 2u);
  EXPECT_EQ(queue.next_before(8), nullptr);
}

}  // namespace
}  // namespace deltamap::daemon
