// SPDX-License-Identifier: Apache-2.0
// A drawn log with each defect that logs of others have, at many places: what is left is read right, and the defect is
// told in a line.
#include <gtest/gtest.h>

#include <functional>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/files/drawn_carmen_log.hpp"

namespace deltamap::drivers::carmen {
namespace {

constexpr int kPlaces = 20;

struct Defect {
  std::string name;
  std::function<std::string(std::vector<Line>, std::size_t)> log;  ///< with the defect at a scan
  std::string told;                                                ///< a part of the line
  std::size_t scans = kScans;
};

/// The line of a scan, changed as text.
std::function<std::string(std::vector<Line>, std::size_t)> with_text(
    const std::function<std::string(const std::string&)>& change) {
  return [change](const std::vector<Line>& lines, std::size_t at) {
    std::string log;
    for (std::size_t i = 0; i < lines.size(); ++i)
      log += (i == at ? change(lines[i].flaser()) : lines[i].flaser()) + "\n";
    return log;
  };
}

std::function<std::string(std::vector<Line>, std::size_t)> with_line(const std::function<void(Line&)>& change) {
  return [change](std::vector<Line> lines, std::size_t at) {
    change(lines[at]);
    return log_of(lines);
  };
}

/// From a scan on.
std::function<std::string(std::vector<Line>, std::size_t)> with_all_from(const std::function<void(Line&)>& change) {
  return [change](std::vector<Line> lines, std::size_t at) {
    for (std::size_t i = at; i < lines.size(); ++i) change(lines[i]);
    return log_of(lines);
  };
}

std::vector<Defect> defects() {
  const auto moved_by = [](const Pose2& jump) { return [jump](Line& line) { line.robot = jump * line.robot; }; };
  return {
      {"one range too few", with_line([](Line& line) { line.ranges.pop_back(); }), "181 ranges announced, 180 there",
       kScans - 1},
      {"one range too many", with_line([](Line& line) { line.ranges.push_back("1.00"); }),
       "181 ranges announced, 182 there", kScans - 1},
      {"a word for a range", with_line([](Line& line) { line.ranges[77] = "1.0x"; }),
       "'range' must be a number, not '1.0x'", kScans - 1},
      {"a line cut short", with_text([](const std::string& line) { return line.substr(0, 400); }),
       ": cut short: ", kScans - 1},
      {"noise", with_text([](const std::string&) { return std::string(20, '\0'); }), "(not text)", kScans - 1},
      {"two lines in one", with_text([](const std::string& line) { return line + line; }), "ranges announced, ",
       kScans - 1},
      {"a heading that is none", with_line([](Line& line) { line.robot.theta = 1.1e9; }),
       "has a heading of 1.1e+09 rad", kScans - 1},
      {"a range that is none", with_line([](Line& line) { line.ranges[5] = "nan"; }),
       "1 range is no number, or below 0: not valid"},
      {"ranges in millimetres", with_line([](Line& line) {
         for (std::string& range : line.ranges) range = text("%.0f", 1000.0 * std::stod(range));
       }),
       "1 scan (the first in line "},
      {"another mount", with_line([](Line& line) { line.robot_from_laser.x += 0.1; }),
       "; elsewhere in 1 scan (the first in line "},
      {"a rear laser", with_line([](Line& line) { line.before = "RLASER 2 1 1 0 0 0 0 0 0 1 host 0\n"; }),
       "1 scan of RLASER left out"},
      {"a second laser", with_line([](Line& line) { line.before = "ROBOTLASER2 0 0 0 0 0\n"; }),
       "1 scan of ROBOTLASER2 left out"},
      {"a clock set back by an hour", with_all_from([](Line& line) { line.stamp_s -= 3600.0; }),
       "the log's clock was set back 1 time "},
      {"a clock set back, without the logger's", with_all_from([](Line& line) {
         line.stamp_s -= 60.0;
         line.logger_s = 0.0;
       }),
       "the log's clock was set back 1 time "},
      {"a clock set back by a little", with_all_from([](Line& line) { line.stamp_s -= 0.5; }),
       " the time stamp of the scan before"},
      {"a wrong stamp", with_line([](Line& line) { line.stamp_s = 12.0; }), "the log's clock was set back 1 time "},
      {"a clock set forward", with_all_from([](Line& line) { line.stamp_s += 1000001.0; }),
       "the log's clock was set forward 1 time (the first in line "},
      {"a clock set forward by two minutes", with_all_from([](Line& line) { line.stamp_s += 120.0; }),
       "the log's clock was set forward 1 time (the first in line "},
      {"a wrong stamp far ahead", with_line([](Line& line) { line.stamp_s += 1e6; }),
       "the log's clock was set forward 1 time (the first in line "},
      {"a repeated stamp", with_line([](Line& line) { line.stamp_s -= kStep_s; }),
       "1 scan repeats the time stamp of the scan before"},
      {"a line twice", with_text([](const std::string& line) { return line + "\n" + line; }), "left out"},
      {"odometry begins anew", with_all_from([](Line& line) { line.robot = inverse(truth(0)) * line.robot; }),
       "the odometry jumps 1 time "},
      {"odometry jumps", with_all_from(moved_by({5.0, -3.0, 0.0})), "the odometry jumps 1 time "},
      {"odometry turns", with_all_from(moved_by({0.0, 0.0, 1.5})), "the odometry jumps 1 time "},
      {"270 degrees",
       [](const std::vector<Line>& lines, std::size_t at) {
         std::string log;
         for (std::size_t i = 0; i < lines.size(); ++i) {
           if (i == at) {
             log += "ROBOTLASER1 0 -2.356194 4.712389 0.017453 30.0 0.01 0 271";
             for (int beam = 0; beam < 271; ++beam) log += " 2.00";
             log += " 0" + text(lines[i].robot * lines[i].robot_from_laser) + text(lines[i].robot) + " 0 0 0 0 0" +
                    text(" %.6f", lines[i].stamp_s) + " host" + text(" %.6f", lines[i].logger_s) + "\n";
           } else {
             log += lines[i].flaser() + "\n";
           }
         }
         return log;
       },
       "90 of 271 beams a scan lie beyond ±90° and are left out in 1 scan"},
  };
}

TEST_F(CarmenDefects, AreTakenOutAndToldAtEveryPlace) {
  for (const Defect& defect : defects()) {
    for (int place = 0; place < kPlaces; ++place) {
      SCOPED_TRACE(defect.name + " at scan " + std::to_string(2 * place + 1));
      look(defect.log(drawn_lines(), static_cast<std::size_t>(2 * place + 1)));
      EXPECT_TRUE(tells(defect.told)) << all_told();
      EXPECT_EQ(survey_.scans, defect.scans);
      expect_one_drive();
    }
  }
}

TEST_F(CarmenDefects, ALongStepThatTheLoggerDoesNotTellFromAPauseIsKeptAndNamed) {
  std::vector<Line> lines = drawn_lines();
  for (std::size_t i = 0; i < lines.size(); ++i) {
    lines[i].logger_s = 0.0;
    if (i >= 7) lines[i].stamp_s += 1000001.0;
  }
  look(log_of(lines));
  EXPECT_TRUE(tells("the log's times step on 1 time (the first in line 9), by up to 1e+06 s: pauses, or a clock"))
      << all_told();
  for (std::size_t i = 7; i < lines.size(); ++i) lines[i].logger_s = 1000010.0 + static_cast<double>(i);
  look(log_of(lines));
  EXPECT_FALSE(tells("step on")) << "the logger has waited as long: " << all_told();
}

TEST_F(CarmenDefects, AStepIsAPauseWhereTheLoggersTimesDoNotRunAsTheStampsDo) {
  std::vector<Line> lines = drawn_lines();  // played again, ten times as fast
  for (std::size_t i = 0; i < lines.size(); ++i) {
    lines[i].stamp_s = kStart_s + 2.0 * static_cast<double>(i) + (i >= 20 ? 90.0 : 0.0);
    lines[i].logger_s = 2.0 + 0.2 * static_cast<double>(i) + (i >= 20 ? 9.0 : 0.0);
  }
  look(log_of(lines));
  EXPECT_FALSE(tells("clock")) << all_told();
}

TEST_F(CarmenDefects, JumpsOfTheLasersPoseAndTheClockAreToldOfAMapFromPoses) {
  for (int place = 1; place < kScans - 1; place += 2) {
    std::vector<Line> lines = drawn_lines();
    for (std::size_t i = static_cast<std::size_t>(place); i < lines.size(); ++i) {
      lines[i].robot = Pose2{4.0, -2.0, 0.4} * lines[i].robot;
      lines[i].stamp_s -= 3600.0;
    }
    look(log_of(lines));
    const auto& notes = survey_.map_notes;
    ASSERT_EQ(notes.size(), 2u) << place;
    EXPECT_EQ(notes[0].find("the log's clock was set back 1 time (the first in line "), 0u) << notes[0];
    EXPECT_EQ(notes[1].find("the laser's pose jumps 1 time (the first in line " + std::to_string(place + 2) + ")"), 0u)
        << notes[1];
  }
}

TEST_F(CarmenDefects, AByteOrderMarkIsNoPartOfTheFirstLine) {
  std::string log;
  for (const Line& line : drawn_lines()) log += line.flaser() + "\n";
  look("\xEF\xBB\xBF" + log);
  EXPECT_EQ(survey_.scans, static_cast<std::size_t>(kScans));
  EXPECT_EQ(told_.size(), 1u) << all_told();
}

TEST_F(CarmenDefects, AFanThatOnlyTheNumberOfValuesTellsIsGuessedAndNamed) {
  const std::vector<std::pair<int, std::string>> usual{{541, "270°"}, {1081, "270°"}, {682, "240°"}, {333, ""}};
  for (const auto& [values, field] : usual) {
    std::vector<Line> lines = drawn_lines();
    for (Line& line : lines) {
      line.announced = values;
      line.ranges.assign(static_cast<std::size_t>(values), "2.50");
    }
    look(log_of(lines));
    EXPECT_TRUE(tells("FLASER lines do not say where their " + std::to_string(values) +
                      " values point: 180° are assumed in 40 scans" +
                      (field.empty() ? "" : ", and scanners with so many see " + field) +
                      "; ROBOTLASER1 lines state start angle and field of view"))
        << all_told();
  }
}

TEST_F(CarmenDefects, TheMountOfTheParameterLinesIsToldWithAllOfItsParts) {
  const std::string parameters =
      "PARAM robot_frontlaser_offset 0.3 1.0 host 1.0\nPARAM robot_frontlaser_side_offset -0.05\n"
      "PARAM\trobot_frontlaser_angular_offset\t3.1415927 1.0 host 1.0\nPARAM robot_rearlaser_offset 9\n";
  std::string raw;
  for (const Line& line : drawn_lines())
    raw += "RAWLASER1 0 -1.5708 3.1416 3.1416 81.9 0.01 0 2 1 1 0" + text(" %.6f", line.stamp_s) + " host 1\n";
  look(parameters + raw);
  EXPECT_TRUE(
      tells("the log has the laser at 0.300, -0.050 m, 180.0°: set laser.mount (--set laser.mount.x_m=0.3 --set "
            "laser.mount.y_m=-0.05 --set laser.mount.yaw_deg=180)"))
      << all_told();
  look("PARAM robot_frontlaser_angular_offset 180\n" + raw);
  EXPECT_TRUE(tells("the log has the laser at 0.000, 0.000 m, 180.0°")) << "in degrees: " << all_told();
  look(parameters + log_of(drawn_lines()));
  EXPECT_TRUE(tells("the log has the laser at 0.100, 0.000 m, 0.0°")) << all_told();
  EXPECT_TRUE(
      tells("; its robot_frontlaser_offset says 0.3 m; its robot_frontlaser_side_offset says -0.05 m; its "
            "robot_frontlaser_angular_offset says 180°"))
      << all_told();
}

TEST_F(CarmenDefects, SweepsThatALogHasAsTwoKindsAreImportedOnce) {
  std::vector<Line> lines = drawn_lines();
  for (Line& line : lines)
    line.before = "RAWLASER1 0 -1.5708 3.1416 0.0175 81.9 0.01 0 2 1 1 0" + text(" %.6f", line.stamp_s) + " host" +
                  text(" %.6f\n", line.logger_s);
  look(log_of(lines));
  EXPECT_EQ(survey_.scans, static_cast<std::size_t>(kScans));
  EXPECT_EQ(survey_.doubled_scans, static_cast<std::size_t>(kScans)) << "told by the import";
  std::string log;
  for (const Line& line : lines) {
    const std::string poses = text(line.robot * line.robot_from_laser) + text(line.robot);
    log += line.flaser() + "\nROBOTLASER1 0 -1.5708 3.1416 0.0175 81.9 0.01 0 2 1 1 0" + poses + " 0 0 0 0 0" +
           text(" %.6f", line.stamp_s) + " host" + text(" %.6f\n", line.logger_s + 0.001);
  }
  look(log);
  EXPECT_EQ(survey_.scans, static_cast<std::size_t>(kScans));
  EXPECT_TRUE(tells("40 scans repeat the time stamp of the scan before")) << all_told();
}

TEST_F(CarmenDefects, AGoodLogIsReadWithItsMountAndNothingElseTold) {
  for (const Pose2& mount : {Pose2{0.1, 0.0, 0.0}, Pose2{-0.2, 0.0, std::numbers::pi}, Pose2{0.25, -0.05, 0.3}}) {
    look(log_of(drawn_lines(mount)));
    ASSERT_EQ(told_.size(), 1u) << all_told();
    EXPECT_TRUE(tells("the log has the laser at ")) << all_told();
    ASSERT_TRUE(survey_.robot_from_laser);
    EXPECT_LT(distance_between(*survey_.robot_from_laser, mount), 0.002);
    EXPECT_LT(std::abs(turn_between(survey_.robot_from_laser->theta, mount.theta)), 0.001);
    EXPECT_FALSE(survey_.no_return_m) << "the corners of a room are no codes";
    expect_one_drive();
  }
  EXPECT_TRUE(tells("--set laser.mount.x_m=0.25 --set laser.mount.y_m=-0.05")) << all_told();
}

TEST_F(CarmenDefects, AMountThatALogOfCorrectedPosesDoesNotTell) {
  std::vector<Line> lines = drawn_lines();
  for (std::size_t i = 0; i < lines.size(); ++i) lines[i].robot_from_laser.x += 0.05 * static_cast<double>(i);
  look(log_of(lines));
  EXPECT_FALSE(survey_.robot_from_laser);
  EXPECT_TRUE(tells("it does not tell the mount")) << all_told();
}

TEST_F(CarmenDefects, RangesInMillimetresAreDoubted) {
  std::vector<Line> lines = drawn_lines();
  for (Line& line : lines) {
    for (std::string& range : line.ranges) range = text("%.0f", 1000.0 * std::stod(range));
  }
  look(log_of(lines));
  EXPECT_TRUE(tells("has a range that the scanner can measure: are its ranges in mm?")) << all_told();
}

TEST_F(CarmenDefects, AMiscountInEveryLineIsRefusedByItsLine) {
  std::vector<Line> lines = drawn_lines();
  for (Line& line : lines) line.ranges.pop_back();
  try {
    look(log_of(lines));
    FAIL() << "it was read";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("drawn.log:2: 181 ranges announced, 180 there"), std::string::npos)
        << error.what();
  }
}

/// A scan as ROBOTLASER1 or RAWLASER1, `remissions` of them announced and `there` there.
std::string configured_line(const Line& line, bool has_poses, std::size_t remissions, std::size_t there) {
  std::string all = std::string(has_poses ? "ROBOTLASER1" : "RAWLASER1") +
                    " 0 -1.570796 3.141593 0.017453 81.9 0.01 0 " + std::to_string(line.announced);
  for (const std::string& range : line.ranges) all += " " + range;
  all += " " + std::to_string(remissions);
  for (std::size_t i = 0; i < there; ++i) all += " " + std::to_string(17 * i % 211);
  if (has_poses) all += text(line.robot) + text(line.robot) + " 0.3 0 0.5 0.5 1000000";
  return all + text(" %.6f", line.stamp_s) + " host" + text(" %.6f\n", line.logger_s);
}

TEST_F(CarmenDefects, AMiscountOfRobotlaserAndRawlaserCostsItsLineAlone) {
  for (const bool has_poses : {true, false}) {
    for (const std::size_t remissions : {0U, 181U}) {
      for (const int more : {-3, -1, 1, 2}) {
        for (const std::size_t at : {0U, 7U, 39U}) {  // the first robot pose is 0 0 0, its words are counts, too
          SCOPED_TRACE("line " + std::to_string(at + 1) + " has " + std::to_string(more) + " ranges more");
          std::string log;
          std::vector<Line> lines = drawn_lines();
          for (Line& line : lines) line.robot = inverse(truth(0)) * line.robot;
          lines[at].ranges.resize(static_cast<std::size_t>(181 + more), "0");
          for (const Line& line : lines) log += configured_line(line, has_poses, remissions, remissions);
          look(log);
          EXPECT_TRUE(tells("drawn.log:" + std::to_string(at + 1) + ": 181 ranges announced, " +
                            std::to_string(181 + more) + " there"))
              << all_told();
          EXPECT_EQ(survey_.scans, static_cast<std::size_t>(kScans - 1));
          EXPECT_FALSE(survey_.clock.by_logger);
        }
      }
    }
  }
}

TEST_F(CarmenDefects, AMiscountOfRemissionsCostsItsLineAlone) {
  for (const std::size_t there : {178U, 180U, 182U}) {
    std::string log;
    const std::vector<Line> lines = drawn_lines();
    for (std::size_t i = 0; i < lines.size(); ++i) log += configured_line(lines[i], true, 181, i == 5 ? there : 181);
    look(log);
    EXPECT_TRUE(tells("drawn.log:6: 181 remissions announced, " + std::to_string(there) + " there")) << all_told();
    EXPECT_EQ(survey_.scans, static_cast<std::size_t>(kScans - 1));
  }
}

TEST_F(CarmenDefects, RobotlaserWithoutAStampIsNoMiscount) {
  std::string log;
  for (const Line& line : drawn_lines()) {
    std::string one = configured_line(line, true, 0, 0);
    log += one.erase(one.find(text(" %.6f", line.stamp_s)), text(" %.6f", line.stamp_s).size());
  }
  look(log);
  EXPECT_EQ(survey_.scans, static_cast<std::size_t>(kScans));
  EXPECT_TRUE(survey_.clock.by_logger);
}

TEST_F(CarmenDefects, WhatStandsApartOrIsOneValueIsNoReturn) {
  const auto with_far = [&](const std::function<std::string(int)>& value) {
    std::vector<Line> lines = drawn_lines();
    for (Line& line : lines) {
      for (int i = 0; i < 5; ++i) line.ranges[static_cast<std::size_t>(20 + i)] = value(i);
    }
    look(log_of(lines));
    return survey_.no_return_m;
  };
  EXPECT_EQ(with_far([](int) { return "30.00"; }), 30.0);
  EXPECT_EQ(with_far([](int i) { return text("%.2f", 30.0 + 0.02 * i); }), 30.0) << "apart from the room";
}

}  // namespace
}  // namespace deltamap::drivers::carmen
