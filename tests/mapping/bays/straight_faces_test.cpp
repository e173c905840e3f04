// SPDX-License-Identifier: Apache-2.0
#include "mapping/bays/straight_faces.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/geometry/angle.hpp"
#include "core/random.hpp"

namespace deltamap::mapping::bays {
namespace {

constexpr double kNoise_m = 0.015;

/// Ends of beams of 1° on a line from `from` to `to`, seen from the origin.
std::vector<Point2> ends_on(const Point2& from, const Point2& to, Random& random) {
  const double first_rad = std::atan2(from.y(), from.x());
  const double last_rad = std::atan2(to.y(), to.x());
  const double turn = first_rad < last_rad ? 1.0 : -1.0;
  std::vector<Point2> ends;
  for (int i = 0; i * radians(1.0) < std::abs(last_rad - first_rad); ++i) {
    const double bearing_rad = first_rad + turn * i * radians(1.0);
    const Point2 beam{std::cos(bearing_rad), std::sin(bearing_rad)};
    const Point2 side = to - from;
    const double range_m = (from.x() * side.y() - from.y() * side.x()) / (beam.x() * side.y() - beam.y() * side.x());
    ends.push_back((range_m + random.normal(kNoise_m)) * beam);
  }
  return ends;
}

/// Of people of 0.25 m radius who stand shoulder to shoulder across the view, `ahead_m` before the laser.
std::vector<Point2> ends_on_people(int people, double ahead_m, double turned_rad, Random& random) {
  constexpr double kRadius_m = 0.25;
  std::vector<Point2> ends;
  for (double bearing_rad = -0.5; bearing_rad < 0.5; bearing_rad += radians(1.0)) {
    const Point2 beam{std::cos(bearing_rad), std::sin(bearing_rad)};
    double nearest_m = HUGE_VAL;
    for (int i = 0; i < people; ++i) {
      const double along_m = (2.0 * i - (people - 1)) * kRadius_m;
      const Point2 middle{ahead_m + along_m * std::sin(turned_rad), along_m * std::cos(turned_rad)};
      const double across_m = std::abs(beam.x() * middle.y() - beam.y() * middle.x());
      if (across_m >= kRadius_m) continue;
      nearest_m = std::min(nearest_m, middle.dot(beam) - std::sqrt(kRadius_m * kRadius_m - across_m * across_m));
    }
    if (std::isfinite(nearest_m)) ends.push_back((nearest_m + random.normal(kNoise_m)) * beam);
  }
  return ends;
}

TEST(StraightFaces, TheNarrowSideOfAPalletIsOneFromNearAndFar) {
  Random random{1};
  for (const double ahead_m : {2.0, 5.0, 8.0}) {
    int found = 0;
    for (int scan = 0; scan < 100; ++scan) {
      const auto ends = ends_on({ahead_m, -0.45}, {ahead_m + 0.2, 0.45}, random);
      const auto faces = straight_faces(ends);
      found += faces.size() == 1 && faces[0].last - faces[0].first == ends.size() ? 1 : 0;
    }
    EXPECT_GE(found, 85) << ahead_m;
  }
}

TEST(StraightFaces, PeopleSideBySideAreNone) {
  Random random{2};
  for (const int people : {1, 2, 3}) {
    int found = 0;
    for (int scan = 0; scan < 100; ++scan) {
      for (const double ahead_m : {2.0, 4.0, 7.0}) {
        const double turned_rad = random.uniform(-1.0, 1.0);
        found += straight_faces(ends_on_people(people, ahead_m, turned_rad, random)).empty() ? 0 : 1;
      }
    }
    EXPECT_LE(found, 6) << people << " people, of 300 scans";
  }
}

TEST(StraightFaces, ACornerIsTwoAndAGapParts) {
  Random random{3};
  std::vector<Point2> ends = ends_on({5.5, -1.2}, {4.5, 0.0}, random);
  const std::size_t corner = ends.size();
  for (const Point2& end : ends_on({4.5, 0.0}, {5.5, 1.2}, random)) ends.push_back(end);
  const auto faces = straight_faces(ends);
  ASSERT_EQ(faces.size(), 2u);
  EXPECT_NEAR(static_cast<double>(faces[0].last), static_cast<double>(corner), 2.0);

  ends = ends_on({5.0, -0.7}, {5.0, -0.2}, random);
  for (const Point2& end : ends_on({5.0, 0.2}, {5.0, 0.7}, random)) ends.push_back(end);
  EXPECT_TRUE(straight_faces(ends).empty()) << "each alone is as narrow as a person";
  EXPECT_TRUE(straight_faces({}).empty());
}

}  // namespace
}  // namespace deltamap::mapping::bays
