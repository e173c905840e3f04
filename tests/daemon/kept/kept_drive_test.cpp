// SPDX-License-Identifier: Apache-2.0
#include "daemon/kept/kept_drive.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <set>

#include "tests/support/files/temporary_folder.hpp"

namespace deltamap::daemon {
namespace {

namespace fs = std::filesystem;
using drivers::pioneer::DriveSwitch;
using navigation::StopReason;
using namespace std::chrono_literals;

constexpr Timestamp kNow = timestamp_from_ns(1'700'000'000'000'000'000);

/// In which nothing can be written, replaced or removed, by root neither: it goes by another name meanwhile.
class ReadOnlyFolder {
 public:
  explicit ReadOnlyFolder(fs::path folder) : folder_{std::move(folder)} {
    fs::permissions(folder_, fs::perms{0555});
    if (was_root_) become(65534);
  }
  ~ReadOnlyFolder() {
    if (was_root_) become(0);
    fs::permissions(folder_, fs::perms{0700});
  }
  ReadOnlyFolder(const ReadOnlyFolder&) = delete;
  ReadOnlyFolder& operator=(const ReadOnlyFolder&) = delete;

 private:
  static void become(uid_t user) { EXPECT_EQ(::seteuid(user), 0); }

  fs::path folder_;
  bool was_root_ = ::geteuid() == 0;
};

class KeptDriveTest : public testing::Test {
 protected:
  [[nodiscard]] DriveSwitch on_disk() const { return read_kept_drive(place_).value; }

