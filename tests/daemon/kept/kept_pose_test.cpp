// SPDX-License-Identifier: Apache-2.0
#include "daemon/kept/kept_pose.hpp"

#include <gtest/gtest.h>

#include "core/files/grid_file.hpp"
#include "daemon/kept/memory_keeper.hpp"
#include "daemon/settings/memory_places.hpp"
#include "tests/support/files/temporary_folder.hpp"

namespace deltamap::daemon {
namespace {

KeptPose some_pose() {
  KeptPose pose;
  pose.first_map = 0xFEDCBA9876543210u;
  pose.revision = 7;
  pose.time = timestamp_from_ns(1'700'000'000'123'456'789);
  pose.map_from_robot = {-1.0 / 3.0, 2.0 / 7.0, 1.0 / 11.0};
  pose.is_sure = true;
  return pose;
}

/// Why the pose in this text is not used; without the folder.
std::string refusal(const test::TemporaryFolder& folder, const std::string& text) {
  const auto file = folder.write("store.pose.json", text);
  const KeptPoseAnswer answer = read_kept_pose(file, some_pose().first_map);
  EXPECT_FALSE(answer.pose) << text;
  EXPECT_EQ(answer.fingerprint, 0u);
  const std::string name = file.string() + ": ";
  EXPECT_TRUE(answer.why_not.starts_with(name)) << answer.why_not;
  return answer.why_not.substr(name.size());
}

TEST(KeptPose, ComesBackBitForBit) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("store.pose.json", json_text(some_pose()));
  const KeptPoseAnswer answer = read_kept_pose(file, some_pose().first_map);
  ASSERT_TRUE(answer.pose) << answer.why_not;
  EXPECT_EQ(answer.pose->map_from_robot, some_pose().map_from_robot);
  EXPECT_EQ(answer.pose->revision, 7u);
  EXPECT_EQ(answer.pose->time, some_pose().time);
  EXPECT_NE(answer.fingerprint, 0u);
}

TEST(KeptPose, WheelsAndMountComeBackThoughThePoseIsOfNoUse) {
  const test::TemporaryFolder folder;
  KeptPose lost = some_pose();
  lost.is_sure = false;
  lost.calibration = localization::motion::DriveCalibration{
      {1.0 / 7.0, -0.02, 1e-9, 0.1}, {0.01, 0.02, 0.03, 0.04}, {0.01, -0.01, 1.0 / 300.0}, {0.001, 0.002, 0.003}};
  const auto file = folder.write("store.pose.json", json_text(lost));
  const KeptPoseAnswer answer = read_kept_pose(file, 1);
  EXPECT_FALSE(answer.pose);
  ASSERT_TRUE(answer.calibration);
  EXPECT_EQ(numbers_of(*answer.calibration), numbers_of(*lost.calibration));
  EXPECT_NE(answer.fingerprint, 0u) << "the run begins from it";
}

TEST(KeptPose, WithoutAFileThereIsNothingToSay) {
  const test::TemporaryFolder folder;
  const KeptPoseAnswer answer = read_kept_pose(folder.path() / "store.pose.json", 1);
  EXPECT_FALSE(answer.pose);
  EXPECT_EQ(answer.why_not, "");
}

TEST(KeptPose, EveryCutAndEveryForeignFileIsRefused) {
  const test::TemporaryFolder folder;
  const std::string whole = json_text(some_pose());
  for (std::size_t length = 0; length + 1 < whole.size(); ++length) {
    EXPECT_EQ(refusal(folder, whole.substr(0, length)), "holds no pose");
  }
  EXPECT_EQ(refusal(folder, "hello"), "holds no pose");
  EXPECT_EQ(refusal(folder, std::string(100'000, '[')), "holds no pose");
  EXPECT_EQ(refusal(folder, R"({"map":"fedcba9876543210","sure":true,"x_m":"1"})"), "holds no pose");
}

TEST(KeptPose, APoseInAnotherMapOrOfALostRobotIsNotUsed) {
  const test::TemporaryFolder folder;
  KeptPose other = some_pose();
  other.first_map = 1;
  EXPECT_EQ(refusal(folder, json_text(other)), "the pose belongs to another map");
  KeptPose lost = some_pose();
  lost.is_sure = false;
  EXPECT_EQ(refusal(folder, json_text(lost)), "the robot did not know where it was");
}

Timestamp at_s(double time_s) { return some_pose().time + duration_from_seconds(time_s); }

TEST(MemoryKeeper, KeepsThePoseBesideTheStore) {
  const test::TemporaryFolder folder;
  std::vector<std::string> warnings;
  OutputBoard board;
  MemoryKeeper keeper{memory_places(folder.path() / "map_store.sqlite"), board,
                      [&](const std::string& line) { warnings.push_back(line); }};
  keeper.keep(some_pose(), at_s(0));
  EXPECT_TRUE(read_kept_pose(folder.path() / "map_store.pose.json", some_pose().first_map).pose);
  EXPECT_TRUE(warnings.empty());
}

TEST(MemoryKeeper, AFullDiskIsToldOnceAndTheNewestPoseIsKeptWhenThereIsRoom) {
  const test::TemporaryFolder folder;
  std::vector<std::string> warnings;
  OutputBoard board;
  MemoryKeeper keeper{memory_places(folder.path() / "later/map_store.sqlite"), board,
                      [&](const std::string& line) { warnings.push_back(line); }};
  KeptPose newest = some_pose();
  newest.revision = 8;
  keeper.keep(some_pose(), at_s(0));
  keeper.keep(newest, at_s(5));
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(warnings[0].starts_with("saving pauses: pose: ")) << warnings[0];
  EXPECT_FALSE(board.all()[0].written);
  std::filesystem::create_directory(folder.path() / "later");
  keeper.retry(at_s(8));
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_TRUE(warnings[1].starts_with("saving goes on: pose after 8 s: ")) << warnings[1];
  EXPECT_EQ(read_kept_pose(folder.path() / "later/map_store.pose.json", some_pose().first_map).pose->revision, 8u);
}

TEST(MemoryKeeper, SavesMapAndPoseAndSaysWhere) {
  const test::TemporaryFolder folder;
  OutputBoard board;
  MemoryKeeper keeper{memory_places(folder.path() / "map_store.sqlite"), board, [](const std::string&) {}};
  const auto map = std::make_shared<const OccupancyGrid>(GridGeometry{4, 3, 0.05, {0.0, 0.0}}, CellState::kFree);
  const control::CommandOutcome outcome = keeper.save({5, some_pose(), map});
  EXPECT_TRUE(outcome.done) << outcome.message;
  EXPECT_EQ(outcome.ticket, 5u);
  const auto saved = folder.path() / "map_store.saved.yaml";
  EXPECT_NE(outcome.message.find(saved.string()), std::string::npos) << outcome.message;
  EXPECT_EQ(read_grid(saved), *map);
  EXPECT_TRUE(read_kept_pose(folder.path() / "map_store.pose.json", some_pose().first_map).pose);

  MemoryKeeper nowhere{memory_places(""), board, [](const std::string&) {}};
  EXPECT_FALSE(nowhere.save({6, some_pose(), map}).done);
}

}  // namespace
}  // namespace deltamap::daemon
