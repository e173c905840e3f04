// SPDX-License-Identifier: Apache-2.0
#include "localization/sensor/weighing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/random.hpp"
#include "tests/support/worlds/drawn_grid.hpp"

namespace deltamap::localization::sensor {
namespace {

const OccupancyGrid kMap = test::drawn_grid({"##########",  //
                                             "#........#",  //
                                             "#........#",  //
                                             "#....#...#",  //
                                             "#........ ",  //
                                             "######### "},
                                            0.1, {-0.3, 0.2});

motion::BeamEnds random_ends(std::size_t count, Random& random) {
  motion::BeamEnds ends;
  for (std::size_t i = 0; i < count; ++i) {
    ends.x_m.push_back(static_cast<float>(random.uniform(-1.5, 1.5)));
    ends.y_m.push_back(static_cast<float>(random.uniform(-1.5, 1.5)));
  }
  return ends;
}

TEST(Weighing, SumsTheFieldUnderEachEnd) {
  const LikelihoodField field{kMap, {}};
  Random random{2};
  for (const std::size_t count : {0u, 1u, 63u, 64u, 65u, 181u, 400u}) {
    const motion::BeamEnds ends = random_ends(count, random);
    const Pose2 pose{random.uniform(-0.3, 0.7), random.uniform(0.2, 0.8), random.uniform(-3.0, 3.0)};
    std::int32_t expected = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const Point2 end{static_cast<double>(ends.x_m[i]), static_cast<double>(ends.y_m[i])};
      expected += field.steps_at(kMap.geometry().cell_at(pose * end));
    }
    // An end on a cell's border may fall to either side in single precision: rare, and here none does.
    EXPECT_EQ(misfit_steps(field, ends, pose), expected);
  }
}

TEST(Weighing, BoundsWhatEachSegmentCounts) {
  const LikelihoodField field{kMap, {}};
  Random random{2};
  const motion::BeamEnds ends = random_ends(150, random);
  const std::vector<ScanSegment> segments{{0, 1}, {1, 40}, {50, 63}, {63, 64}, {64, 65}, {66, 129}, {130, 150}};
  const Pose2 pose{0.2, 0.5, 0.4};
  for (const std::int32_t most : {0, 300, 2000, 1'000'000}) {
    std::int32_t beyond = 0;
    for (const ScanSegment& segment : segments) {
      motion::BeamEnds part;
      for (std::size_t i = segment.first; i < segment.past; ++i) {
        part.x_m.push_back(ends.x_m[i]);
        part.y_m.push_back(ends.y_m[i]);
      }
      beyond += std::max(0, misfit_steps(field, part, pose) - most);
    }
    const SegmentedMisfit misfit = segmented_misfit(field, ends, segments, most, pose);
    EXPECT_EQ(misfit.all, misfit_steps(field, ends, pose));
    EXPECT_EQ(misfit.bounded, misfit.all - beyond) << most;
  }
}

TEST(Weighing, TakesEndsFarOutsideAsUnknown) {
  const LikelihoodField field{kMap, {}};
  const motion::BeamEnds ends{{1e6F, -1e6F, 0.0F}, {0.0F, -1e6F, 1e9F}};
  EXPECT_EQ(misfit_steps(field, ends, {}), 3 * field.steps_at({-1000, -1000}));
}

TEST(Weighing, IsTheGeometricMeanOfTheLikelihoodsAndIndependentOfTheirNumber) {
  EXPECT_DOUBLE_EQ(mean_likelihood(0, 5), 1.0);
  EXPECT_DOUBLE_EQ(mean_likelihood(64, 1), std::exp(-1.0));
  EXPECT_DOUBLE_EQ(mean_likelihood(6400, 100), std::exp(-1.0));
}

TEST(Weighing, CountsTheShareOfEndsThatTheMapExplains) {
  const LikelihoodField field{kMap, {}};
  const motion::BeamEnds ends{{0.25F, 0.25F, -0.05F, -0.05F},
                              {0.25F, 0.55F, 0.25F, 0.35F}};  // pillar, wall, two in free space
  EXPECT_DOUBLE_EQ(explained_share(field, ends, {0.0, 0.2, 0.0}), 0.5);
  EXPECT_DOUBLE_EQ(explained_share(field, {}, {}), 0.0);
}

}  // namespace
}  // namespace deltamap::localization::sensor
