// SPDX-License-Identifier: Apache-2.0
#include "localization/surfaces/surface_sighting.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "core/random.hpp"
#include "localization/motion/deskew.hpp"
#include "tests/support/worlds/container_hall.hpp"

namespace deltamap::localization::surfaces {
namespace {

constexpr double kRangesErrM = 0.02;

/// A laser in the aisle between the rows of containers; the hall is as its map has it.
class Aisle {
 public:
  Aisle()
      : map_{std::make_shared<const OccupancyGrid>(test::map_of(test::containers_in_order()))},
        world_{test::world_of(test::containers_in_order())},
        field_{*map_, {}},
        surfaces_{map_} {}

  /// What is seen from `truth`, taken for a scan from `believed`.
  std::span<const Sighting> seen(const Pose2& truth, const Pose2& believed) {
    const Scan scan = test::cast_scan(world_, truth, {}, {.max_range_m = 8.0}, random_);
    const std::vector<RayInRobot> rays = motion::deskewed(scan, {});
    ends_ = faced_ends(scan, rays, std::move(ends_));
    corners_ = corners_of(scan, rays, std::move(corners_));
    return finder_.find(surfaces_, field_, {ends_, corners_, kRangesErrM}, believed, [](const SurfaceRecord& record) {
      return SurfacePlace{record.offset_m, 0.0, 0.02};
    });
  }

 private:
  std::shared_ptr<const OccupancyGrid> map_;
  OccupancyGrid world_;
  sensor::LikelihoodField field_;
  SurfaceMap surfaces_;
  SightingFinder finder_;
  std::vector<FacedEnd> ends_;
  std::vector<Corner> corners_;
  Random random_{3};
};

/// Of the container beside the robot, the face around its far corner.
bool is_around_the_corner(const Sighting& sighting) {
  return sighting.surface.normal.x() > 0.9 && std::abs(sighting.surface.centre.x() - 5.0) < 0.1;
}

TEST(SurfaceSighting, TellsOfFacesAndCornersHowFarRangesErr) {
  Aisle aisle;
  const Pose2 truth{3.5, 4.25, 0.0};
  int corners = 0;
  int faces = 0;
  for (const Sighting& sighting : aisle.seen(truth, truth)) {
    EXPECT_EQ(sighting.range_deviation_m, kRangesErrM);
    ++(sighting.corner_deviation_m > 0.0 ? corners : faces);
  }
  EXPECT_GT(corners, 0);
  EXPECT_GT(faces, 0);
}

TEST(SurfaceSighting, SeesAFaceThatNoBeamMeetsByItsCorner) {
  Aisle aisle;
  const Pose2 truth{3.5, 4.25, 0.0};
  for (const double ahead_m : {0.0, 0.2, -0.3}) {
    int corners = 0;
    for (const Sighting& sighting : aisle.seen(truth, truth * Pose2{ahead_m, 0.0, 0.0})) {
      if (!is_around_the_corner(sighting)) continue;
      ++corners;
      EXPECT_GT(sighting.corner_deviation_m, 0.0);
      const Sighting::Measured measured = sighting.measured(truth * Pose2{ahead_m, 0.0, 0.0});
      EXPECT_NEAR(measured.distance_m, ahead_m, 2.0 * sighting.corner_deviation_m + 0.03) << ahead_m;
    }
    EXPECT_EQ(corners, 2) << "the containers to the left and to the right, believed ahead by " << ahead_m;
  }
}

TEST(SurfaceSighting, TrustsBeamsOnAFaceRatherThanItsCorner) {
  Aisle aisle;
  const Pose2 behind_the_containers{6.5, 4.25, radians(180.0)};
  int faces = 0;
  for (const Sighting& sighting : aisle.seen(behind_the_containers, behind_the_containers)) {
    if (!is_around_the_corner(sighting)) continue;
    ++faces;
    EXPECT_EQ(sighting.corner_deviation_m, 0.0);
    EXPECT_GE(sighting.beams, 3.0);
  }
  EXPECT_GE(faces, 2);
}

TEST(SurfaceSighting, TakesTheEndOfAMappedWallForNoOtherWallNearby) {
  // The wall at y = 2 ends at a door, at x = 3; another one meets it 0.8 m before.
  const auto room = [](double resolution_m, double half_m) {
    const auto cells = [&](double length_m) { return static_cast<int>(std::lround(length_m / resolution_m)); };
    OccupancyGrid map{{cells(7.0), cells(6.0), resolution_m, {-0.5, -0.5}}, CellState::kFree};
    test::fill_box(map, {0.0, 2.0 - half_m}, {3.0, 2.0 + half_m}, CellState::kOccupied);
    test::fill_box(map, {2.2 - half_m, 2.0}, {2.2 + half_m, 5.0}, CellState::kOccupied);
    return map;
  };
  const auto map = std::make_shared<const OccupancyGrid>(room(0.05, 0.03));
  const sensor::LikelihoodField field{*map, {}};
  SurfaceMap surfaces{map};
  SightingFinder finder;
  Random random{5};
  const Pose2 pose{1.0, 0.5, radians(45.0)};
  const Scan scan = test::cast_scan(room(0.01, 0.025), pose, {}, {.max_range_m = 8.0}, random);
  const std::vector<RayInRobot> rays = motion::deskewed(scan, {});
  const std::vector<FacedEnd> ends = faced_ends(scan, rays);
  const std::vector<Corner> corners = corners_of(scan, rays);
  ASSERT_FALSE(corners.empty());
  for (const Sighting& sighting : finder.find(surfaces, field, {ends, corners}, pose, [](const SurfaceRecord&) {
         return SurfacePlace{0.0, 0.0, 0.5};
       })) {
    EXPECT_EQ(sighting.corner_deviation_m, 0.0) << sighting.surface.centre.transpose();
  }
}

/// Beams on a face that stands across the x axis, seen from the origin so far off its place in the map.
Sighting sighting_of(const Point2& centre, double off_m) {
  return {.id = {},
          .surface = {.centre = centre, .normal = {-1.0, 0.0}, .half_length_m = 0.9, .offset_deviation_m = 0.03},
          .beams = 5.0,
          .mean = centre - off_m * Point2{1.0, 0.0},
          .scatter = Eigen::Vector2d{0.0, 1.0}.asDiagonal()};
}

TEST(SupportingFaces, CountThePiecesOfOneFaceAsOneObservation) {
  const std::vector<Sighting> seen{sighting_of({4.0, 0.0}, 0.02), sighting_of({4.0, 2.0}, 0.01),
                                   sighting_of({6.0, 9.0}, 0.0)};
  const std::vector<SupportingFace> faces = supporting_faces(seen, {}, 0.08);
  ASSERT_EQ(faces.size(), 3U);
  EXPECT_DOUBLE_EQ(faces[0].weight, 0.5);
  EXPECT_DOUBLE_EQ(faces[1].weight, 0.5);
  EXPECT_DOUBLE_EQ(faces[2].weight, 1.0);
  EXPECT_NEAR(faces[0].off_m, 0.02, 1e-12);
}

TEST(SupportingFaces, AreNoneThatWereMovedAndNoCorners) {
  std::vector<Sighting> seen{sighting_of({4.0, 0.0}, 0.3), sighting_of({6.0, 9.0}, 0.01)};
  seen.back().corner_deviation_m = 0.02;
  EXPECT_TRUE(supporting_faces(seen, {}, 0.08).empty());
}

}  // namespace
}  // namespace deltamap::localization::surfaces
