// SPDX-License-Identifier: Apache-2.0
#include "localization/surfaces/offset_filter.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <memory>

#include "localization/belief/stability.hpp"
#include "localization/localizer.hpp"
#include "localization/localizer_params.hpp"
#include "localization/tracking/surface_tracker.hpp"
#include "tests/support/worlds/container_hall.hpp"

namespace deltamap::localization::surfaces {
namespace {

/// A robot whose wheels count 1 % too far and turn 2 % too little, by a fixed round through the aisles.
class Drive {
 public:
  explicit Drive(const test::Containers& in_truth, bool follow_surfaces)
      : world_{test::world_of(in_truth)}, localizer_{params(follow_surfaces), map(), start(), 5} {
    odometry_.time = timestamp_from_ns(1'700'000'000'000'000'000);
  }

  void go(double metres, double turn_rad) {
    const int steps = static_cast<int>(std::ceil(std::max(metres / 0.05, std::abs(turn_rad) / radians(3.0))));
    for (int i = 0; i < steps; ++i) step({metres / steps, 0.0, turn_rad / steps});
  }
  /// All that the map shows has proven to stay.
  void live_there() {
    const GridGeometry& geometry = map()->geometry();
    belief::Stability stability{geometry};
    for (int look = 0; look < 12; ++look) {
      const Timestamp time = timestamp_from_ns(0) + duration_from_seconds(60.0 * look);
      const Point2 from{look % 2 == 0 ? -20.0 - 2.0 * look : 40.0 + 2.0 * look, 1.0};
      for (int row = 0; row < geometry.height; ++row) {
        for (int column = 0; column < geometry.width; ++column) stability.confirm({column, row}, from, time);
      }
    }
    ASSERT_TRUE(localizer_.restore(stability.record()));
  }
  void rearrange(const test::Containers& containers) { world_ = test::world_of(containers); }
  /// Neither scans nor odometry for so long, in which it moves on.
  void be_blind(double seconds, const Pose2& robot_from_moved) {
    truth_ = truth_ * robot_from_moved;
    odometry_.time += duration_from_seconds(seconds);
  }
  void slip(const Pose2& robot_from_moved) { truth_ = truth_ * robot_from_moved; }
  [[nodiscard]] double error_m() const { return distance_between(truth_, estimate_.map_from_robot); }
  [[nodiscard]] const Estimate& estimate() const { return estimate_; }
  [[nodiscard]] double worst_m() const { return worst_m_; }
  void forget_worst() { worst_m_ = 0.0; }
  [[nodiscard]] const Pose2& truth() const { return truth_; }

 private:
  static std::shared_ptr<const OccupancyGrid> map() {
    return std::make_shared<const OccupancyGrid>(test::map_of(test::containers_in_order()));
  }
  static LocalizerParams params(bool follow_surfaces) {
    LocalizerParams params;
    params.follow_surfaces = follow_surfaces;
    return params;
  }
  static particles::InitialPose start() { return {{2.0, 1.0, 0.0}, 0.05, 0.02}; }

  void step(const Pose2& counted) {
    truth_ = truth_ * Pose2{counted.x / 1.01, 0.0, counted.theta * 1.02};
    odometry_.odom_from_robot = odometry_.odom_from_robot * counted;
    odometry_.time += duration_from_seconds(0.1);
    localizer_.observe(odometry_);
    estimate_ =
        localizer_.observe(test::cast_scan(world_, truth_, odometry_.time, {.max_range_m = 8.0}, random_)).estimate;
    worst_m_ = std::max(worst_m_, error_m());
  }

