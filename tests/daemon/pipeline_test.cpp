// SPDX-License-Identifier: Apache-2.0
// The live pipeline, with all its threads, on a scripted drive; and the replay of what it recorded, which must come to
// the same bytes whatever the scheduler did.
#include "daemon/pipeline.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <sstream>

#include "core/grid_file.hpp"
#include "daemon/replay_run.hpp"
#include "daemon/tool/import_carmen.hpp"
#include "tests/support/scripted_drive.hpp"
#include "tests/support/scripted_port.hpp"
#include "tests/support/temporary_folder.hpp"

namespace deltamap::daemon {
namespace {

namespace fs = std::filesystem;

constexpr double kDrive_s = 45.0;

std::string content_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

std::size_t lines_of(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

std::string first_difference(const std::string& one, const std::string& other) {
  if (one == other) return "";
  const auto differ = std::mismatch(one.begin(), one.end(), other.begin(), other.end());
  const auto at = static_cast<std::size_t>(differ.first - one.begin());
  const std::size_t line = one.rfind('\n', at == 0 ? 0 : at - 1) + 1;
  return "line " + std::to_string(lines_of(one.substr(0, at)) + 1) + ": " + one.substr(line, 100) + " | " +
         (line < other.size() ? other.substr(line, 100) : "");
}

class PipelineTest : public testing::Test {
 protected:
  PipelineTest() {
    test::write_drive(folder_.path() / "drive.log", kDrive_s);
    (void)tool::import_carmen(folder_.path() / "drive.log", folder_.path() / "drive.pcapng", std::nullopt);
    write_grid(test::small_room(false), folder_.path() / "room.yaml");
    const Pose2 start = test::pose_on_drive(0.0);
    settings_.initial_pose = start;
    settings_.localizer.particles.min = 200;
    settings_.localizer.particles.max = 200;
    settings_.recording.file = folder_.path() / "live.pcapng";
  }

  RunReport run_live(std::chrono::microseconds pause) {
    test::ScriptedPorts ports{folder_.path() / "drive.pcapng", pause};
    auto played = ports.played();
    fs::create_directories(folder_.path() / "live");
    Pipeline::Options options;
    options.start.map = std::make_shared<const OccupancyGrid>(read_grid(folder_.path() / "room.yaml"));
    options.out = folder_.path() / "live";
    options.mode = drivers::SessionMode::kListenOnly;
    options.open = [&ports](boost::asio::io_context& loop, drivers::port::PortId id, unsigned) {
      return ports.open(loop, id);
    };
    options.log = [](const std::string&) {};
    options.failed = [](const std::string& why) { FAIL() << why; };
    Pipeline pipeline{settings_, std::move(options)};
    EXPECT_EQ(played.wait_for(std::chrono::seconds(200)), std::future_status::ready);
    return pipeline.stop();
  }

  RunReport replay(const std::string& recording, const std::string& out) {
    ReplayJob job;
    job.recording = folder_.path() / recording;
    job.map = folder_.path() / "room.yaml";
    job.settings = settings_;
    job.out = folder_.path() / out;
    return run_replay(job, [](double) { return true; });
  }

  void expect_same_files(const std::string& one, const std::string& other) {
    for (const char* name : {"trajectory.tum", "changes.jsonl", "map.pgm", "map.yaml"}) {
      const std::string content = content_of(folder_.path() / one / name);
      EXPECT_EQ(first_difference(content, content_of(folder_.path() / other / name)), "") << name;
      EXPECT_TRUE(std::string(name) == "changes.jsonl" || !content.empty()) << name;
    }
  }

  test::TemporaryFolder folder_;
  Settings settings_;
};

TEST_F(PipelineTest, AnUnhurriedLiveRunAndItsReplayGiveTheSameBytes) {
  const RunReport live = run_live(std::chrono::microseconds(2000));
  EXPECT_EQ(live.scans.lost + live.scans.odometry_lost + live.scans.recording_lost, 0u);
  EXPECT_GT(live.scans.localized, 300u);
  EXPECT_EQ(live.time_lost_s, 0.0);
  const auto accepted = std::count_if(live.changes.begin(), live.changes.end(),
                                      [](const ChangeNote& c) { return c.revision.has_value(); });
  EXPECT_GE(accepted, 1) << "the box must have become map";

  const RunReport again = replay("live.pcapng", "replayed");
  EXPECT_EQ(again.journal, "obeyed");
  EXPECT_EQ(again.journal_differences, 0u);
  expect_same_files("live", "replayed");
  EXPECT_EQ(lines_of(content_of(folder_.path() / "live/trajectory.tum")), live.scans.decoded);
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

TEST_F(PipelineTest, AnIoThreadThatHangsShowsInTheLongestWork) {
  std::promise<void> comes_back;
  Pipeline::Options options;
  options.start.map = std::make_shared<const OccupancyGrid>(read_grid(folder_.path() / "room.yaml"));
  options.open = [hangs = comes_back.get_future().share()](boost::asio::io_context&, drivers::port::PortId, unsigned) {
    hangs.wait();
    return drivers::port::SerialPortAnswer{nullptr, "is missing"};
  };
  options.log = [](const std::string&) {};
  options.failed = [](const std::string& why) { FAIL() << why; };
  Pipeline pipeline{settings_, std::move(options)};
  const auto give_up_at = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  double longest_s = 0.0;
  while (longest_s <= 0.01 && std::chrono::steady_clock::now() < give_up_at) longest_s = pipeline.longest_work_s();
  comes_back.set_value();
  EXPECT_GT(longest_s, 0.01);
  while (longest_s > 0.0 && std::chrono::steady_clock::now() < give_up_at) longest_s = pipeline.longest_work_s();
  EXPECT_EQ(longest_s, 0.0);
  (void)pipeline.stop();
}

TEST_F(PipelineTest, AReportThatCannotBeWrittenIsAnErrorAndNoCrash) {
  fs::create_directories(folder_.path() / "live");
  fs::create_symlink("/dev/full", folder_.path() / "live/report.json");
  EXPECT_THROW((void)run_live(std::chrono::microseconds(0)), std::runtime_error);
}

TEST_F(PipelineTest, AJournalOfOtherSettingsIsNotObeyed) {
  (void)run_live(std::chrono::microseconds(0));
  settings_.seed = 2;
  const RunReport again = replay("live.pcapng", "replayed");
  EXPECT_EQ(again.journal, "not obeyed: other settings or map");
  EXPECT_EQ(again.scans.dropped, 0u);
}

}  // namespace
}  // namespace deltamap::daemon
