// SPDX-License-Identifier: Apache-2.0
#include "navigation/laser_watch.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/random.hpp"
#include "navigation/lost_ends.hpp"

namespace deltamap::navigation {
namespace {

constexpr Timestamp kFirstScan = timestamp_from_ns(1'000'000'000'000);
constexpr double kScanS = 0.1;

/// A laser in a room of 4 m around it, on wheels that say where it is.
class Watched {
 public:
  Watched() {
    scan.first_bearing_rad = -std::numbers::pi / 2.0;
    scan.bearing_step_rad = std::numbers::pi / 180.0;
    scan.max_range_m = 8.0;
    scan.beams.assign(181, {4.0F, 0.0F, BeamKind::kRange});
  }
  void pass(double for_s) {
    for (double t = 0.0; t < for_s - 1e-9; t += kScanS) {
      now += duration_from_seconds(kScanS);
      odometry.time = scan.time = scan.received = now;
      odometry.odom_from_robot.x += kScanS * odometry.speed_m_per_s;
      for (Beam& beam : scan.beams) {
        if (is_alive) beam.range_m = 4.0F + static_cast<float>(random.normal(0.01));
      }
      watch.observe(odometry);
      watch.observe(scan);
      if (is_excused) watch.excuse(now);
      if (!is_excused) watch.excuse(std::nullopt);
    }
  }
  void set(std::size_t first, std::size_t last, BeamKind kind) {
    for (std::size_t i = first; i < last; ++i) scan.beams[i].kind = kind;
  }

