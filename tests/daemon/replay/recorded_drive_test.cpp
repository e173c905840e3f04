// SPDX-License-Identifier: Apache-2.0
// A recording read once gives what `deltamap replay` gives, byte for byte, however many replay it at a time.
#include "daemon/replay/recorded_drive.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "core/files/grid_file.hpp"
#include "tests/support/files/temporary_folder.hpp"
#include "tests/support/files/text_file.hpp"
#include "tests/support/scans/scripted_drive.hpp"
#include "tool/import_carmen.hpp"

namespace deltamap::daemon {
namespace {

namespace fs = std::filesystem;

using test::content_of;

class RecordedDriveTest : public testing::Test {
 protected:
  RecordedDriveTest() {
    test::write_drive(folder_.path() / "drive.log", 30.0);
    (void)tool::import_carmen(folder_.path() / "drive.log", folder_.path() / "drive.pcapng", std::nullopt);
    write_grid(test::small_room(false), folder_.path() / "room.yaml");
  }

  [[nodiscard]] ReplayJob job(std::uint64_t seed) const {
    ReplayJob job;
    job.recording = folder_.path() / "drive.pcapng";
    job.map = folder_.path() / "room.yaml";
    job.settings.initial_pose = test::pose_on_drive(0.0);
    job.settings.seed = seed;
    job.out = folder_.path() / ("whole" + std::to_string(seed));
    return job;
  }

  test::TemporaryFolder folder_;
};

bool go_on(double) { return true; }

TEST_F(RecordedDriveTest, GivesTheFilesOfAReplayForEachSeedWhileOthersGoOn) {
  const RecordedDrive drive = recorded_drive(job(1));
  const FirstMap map = first_map(std::make_shared<const OccupancyGrid>(read_grid(folder_.path() / "room.yaml")));
  const std::vector<std::uint64_t> seeds{1, 2, 3};
  {
    std::vector<std::jthread> threads;
    for (const std::uint64_t seed : seeds) {
      threads.emplace_back([&, seed] {
        const fs::path out = folder_.path() / ("again" + std::to_string(seed));
        fs::create_directories(out);
        FolderOutput output{out, *map.grid, 0};
        const RunReport report = replay_again(job(seed), drive, map, output, go_on);
        EXPECT_EQ(report.scans.decoded, drive.scans);
        EXPECT_GT(report.cpu_total_s, 0.0);
      });
    }
  }
  for (const std::uint64_t seed : seeds) {
    (void)run_replay(job(seed), go_on);
    const fs::path again = folder_.path() / ("again" + std::to_string(seed));
    for (const char* name : {"trajectory.tum", "localization.csv", "changes.jsonl", "map.pgm", "map.yaml"})
      EXPECT_EQ(content_of(again / name), content_of(job(seed).out / name)) << seed << " " << name;
  }
  EXPECT_NE(content_of(job(1).out / "localization.csv"), content_of(job(2).out / "localization.csv"));
  EXPECT_NE(content_of(job(1).out / "changes.jsonl"), "") << "the box";
}

TEST_F(RecordedDriveTest, IsDecodedAnewOnlyForOtherSettingsOfTheDevices) {
  Settings settings = job(1).settings;
  const std::string as_given = decoding_settings(settings);
  settings.seed = 7;
  settings.localizer.beams = 33;
  EXPECT_EQ(decoding_settings(settings), as_given);
  settings.laser.session.robot_from_laser.x = 0.25;
  EXPECT_NE(decoding_settings(settings), as_given);
}

TEST_F(RecordedDriveTest, WithoutAScanIsRefusedAsAReplayIs) {
  ReplayJob late = job(1);
  late.from_s = 1000.0;
  EXPECT_THROW((void)recorded_drive(late), std::runtime_error);
}

TEST_F(RecordedDriveTest, EndsWhereAPersonEndsIt) {
  const RecordedDrive drive = recorded_drive(job(1));
  const FirstMap map = first_map(std::make_shared<const OccupancyGrid>(test::small_room(false)));
  fs::create_directories(folder_.path() / "cut");
  FolderOutput output{folder_.path() / "cut", *map.grid, 0};
  const auto stop = [](double) { return false; };
  EXPECT_THROW((void)replay_again(job(1), drive, map, output, stop), std::runtime_error);
}

}  // namespace
}  // namespace deltamap::daemon