  OccupancyGrid world_;
  Localizer localizer_;
  Pose2 truth_ = start().map_from_robot;
  Estimate estimate_;
  Odometry odometry_;
  Random random_{11};
  double worst_m_ = 0.0;
};

test::Containers shifted() {
  test::Containers containers = test::containers_in_order();
  containers[3] += Point2{-0.3, -0.2};
  return containers;
}

/// The largest error of a round through a hall one of whose containers is shifted as the robot comes.
double worst_among_shifted_m(bool follow_surfaces) {
  Drive drive{test::containers_in_order(), follow_surfaces};
  drive.go(8.0, 0.0);
  drive.go(0.0, radians(90.0));
  drive.rearrange(shifted());
  drive.forget_worst();
  drive.go(3.0, 0.0);
  drive.go(0.0, radians(90.0));
  drive.go(8.0, 0.0);
  return drive.worst_m();
}

TEST(SurfaceTracker, IsNotLedAstrayByContainersThatWereShifted) {
  const double by_surfaces_m = worst_among_shifted_m(true);
  EXPECT_LT(by_surfaces_m, 0.06);
  EXPECT_LT(by_surfaces_m, 0.5 * worst_among_shifted_m(false));
}

TEST(SurfaceTracker, HoldsThePoseInAHallThatIsAsItWas) {
  Drive drive{test::containers_in_order(), true};
  drive.go(3.0, 0.0);
  drive.forget_worst();
  drive.go(5.0, 0.0);
  EXPECT_LT(drive.worst_m(), 0.03);
  EXPECT_GE(drive.estimate().belief.pose_right, 0.84) << "as much as tiles may say that have not been proven yet";
}

TEST(SurfaceTracker, IsSurelyRightWhereWallsThatHaveProvenToStayTellOfThePose) {
  Drive drive{test::containers_in_order(), true};
  drive.live_there();
  drive.go(8.0, 0.0);
  EXPECT_EQ(drive.estimate().belief.verdict, PoseVerdict::kRight);
  EXPECT_GT(drive.estimate().belief.pose_right, 0.95);
}

TEST(SurfaceTracker, SeesAtTheNextScanThatOneWheelHasSlippedAndStaysAsSureAlongTheAisle) {
  Drive drive{test::containers_in_order(), true};
  drive.go(5.0, 0.0);
  const double deviation_m = std::sqrt(drive.estimate().covariance(0, 0));
  drive.slip({0.0, 0.0, 0.07});
  drive.go(0.05, 0.0);
  EXPECT_NEAR(turn_between(drive.truth().theta, drive.estimate().map_from_robot.theta), 0.0, 0.015);
  EXPECT_LT(std::sqrt(drive.estimate().covariance(0, 0)), deviation_m + 0.03);
}

TEST(SurfaceTracker, FindsThePoseAgainAfterASlip) {
  Drive drive{test::containers_in_order(), true};
  drive.go(5.0, 0.0);
  drive.slip({-0.1, 0.0, radians(5.0)});
  drive.go(0.5, 0.0);
  EXPECT_LT(drive.error_m(), 0.05);
}

TEST(SurfaceTracker, FindsThePoseAtOnceAfterALargeSlip) {
  for (const Pose2& slip : {Pose2{-0.3, 0.0, 0.0}, Pose2{0.0, 0.0, 0.15}, Pose2{0.2, 0.0, -0.12}}) {
    Drive drive{test::containers_in_order(), true};
    drive.go(5.0, 0.0);
    drive.slip(slip);
    drive.go(0.3, 0.0);
    EXPECT_LT(drive.error_m(), 0.05) << slip.x << " m, " << slip.theta << " rad";
  }
}

TEST(SurfaceTracker, FindsASlipThatLooksLikeAMovedWallOnceOtherSurfacesTell) {
  Drive drive{test::containers_in_order(), true};
  drive.go(5.0, 0.0);
  drive.slip({0.3, 0.0, 0.0});  // along the aisle: only the wall at its end is not where it was
  drive.go(2.0, 0.0);
  drive.go(0.0, radians(90.0));
  drive.go(3.0, 0.0);
  EXPECT_LT(drive.error_m(), 0.05);
}

TEST(SurfaceTracker, TakesASlipForNoChangeOfTheHall) {
  // Of four containers one has been shifted before: where it stands is known when the wheels slip.
  Drive drive{test::containers_in_order(), true};
  drive.go(3.0, 0.0);
  drive.rearrange(shifted());
  drive.go(5.0, 0.0);
  drive.go(0.0, radians(90.0));
  drive.go(2.0, 0.0);
  drive.slip({-0.2, 0.0, 0.1});
  drive.go(0.5, 0.0);
  EXPECT_LT(drive.error_m(), 0.06);
}

TEST(SurfaceTracker, LeavesAPoseThatIsNotSureToTheParticles) {
  Drive drive{test::containers_in_order(), true};
  drive.go(5.0, 0.0);
  drive.be_blind(20.0, {1.2, 0.0, 0.1});
  drive.go(3.5, 0.0);
  EXPECT_LT(drive.error_m(), 0.06);
  EXPECT_FALSE(tracking::SurfaceTracker::is_one_place(Eigen::Vector3d{0.04, 0.0, 0.0}.asDiagonal().toDenseMatrix()));
  EXPECT_FALSE(tracking::SurfaceTracker::is_one_place(Eigen::Vector3d{0.0, 0.0, 0.01}.asDiagonal().toDenseMatrix()));
  EXPECT_TRUE(tracking::SurfaceTracker::is_one_place(Eigen::Vector3d{1e-3, 1e-3, 1e-4}.asDiagonal().toDenseMatrix()));
}

/// A robot by a fixed round through the aisles, whose scans are the filter's alone.
class Round {
 public:
  explicit Round(const Pose2& mount_error)
      : world_{test::world_of(test::containers_in_order())},
        map_{std::make_shared<const OccupancyGrid>(test::map_of(test::containers_in_order()))},
        field_{*map_, {}},
        filter_{map_},
        mount_error_{mount_error} {
    filter_.start({truth_, Eigen::Vector3d{1e-4, 1e-4, 1e-5}.asDiagonal().toDenseMatrix()});
  }

  void drive(int sides) {
    for (int side = 0; side < sides; ++side) {
      for (int i = 0; i < 40 + 30; ++i)
        step(i < 40 ? Pose2{side % 2 == 0 ? 0.2 : 0.075, 0.0, 0.0} : Pose2{0.0, 0.0, radians(3.0)});
    }
  }
  [[nodiscard]] const OffsetFilter& filter() const { return filter_; }
  [[nodiscard]] const Pose2& truth() const { return truth_; }