  LaserWatch watch;
  Odometry odometry;
  Scan scan;
  bool is_alive = true;
  bool is_excused = false;
  Random random{3};
  Timestamp now = kFirstScan;
};

TEST(LaserWatch, IsBlindAfterASecondWithoutARange) {
  for (const BeamKind kind : {BeamKind::kBeyondMaximum, BeamKind::kNotValid, BeamKind::kDazzled, BeamKind::kOther}) {
    Watched laser;
    laser.pass(2.0);
    EXPECT_FALSE(laser.watch.sees_nothing());
    laser.set(0, 181, kind);
    laser.pass(0.9);
    EXPECT_FALSE(laser.watch.sees_nothing());
    laser.pass(0.3);
    EXPECT_TRUE(laser.watch.sees_nothing());
    laser.set(0, 181, BeamKind::kRange);
    laser.pass(0.2);
    EXPECT_FALSE(laser.watch.sees_nothing());
  }
}

TEST(LaserWatch, IsBlindFromTheStart) {
  Watched laser;
  laser.set(0, 181, BeamKind::kBeyondMaximum);
  laser.pass(1.3);
  EXPECT_TRUE(laser.watch.sees_nothing());
}

TEST(LaserWatch, ExcusesALaserThatHasNothingToSeeButNotOneThatIsCovered) {
  Watched laser;
  laser.is_excused = true;
  for (std::size_t beam = 0; beam < 181; beam += 3) {  // they drop out one after another, as walls get out of reach
    laser.set(beam, std::min<std::size_t>(beam + 3, 181), BeamKind::kBeyondMaximum);
    laser.pass(kScanS);
  }
  laser.pass(5.0);
  EXPECT_FALSE(laser.watch.sees_nothing());
  laser.is_excused = false;
  laser.pass(1.0);
  EXPECT_TRUE(laser.watch.sees_nothing()) << "nobody says any more that the map has nothing";

  Watched covered;
  covered.is_excused = true;
  covered.pass(1.0);
  covered.set(0, 181, BeamKind::kBeyondMaximum);
  covered.pass(1.3);
  EXPECT_TRUE(covered.watch.sees_nothing()) << "all at once: a lens is covered, the world does not vanish so";
}

TEST(LaserWatch, TakesASectorThatBreaksOffAtOnceForCoveredUntilItSeesAgain) {
  Watched laser;
  laser.pass(1.0);
  laser.set(60, 120, BeamKind::kBeyondMaximum);
  laser.pass(kScanS);
  EXPECT_EQ(laser.watch.believed(laser.scan).beams[90].kind, BeamKind::kNotValid) << "at once: it is not free";
  EXPECT_EQ(laser.watch.believed(laser.scan).beams[30].kind, BeamKind::kRange);
  EXPECT_FALSE(laser.watch.sees_nothing());
  laser.pass(1.1);
  EXPECT_TRUE(laser.watch.sees_nothing());
  laser.set(60, 120, BeamKind::kRange);
  laser.pass(0.2);
  EXPECT_FALSE(laser.watch.sees_nothing());
  EXPECT_EQ(laser.watch.believed(laser.scan).beams[90].kind, BeamKind::kRange);
}

TEST(LaserWatch, LetsTheMapExcuseASectorButNotWhatBreaksOffAfterThat) {
  Watched laser;
  laser.is_excused = true;
  laser.pass(1.0);
  laser.set(60, 120, BeamKind::kBeyondMaximum);
  laser.pass(kScanS);
  EXPECT_EQ(laser.watch.believed(laser.scan).beams[90].kind, BeamKind::kBeyondMaximum) << "the map has nothing there";
  laser.pass(5.0);
  EXPECT_FALSE(laser.watch.sees_nothing());
  laser.is_excused = false;  // it has come to where the map has walls, and still no range
  laser.pass(2 * kScanS);
  EXPECT_TRUE(laser.watch.sees_nothing()) << "a covered lens stays one";
  EXPECT_EQ(laser.watch.believed(laser.scan).beams[90].kind, BeamKind::kNotValid);

  Watched covered;
  covered.is_excused = true;
  covered.pass(0.3);
  covered.set(60, 120, BeamKind::kBeyondMaximum);  // nothing has been said of this scan yet
  covered.now += duration_from_seconds(kScanS);
  covered.scan.time = covered.now;
  covered.watch.observe(covered.scan);
  EXPECT_EQ(covered.watch.believed(covered.scan).beams[90].kind, BeamKind::kNotValid);
}

TEST(LaserWatch, ForgetsACoveredSectorByAPersonsWordAlone) {
  Watched laser;
  laser.pass(1.0);
  laser.set(60, 120, BeamKind::kBeyondMaximum);
  laser.pass(60.0);
  EXPECT_TRUE(laser.watch.sees_nothing());
  laser.watch.begin_anew();
  EXPECT_FALSE(laser.watch.sees_nothing());
  laser.pass(5.0);
  EXPECT_FALSE(laser.watch.sees_nothing());
  laser.set(0, 60, BeamKind::kBeyondMaximum);
  laser.pass(1.3);
  EXPECT_TRUE(laser.watch.sees_nothing()) << "another one";
  laser.set(0, 181, BeamKind::kBeyondMaximum);
  laser.pass(1.3);
  laser.watch.begin_anew();
  EXPECT_TRUE(laser.watch.sees_nothing()) << "there is no range at all";
}

TEST(LaserWatch, HoldsNothingAgainstScansThatCouldNotBeBelieved) {
  Watched laser;
  laser.set(60, 120, BeamKind::kBeyondMaximum);
  laser.pass(1.0);
  laser.set(60, 120, BeamKind::kRange);
  laser.scan.implausible = true;
  laser.pass(1.0);
  laser.scan.implausible = false;
  laser.set(60, 120, BeamKind::kBeyondMaximum);
  laser.pass(2.0);
  EXPECT_FALSE(laser.watch.sees_nothing());

  Watched covered;
  covered.pass(1.0);
  covered.set(60, 120, BeamKind::kBeyondMaximum);
  covered.pass(1.3);
  covered.set(60, 120, BeamKind::kRange);
  covered.scan.implausible = true;
  covered.pass(0.3);
  covered.set(60, 120, BeamKind::kBeyondMaximum);
  covered.scan.implausible = false;
  covered.pass(0.3);
  EXPECT_TRUE(covered.watch.sees_nothing()) << "such ranges do not open a sector either";
}

TEST(LaserWatch, LetsASmallGapAndOneThatGrowsBe) {
  Watched laser;
  laser.pass(1.0);
  laser.set(80, 100, BeamKind::kBeyondMaximum);  // a window
  laser.pass(2.0);
  EXPECT_FALSE(laser.watch.sees_nothing());
  for (std::size_t beam = 100; beam < 160; beam += 6) {
    laser.set(beam, beam + 6, BeamKind::kBeyondMaximum);
    laser.pass(kScanS);
  }
  laser.pass(2.0);
  EXPECT_FALSE(laser.watch.sees_nothing());
}

TEST(LaserWatch, NoticesALaserThatRepeatsItselfOnceTheWheelsHaveTurned) {
  Watched laser;
  laser.pass(1.0);
  laser.is_alive = false;
  laser.pass(20.0);
  EXPECT_FALSE(laser.watch.repeats_itself()) << "the robot stands: a scan in whole centimetres may be the same";
  laser.odometry.speed_m_per_s = 0.3;
  laser.pass(0.5);
  EXPECT_TRUE(laser.watch.repeats_itself());
  laser.is_alive = true;
  laser.pass(0.1);
  EXPECT_FALSE(laser.watch.repeats_itself());
}

TEST(LaserWatch, NoticesScansThatStandWhileTheWheelsTurn) {
  Watched laser;
  laser.pass(1.0);
  laser.odometry.speed_m_per_s = 0.3;
  laser.pass(0.7);
  EXPECT_FALSE(laser.watch.motion().contradicts_wheels()) << "one such pair may be chance";
  laser.pass(1.3);
  EXPECT_TRUE(laser.watch.motion().contradicts_wheels());
  laser.watch.begin_anew();
  EXPECT_FALSE(laser.watch.motion().contradicts_wheels());
}

TEST(LaserWatch, ComparesNothingAcrossAJumpOfTheOdometry) {
  Watched laser;
  laser.pass(1.0);
  for (int i = 0; i < 20; ++i) {
    ++laser.odometry.epoch;
    laser.odometry.odom_from_robot.x += 5.0;
    laser.pass(kScanS);
  }
  EXPECT_FALSE(laser.watch.motion().contradicts_wheels());
}

TEST(LaserWatch, CallsScansImplausibleThatShowACircleAroundTheLaser) {
  Scan scan;
  scan.bearing_step_rad = radians(0.5);
  scan.first_bearing_rad = radians(-90.0);
  for (int i = 0; i < 361; ++i) {  // a room of 8 m by 8 m, seen from its middle
    const double bearing_rad = scan.bearing_rad(static_cast<std::size_t>(i));
    const double range_m = 4.0 / std::max(std::abs(std::cos(bearing_rad)), std::abs(std::sin(bearing_rad)));
    scan.beams.push_back({static_cast<float>(range_m), 0.0F, BeamKind::kRange});
  }
  EXPECT_FALSE(is_implausible(scan));
  const auto with_an_arc_of = [&](std::size_t beams) {
    Scan arc = scan;
    for (std::size_t i = 100; i < 100 + beams; ++i) arc.beams[i].range_m = i % 2 == 0 ? 2.0F : 2.008F;
    return arc;
  };
  EXPECT_FALSE(is_implausible(with_an_arc_of(160))) << "a pillar, a bay";
  EXPECT_TRUE(is_implausible(with_an_arc_of(181)));
  Scan broken = with_an_arc_of(181);
  broken.beams[190].kind = BeamKind::kBeyondMaximum;
  EXPECT_FALSE(is_implausible(broken));
  scan.implausible = true;
  EXPECT_TRUE(is_implausible(scan)) << "the laser says so itself";
  EXPECT_FALSE(is_implausible(Scan{}));
}

TEST(LostEnds, KeepWhatStandsNearUntilABeamHasGoneThroughItsPlace) {
  for (const BeamKind back : {BeamKind::kRange, BeamKind::kBeyondMaximum}) {
    Watched laser;
    LostEnds ends;
    const auto look = [&](double at_m = 0.0) {
      laser.pass(0.1);
      ends.observe(laser.scan, Pose2{at_m, 0.0, 0.0});
      return ends.in_robot().size();
    };
    laser.is_alive = false;
    for (std::size_t i = 80; i < 100; ++i) laser.scan.beams[i].range_m = 0.6F;
    (void)look();
    laser.set(0, 181, BeamKind::kNotValid);
    for (int i = 0; i < 100; ++i) (void)look();
    EXPECT_EQ(look(), 20u) << "the far ones are forgotten";
    laser.set(0, 181, back);
    for (Beam& beam : laser.scan.beams) beam.range_m = 4.0F;
    EXPECT_EQ(look(), 0u);
  }
  Watched laser;
  LostEnds ends;
  for (Beam& beam : laser.scan.beams) beam.range_m = 0.6F;
  laser.is_alive = false;
  laser.pass(0.1);
  ends.observe(laser.scan, Pose2{});
  laser.set(0, 181, BeamKind::kNotValid);
  laser.pass(3.0);
  ends.observe(laser.scan, Pose2{});
  EXPECT_FALSE(ends.in_robot().empty());
  ends.observe(laser.scan, Pose2{-2.0, 0.0, 0.0});
  EXPECT_TRUE(ends.in_robot().empty()) << "the robot has left";
}

TEST(LostEnds, KeepWhatWasSeenUntilSomethingIsSeenThere) {
  Watched laser;
  LostEnds ends;
  laser.pass(0.1);
  ends.observe(laser.scan, Pose2{});
  EXPECT_TRUE(ends.in_robot().empty());
  laser.set(60, 120, BeamKind::kBeyondMaximum);
  laser.pass(0.1);
  ends.observe(laser.scan, Pose2{0.1, 0.0, 0.0});
  ASSERT_GT(ends.in_robot().size(), 50u);
  const auto ahead =
      std::min_element(ends.in_robot().begin(), ends.in_robot().end(),
                       [](const Point2& a, const Point2& b) { return std::abs(a.y()) < std::abs(b.y()); });
  EXPECT_NEAR(ahead->x(), 3.9, 0.05) << "the robot has come nearer to it";
  laser.set(60, 120, BeamKind::kRange);
  laser.pass(0.1);
  ends.observe(laser.scan, Pose2{0.1, 0.0, 0.0});
  EXPECT_TRUE(ends.in_robot().empty());
}

TEST(LostEnds, ForgetAfterAWhileAndWhereTheWheelsDoNotTell) {
  Watched laser;
  LostEnds ends;
  laser.pass(0.1);
  ends.observe(laser.scan, Pose2{});
  laser.set(60, 120, BeamKind::kBeyondMaximum);
  laser.pass(0.1);
  ends.observe(laser.scan, Pose2{});
  EXPECT_FALSE(ends.in_robot().empty());
  laser.pass(2.0);
  ends.observe(laser.scan, Pose2{});
  EXPECT_TRUE(ends.in_robot().empty());
  laser.set(60, 120, BeamKind::kRange);
  laser.pass(0.1);
  ends.observe(laser.scan, Pose2{});
  laser.set(60, 120, BeamKind::kBeyondMaximum);
  laser.pass(0.1);
  ends.observe(laser.scan, std::nullopt);
  EXPECT_TRUE(ends.in_robot().empty());
}

TEST(LostEnds, KeepAPlaceThatALaserHasNotSeenFreeButHasCeasedToLookAt) {
  Watched laser;
  LostEnds ends;
  laser.pass(0.1);
  ends.observe(laser.scan, Pose2{});
  laser.is_alive = false;
  for (Beam& beam : laser.scan.beams) beam.range_m = 7.0F;  // all at once it looks elsewhere
  for (int i = 0; i < 10; ++i) {
    laser.pass(0.1);
    ends.observe(laser.scan, Pose2{});
    EXPECT_GT(ends.in_robot().size(), 150u) << i;
  }
  laser.pass(1.0);
  ends.observe(laser.scan, Pose2{});
  EXPECT_TRUE(ends.in_robot().empty()) << "the scans follow each other again";
}

}  // namespace
}  // namespace deltamap::navigation
