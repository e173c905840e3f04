// SPDX-License-Identifier: Apache-2.0
#include "navigation/borders_in_reach.hpp"

#include <gtest/gtest.h>

namespace deltamap::navigation {
namespace {

const Zone kBlocked{
    .id = "B", .kind = ZoneKind::kBlocked, .polygon = {{2.0, -50.0}, {60.0, -50.0}, {60.0, 50.0}, {2.0, 50.0}}};

TEST(BordersInReach, AreNamedAndOnlyThoseOnBothSidesLeaveNoWay) {
  const Zone behind{.id = "A", .kind = ZoneKind::kBlocked, .polygon = {{-3.0, -5.0}, {-0.2, -5.0}, {-0.2, 5.0}}};
  EXPECT_TRUE(borders_in_reach({kBlocked}, {1.5, 0.0}, 0.34).ids.empty());
  const BordersInReach one = borders_in_reach({kBlocked}, {1.8, 0.0}, 0.34);
  EXPECT_EQ(one.ids, std::vector<std::string>{"B"});
  EXPECT_TRUE(one.leave_a_way) << "back";
  EXPECT_TRUE(borders_in_reach({kBlocked}, {2.1, 0.0}, 0.34).ids.empty()) << "it stands in it, and may leave";
  const Zone before{
      .id = "C", .kind = ZoneKind::kBlocked, .polygon = {{0.2, -5.0}, {3.0, -5.0}, {3.0, 5.0}, {0.2, 5.0}}};
  const BordersInReach both = borders_in_reach({behind, before}, {0.0, 4.0}, 0.34);
  EXPECT_EQ(both.ids, (std::vector<std::string>{"A", "C"}));
  EXPECT_FALSE(both.leave_a_way) << "along the one, points of the other come nearer";
}

}  // namespace
}  // namespace deltamap::navigation
