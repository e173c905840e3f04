// SPDX-License-Identifier: Apache-2.0
// The live pipeline, with all its threads, on a scripted drive; and the replay of what it recorded, which must come to
// the same bytes whatever the scheduler did.
#include "daemon/pipeline.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <mutex>

#include "daemon/settings/start_error.hpp"
#include "tests/support/daemon/pipeline_fixture.hpp"
#include "tests/support/files/not_root.hpp"

namespace deltamap::daemon {
namespace {

namespace fs = std::filesystem;
using test::content_of;
using test::lines_of;

class PipelineTest : public test::PipelineFixture {};

TEST_F(PipelineTest, AnUnhurriedLiveRunAndItsReplayGiveTheSameBytes) {
  const RunReport live = run_live(std::chrono::microseconds(2000));
  EXPECT_EQ(live.scans.lost + live.scans.odometry_lost + live.scans.recording_lost, 0u);
  EXPECT_GT(live.scans.localized, 300u);
  EXPECT_EQ(live.time_lost_s, 0.0);
  EXPECT_GE(live.changes.accepted(), 1u) << "the box must have become map";

  const RunReport again = replay("live.pcapng", "replayed");
  EXPECT_EQ(again.journal, "obeyed");
  EXPECT_EQ(again.journal_differences, 0u);
  expect_same_files("live", "replayed");
  EXPECT_EQ(lines_of(content_of(folder_.path() / "live/trajectory.tum")), live.scans.decoded);
  EXPECT_EQ(lines_of(content_of(folder_.path() / "live/localization.csv")), live.scans.localized + 1);
}

TEST_F(PipelineTest, AStartPoseThatDoesNotFitIsAWarning) {
  settings_.initial_pose = test::pose_on_drive(0.0) * Pose2{-1.5, 0.0, 0.7};
  std::mutex mutex;
  std::vector<std::string> warnings;
  prepare_ = [&](Pipeline::Options& live) {
    live.warn = [&](const std::string& line) {
      const std::scoped_lock lock{mutex};
      warnings.push_back(line);
    };
  };
  (void)run_live(std::chrono::microseconds(500));
  ASSERT_FALSE(warnings.empty());
  EXPECT_TRUE(warnings.front().starts_with("the start pose does not fit: ")) << warnings.front();
}

TEST_F(PipelineTest, ARunThatDropsScansIsReplayedWithTheSameDrops) {
  const RunReport live = run_live(std::chrono::microseconds(0));
  EXPECT_GT(live.scans.dropped + live.scans.lost, 0u) << "the ports must have been faster than the localizer";
  const RunReport again = replay("live.pcapng", "replayed");
  EXPECT_EQ(again.journal, "obeyed");
  EXPECT_EQ(again.journal_differences, 0u);
  EXPECT_EQ(again.scans.dropped, live.scans.dropped);
  EXPECT_EQ(again.scans.lost, live.scans.lost);
  EXPECT_EQ(live.scans.recording_lost, 0u);
  EXPECT_EQ(again.scans.odometry_lost, live.scans.odometry_lost);
  expect_same_files("live", "replayed");
}

TEST_F(PipelineTest, TheSameReplayTwiceGivesTheSameBytesAndAnotherSeedOthers) {
  const RunReport once = replay("drive.pcapng", "once");
  EXPECT_EQ(once.journal, "none");
  (void)replay("drive.pcapng", "twice");
  expect_same_files("once", "twice");
  settings_.seed = 2;
  (void)replay("drive.pcapng", "other");
  EXPECT_NE(content_of(folder_.path() / "once/trajectory.tum"), content_of(folder_.path() / "other/trajectory.tum"));
}

TEST_F(PipelineTest, AnIoThreadThatHangsShowsInTheLongestSilence) {
  std::promise<void> comes_back;
  Pipeline::Options hanging = options();
  hanging.open = [hangs = comes_back.get_future().share()](boost::asio::io_context&, drivers::port::PortId, unsigned) {
    hangs.wait();
    return drivers::port::SerialPortAnswer{nullptr, "is missing"};
  };
  Pipeline pipeline{settings_, std::move(hanging)};
  const auto give_up_at = std::chrono::steady_clock::now() + std::chrono::seconds(120);
  constexpr double kLong_s = 2.5;  // the others look for work once a second, unless the machine is busy
  Pipeline::Silence longest;
  const auto look_until = [&](bool io_is_silent) {
    do {
      longest = pipeline.longest_silence();
    } while ((longest.silence_s > kLong_s && longest.stage == "io") != io_is_silent &&
             std::chrono::steady_clock::now() < give_up_at);
    return longest.silence_s > kLong_s && longest.stage == "io";
  };
  EXPECT_TRUE(look_until(true)) << longest.stage << ", " << longest.silence_s << " s";
  comes_back.set_value();
  EXPECT_FALSE(look_until(false)) << longest.silence_s << " s";
  (void)pipeline.stop();
}

TEST_F(PipelineTest, AReportThatCannotBeWrittenIsAWarningAndTheRunEndsWell) {
  fs::create_directories(folder_.path() / "live/report.json");
  std::vector<std::string> warnings;
  prepare_ = [&](Pipeline::Options& live) { live.warn = [&](const std::string& line) { warnings.push_back(line); }; };
  EXPECT_GT(run_live(std::chrono::microseconds(0)).scans.decoded, 0u);
  // A run as hurried as this one loses scans, and may have to say more.
  EXPECT_TRUE(std::any_of(warnings.begin(), warnings.end(), [](const std::string& line) {
    return line.find("report.json: cannot be written: ") != std::string::npos;
  })) << ::testing::PrintToString(warnings);
}

TEST_F(PipelineTest, AFolderWhoseLockMayNotBeReadIsAPersonsMistake) {
  const fs::path out = folder_.path() / "live";
  fs::create_directories(out);
  fs::permissions(folder_.write("live/.lock", ""), fs::perms::none);
  for (const fs::path& open : {folder_.path(), out}) fs::permissions(open, fs::perms::all);
  Pipeline::Options wanted = options();
  wanted.out = out;
  const test::NotRoot another_user;
  EXPECT_THROW((Pipeline{settings_, std::move(wanted)}), StartError);
}

TEST_F(PipelineTest, ASecondDaemonInTheSameFolderOrRecordingEndsBeforeItDoesHarm) {
  fs::create_directories(folder_.path() / "live");
  const auto without_devices = [&](bool with_out) {
    Pipeline::Options wanted = options();
    if (with_out) wanted.out = folder_.path() / "live";
    wanted.open = [](boost::asio::io_context&, drivers::port::PortId, unsigned) {
      return drivers::port::SerialPortAnswer{nullptr, "is missing"};
    };
    return wanted;
  };
  Pipeline pipeline{settings_, without_devices(true)};
  const auto refusal = [&](Pipeline::Options other) -> std::string {
    try {
      const Pipeline second{settings_, std::move(other)};
    } catch (const FileInUse& error) {
      return error.what();
    }
    return "";
  };
  const std::string holder = " (pid " + std::to_string(getpid()) + ")";
  EXPECT_NE(refusal(without_devices(false)).find("live.pcapng: is in use by "), std::string::npos);
  const std::string told = refusal(without_devices(true));
  EXPECT_NE(told.find("live: is in use by "), std::string::npos) << told;
  EXPECT_NE(told.find(holder), std::string::npos) << told;
  EXPECT_FALSE(fs::exists(folder_.path() / "live.previous.pcapng"));
  (void)pipeline.stop();
}

TEST_F(PipelineTest, AJournalOfOtherSettingsIsNotObeyed) {
  (void)run_live(std::chrono::microseconds(0));
  settings_.seed = 2;
  const RunReport again = replay("live.pcapng", "replayed");
  EXPECT_EQ(again.journal, "not obeyed: other settings or map");
  EXPECT_EQ(again.scans.dropped, 0u);
}

TEST_F(PipelineTest, AStartPoseWhereNobodyCanStandIsTold) {
  OccupancyGrid map = *options().start.map;
  const Point2 corner = map.geometry().origin;
  for (int row = 0; row < map.height(); ++row) {
    for (int column = 0; column < map.width(); ++column) {
      const Cell cell{column, row};
      if ((map.geometry().centre_of(cell) - corner).norm() < 1.5) map.set(cell, CellState::kOccupied);
    }
  }
  Settings settings = settings_;
  settings.initial_pose = Pose2{corner.x() + 0.1, corner.y() + 0.1, 0.0};
  std::mutex mutex;
  std::string log;
  Pipeline::Options live = options();
  live.start.map = std::make_shared<const OccupancyGrid>(std::move(map));
  live.log = [&](const std::string& line) {
    const std::scoped_lock lock{mutex};
    log += line + "\n";
  };
  live.open = [](boost::asio::io_context&, drivers::port::PortId, unsigned) {
    return drivers::port::SerialPortAnswer{nullptr, "none here"};
  };
  (void)Pipeline{settings, std::move(live)}.stop();
  EXPECT_NE(log.find("the start pose lies more than 1 m from free floor"), std::string::npos) << log;
}

}  // namespace
}  // namespace deltamap::daemon
