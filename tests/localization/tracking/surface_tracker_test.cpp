// SPDX-License-Identifier: Apache-2.0
#include "localization/tracking/surface_tracker.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "core/random.hpp"
#include "tests/support/scans/cast_scan.hpp"

namespace deltamap::localization::tracking {
namespace {

constexpr double kLengthM = 60.0;

/// A corridor 3 m wide with a box on alternate sides each 2 m. From `moved_from_m` on each wall and each box stands
/// elsewhere, by up to 0.3 m.
OccupancyGrid corridor(double resolution_m, double shrunk_m, double moved_from_m) {
  const auto cells = [&](double length_m) { return static_cast<int>(std::lround(length_m / resolution_m)); };
  OccupancyGrid world{{cells(kLengthM + 1.0), cells(5.0), resolution_m, {-0.5, -1.0}}, CellState::kOccupied};
  const Point2 shrunk = Point2::Constant(shrunk_m);
  const double moved_m = std::min(moved_from_m, kLengthM);
  test::fill_box(world, -shrunk, Point2{moved_m, 3.0} + shrunk, CellState::kFree);
  test::fill_box(world, Point2{moved_m - 0.1, 0.2} - shrunk, Point2{kLengthM, 2.75} + shrunk, CellState::kFree);
  for (int i = 0; i < 29; ++i) {
    const double off_m = 2.0 * i + 1.5 > moved_from_m ? 0.1 * (i % 3 + 1) * (i % 2 == 0 ? 1.0 : -1.0) : 0.0;
    const Point2 low{2.0 * i + 1.5 + off_m, i % 2 == 0 ? -0.5 : 2.2 + 0.5 * std::abs(off_m)};
    test::fill_box(world, low + shrunk, low + Point2{0.8, 1.3} - shrunk, CellState::kOccupied);
  }
  return world;
}

/// A robot that follows the corridor by surfaces alone; its wheels are right.
class CorridorDrive {
 public:
  explicit CorridorDrive(double moved_from_m)
      : world_{corridor(0.005, 0.025, moved_from_m)},
        map_{std::make_shared<const OccupancyGrid>(corridor(0.05, 0.0, kLengthM))},
        field_{*map_, {}},
        tracker_{{}, {}, 60.0, map_} {}

  void go_to(double x_m) {
    while (truth_.x < x_m) {
      truth_.x += 0.1;
      odom_.x += 0.1;
      observe();
    }
  }
  /// It stands, and its wheels say nothing.
  void stand_without_wheels(int scans) {
    for (int i = 0; i < scans; ++i) observe(std::nullopt);
  }
  void be_carried(const Pose2& robot_from_there) { truth_ = truth_ * robot_from_there; }
  [[nodiscard]] const SurfaceTracker& tracker() const { return tracker_; }
  [[nodiscard]] double error_m() const { return distance_between(truth_, believed_.map_from_robot); }

 private:
  void observe() { observe(motion::OdometryAt{odom_, 0, odom_}); }
  void observe(const std::optional<motion::OdometryAt>& odometry) {
    const Scan scan = test::cast_scan(world_, truth_, timestamp_from_ns(++scans_ * 100'000'000),
                                      {.max_range_m = 8.0, .beams = 361}, random_);
    const std::vector<RayInRobot> rays = motion::deskewed(scan, {});
    surfaces::FaceFinder faces;
    faces.begin(scan, rays);
    motion::BeamEnds ends;
    for (const surfaces::FacedEnd& end : faces.faces().ends) {
      ends.x_m.push_back(static_cast<float>(end.at.x()));
      ends.y_m.push_back(static_cast<float>(end.at.y()));
    }
    const motion::ScanInstant now{scan.time, odometry};
    const SeenScan seen{.now = now, .ends = ends, .field = field_, .faces = faces, .velocity = {1.0, 0.0}};
    const sensor::RefinedPose start{truth_, Eigen::Vector3d{1e-4, 1e-4, 1e-5}.asDiagonal().toDenseMatrix()};
    believed_ = tracker_.leads() ? tracker_.observe(seen) : tracker_.lead_from(start, seen);
  }

  OccupancyGrid world_;
  std::shared_ptr<const OccupancyGrid> map_;
  sensor::LikelihoodField field_;
  SurfaceTracker tracker_;
  sensor::RefinedPose believed_;
  Pose2 truth_{0.5, 1.5, 0.0};
  Pose2 odom_;
  std::int64_t scans_ = 0;
  Random random_{7};
};

TEST(SurfaceTracker, HoldsThePoseForSomeMetresWhileAllThatItFollowsWasMoved) {
  CorridorDrive drive{12.0};
  drive.go_to(11.0);
  EXPECT_TRUE(drive.tracker().is_fixed_by_surfaces());
  drive.go_to(20.0);
  EXPECT_TRUE(drive.tracker().is_fixed_by_surfaces());
  EXPECT_LT(drive.error_m(), 0.1);
  drive.go_to(40.0);
  EXPECT_FALSE(drive.tracker().is_fixed_by_surfaces()) << "for kForgottenAfterM, no longer";
}

TEST(SurfaceTracker, LeadsOnWhileTheWheelsAreSilent) {
  CorridorDrive drive{kLengthM};
  drive.go_to(5.0);
  drive.stand_without_wheels(20);
  EXPECT_TRUE(drive.tracker().leads());
  EXPECT_LT(drive.error_m(), 0.05);
}

TEST(SurfaceTracker, HoldsThePoseNoLongerWhereWhatItFollowsIsNotWhereItWas) {
  CorridorDrive drive{kLengthM};
  drive.go_to(11.0);
  EXPECT_TRUE(drive.tracker().is_fixed_by_surfaces());
  drive.be_carried({7.0, 0.5, radians(40.0)});
  drive.go_to(18.6);
  EXPECT_FALSE(drive.tracker().is_fixed_by_surfaces());
}

}  // namespace
}  // namespace deltamap::localization::tracking