 private:
  void step(const Pose2& counted) {
    truth_ = truth_ * Pose2{counted.x * 1.01, 0.0, counted.theta * 0.98};
    filter_.predict({.motion = counted}, Eigen::Vector3d{1e-6, 1e-6, 1e-7}.asDiagonal().toDenseMatrix());
    const test::CastScanner scanner{.max_range_m = 8.0, .robot_from_laser = mount_error_};
    Scan scan = test::cast_scan(world_, truth_, timestamp_from_ns(++scans_), scanner, random_);
    scan.robot_from_laser = filter_.calibration().mount_error;  // told: the identity
    ends_ = faced_ends(scan, motion::deskewed(scan, {}), std::move(ends_));
    (void)filter_.observe(field_, {ends_}, 0.1, {});
  }

  OccupancyGrid world_;
  std::shared_ptr<const OccupancyGrid> map_;
  sensor::LikelihoodField field_;
  OffsetFilter filter_;
  Pose2 mount_error_;
  Pose2 truth_{2.0, 1.0, 0.0};
  std::vector<FacedEnd> ends_;
  Random random_{4};
  int scans_ = 0;
};

TEST(OffsetFilter, FindsTheErrorsOfTheWheels) {
  Round round{{}};
  round.drive(8);
  EXPECT_NEAR(round.filter().calibration().wheels.distance, 0.01, 0.002);
  EXPECT_NEAR(round.filter().calibration().wheels.turn, -0.02, 0.003);
  EXPECT_LT(distance_between(round.filter().believed().map_from_robot, round.truth()), 0.03);
}

TEST(OffsetFilter, FindsTheErrorOfTheMount) {
  Round round{{0.015, -0.01, radians(0.5)}};
  round.drive(16);
  EXPECT_NEAR(round.filter().calibration().mount_error.x, 0.015, 0.01);
  EXPECT_NEAR(round.filter().calibration().mount_error.y, -0.01, 0.01);
  EXPECT_NEAR(round.filter().calibration().mount_error.theta, radians(0.5), radians(0.15));
  EXPECT_LT(distance_between(round.filter().believed().map_from_robot, round.truth()), 0.03);
}

TEST(OffsetFilter, KnowsWhatCellsLeaveOpenHoweverOftenTheyAreSeen) {
  const double of_a_wall_m2 = std::pow(0.29 * test::map_of(test::containers_in_order()).resolution_m(), 2);
  Round round{{}};
  EXPECT_TRUE(round.filter().unknown_of_cells().scattered.isZero()) << "nothing is followed yet";
  round.drive(8);
  const Eigen::Matrix2d after_two_rounds = round.filter().unknown_of_cells().scattered;
  round.drive(16);
  const Eigen::Matrix2d after_six = round.filter().unknown_of_cells().scattered;
  for (const Eigen::Matrix2d& unknown : {after_two_rounds, after_six}) {
    const Eigen::Vector2d variances = unknown.selfadjointView<Eigen::Lower>().eigenvalues();
    EXPECT_GT(variances.minCoeff(), of_a_wall_m2 / 32.0) << "as many surfaces as are followed at most";
    EXPECT_LE(variances.maxCoeff(), 1.001 * of_a_wall_m2) << "one is enough to tell of a direction";
  }
  EXPECT_NEAR(after_six.trace(), after_two_rounds.trace(), 0.5 * after_two_rounds.trace());
}

TEST(SurfaceTracker, TellsNoPoseSurerThanTheCellsOfTheMap) {
  Drive drive{test::containers_in_order(), true};
  for (int i = 0; i < 40; ++i) drive.go(0.0, radians(90.0));
  const double of_a_wall_m = 0.29 * test::map_of(test::containers_in_order()).resolution_m();
  EXPECT_GT(std::sqrt(drive.estimate().covariance(0, 0)), of_a_wall_m / 4.0) << "ten turns at one place";
  EXPECT_LE(drive.estimate().noise_covariance()(0, 0), drive.estimate().covariance(0, 0));
  EXPECT_GT(std::sqrt(drive.estimate().covariance(1, 1)), of_a_wall_m / 4.0);
}

/// What walls that are off alike leave open, a few scans after the start, when no surface is followed yet.
Eigen::Matrix2d told_as_a_bias_at_first(bool know_surfaces) {
  Drive drive{test::containers_in_order(), know_surfaces};
  drive.go(0.2, 0.0);
  return drive.estimate().bias_covariance.topLeftCorner<2, 2>();
}

TEST(SurfaceTracker, TellsWhatCellsLeaveOpenWhileTheParticlesLead) {
  const double of_a_wall_m = 0.29 * test::map_of(test::containers_in_order()).resolution_m();
  EXPECT_GT(std::sqrt(told_as_a_bias_at_first(true).trace()), 0.5 * of_a_wall_m);
  EXPECT_LT(std::sqrt(told_as_a_bias_at_first(true).trace()), 2.0 * of_a_wall_m);
  EXPECT_TRUE(told_as_a_bias_at_first(false).isZero()) << "without surfaces nobody knows";
}

}  // namespace
}  // namespace deltamap::localization::surfaces
