// SPDX-License-Identifier: Apache-2.0
#include "daemon/kept_drive.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/temporary_folder.hpp"

namespace deltamap::daemon {
namespace {

using drivers::pioneer::DriveSwitch;

class KeptDriveTest : public testing::Test {
 protected:
  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "store.drive.json";
};

TEST_F(KeptDriveTest, IsUnknownAtTheFirstStartAndWithoutAPlace) {
  EXPECT_EQ(KeptDrive{file_}.value(), DriveSwitch::kUnknown);
  EXPECT_EQ(KeptDrive{file_}.why_unknown(), "");
  KeptDrive nowhere{{}};
  EXPECT_EQ(nowhere.keep(DriveSwitch::kOn), "");
  EXPECT_EQ(nowhere.value(), DriveSwitch::kOn) << "for this run";
}

TEST_F(KeptDriveTest, IsOnDiskAsSoonAsItChanges) {
  KeptDrive kept{file_};
  for (const auto value : {DriveSwitch::kOn, DriveSwitch::kOffAtRobot, DriveSwitch::kOffByOperator}) {
    EXPECT_EQ(kept.keep(value), "");
    EXPECT_EQ(KeptDrive{file_}.value(), value);
  }
}

TEST_F(KeptDriveTest, ADamagedFileIsUnknownAndSaysSo) {
  for (const char* text : {"", "on", "{\"drive\":1}", "{\"drive\":\"perhaps\"}", "[\"on\"]", "{\"drive\":\"on\""}) {
    std::ofstream(file_) << text;
    const KeptDrive kept{file_};
    EXPECT_EQ(kept.value(), DriveSwitch::kUnknown) << text;
    EXPECT_NE(kept.why_unknown().find("store.drive.json"), std::string::npos) << text;
  }
}

TEST_F(KeptDriveTest, AnOffThatCannotBeWrittenTakesTheOldOnFromTheDisk) {
  KeptDrive kept{file_};
  ASSERT_EQ(kept.keep(DriveSwitch::kOn), "");
  // The draft of a file that is replaced cannot be made: a folder stands in its place.
  std::filesystem::create_directories(file_.string() + ".part/in the way");
  const std::string line = kept.keep(DriveSwitch::kOffAtRobot);
  EXPECT_NE(line, "");
  EXPECT_EQ(KeptDrive{file_}.value(), DriveSwitch::kUnknown);
}

}  // namespace
}  // namespace deltamap::daemon
