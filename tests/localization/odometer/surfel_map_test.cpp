// SPDX-License-Identifier: Apache-2.0
#include "localization/odometer/surfel_map.hpp"

#include <gtest/gtest.h>

namespace deltamap::localization::odometer {
namespace {

const LinePoint kAhead{{2.0F, 0.0F}, {-1.0F, 0.0F}};

TEST(SurfelMap, KnowsWhatWasSeenFarFromItsOriginToo) {
  for (const double far_m : {0.0, 10000.0}) {
    SurfelMap map;
    map.insert(std::vector{kAhead}, {far_m, 0.0, 0.0});
    const NearSurfel near = map.near({far_m + 2.05, 0.02}, {-1.0F, 0.0F}, 0.4F);
    ASSERT_NE(near.surfel, nullptr) << far_m;
    EXPECT_NEAR(near.off_m, -0.05F, 1e-4F) << far_m;
  }
}

TEST(SurfelMap, KeepsBothFacesOfAThinWallApart) {
  SurfelMap map;
  map.insert(std::vector{kAhead, LinePoint{{2.02F, 0.0F}, {1.0F, 0.0F}}}, {});
  EXPECT_NEAR(map.near({2.0, 0.0}, {-1.0F, 0.0F}, 0.4F).off_m, 0.0F, 1e-4F);
  EXPECT_NEAR(map.near({2.0, 0.0}, {1.0F, 0.0F}, 0.4F).off_m, -0.02F, 1e-4F);
}

TEST(SurfelMap, TakesTheMeanOfWhatScansSee) {
  SurfelMap map;
  for (const float x : {2.09F, 2.11F, 2.10F, 2.10F}) map.insert(std::vector{LinePoint{{x, 0.1F}, {-1.0F, 0.0F}}}, {});
  EXPECT_NEAR(map.near({2.1, 0.1}, {-1.0F, 0.0F}, 0.4F).off_m, 0.0F, 1e-3F);
}

TEST(SurfelMap, ForgetsWhatLiesMetresBack) {
  SurfelMap map;
  map.insert(std::vector{kAhead}, {});
  map.go_on(7.9, 20.0);
  EXPECT_NE(map.near({2.0, 0.0}, {-1.0F, 0.0F}, 0.4F).surfel, nullptr);
  map.go_on(8.1, 21.0);
  EXPECT_EQ(map.near({2.0, 0.0}, {-1.0F, 0.0F}, 0.4F).surfel, nullptr);
}

TEST(SurfelMap, TellsYoungSurfelsAndForgetsThemOnOrder) {
  SurfelMap map;
  map.insert(std::vector{kAhead}, {});
  map.go_on(0.5, 2.0);
  map.insert(std::vector{LinePoint{{0.0F, 3.0F}, {0.0F, -1.0F}}}, {});
  EXPECT_FALSE(map.is_young(*map.near({2.0, 0.0}, {-1.0F, 0.0F}, 0.4F).surfel));
  EXPECT_TRUE(map.is_young(*map.near({0.0, 3.0}, {0.0F, -1.0F}, 0.4F).surfel));
  map.forget_since(1.0);
  EXPECT_EQ(map.near({0.0, 3.0}, {0.0F, -1.0F}, 0.4F).surfel, nullptr);
  EXPECT_NE(map.near({2.0, 0.0}, {-1.0F, 0.0F}, 0.4F).surfel, nullptr);
}

}  // namespace
}  // namespace deltamap::localization::odometer
