// SPDX-License-Identifier: Apache-2.0
#include "localization/hypotheses/image_watch.hpp"

#include <gtest/gtest.h>

#include "tests/support/symmetric_hall.hpp"

namespace deltamap::localization::hypotheses {
namespace {

const Pose2 kMotion{0.1, 0.0, 0.1};  // of each scan: round a circle of 1 m

/// A robot that drives in circles and knows where it is; the watch beside it.
class WatchedRound {
 public:
  WatchedRound(const OccupancyGrid& map, const OccupancyGrid& world)
      : world_{world}, field_{map, {}}, coarse_{map, field_, 0.25} {}

  void step() {
    truth_ = truth_ * kMotion;
    watch_.carry(kMotion);
    const Scan scan = test::cast_scan(world_, truth_, {}, {}, random_);
    const motion::BeamEnds ends = motion::scoring_ends(scan, motion::deskewed(scan, {}), 60);
    watch_.observe({.field = field_,
                    .coarse = coarse_,
                    .ends = ends,
                    .near_ends = ends,
                    .map_from_believed = truth_,
                    .joined_from_robot = truth_,
                    .stack = stack_},
                   {});
    stack_.add(ends, truth_);
  }
  [[nodiscard]] std::span<const Place> images() const { return watch_.places().rivals(); }

 private:
  const OccupancyGrid& world_;
  Pose2 truth_{6.0, 4.0, 0.0};
  Random random_{2};
  sensor::LikelihoodField field_;
  sensor::CoarseField coarse_;
  ScanStack stack_;
  ImageWatch watch_{{}, {.prior = 0.003}};
};

TEST(ImageWatch, HoldsImagesForAsUnlikelyAsThatSomebodyCarriesRobots) {
  const OccupancyGrid map = test::symmetric_hall();
  WatchedRound round{map, map};
  for (int i = 0; i < 60; ++i) round.step();
  ASSERT_FALSE(round.images().empty());
  for (const Place& image : round.images()) EXPECT_DOUBLE_EQ(image.log_prior, std::log(0.003));
}

}  // namespace
}  // namespace deltamap::localization::hypotheses
