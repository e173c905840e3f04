// SPDX-License-Identifier: Apache-2.0
#include "mapping/scan_set/map_change.hpp"

#include <gtest/gtest.h>

#include <set>

namespace deltamap::mapping::scan_set {
namespace {

TEST(Refusal, HasANameOfItsOwn) {
  std::set<std::string_view> names;
  constexpr int kRefusals = static_cast<int>(Refusal::kSetByOperator) + 1;
  for (int i = 0; i < kRefusals; ++i) names.insert(name_of(static_cast<Refusal>(i)));
  EXPECT_EQ(names.size(), static_cast<std::size_t>(kRefusals));
  EXPECT_EQ(names.count("?"), 0u);
  EXPECT_EQ(name_of(Refusal::kPoseInDoubt), "pose in doubt");
}

TEST(Refusal, LeavesTheMapStaleUnlessItWasFoundRightOrSomebodyForbidsTheChange) {
  for (const Refusal none : {Refusal::kNone, Refusal::kNothingChanged, Refusal::kSetByOperator, Refusal::kZoned})
    EXPECT_FALSE(leaves_map_stale(none)) << name_of(none);
  for (const Refusal stale : {Refusal::kTooFewScans, Refusal::kNoAlignment, Refusal::kNoMerge, Refusal::kLowAcceptance,
                              Refusal::kImplausible, Refusal::kPoseInDoubt})
    EXPECT_TRUE(leaves_map_stale(stale)) << name_of(stale);
}

TEST(MapUpdate, IsAcceptedUnlessARefusalIsNamed) {
  EXPECT_TRUE(MapUpdate{}.accepted());
  MapUpdate update;
  update.refusal = Refusal::kNothingChanged;
  EXPECT_FALSE(update.accepted());
}

}  // namespace
}  // namespace deltamap::mapping::scan_set
