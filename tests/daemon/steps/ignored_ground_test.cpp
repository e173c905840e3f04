// SPDX-License-Identifier: Apache-2.0
#include "daemon/steps/ignored_ground.hpp"

#include <gtest/gtest.h>

#include "tests/support/worlds/drawn_grid.hpp"

namespace deltamap::daemon {
namespace {

const Zones kLeft{
    {.id = "left", .kind = ZoneKind::kIgnore, .polygon = {{0.0, 0.0}, {0.2, 0.0}, {0.2, 0.3}, {0.0, 0.3}}}};

std::shared_ptr<const OccupancyGrid> drawn(const std::vector<std::string>& rows) {
  return std::make_shared<const OccupancyGrid>(test::drawn_grid(rows, 0.1));
}

TEST(IgnoredGround, TheLocalizerKnowsNothingThere) {
  const IgnoredGround ground{kLeft, drawn({"#..#", ".#.#", "####"})};
  EXPECT_EQ(*ground.known(), test::drawn_grid({"??.#", "??.#", "??##"}, 0.1));
  EXPECT_EQ(*ground.whole(), *drawn({"#..#", ".#.#", "####"}));
}

TEST(IgnoredGround, WithoutSuchZonesThereIsOneMap) {
  const auto map = drawn({"#..#"});
  const IgnoredGround ground{{{.id = "B", .kind = ZoneKind::kBlocked, .polygon = kLeft[0].polygon}}, map};
  EXPECT_EQ(ground.known(), map);
}

TEST(IgnoredGround, OfARevisionTheLocalizerTakesWhatLiesElsewhere) {
  IgnoredGround ground{kLeft, drawn({"#..#", ".#.#", "####"})};
  MapRevision revision;
  revision.number = 1;
  revision.map = drawn({"..##", ".#.#", "####"});
  revision.changes = changes_between(*ground.whole(), *revision.map);
  ASSERT_EQ(revision.changes.size(), 2u);
  const MapRevision taken = ground.follow(revision, {});
  EXPECT_EQ(taken.number, 1u);
  EXPECT_EQ(taken.changes.size(), 1u);
  EXPECT_EQ(*taken.map, test::drawn_grid({"??##", "??.#", "??##"}, 0.1));
  EXPECT_FALSE(taken.field_patch.box.empty());
  EXPECT_EQ(ground.whole(), revision.map);
}

TEST(IgnoredGround, OtherZonesMakeAnotherMap) {
  IgnoredGround ground{kLeft, drawn({"#..#"})};
  EXPECT_TRUE(ground.set_zones({}));
  EXPECT_EQ(ground.known(), ground.whole());
  EXPECT_FALSE(ground.set_zones({}));
}

}  // namespace
}  // namespace deltamap::daemon
