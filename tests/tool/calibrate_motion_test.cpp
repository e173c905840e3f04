// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "core/files/grid_file.hpp"
#include "tests/support/files/temporary_folder.hpp"
#include "tests/support/files/tool_run.hpp"
#include "tests/support/scans/cast_scan.hpp"
#include "tests/support/worlds/drawn_hall.hpp"

namespace deltamap::tool {
namespace {

using test::ToolRun;

class CalibrateMotion : public testing::Test {
 protected:
  std::string file(const std::string& name) const { return (folder_.path() / name).string(); }

  /// A recording of a robot that drives between the containers of the drawn hall, or stands: 10 scans a second. Its
  /// wheels report 5 % less than it drives.
  void record(int scans, bool moving) {
    const OccupancyGrid hall = test::drawn_hall(0.05);
    write_grid(hall, file("hall.yaml"));
    Random random{7};
    Pose2 truth{1.5, 1.5, 0.0};
    Pose2 odom;
    std::ofstream log{file("drive.log")};
    const std::vector<Point2> corners{{7.5, 1.2}, {7.5, 6.8}, {1.5, 6.8}, {1.5, 1.5}};
    std::size_t corner = 0;
    for (int i = 0; i < scans; ++i) {
      if ((corners[corner] - truth.position()).norm() < 0.3) corner = (corner + 1) % corners.size();
      const Point2 way = corners[corner] - truth.position();
      const double off_rad = turn_between(truth.theta, std::atan2(way.y(), way.x()));
      const double turn_rad = moving ? std::clamp(off_rad, -0.08, 0.08) : 0.0;
      const double forward_m = moving && std::abs(off_rad) < 0.5 ? 0.06 : 0.0;
      truth = truth * Pose2{forward_m, 0.0, turn_rad};
      odom = odom * Pose2{0.95 * forward_m * (1.0 + random.normal(0.02)), 0.0, turn_rad + random.normal(0.001)};
      const Timestamp time = timestamp_from_ns(1'600'000'000'000'000'000) + duration_from_seconds(0.1 * i);
      write_line(log, test::cast_scan(hall, truth, time, {.noise_m = 0.005, .beams = 181}, random), odom, 0.1 * i);
    }
    log.close();
    const ToolRun imported =
        test::run_deltamap({"import", "carmen", file("drive.log"), file("drive.pcapng"), "--no-return", "80"});
    ASSERT_EQ(imported.exit_code, 0) << imported.errors;
  }

  ToolRun calibrate() {
    return test::run_deltamap({"calibrate", "motion", file("drive.pcapng"), "--map", file("hall.yaml"),
                               "--initial-pose", "1.5,1.5,0", "--set", "laser.variant=180/1", "--json"});
  }

  test::TemporaryFolder folder_;

 private:
  static void write_line(std::ostream& log, const Scan& scan, const Pose2& odom, double time_s) {
    log << "FLASER 180";
    for (std::size_t i = 0; i < 180; ++i) log << ' ' << scan.beams[i].range_m;
    for (int i = 0; i < 2; ++i) log << ' ' << odom.x << ' ' << odom.y << ' ' << odom.theta;
    log << ' ' << std::fixed << 1600000000.0 + time_s << std::defaultfloat << " test " << time_s << '\n';
  }
};

TEST_F(CalibrateMotion, FindsTheScaleOfTheWheelsAndOffersTheKeys) {
  record(900, true);
  const ToolRun calibrated = calibrate();
  ASSERT_EQ(calibrated.exit_code, 0) << calibrated.errors;
  const auto json = nlohmann::json::parse(calibrated.output);
  EXPECT_NEAR(json["systematic"]["wheel_scale"]["value"].get<double>(), 1.0 / 0.95 - 1.0, 0.01);
  EXPECT_GT(json["driven_m"].get<double>(), 20.0);
  for (const char* key : {"turn_per_turn", "turn_per_metre_deg", "metre_per_metre", "metre_per_turn_m"}) {
    EXPECT_GE(json["motion"][key]["value"].get<double>(), 0.0) << key;
  }
  EXPECT_GT(json["motion"]["metre_per_metre"]["value"].get<double>(), 0.03) << "must cover the scale";
  EXPECT_TRUE(json["cut"].is_null());
}

TEST_F(CalibrateMotion, TellsWhatTheLocalizerFindsWhileDriving) {
  record(900, true);
  const ToolRun calibrated = calibrate();
  ASSERT_EQ(calibrated.exit_code, 0) << calibrated.errors;
  const auto found = nlohmann::json::parse(calibrated.output)["calibration"];
  EXPECT_NEAR(found["distance_percent"].get<double>(), 100.0 * (1.0 / 0.95 - 1.0), 1.0);
  EXPECT_LT(found["deviations"]["distance_percent"].get<double>(), 1.0);
  for (const char* name : {"turn_percent", "drift_deg_per_m", "lag_ms", "mount"})
    EXPECT_TRUE(found.contains(name)) << name;
}

TEST_F(CalibrateMotion, UsesARecordingThatWasCutUpToTheCut) {
  record(900, true);
  const auto whole = std::filesystem::file_size(file("drive.pcapng"));
  std::filesystem::resize_file(file("drive.pcapng"), whole * 3 / 4 + 1);
  std::filesystem::resize_file(file("drive.pcapng"), whole);  // the rest is zeros
  const ToolRun calibrated = calibrate();
  ASSERT_EQ(calibrated.exit_code, 0) << calibrated.errors;
  const auto json = nlohmann::json::parse(calibrated.output);
  EXPECT_GT(json["driven_m"].get<double>(), 15.0);
  EXPECT_NE(json["cut"].get<std::string>().find("drive.pcapng: byte "), std::string::npos);
  EXPECT_NE(calibrated.errors.find("deltamap: warning: "), std::string::npos) << calibrated.errors;
}

TEST_F(CalibrateMotion, RefusesARobotThatStandsInOneLine) {
  record(40, false);
  const ToolRun refused = calibrate();
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.errors.find("drive.pcapng: too little motion to calibrate from"), std::string::npos)
      << refused.errors;
  EXPECT_EQ(std::count(refused.errors.begin(), refused.errors.end(), '\n'), 1);
  EXPECT_TRUE(refused.output.empty());
}

TEST_F(CalibrateMotion, RefusesAMapThatTheDriveDoesNotFit) {
  record(300, true);
  OccupancyGrid elsewhere{{200, 200, 0.1, {-5.0, -5.0}}, CellState::kFree};
  test::fill(elsewhere, {8.0, 8.0}, {9.0, 9.0}, CellState::kOccupied);
  test::fill(elsewhere, {-5.0, 12.0}, {15.0, 15.0}, CellState::kUnknown);
  write_grid(elsewhere, file("hall.yaml"));
  const ToolRun refused = calibrate();
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.errors.find("drive.pcapng: the pose was sure at"), std::string::npos) << refused.errors;
  EXPECT_EQ(std::count(refused.errors.begin(), refused.errors.end(), '\n'), 1) << refused.errors;
}

}  // namespace
}  // namespace deltamap::tool
