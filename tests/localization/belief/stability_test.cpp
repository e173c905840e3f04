// SPDX-License-Identifier: Apache-2.0
#include "localization/belief/stability.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "localization/localizer.hpp"
#include "localization/localizer_params.hpp"
#include "tests/support/worlds/drawn_flat.hpp"

namespace deltamap::localization::belief {
namespace {

const GridGeometry kGeometry{100, 60, 0.05, {0.0, 0.0}};
constexpr Cell kWall{40, 30};
const Timestamp kStart = timestamp_from_ns(1'700'000'000'000'000'000);

Timestamp after(double passed_s) { return kStart + duration_from_seconds(passed_s); }

/// Every half minute from another end of a lane below the wall.
Stability lived_in(int visits) {
  Stability stability{kGeometry};
  for (int i = 0; i < visits; ++i) stability.confirm(kWall, {i % 2 == 0 ? 0.1 : 4.9, 0.2}, after(30.0 * i));
  return stability;
}

TEST(Stability, IsEarnedAndNotAssumed) {
  EXPECT_FALSE(lived_in(0).proven(kWall));
  EXPECT_FALSE(lived_in(5).proven(kWall));
  EXPECT_TRUE(lived_in(6).proven(kWall));
  EXPECT_EQ(lived_in(6).proven_tiles(), 1u);
}

TEST(Stability, IsNotEarnedInAMoment) {
  Stability stability{kGeometry};
  for (int i = 0; i < 300; ++i) stability.confirm(kWall, {i % 2 == 0 ? 0.1 : 4.9, 0.2}, after(0.2 * i));
  EXPECT_FALSE(stability.proven(kWall));
}

TEST(Stability, IsNotEarnedFromOnePlace) {
  Stability stability{kGeometry};
  for (int i = 0; i < 300; ++i) stability.confirm(kWall, {0.1, 0.2}, after(60.0 * i));
  EXPECT_FALSE(stability.proven(kWall));
}

TEST(Stability, IsNotEarnedFromOneDirection) {
  Stability stability{{1000, 60, 0.05, {0.0, 0.0}}};
  for (int i = 0; i < 300; ++i) stability.confirm(kWall, {i % 2 == 0 ? 20.1 : 23.4, 1.5}, after(60.0 * i));
  EXPECT_FALSE(stability.proven(kWall));
}

TEST(Stability, IsLostToBeamsThatGoThroughHoweverLongItWasEarned) {
  Stability stability = lived_in(1000);
  stability.refute(kWall, {0.1, 0.2}, after(40'000.0));
  EXPECT_TRUE(stability.proven(kWall)) << "one moment is not enough";
  for (int i = 1; i < 4; ++i) stability.refute(kWall, {i % 2 == 0 ? 0.1 : 4.9, 0.2}, after(40'000.0 + 30.0 * i));
  EXPECT_FALSE(stability.proven(kWall));
}

TEST(Stability, BeginsAgainWhereARevisionRewritesAnObstacle) {
  Stability stability = lived_in(6);
  stability.forget(std::vector<CellChange>{{kWall, CellState::kUnknown, CellState::kFree}});
  EXPECT_TRUE(stability.proven(kWall));
  stability.forget(std::vector<CellChange>{{kWall, CellState::kOccupied, CellState::kFree}});
  EXPECT_FALSE(stability.proven(kWall));
}

TEST(Stability, IsKeptByARecordAndRefusesTheRecordOfAnotherMap) {
  const StabilityRecord record = lived_in(6).record();
  Stability again{kGeometry};
  EXPECT_TRUE(again.restore(record));
  EXPECT_TRUE(again.proven(kWall));

  Stability wider{{101, 60, 0.05, {0.0, 0.0}}};
  EXPECT_FALSE(wider.restore(record));
  Stability moved{{100, 60, 0.05, {0.1, 0.0}}};
  EXPECT_FALSE(moved.restore(record));
  StabilityRecord cut = record;
  cut.bytes.pop_back();
  EXPECT_FALSE(again.restore(cut));
  EXPECT_TRUE(again.proven(kWall)) << "a refused record changes nothing";
}

TEST(Stability, IgnoresWhatLiesOutsideTheMap) {
  Stability stability{kGeometry};
  stability.confirm({-1, 5}, {0.1, 0.2}, kStart);
  stability.refute({100, 5}, {0.1, 0.2}, kStart);
  EXPECT_FALSE(stability.proven({100, 60}));
  EXPECT_EQ(stability.proven_tiles(), 0u);
}

TEST(Stability, OfALocalizerIsHandedInAndOutAndRefusedForAnotherMap) {
  const auto map = std::make_shared<const OccupancyGrid>(test::drawn_flat());
  Localizer localizer{LocalizerParams{}, map, particles::InitialPose{{4.1, 1.5, 0.05}}, 1};
  StabilityRecord record = localizer.stability();
  EXPECT_EQ(record.geometry, map->geometry());
  record.bytes.at(0) = 7;
  EXPECT_TRUE(localizer.restore(record));
  EXPECT_EQ(localizer.stability().bytes, record.bytes);
  record.geometry.width += 1;
  EXPECT_FALSE(localizer.restore(record));
}

}  // namespace
}  // namespace deltamap::localization::belief
