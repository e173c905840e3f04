// SPDX-License-Identifier: Apache-2.0
#include "simulation/world/ray_caster.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/random.hpp"

namespace deltamap::simulation {
namespace {

constexpr double kExact = 1e-9;

World room_with(std::vector<Object> objects) {
  objects.push_back({1, ObjectKind::kWall, Polyline{{{0, 0}, {20, 0}, {20, 10}, {0, 10}, {0, 0}}}});
  return {objects};
}

TEST(RayCaster, MeetsAWallAtTheAnalyticDistanceForEveryBearing) {
  const RayCaster caster{room_with({})};
  const Point2 from{7.3, 4.1};
  for (int degree = 0; degree < 360; degree += 7) {
    const double bearing = radians(degree + 0.3);
    const double to_x = std::cos(bearing) > 0 ? (20 - from.x()) / std::cos(bearing) : -from.x() / std::cos(bearing);
    const double to_y = std::sin(bearing) > 0 ? (10 - from.y()) / std::sin(bearing) : -from.y() / std::sin(bearing);
    const auto hit = caster.cast(from, bearing, 80.0);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->range_m, std::min(to_x, to_y), kExact) << degree;
    EXPECT_EQ(hit->object, 1);
  }
}

TEST(RayCaster, MeetsACircleAtTheAnalyticDistance) {
  const RayCaster caster{room_with({{7, ObjectKind::kPost, Circle{{10, 5}, 0.5}}})};
  const auto centred = caster.cast({4, 5}, 0.0, 80.0);
  ASSERT_TRUE(centred);
  EXPECT_NEAR(centred->range_m, 5.5, kExact);
  EXPECT_EQ(centred->object, 7);
  const auto off_centre = caster.cast({4, 5.3}, 0.0, 80.0);
  ASSERT_TRUE(off_centre);
  EXPECT_NEAR(off_centre->range_m, 6.0 - std::sqrt(0.25 - 0.09), kExact);
  EXPECT_NEAR(caster.cast({4, 5.6}, 0.0, 80.0)->range_m, 16.0, kExact) << "passes beside it";
}

TEST(RayCaster, TellsWhichFaceOfATurnedBoxIsHit) {
  const Box box{{10, 5}, 2.0, 1.0, radians(90)};  // its own x points up
  const RayCaster caster{room_with({{3, ObjectKind::kContainer, box}})};
  const auto from_left = caster.cast({4, 5}, 0.0, 80.0);
  ASSERT_TRUE(from_left);
  EXPECT_NEAR(from_left->range_m, 5.5, kExact);
  EXPECT_EQ(from_left->face, 2) << "the face at its own +y";
  const auto from_below = caster.cast({10, 1}, std::numbers::pi / 2, 80.0);
  ASSERT_TRUE(from_below);
  EXPECT_NEAR(from_below->range_m, 3.0, kExact);
  EXPECT_EQ(from_below->face, 3) << "the face at its own -x";
}

TEST(RayCaster, SeesNothingBeyondItsRangeAndPeopleBeforeWalls) {
  const RayCaster caster{room_with({})};
  EXPECT_FALSE(caster.cast({10, 5}, 0.0, 9.9));
  EXPECT_TRUE(caster.cast({10, 5}, 0.0, 10.1));
  const std::vector<Circle> people{{{15, 5}, 0.25}};
  const auto hit = caster.cast({10, 5}, 0.0, 80.0, {.round = people});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->object, kMoverId);
  EXPECT_NEAR(hit->range_m, 4.75, kExact);
}

TEST(RayCaster, AnswersAsATestOfEverySurfaceWould) {
  Random random{5};
  std::vector<Object> objects;
  for (int id = 2; id < 60; ++id) {
    objects.push_back({id, ObjectKind::kContainer,
                       Box{{random.uniform(1, 19), random.uniform(1, 9)},
                           random.uniform(0.1, 0.8),
                           random.uniform(0.1, 0.8),
                           random.uniform(-3, 3)}});
  }
  const World world = room_with(objects);
  const RayCaster caster{world};
  for (int i = 0; i < 300; ++i) {
    const Point2 from{random.uniform(0.1, 19.9), random.uniform(0.1, 9.9)};
    const double bearing = random.uniform(-3.1, 3.1);
    double nearest = 1e9;
    for (const Object& object : world.objects) {
      // One object alone in a caster has but one surface near: the buckets cannot hide any.
      for (const Segment& piece : segments_of(object.shape)) {
        const RayCaster alone{{{{object.id, object.kind, Polyline{{piece.from, piece.to}}}}}};
        if (const auto hit = alone.cast(from, bearing, 80.0)) nearest = std::min(nearest, hit->range_m);
      }
    }
    ASSERT_NEAR(caster.cast(from, bearing, 80.0)->range_m, nearest, kExact);
  }
}

TEST(RayCaster, FindsTheNearestSurfaceAndItsDirection) {
  const RayCaster caster{room_with({})};
  const auto nearest = caster.nearest_surface({0.3, 4.0}, 0.5);
  ASSERT_TRUE(nearest);
  EXPECT_NEAR(nearest->distance_m, 0.3, kExact);
  EXPECT_NEAR(nearest->direction.x(), -1.0, kExact);
  EXPECT_FALSE(caster.nearest_surface({5.0, 4.0}, 0.5));
}

TEST(Shapes, OverlapOnlyWhereTheyShareArea) {
  const Box box{{0, 0}, 2, 2, 0};
  EXPECT_TRUE(overlap(box, Box{{1.9, 0}, 2, 2, 0}));
  EXPECT_FALSE(overlap(box, Box{{2.0, 0}, 2, 2, 0})) << "touching";
  EXPECT_FALSE(overlap(box, Box{{2.2, 0}, 1, 1, radians(45)})) << "a corner that does not reach";
  EXPECT_TRUE(overlap(box, Box{{1.6, 0}, 1, 1, radians(45)}));
  EXPECT_TRUE(overlap(box, Shape{Circle{{1.2, 0}, 0.3}}));
  EXPECT_FALSE(overlap(box, Shape{Circle{{1.4, 1.4}, 0.5}})) << "near the corner but beside it";
  EXPECT_TRUE(overlap(box, Shape{Polyline{{{-3, 0.5}, {3, 0.5}}}}));
  EXPECT_FALSE(overlap(box, Shape{Polyline{{{-3, 1.5}, {3, 1.5}}}}));
}

}  // namespace
}  // namespace deltamap::simulation
