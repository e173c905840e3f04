// SPDX-License-Identifier: Apache-2.0
// A robot drives through a drawn room whose map has another scale than its ranges, or the same.
#include "localization/sensor/range_scale.hpp"

#include <gtest/gtest.h>

#include "tests/support/scans/cast_ends.hpp"
#include "tests/support/worlds/pillar_room.hpp"

namespace deltamap::localization::sensor {
namespace {

const Point2 kLaser{0.1, 0.0};

/// Ranges are `factor` of what they should be; of `strangers` in ten beams something stands in the way.
RangeScale scale_after(double way_m, double factor, std::size_t strangers = 0) {
  const OccupancyGrid map = test::pillar_room();
  const LikelihoodField field{map, {}};
  RangeScale scale;
  constexpr double kStepM = 0.05;
  for (double driven_m = 0.0; driven_m < way_m; driven_m += kStepM) {
    const double angle = driven_m / 1.2;
    const Pose2 truth{3.0 + 1.2 * std::cos(angle), 2.0 + 0.6 * std::sin(angle), angle + 1.57};
    motion::BeamEnds ends = test::cast_ends(map, truth, {.noise_m = 0.005});
    for (std::size_t i = 0; i < ends.size(); ++i) {
      const double share = factor * (i % 10 < strangers ? 0.6 : 1.0);
      ends.x_m[i] = static_cast<float>(kLaser.x() + share * (ends.x_m[i] - kLaser.x()));
      ends.y_m[i] = static_cast<float>(kLaser.y() + share * (ends.y_m[i] - kLaser.y()));
    }
    const Pose2 believed = truth * Pose2{factor == 1.0 ? 0.0 : 0.2, 0.1 * (1.0 - factor), 0.0};
    scale.observe(field, ends, kLaser, believed, kStepM);
  }
  return scale;
}

std::optional<OtherScale> shown_after(double way_m, double factor, std::size_t strangers = 0) {
  return scale_after(way_m, factor, strangers).shown();
}

TEST(RangeScale, NamesTheFactorThatExplainsMore) {
  for (const auto& [factor, right] : {std::pair{0.9, 1.1}, {1.1, 0.9}, {1.25, 0.8}, {0.8, 1.25}}) {
    const auto shown = shown_after(30.0, factor);
    ASSERT_TRUE(shown) << factor;
    EXPECT_NEAR(shown->factor, right, 0.06) << "ends within a cell or two are alike";
    EXPECT_GT(shown->explained, shown->explained_as_is);
  }
}

TEST(RangeScale, SaysNothingOfRangesThatAreRight) { EXPECT_FALSE(shown_after(60.0, 1.0)); }

TEST(RangeScale, SaysNothingWhereMuchStandsInTheWay) {
  EXPECT_FALSE(shown_after(60.0, 1.0, 3));
  EXPECT_FALSE(shown_after(60.0, 1.0, 6));
}

TEST(RangeScale, SaysNothingBeforeEnoughScansHaveShownIt) { EXPECT_FALSE(shown_after(15.0, 0.9)); }

TEST(RangeScale, LooksNoLongerOnceAFactorIsNamedOrRangesHaveProvenRight) {
  EXPECT_TRUE(scale_after(30.0, 0.9).is_settled());
  EXPECT_FALSE(scale_after(60.0, 1.0).is_settled());
  EXPECT_TRUE(scale_after(80.0, 1.0).is_settled());
}

TEST(RangeScale, GoesOnLookingWhereTheRangesAsTheyAreExplainLittle) {
  EXPECT_FALSE(scale_after(90.0, 1.0, 6).is_settled());
}

}  // namespace
}  // namespace deltamap::localization::sensor
