// SPDX-License-Identifier: Apache-2.0
// Imported logs read back through the drivers' own decoders.
#include "tool/import_carmen.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <sstream>

#include "daemon/records/recording_decoder.hpp"
#include "drivers/lms200/command.hpp"
#include "drivers/lms200/measurement.hpp"
#include "drivers/lms200/status.hpp"
#include "drivers/lms200/telegram.hpp"
#include "drivers/pioneer/config_packet.hpp"
#include "drivers/pioneer/extra_packets.hpp"
#include "drivers/pioneer/odometry.hpp"
#include "drivers/pioneer/packet.hpp"
#include "drivers/port/byte_log.hpp"
#include "tests/support/files/decoded_recording.hpp"
#include "tests/support/files/source_tree.hpp"
#include "tests/support/files/temporary_folder.hpp"
#include "tool/run_tool.hpp"

namespace deltamap::tool {
namespace {

namespace lms200 = drivers::lms200;
namespace pioneer = drivers::pioneer;
using test::Decoded;
using test::decoded;

constexpr double kTimeToleranceS = 1e-6;
constexpr double kHalfMillimetre = 0.0005 + 1e-9;
constexpr double kHalfHeadingUnit = std::numbers::pi / 4096.0 + 1e-9;

Decoded imported(const test::TemporaryFolder& folder, const std::string& log, std::optional<double> no_return_m = {}) {
  (void)import_carmen(folder.write("a.log", log), folder.path() / "a.pcapng", no_return_m);
  return decoded(folder.path() / "a.pcapng");
}

std::string flaser(const std::vector<std::string>& ranges, const std::string& robot, const std::string& time) {
  std::string line = "FLASER " + std::to_string(ranges.size());
  for (const auto& range : ranges) line += " " + range;
  return line + " 9 9 0.9 " + robot + " " + time + " host 0\n";
}

std::string fan(std::size_t count, const std::string& fill, const std::string& first, const std::string& robot,
                const std::string& time) {
  std::vector<std::string> ranges(count, fill);
  ranges[0] = first;
  return flaser(ranges, robot, time);
}

TEST(ImportCarmen, GivesBackTimesRangesAndRobotPosesOfTheLog) {
  const test::TemporaryFolder folder;
  const Decoded all = imported(folder, fan(180, "1.07", "2.50", "0.1234 -2 0.5", "976055546.374470") +
                                           fan(180, "1.08", "81.83", "0.2 -2.1 0.51", "976055546.454471"));
  ASSERT_EQ(all.scans.size(), 2u);
  EXPECT_NEAR(seconds(all.scans[0].time - timestamp_from_ns(976055546374470000)), 0.0, kTimeToleranceS);
  EXPECT_NEAR(seconds(all.scans[1].time - timestamp_from_ns(976055546454471000)), 0.0, kTimeToleranceS);
  ASSERT_EQ(all.scans[0].beams.size(), 181u);
  EXPECT_FLOAT_EQ(all.scans[0].beams[0].range_m, 2.5F);
  EXPECT_FLOAT_EQ(all.scans[0].beams[179].range_m, 1.07F);
  EXPECT_EQ(all.measurements[0].words[180], 0x1FFF);  // 180 values: the 181st is not valid
  EXPECT_EQ(all.scans[0].beams[180].kind, BeamKind::kNotValid);
  EXPECT_EQ(all.measurements[1].words[0], 0x1FF7);  // 81.83 m bit for bit
  EXPECT_EQ(all.scans[1].beams[0].kind, BeamKind::kBeyondMaximum);
  EXPECT_NEAR(degrees(all.scans[0].first_bearing_rad), -90.0, 1e-9);
  EXPECT_NEAR(degrees(all.scans[0].bearing_step_rad), 1.0, 1e-9);

  ASSERT_EQ(all.odometry.size(), 2u);  // 80 ms apart: nothing between
  EXPECT_NEAR(seconds(all.odometry[0].time - all.scans[0].time), 0.0, kTimeToleranceS);
  EXPECT_NEAR(seconds(all.odometry[1].time - all.scans[1].time), 0.0, kTimeToleranceS);
  EXPECT_NEAR(all.sip_poses[0].x, 0.123, 1e-9);
  EXPECT_NEAR(all.sip_poses[0].y, 32.768 - 2.0, 1e-9);  // 15 bits
  EXPECT_NEAR(all.sip_poses[0].theta, 0.5, kHalfHeadingUnit);
  EXPECT_EQ(all.odometry[1].epoch, all.odometry[0].epoch);
  EXPECT_NEAR(all.odometry[1].odom_from_robot.x - all.odometry[0].odom_from_robot.x, 0.2 - 0.1234, 2 * kHalfMillimetre);
  EXPECT_NEAR(all.odometry[1].odom_from_robot.y - all.odometry[0].odom_from_robot.y, -0.1, 2 * kHalfMillimetre);
  EXPECT_TRUE(all.odometry[0].motors_enabled);
}

/// As every replay reads it: neither session is told a baud but by the recording.
TEST(ImportCarmen, IsReplayedWithPosesAtTheTimesOfTheirScans) {
  const test::TemporaryFolder folder;
  std::string log;
  for (int i = 0; i < 5; ++i)
    log += fan(180, "1.07", "2.50", "0." + std::to_string(i) + " 0 0", "976055546." + std::to_string(i) + "74470");
  (void)imported(folder, log);
  drivers::port::ByteLogReader reader{folder.path() / "a.pcapng"};
  daemon::RecordingDecoder decoder{daemon::Settings{}};
  std::vector<Timestamp> poses;
  std::vector<Timestamp> scans;
  const daemon::RecordingDecoder::Sinks sinks{
      [&](Odometry&& odometry, std::uint32_t) { poses.push_back(odometry.time); },
      [&](Scan&& scan) { scans.push_back(scan.time); }};
  while (const auto record = reader.next()) decoder.feed(*record, sinks);
  ASSERT_EQ(scans.size(), 5u);
  ASSERT_EQ(poses.size(), 5u);
  for (std::size_t i = 0; i < scans.size(); ++i) EXPECT_NEAR(seconds(poses[i] - scans[i]), 0.0, kTimeToleranceS) << i;
}

TEST(ImportCarmen, BeginsWithTheRepliesOfALiveStart) {
  const test::TemporaryFolder folder;
  const Decoded all = imported(folder, fan(361, "1.07", "2.50", "0 0 0", "5.5"));
  EXPECT_EQ(all.greeting, (std::vector<std::string>{"SYNC2 p3dx-sh", "CONFIGpac p3dx-sh", "B1h 180/50", "F4h"}));
  EXPECT_EQ(all.measuring_mode, 0);
  EXPECT_EQ(all.scans.at(0).beams.size(), 361u);
}

TEST(ImportCarmen, FillsGapsOfMoreThanATenthOfASecondWithPosesInBetween) {
  const test::TemporaryFolder folder;
  const Decoded all =
      imported(folder, fan(180, "1.07", "2.50", "0 0 3.1", "100.0") + fan(180, "1.07", "2.50", "0.5 0 -3.1", "101.05"));
  ASSERT_EQ(all.odometry.size(), 12u);
  const double turn_rad = 2.0 * std::numbers::pi - 6.2;  // the short way round
  for (std::size_t i = 0; i < 12; ++i) {
    const double share = static_cast<double>(i) / 11.0;
    EXPECT_NEAR(seconds(all.odometry[i].time - timestamp_from_ns(100'000'000'000)), 1.05 * share, kTimeToleranceS);
    EXPECT_NEAR(all.sip_poses[i].x, 0.5 * share, kHalfMillimetre);
    EXPECT_NEAR(turn_between(3.1 + share * turn_rad, all.sip_poses[i].theta), 0.0, kHalfHeadingUnit);
    if (i == 0) continue;
    EXPECT_NEAR(std::abs(all.odometry[i].speed_m_per_s), 0.5 / 1.05, 0.001);
    EXPECT_NEAR(all.odometry[i].turn_rate_rad_per_s, turn_rad / 1.05, 0.006);
  }
  EXPECT_TRUE(std::is_sorted(all.stamps.begin(), all.stamps.end()));
}

TEST(ImportCarmen, ChoosesTheUnitByTheWholeLogAndRoundsToNearest) {
  const test::TemporaryFolder folder;
  const Decoded cm = imported(folder, fan(181, "4.35", "50", "0 0 0", "1") + fan(181, "0.29", "0.57", "0 0 0", "1.05"));
  EXPECT_EQ(cm.measurements[0].unit_code, 0);
  EXPECT_EQ(cm.measurements[0].words[1], 435);
  EXPECT_EQ(cm.measurements[1].words[1], 29);
  const Decoded mm = imported(folder, fan(181, "4.35", "1", "0 0 0", "1") + fan(181, "0.2906", "5", "0 0 0", "1.05"));
  EXPECT_EQ(mm.measurements[0].unit_code, 1);
  EXPECT_EQ(mm.measurements[0].words[1], 4350);
  EXPECT_EQ(mm.measurements[1].words[1], 291);
}

TEST(ImportCarmen, KeepsTheCodesOfEveryModeBitForBit) {
  const test::TemporaryFolder folder;
  struct Case {
    std::string range;
    std::uint16_t word;
    BeamKind kind;
    std::uint8_t mode;
  };
  for (const Case& c :
       {Case{"81.83", 0x1FF7, BeamKind::kBeyondMaximum, 0x00}, Case{"81.90", 0x1FFE, BeamKind::kDazzled, 0x00},
        Case{"81.91", 0x1FFF, BeamKind::kNotValid, 0x00}, Case{"8.187", 0x1FFB, BeamKind::kOther, 0x00},
        Case{"16.375", 0x3FF7, BeamKind::kBeyondMaximum, 0x04}, Case{"16.383", 0x3FFF, BeamKind::kNotValid, 0x04},
        Case{"32.767", 0x7FFF, BeamKind::kNotValid, 0x06}, Case{"0", 0x1FFF, BeamKind::kNotValid, 0x00}}) {
    const Decoded all = imported(folder, fan(181, "1.02", c.range, "0 0 0", "1"), 0.0);
    EXPECT_EQ(all.measurements[0].words[0], c.word) << c.range;
    EXPECT_EQ(all.scans[0].beams[0].kind, c.kind) << c.range;
    EXPECT_EQ(all.measuring_mode, c.mode) << c.range;
    EXPECT_EQ(all.scans[0].beams[1].kind, BeamKind::kRange) << c.range;
  }
}

TEST(ImportCarmen, TakesTheLargestValueForNoReturnOnlyWhereManyBeamsHaveIt) {
  const test::TemporaryFolder folder;
  std::string log;
  for (int i = 0; i < 4; ++i) log += fan(181, "3.21", i == 0 ? "50" : "4", "0 0 0", std::to_string(i));
  EXPECT_EQ(imported(folder, log).scans[0].beams[0].kind, BeamKind::kRange);  // 1 of 724 beams: 0.14 %
  log.resize(log.find('\n') + 1);
  EXPECT_EQ(imported(folder, log).scans[0].beams[0].kind, BeamKind::kBeyondMaximum);  // 1 of 181: 0.55 %
  EXPECT_EQ(imported(folder, log, 0.0).scans[0].beams[0].kind, BeamKind::kRange);
  const Decoded told = imported(folder, log, 3.21);
  EXPECT_EQ(told.scans[0].beams[1].kind, BeamKind::kBeyondMaximum);
}

TEST(ImportCarmen, TakesTheLoggersTimesWhereTheStampsTellNothing) {
  const test::TemporaryFolder folder;
  std::string log;
  for (int i = 0; i < 8; ++i) {
    std::string line = fan(180, "1.07", "2.5", std::to_string(0.05 * i) + " 0 0", "1.13486e+09");
    line.replace(line.rfind(" 0\n"), 3, " " + std::to_string(4.0 + 0.2 * i) + "\n");
    log += line;
  }
  const Decoded all = imported(folder, log);
  ASSERT_EQ(all.scans.size(), 8u);
  for (std::size_t i = 0; i < all.scans.size(); ++i) {
    const Timestamp expected = timestamp_from_ns(1'134'860'000'000'000'000) + Duration{200'000'000} * i;
    EXPECT_NEAR(seconds(all.scans[i].time - expected), 0.0, kTimeToleranceS) << i;
  }
  // One stamp, and a logger that says nothing: no times.
  const std::string same = fan(180, "1.07", "2.5", "0 0 0", "1.13486e+09");
  try {
    (void)import_carmen(folder.write("same.log", same + same + same), folder.path() / "b.pcapng", {});
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("same.log: cannot be imported without times: 2 of 3 scans have the time "),
              std::string::npos)
        << error.what();
  }
}

TEST(ImportCarmen, UsesALogThatWasCutInItsLastLineUpToThere) {
  const test::TemporaryFolder folder;
  const std::string good = fan(180, "1.07", "2.50", "0 0 0", "1") + fan(180, "1.07", "2.50", "0 0 0", "1.1");
  const std::string cut = folder.write("cut.log", good + good.substr(0, 300));
  const CarmenImport done = import_carmen(cut, folder.path() / "cut.pcapng", std::nullopt);
  EXPECT_EQ(done.survey.scans, 2u);
  ASSERT_TRUE(done.survey.cut);
  EXPECT_NE(done.survey.cut->find("cut.log:3: "), std::string::npos) << *done.survey.cut;
  EXPECT_EQ(decoded(folder.path() / "cut.pcapng").scans.size(), 2u);
  const std::string out = (folder.path() / "again.pcapng").string();
  const char* arguments[] = {"deltamap", "import", "carmen", cut.c_str(), out.c_str()};
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  EXPECT_EQ(run_tool(5, arguments), 0);
  (void)testing::internal::GetCapturedStdout();
  EXPECT_NE(testing::internal::GetCapturedStderr().find("deltamap: warning: " + cut + ":3: "), std::string::npos);
}

TEST(ImportCarmen, ResamplesOtherScannersToTheNearestVariant) {
  const test::TemporaryFolder folder;
  // 511 beams over 255°: what lies behind ±90° falls away, what the log states as maximum is no return.
  std::string log = "ROBOTLASER1 0 -2.2252948 4.4505896 0.00872664 5.6 0.01 0 511";
  for (int i = 0; i < 511; ++i) log += i == 0 ? " 5.6" : " " + std::to_string(0.001 * (1000 + i));
  log += " 0 7 7 7 0.25 0 0 0 0 0 0 0 2.5 host 0\n";
  const Decoded all = imported(folder, log);
  ASSERT_EQ(all.scans.at(0).beams.size(), 361u);
  for (const std::size_t i : {0u, 180u, 360u}) {  // beam i points to -90° + i · 0.5°, which is value i + 75 of the log
    EXPECT_NEAR(static_cast<double>(all.scans[0].beams[i].range_m), 1.075 + 0.001 * static_cast<double>(i),
                kHalfMillimetre);
  }
  EXPECT_NEAR(all.sip_poses[0].x, 0.25, kHalfMillimetre);
  const Decoded narrow = imported(folder, fan(401, "1", "2.5", "0 0 0", "1"));
  EXPECT_EQ(narrow.scans[0].beams.size(), 401u);
  EXPECT_NEAR(degrees(narrow.scans[0].first_bearing_rad), -50.0, 1e-9);
}

TEST(ImportCarmen, TakesPosesFromOdomLinesOnlyWhereNoScanLineCarriesOne) {
  const test::TemporaryFolder folder;
  const std::string raw = "RAWLASER1 0 -1.570796 3.141593 1.570796 81.9 0.01 0 3 1 1 1 0 10.05 host 0\n";
  const std::string odometry = "ODOM 1 0 0 0 0 0 10.0 host 0\nODOM 2 0 0 0 0 0 10.1 host 0\n";
  const Decoded without = imported(folder, odometry + raw);
  ASSERT_EQ(without.odometry.size(), 3u);
  EXPECT_NEAR(without.sip_poses[0].x, 1.0, kHalfMillimetre);
  EXPECT_NEAR(without.sip_poses[1].x, 1.5, kHalfMillimetre);
  EXPECT_NEAR(seconds(without.odometry[1].time - without.scans[0].time), 0.0, kTimeToleranceS);
  EXPECT_NEAR(without.sip_poses[2].x, 2.0, kHalfMillimetre);
  const Decoded with = imported(folder, odometry + raw + fan(180, "1.07", "2.50", "7 0 0", "10.05"));
  ASSERT_EQ(with.odometry.size(), 1u);
  EXPECT_EQ(with.scans.size(), 1u);
  EXPECT_NEAR(with.sip_poses[0].x, 7.0, kHalfMillimetre);
}

TEST(ImportCarmen, KeepsTheOrderOfArrivalWhereScansFollowFast) {
  const test::TemporaryFolder folder;
  std::string log;
  for (int i = 0; i < 20; ++i) log += fan(361, "1.07", "2.50", "0 0 0", "7." + std::to_string(100 + 10 * i));
  const Decoded all = imported(folder, log);
  EXPECT_EQ(all.scans.size(), 20u);
  EXPECT_TRUE(std::is_sorted(all.stamps.begin(), all.stamps.end()));
}

TEST(ImportCarmen, LeavesNothingBehindWhereTheLogIsBad) {
  const test::TemporaryFolder folder;
  const auto out = folder.path() / "out.pcapng";
  const auto refusal = [&](const std::string& log) -> std::string {
    try {
      (void)import_carmen(folder.write("bad.log", log), out, std::nullopt);
    } catch (const std::runtime_error& error) {
      EXPECT_FALSE(std::filesystem::exists(out));
      EXPECT_FALSE(std::filesystem::exists(out.string() + ".part"));
      return error.what();
    }
    return "";
  };
  const std::string good = fan(180, "1.07", "2.50", "0 0 0", "1");
  EXPECT_NE(refusal("").find("bad.log: line 1: the file is empty"), std::string::npos);
  EXPECT_NE(refusal("some text\n").find("bad.log:1: not a CARMEN log"), std::string::npos);
  EXPECT_NE(refusal(good.substr(0, 300)).find("bad.log:1: "), std::string::npos);
  EXPECT_NE(refusal("ODOM 0 0 0 0 0 0 1 host 0\n").find("bad.log: no scan"), std::string::npos);
  EXPECT_THROW((void)import_carmen(folder.write("good.log", good), folder.path() / "no" / "out.pcapng", {}),
               std::runtime_error);
  EXPECT_THROW((void)import_carmen(folder.path() / "good.log", folder.path() / "good.log", {}), std::runtime_error);
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "good.log"));
}

TEST(ImportCarmen, AnswersWithTheExitCodesOfTheTool) {
  const test::TemporaryFolder folder;
  const std::string log = folder.write("good.log", fan(180, "1.07", "2.50", "0 0 0", "1"));
  const std::string out = (folder.path() / "out.pcapng").string();
  const char* good[] = {"deltamap", "import", "carmen", log.c_str(), out.c_str(), "--json"};
  const char* missing[] = {"deltamap", "import", "carmen", "/no/such.log", out.c_str()};
  const char* wrong[] = {"deltamap", "import", "carmen"};
  testing::internal::CaptureStdout();
  EXPECT_EQ(run_tool(6, good), 0);
  EXPECT_NE(testing::internal::GetCapturedStdout().find("\"scans\": 1"), std::string::npos);
  testing::internal::CaptureStderr();
  EXPECT_EQ(run_tool(5, missing), 1);
  EXPECT_EQ(run_tool(3, wrong), 2);
  EXPECT_NE(testing::internal::GetCapturedStderr().find("/no/such.log: No such file"), std::string::npos);
}

/// Every log of the real data: each scan's time to a microsecond, each range to rounding.
TEST(ImportCarmen, TellsInTextAndJsonWhatItLeavesOutAndWhereTheLogHasItsLaser) {
  const test::TemporaryFolder folder;
  std::string log = "RLASER 1 1 0 0 0 0 0 0 1 host 0\n";
  for (const char* time : {"1", "1.1", "1.2"}) {
    std::string line = fan(181, "1.07", "2.50", "0 0 0", time);
    log += line.replace(line.find(" 9 9 0.9 "), 9, " -0.2 0 3.1415927 ");
  }
  const std::string in = folder.write("rear.log", log);
  const std::string out = (folder.path() / "out.pcapng").string();
  const auto printed = [&](std::vector<const char*> arguments) {
    testing::internal::CaptureStdout();
    EXPECT_EQ(run_tool(static_cast<int>(arguments.size()), arguments.data()), 0);
    return testing::internal::GetCapturedStdout();
  };
  const std::string text = printed({"deltamap", "import", "carmen", in.c_str(), out.c_str()});
  const std::string json = printed({"deltamap", "import", "carmen", in.c_str(), out.c_str(), "--json"});
  for (const std::string& of : {text, json}) {
    EXPECT_NE(of.find("1 scan of RLASER left out"), std::string::npos) << of;
    EXPECT_NE(of.find("the log has the laser at -0.200, 0.000 m, 180.0°: set laser.mount"), std::string::npos) << of;
  }
  EXPECT_NE(json.find("\"laser_mount\": {"), std::string::npos) << json;
}

TEST(ImportCarmen, GivesBackTheTimesAndRangesOfRealLogs) {
  const std::filesystem::path data = test::data_folder();
  if (!std::filesystem::exists(data / "logs" / "intel.log.xz")) GTEST_SKIP() << "no real logs in " << data;
  if (std::system("command -v xz > /dev/null 2>&1") != 0) GTEST_SKIP() << "xz is not installed";
  const test::TemporaryFolder folder;
  for (const std::string name : {"intel", "wean3", "duke", "aces", "uma_loc", "uma_map", "p3dx0"}) {
    const auto log = folder.path() / (name + ".log");
    ASSERT_EQ(std::system(
                  ("xz -dc '" + (data / "logs" / (name + ".log.xz")).string() + "' > '" + log.string() + "'").c_str()),
              0);
    const CarmenImport done = import_carmen(log, folder.path() / "a.pcapng", std::nullopt);
    const Decoded all = decoded(folder.path() / "a.pcapng");
    drivers::carmen::CarmenLog lines{log};
    std::size_t i = 0;
    std::size_t ranges = 0;
    const double rounding_m = done.survey.units == lms200::Units::kCentimetre ? 1e-5 : kHalfMillimetre;
    while (const auto record = lines.next()) {
      const auto* scan = std::get_if<drivers::carmen::CarmenScan>(&*record);
      if (scan == nullptr) continue;
      ASSERT_LT(i, all.scans.size()) << name;
      const Scan& back = all.scans[i++];
      ASSERT_NEAR(seconds(back.time - scan->time), 0.0, kTimeToleranceS) << name << ":" << scan->line;
      for (std::size_t beam = 0; beam < back.beams.size(); ++beam) {
        if (back.beams[beam].kind != BeamKind::kRange) continue;
        const auto value = static_cast<std::size_t>(
            std::lround((back.bearing_rad(beam) - scan->first_bearing_rad) / scan->bearing_step_rad));
        ASSERT_NEAR(static_cast<double>(back.beams[beam].range_m), scan->ranges_m.at(value), rounding_m) << name;
        ++ranges;
      }
    }
    EXPECT_EQ(i, all.scans.size()) << name;
    EXPECT_EQ(i, done.survey.scans) << name;
    EXPECT_GT(ranges, 100 * i) << name;
    EXPECT_EQ(all.odometry.back().epoch, all.odometry.front().epoch) << name;
    EXPECT_TRUE(std::is_sorted(all.stamps.begin(), all.stamps.end())) << name;
  }
}

}  // namespace
}  // namespace deltamap::tool
