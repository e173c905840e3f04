// SPDX-License-Identifier: Apache-2.0
// What the pilot says of a scan: by the map nothing unless its pose can be trusted, and no command of its own then.
#include "daemon/steps/pilot_step.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "core/geometry/angle.hpp"

namespace deltamap::daemon {
namespace {

using navigation::StopReason;

constexpr double kHallM = 40.0;
constexpr double kScanPeriodS = 0.1;

/// A wall all along the hall, so far to the left of a robot that drives through its middle.
std::shared_ptr<const OccupancyGrid> hall_with_a_wall(double left_m) {
  OccupancyGrid map{{400, 400, 0.1, {0.0, 0.0}}, CellState::kFree};
  const Cell wall = map.geometry().cell_at({0.0, 0.5 * kHallM + left_m});
  for (int x = 0; x < 400; ++x) map.set(Cell{x, wall.row}, CellState::kOccupied);
  return std::make_shared<const OccupancyGrid>(std::move(map));
}

/// Through the middle of the hall; 8 m of laser bring no range at all.
class Drive {
 public:
  explicit Drive(double wall_left_m) : map_{hall_with_a_wall(wall_left_m)} {}

  [[nodiscard]] TrackedScan next() {
    ++scans_;
    TrackedScan tracked;
    tracked.scan.time = timestamp_from_ns(1'000'000'000) + duration_from_seconds(kScanPeriodS * scans_);
    tracked.scan.first_bearing_rad = radians(-90.0);
    tracked.scan.bearing_step_rad = radians(1.0);
    tracked.scan.max_range_m = 8.0;
    tracked.scan.beams.assign(181, Beam{0.0F, 0.0F, BeamKind::kBeyondMaximum});
    tracked.estimate.time = tracked.scan.time;
    tracked.estimate.map = map_;
    tracked.estimate.state = LocalizerState::kTracking;
    tracked.estimate.map_from_robot = {10.0 + kScanPeriodS * scans_, 0.5 * kHallM, 0.0};
    tracked.estimate.covariance = PoseCovariance{Eigen::Vector3d{4e-4, 4e-4, 1e-4}.asDiagonal()};
    return tracked;
  }

 private:
  std::shared_ptr<const OccupancyGrid> map_;
  int scans_ = 0;
};

struct PoorPose {
  StopReason why;
  std::function<void(TrackedScan&, PilotStep::Seen&)> spoil;
};

const std::vector<PoorPose>& poor_poses() {
  using Seen = PilotStep::Seen;
  static const std::vector<PoorPose> kAll{
      {StopReason::kPoseUnknown, [](TrackedScan& t, Seen&) { t.estimate.state = LocalizerState::kGlobal; }},
      {StopReason::kLost, [](TrackedScan& t, Seen&) { t.estimate.state = LocalizerState::kLost; }},
      {StopReason::kPoseWrong, [](TrackedScan& t, Seen&) { t.estimate.belief.verdict = PoseVerdict::kWrong; }},
      {StopReason::kStartUnfit, [](TrackedScan&, Seen& seen) { seen.start_fits = false; }},
      {StopReason::kPoseUnsure, [](TrackedScan& t, Seen&) { t.estimate.covariance(1, 1) = 4.0; }},
      {StopReason::kPoseUnfit, [](TrackedScan&, Seen& seen) { seen.fit = 0.0; }},
  };
  return kAll;
}

/// What it says at the end of some metres; `spoil` may be none.
PilotWord word_after(int scans, double wall_left_m, const std::function<void(TrackedScan&, PilotStep::Seen&)>& spoil,
                     const Settings& settings) {
  Drive drive{wall_left_m};
  PilotStep pilot{settings};
  PilotWord word;
  for (int i = 0; i < scans; ++i) {
    TrackedScan tracked = drive.next();
    PilotStep::Seen seen;
    if (spoil) spoil(tracked, seen);
    word = pilot.observe(tracked, seen);
  }
  return word;
}

Settings wandering(bool without_pose = false) {
  Settings settings;
  settings.navigation.mode = navigation::DriveMode::kWander;
  settings.navigation.drive_without_pose = without_pose;
  return settings;
}

constexpr int kLong = 100;         // scans: ten metres
constexpr double kBeyondM = 12.0;  // a wall that no beam reaches
constexpr double kMissedM = 4.0;   // a wall that beams should meet

TEST(PilotStep, DrivesByATrustedPoseAndExcusesALaserThatHasNothingToSee) {
  const PilotWord word = word_after(kLong, kBeyondM, {}, wandering());
  EXPECT_EQ(word.pose, StopReason::kNone);
  EXPECT_EQ(word.held_by, StopReason::kNone);
  EXPECT_TRUE(word.expects_no_range);
  EXPECT_FALSE(word.misses_walls);
  EXPECT_GT(word.command.speed_m_per_s, 0.0);
}

TEST(PilotStep, TellsThatALaserMissesTheWallsOfTheMap) {
  const PilotWord word = word_after(kLong, kMissedM, {}, wandering());
  EXPECT_FALSE(word.expects_no_range);
  EXPECT_TRUE(word.misses_walls);
}

TEST(PilotStep, SaysNothingByTheMapAndDoesNotDriveWhereItsPoseIsNotToBeTrusted) {
  for (const PoorPose& poor : poor_poses()) {
    const PilotWord word = word_after(kLong, kBeyondM, poor.spoil, wandering());
    EXPECT_EQ(word.pose, poor.why);
    EXPECT_EQ(word.held_by, poor.why);
    EXPECT_FALSE(word.expects_no_range) << name_of(poor.why) << ": nobody knows what the laser should see";
    EXPECT_EQ(word.command.speed_m_per_s, 0.0) << name_of(poor.why);
    EXPECT_EQ(word.command.turn_rate_rad_per_s, 0.0) << name_of(poor.why);
    // A fit of none needs seconds to be believed: by then some places have counted.
    if (poor.why == StopReason::kPoseUnfit) continue;
    EXPECT_FALSE(word_after(kLong, kMissedM, poor.spoil, wandering()).misses_walls) << name_of(poor.why);
  }
}

TEST(PilotStep, ThatDrivesWithoutAPoseSaysNothingByTheMapEither) {
  for (const PoorPose& poor : poor_poses()) {
    const PilotWord word = word_after(kLong, kBeyondM, poor.spoil, wandering(true));
    EXPECT_EQ(word.pose, poor.why) << "others are told";
    EXPECT_EQ(word.held_by, StopReason::kNone);
    EXPECT_FALSE(word.expects_no_range) << name_of(poor.why);
    EXPECT_TRUE(word.command.speed_m_per_s > 0.0 || word.command.turn_rate_rad_per_s != 0.0) << name_of(poor.why);
  }
}

TEST(PilotStep, CallsWheelsThatTurnWhileTheScansStandSpinning) {
  const auto stands_for = [](double stood_m) {
    const auto stand = [&](TrackedScan& tracked, PilotStep::Seen&) { tracked.stood_m = stood_m; };
    return word_after(1, kBeyondM, stand, Settings{}).wheels_spin;
  };
  EXPECT_FALSE(stands_for(0.0));
  EXPECT_FALSE(stands_for(0.25));
  EXPECT_TRUE(stands_for(0.35));
}

/// What it says at the end of two metres, from x = 10 m on, with a zone that begins at x = 12.2 m.
PilotWord word_before(ZoneKind kind, bool has_pose = true) {
  const double middle = 0.5 * kHallM;
  const Zone zone{.id = "Z",
                  .kind = kind,
                  .most_speed_m_per_s = 0.1,
                  .polygon = {{12.2, middle - 3.0}, {16.0, middle - 3.0}, {16.0, middle + 3.0}, {12.2, middle + 3.0}}};
  Drive drive{kBeyondM};
  PilotStep pilot{wandering(true), {zone}};
  PilotWord word;
  for (int i = 0; i < 20; ++i) {
    TrackedScan tracked = drive.next();
    if (!has_pose) tracked.estimate.state = LocalizerState::kGlobal;
    word = pilot.observe(tracked, {});
  }
  return word;
}

TEST(PilotStep, TurnsBeforeABlockedZoneAndTellsWhoeverDrivesWhatZonesAsk) {
  EXPECT_GT(word_before(ZoneKind::kFrozen).command.speed_m_per_s, 0.2);
  const PilotWord blocked = word_before(ZoneKind::kBlocked);
  EXPECT_EQ(blocked.command.speed_m_per_s, 0.0);
  EXPECT_NE(blocked.command.turn_rate_rad_per_s, 0.0);
  EXPECT_FALSE(blocked.zones.blocked_in_robot.empty()) << "whoever drives: Safety heeds it";
  EXPECT_EQ(word_before(ZoneKind::kSpeedLimit).zones.most_speed_m_per_s, 0.1);
  const PilotWord lost = word_before(ZoneKind::kSpeedLimit, false);
  EXPECT_TRUE(std::isinf(lost.zones.most_speed_m_per_s)) << "nobody knows where that is";
  EXPECT_TRUE(word_before(ZoneKind::kBlocked, false).zones.blocked_in_robot.empty());
}

TEST(PilotStep, OfARunInWhichNobodyDrivesNeverCommands) {
  const PilotWord word = word_after(kLong, kBeyondM, {}, Settings{});
  EXPECT_EQ(word.held_by, StopReason::kNone);
  EXPECT_EQ(word.command.speed_m_per_s, 0.0);
  EXPECT_EQ(word.command.turn_rate_rad_per_s, 0.0);
}

}  // namespace
}  // namespace deltamap::daemon