  test::TemporaryFolder folder_;
  DrivePlace place_ = drive_place(folder_.path() / "hall.sqlite", "/dev/ttyUSB0");
};

TEST_F(KeptDriveTest, IsUnknownAtTheFirstStartAndWithoutAPlace) {
  EXPECT_EQ(KeptDrive{place_}.value(), DriveSwitch::kUnknown);
  EXPECT_EQ(KeptDrive{place_}.why_unknown(), "");
  EXPECT_TRUE(drive_place("", "/dev/ttyUSB0").file.empty());
  KeptDrive nowhere{{}};
  EXPECT_EQ(nowhere.keep(DriveSwitch::kOn, kNow), "");
  EXPECT_EQ(nowhere.value(), DriveSwitch::kOn) << "for this run";
  EXPECT_EQ(nowhere.why_not_kept(), "");
  EXPECT_EQ(KeptDrive{{}}.value(), DriveSwitch::kUnknown);
}

TEST_F(KeptDriveTest, IsOnDiskAsSoonAsItChanges) {
  KeptDrive kept{place_};
  for (const auto value : {DriveSwitch::kOn, DriveSwitch::kOffAtRobot, DriveSwitch::kOffByOperator}) {
    EXPECT_EQ(kept.keep(value, kNow), "");
    EXPECT_EQ(kept.why_not_kept(), "");
    EXPECT_EQ(KeptDrive{place_}.value(), value);
  }
}

TEST_F(KeptDriveTest, ADamagedFileIsUnknownAndSaysSo) {
  for (const char* text :
       {"", "on", "{\"drive\":1}", "{\"drive\":\"perhaps\",\"robot_port\":\"/dev/ttyUSB0\"}", "[\"on\"]",
        "{\"drive\":\"on\"", "{\"drive\":\"on\"}", "{\"drive\":\"on\",\"robot_port\":1}"}) {
    std::ofstream(place_.file) << text;
    const KeptDrive kept{place_};
    EXPECT_EQ(kept.value(), DriveSwitch::kUnknown) << text;
    EXPECT_NE(kept.why_unknown().find("ttyUSB0.drive.json"), std::string::npos) << text;
  }
}

// --- whose it is ---

TEST_F(KeptDriveTest, ARobotHasOneSwitchForAllMapsInAFolder) {
  EXPECT_EQ(KeptDrive{drive_place(folder_.path() / "east.sqlite", "/dev/ttyUSB0")}.keep(DriveSwitch::kOn, kNow), "");
  KeptDrive west{drive_place(folder_.path() / "west.sqlite", "/dev/../dev//ttyUSB0")};
  EXPECT_EQ(west.value(), DriveSwitch::kOn);
  EXPECT_EQ(west.keep(DriveSwitch::kOffByOperator, kNow), "");
  const KeptDrive east{drive_place(folder_.path() / "east.sqlite", "/dev/ttyUSB0")};
  EXPECT_EQ(east.value(), DriveSwitch::kOffByOperator);
}

TEST_F(KeptDriveTest, TwoRobotsNeverShareASwitch) {
  const char* ports[] = {"/dev/ttyUSB0",
                         "/dev/ttyUSB1",
                         "/dev/serial/by-path/x",
                         "/dev/x",
                         "ttyUSB0",
                         "/tmp/ttyUSB0",
                         "/dev/serial/by-path+x",
                         "/dev/serial+by-path/x",
                         "/ttyUSB0",
                         "/dev/a%2Bb",
                         "/dev/a+b",
                         "/dev/a/b",
                         "/dev/a-b",
                         "/dev/dev/a/b"};
  std::set<fs::path> files;
  for (const char* port : ports) {
    // Stores whose names differ in their extension alone.
    const fs::path file = drive_place(folder_.path() / "hall.1", port).file;
    EXPECT_EQ(file, drive_place(folder_.path() / "hall.2", port).file);
    EXPECT_EQ(file.parent_path(), folder_.path());
    EXPECT_TRUE(files.insert(file).second) << file;
  }
  EXPECT_EQ(drive_place("a/b.sqlite", "/dev/deltamap/robot").file, "a/deltamap+robot.drive.json");
}

TEST_F(KeptDriveTest, AFileOfAnotherRobotIsUnknownAndSaysSo) {
  DrivePlace other{place_.file, "/dev/ttyUSB1"};
  EXPECT_EQ(KeptDrive{other}.keep(DriveSwitch::kOn, kNow), "");
  const KeptDrive kept{place_};
  EXPECT_EQ(kept.value(), DriveSwitch::kUnknown);
  EXPECT_NE(kept.why_unknown().find("is of the robot at /dev/ttyUSB1"), std::string::npos) << kept.why_unknown();
}

// --- a disk that does not take it ---

TEST_F(KeptDriveTest, AnOffThatCannotBeWrittenIsToldAndTriedAgainEverySecond) {
  KeptDrive kept{place_};
  ASSERT_EQ(kept.keep(DriveSwitch::kOn, kNow), "");
  {
    const ReadOnlyFolder read_only{folder_.path()};
    EXPECT_NE(kept.keep(DriveSwitch::kOffByOperator, kNow).find("drive: not kept: "), std::string::npos);
    EXPECT_NE(kept.why_not_kept().find("cannot be written"), std::string::npos) << kept.why_not_kept();
    EXPECT_EQ(kept.value(), DriveSwitch::kOn) << "as the disk has it";
    EXPECT_EQ(kept.keep(DriveSwitch::kOffByOperator, kNow + 1s), "") << "told once";
    EXPECT_NE(kept.why_not_kept(), "");
  }
  EXPECT_EQ(kept.keep(DriveSwitch::kOffByOperator, kNow + 1900ms), "");
  EXPECT_EQ(on_disk(), DriveSwitch::kOn) << "less than a second after the try before";
  EXPECT_EQ(kept.keep(DriveSwitch::kOffByOperator, kNow + 2s), "drive: kept now: off by the operator");
  EXPECT_EQ(on_disk(), DriveSwitch::kOffByOperator);
  EXPECT_EQ(kept.why_not_kept(), "");
}

TEST_F(KeptDriveTest, ASwitchThatChangesIsWrittenAtOnceThoughTheOneBeforeFailed) {
  KeptDrive kept{place_};
  {
    const ReadOnlyFolder read_only{folder_.path()};
    EXPECT_NE(kept.keep(DriveSwitch::kOn, kNow), "");
  }
  EXPECT_EQ(kept.keep(DriveSwitch::kOffAtRobot, kNow + 1ms), "drive: kept now: off at the robot");
  EXPECT_EQ(on_disk(), DriveSwitch::kOffAtRobot);
}

TEST_F(KeptDriveTest, AnOnThatCannotBeWrittenAnewAtTheStartIsUnknown) {
  ASSERT_EQ(KeptDrive{place_}.keep(DriveSwitch::kOn, kNow), "");
  std::optional<KeptDrive> kept;
  {
    const ReadOnlyFolder read_only{folder_.path()};
    ASSERT_EQ(on_disk(), DriveSwitch::kOn);
    kept.emplace(place_);
    EXPECT_EQ(kept->value(), DriveSwitch::kUnknown);
    EXPECT_NE(kept->why_unknown().find("ttyUSB0.drive.json: cannot be written"), std::string::npos)
        << kept->why_unknown();
    EXPECT_NE(kept->keep(DriveSwitch::kUnknown, kNow), "") << "the old on is still there";
  }
  EXPECT_EQ(kept->keep(DriveSwitch::kUnknown, kNow + 1s), "drive: kept now: unknown");
  EXPECT_EQ(KeptDrive{place_}.value(), DriveSwitch::kUnknown);
}

TEST_F(KeptDriveTest, AnOffThatCannotBeWrittenTakesTheOldOnFromTheDisk) {
  KeptDrive kept{place_};
  ASSERT_EQ(kept.keep(DriveSwitch::kOn, kNow), "");
  // The draft of a file that is replaced cannot be made: a folder stands in its place.
  const fs::path in_the_way = place_.file.string() + ".part";
  fs::create_directories(in_the_way / "something");
  const std::string line = kept.keep(DriveSwitch::kOffAtRobot, kNow);
  EXPECT_NE(line.find("removed, so that the next run does not drive"), std::string::npos) << line;
  EXPECT_NE(kept.why_not_kept(), "");
  EXPECT_EQ(on_disk(), DriveSwitch::kUnknown);
  fs::remove_all(in_the_way);
  EXPECT_EQ(kept.keep(DriveSwitch::kOffAtRobot, kNow + 1s), "drive: kept now: off at the robot");
  EXPECT_EQ(on_disk(), DriveSwitch::kOffAtRobot);
}

// --- stops that wait for a person ---

TEST(SwitchToKeep, IsOffAtTheRobotWhileAStopWaitsForAPerson) {
  for (const auto value :
       {DriveSwitch::kUnknown, DriveSwitch::kOn, DriveSwitch::kOffAtRobot, DriveSwitch::kOffByOperator}) {
    EXPECT_EQ(switch_to_keep(value, StopReason::kNone), value);
    EXPECT_EQ(switch_to_keep(value, StopReason::kBumper), value == DriveSwitch::kOn ? DriveSwitch::kOffAtRobot : value);
  }
}

}  // namespace
}  // namespace deltamap::daemon
