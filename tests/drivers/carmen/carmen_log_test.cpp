// SPDX-License-Identifier: Apache-2.0
#include "drivers/carmen/carmen_log.hpp"

#include <gtest/gtest.h>

#include "tests/support/files/temporary_folder.hpp"

namespace deltamap::drivers::carmen {
namespace {

const std::string kOdometry = "ODOM 1.5 -2 4.0 0.25 -0.5 0 1376.000000250 host 3.5\n";
const std::string kFlaser = "FLASER 3 1.07 81.83 0.5 1 2 0.5 0.75 2 0.5 976055546.374470 nohost 2690.3\n";
const std::string kRobotLaser =
    "ROBOTLASER1 0 -1.25 2.5 1.25 5.6 0.01 0 3 0.1 5.6 nan 2 7 8 1 2 3 4 5 6 0.3 0.1 0.5 0.5 100 12.5 host 0.1\n";
const std::string kRawLaser =
    "RAWLASER1 0 -1.570796 3.141593 1.570796 16.38 0.001 0 3 0.205 16.383 8 0 1497524441.655 h 1\n";

std::vector<CarmenRecord> records(const std::filesystem::path& file) {
  CarmenLog log{file};
  std::vector<CarmenRecord> all;
  while (auto record = log.next()) all.push_back(std::move(*record));
  return all;
}

std::string refusal(const std::filesystem::path& file) {
  try {
    (void)records(file);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(CarmenLog, ReadsEveryKindOfLineAndSkipsOthers) {
  const test::TemporaryFolder folder;
  const auto all =
      records(folder.write("a.log", "# words\nPARAM x y\n" + kOdometry + "\n" + kFlaser + kRobotLaser + kRawLaser));
  ASSERT_EQ(all.size(), 4u);
  const auto& odometry = std::get<CarmenOdometry>(all[0]);
  EXPECT_EQ(odometry.line, 3u);
  EXPECT_EQ(unix_ns(odometry.time), 1376000000250);
  EXPECT_EQ(odometry.odom_from_robot, (Pose2{1.5, -2.0, wrapped_angle(4.0)}));
  EXPECT_EQ(odometry.speed_m_per_s, 0.25);
  const auto& flaser = std::get<CarmenScan>(all[1]);
  EXPECT_EQ(unix_ns(flaser.time), 976055546374470000);
  EXPECT_EQ(flaser.ranges_m, (std::vector<double>{1.07, 81.83, 0.5}));
  EXPECT_EQ(flaser.poses->odom_from_laser, (Pose2{1, 2, 0.5}));
  EXPECT_EQ(flaser.poses->odom_from_robot, (Pose2{0.75, 2, 0.5}));
  EXPECT_FALSE(flaser.stated_max_range_m);
  const auto& robotlaser = std::get<CarmenScan>(all[2]);
  EXPECT_EQ(robotlaser.ranges_m, (std::vector<double>{0.1, 5.6, 0.0}));
  EXPECT_EQ(robotlaser.stated_max_range_m, 5.6);
  EXPECT_EQ(robotlaser.first_bearing_rad, -1.25);
  EXPECT_EQ(robotlaser.poses->odom_from_robot, (Pose2{4, 5, wrapped_angle(6)}));
  EXPECT_EQ(unix_ns(robotlaser.times.stamp.value()), 12500000000);
  const auto& raw = std::get<CarmenScan>(all[3]);
  EXPECT_FALSE(raw.poses);
  EXPECT_EQ(unix_ns(raw.times.stamp.value()), 1497524441655000000);
}

TEST(CarmenLog, TakesTheBearingsOfFlaserFromTheNumberOfItsValues) {
  const test::TemporaryFolder folder;
  const auto step_deg = [&](int count) {
    std::string line = "FLASER " + std::to_string(count);
    for (int i = 0; i < count; ++i) line += " 1";
    const auto all = records(folder.write("n.log", line + " 0 0 0 0 0 0 1 h 1\n"));
    const auto& scan = std::get<CarmenScan>(all[0]);
    EXPECT_NEAR(degrees(scan.first_bearing_rad), count == 401 ? -50.0 : -90.0, 1e-12);
    return degrees(scan.bearing_step_rad);
  };
  EXPECT_NEAR(step_deg(180), 1.0, 1e-12);
  EXPECT_NEAR(step_deg(181), 1.0, 1e-12);
  EXPECT_NEAR(step_deg(360), 0.5, 1e-12);
  EXPECT_NEAR(step_deg(361), 0.5, 1e-12);
  EXPECT_NEAR(step_deg(401), 0.25, 1e-12);
  EXPECT_NEAR(step_deg(91), 2.0, 1e-12);
}

TEST(CarmenLog, ReadsALogThatWasCutUpToTheCutAndSaysWhere) {
  const test::TemporaryFolder folder;
  for (const std::string& tail : {std::string(), std::string(3000, '\0'), std::string("\xFF\xFE\n\x01 FLA\n\0", 10)}) {
    for (std::size_t kept = 7; kept < kFlaser.find(" 2690.3"); ++kept) {
      CarmenLog log{folder.write("cut.log", kOdometry + kFlaser + kFlaser.substr(0, kept) + tail)};
      EXPECT_TRUE(log.next() && log.next()) << kept;
      EXPECT_FALSE(log.next()) << kept;
      EXPECT_FALSE(log.next()) << kept;
      ASSERT_TRUE(log.cut()) << kept;
      EXPECT_NE(log.cut()->find("cut.log:3: "), std::string::npos) << *log.cut();
      EXPECT_NE(log.cut()->find("; the log ends there, the 2 scans and poses before it are used"), std::string::npos);
    }
  }
  CarmenLog whole{folder.write("whole.log", kOdometry + kFlaser.substr(0, kFlaser.size() - 1))};
  EXPECT_TRUE(whole.next() && whole.next());
  EXPECT_FALSE(whole.next() || whole.cut()) << "a last line may lack its line feed";
}

TEST(CarmenLog, LeavesOutABrokenLineThatOthersFollowAndNamesIt) {
  const test::TemporaryFolder folder;
  for (std::size_t kept = 7; kept < kFlaser.find(" 2690.3"); ++kept) {
    CarmenLog log{folder.write("cut.log", kOdometry + kFlaser + kFlaser.substr(0, kept) + "\n" + kFlaser)};
    EXPECT_TRUE(log.next() && log.next() && log.next()) << kept;
    EXPECT_FALSE(log.next() || log.cut()) << kept;
    ASSERT_EQ(log.faults().broken_lines, 1u) << kept;
    EXPECT_NE(log.faults().broken.front().find("cut.log:3: "), std::string::npos) << kept;
  }
}

TEST(CarmenLog, RefusesALogOfBrokenLinesByTheFirst) {
  const test::TemporaryFolder folder;
  EXPECT_NE(refusal(folder.write("word.log", "FLASER 2 1 x 0 0 0 0 0 0 1 h 1\n"))
                .find("word.log:1: 'range' must be a number, not 'x'"),
            std::string::npos);
  EXPECT_NE(refusal(folder.write("many.log", "FLASER 99999999999 1\n")).find("many.log:1: 'number of ranges'"),
            std::string::npos);
  EXPECT_NE(refusal(folder.write("time.log", "ODOM 0 0 0 0 0 0 -3 h 1\n")).find("time.log:1: 'time stamp'"),
            std::string::npos);
  EXPECT_NE(refusal(folder.write("pose.log", "ODOM nan 0 0 0 0 0 3 h 1\n")).find("pose.log:1: 'pose' is not finite"),
            std::string::npos);
}

TEST(CarmenLog, ReadsTimesAsFarAsALineHasThem) {
  const test::TemporaryFolder folder;
  const std::string line = "FLASER 2 1 2 0 0 0 0 0 0";
  const auto times_of = [&](const std::string& end) {
    return std::get<CarmenScan>(records(folder.write("a.log", line + end + "\n")).at(0)).times;
  };
  EXPECT_EQ(times_of(" 1.13486e+09 host 9.283348").stamp, timestamp_from_ns(1'134'860'000'000'000'000));
  EXPECT_EQ(times_of(" 1.13486e+09 host 9.283348").logger, Duration{9'283'348'000});
  EXPECT_EQ(times_of(" 3e2").stamp, timestamp_from_ns(300'000'000'000));
  EXPECT_EQ(times_of(" nohost -0.5").logger, Duration{-500'000'000});
  EXPECT_FALSE(times_of(" nohost -0.5").stamp);
  EXPECT_FALSE(times_of("").stamp || times_of("").logger);
  const CarmenClock clock{true, timestamp_from_ns(5'000'000'000)};
  CarmenLog log{folder.write("b.log", line + " 1.13486e+09 host 2.5\n"), clock};
  EXPECT_EQ(std::get<CarmenScan>(log.next().value()).time, timestamp_from_ns(7'500'000'000));
}

TEST(CarmenLog, SaysPlainlyWhatAForeignFileIs) {
  const test::TemporaryFolder folder;
  EXPECT_NE(refusal(folder.path() / "none.log").find("none.log: No such file"), std::string::npos);
  EXPECT_NE(refusal(folder.path()).find("is a directory"), std::string::npos);
  EXPECT_NE(refusal(folder.write("empty.log", "")).find("empty.log: line 1: the file is empty"), std::string::npos);
  EXPECT_NE(refusal(folder.write("a.log.xz", std::string("\xFD"
                                                         "7zXZ\0\0",
                                                         7)))
                .find("a.log.xz: is xz-compressed; unpack it first"),
            std::string::npos);
  EXPECT_NE(refusal(folder.write("binary.log", std::string("ab\n\0\1", 5))).find("binary.log:2: not a CARMEN log"),
            std::string::npos);
  const std::string map = "####\n# a map\n####\nCARMENMAPFILEv020 \xb8";
  EXPECT_NE(refusal(folder.write("unpacked", map)).find("unpacked: is a CARMEN map, not a log"), std::string::npos);
  for (const char* name : {"site.map", "site.map.gz"}) {
    EXPECT_NE(refusal(folder.write(name, "\x1F\x8B\x08")).find(": is a CARMEN map, not a log"), std::string::npos);
  }
  EXPECT_NE(refusal(folder.write("a.log.gz", "\x1F\x8B\x08")).find("is gzip-compressed"), std::string::npos);
  EXPECT_NE(refusal(folder.write("drive.2d", "LaserOdometryLog\n#Created by ARNL.\nversion: 2\n"))
                .find("is a laser log of ARIA (.2d)"),
            std::string::npos);
  EXPECT_NE(refusal(folder.write("office.log", "2D-Map\nLineMinPos: 0 0\n")).find("is a map of ARIA"),
            std::string::npos);
  EXPECT_NE(refusal(folder.write("text.log", "hello\nworld\n")).find("text.log:2: not a CARMEN log"),
            std::string::npos);
}

}  // namespace
}  // namespace deltamap::drivers::carmen
