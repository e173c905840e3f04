// SPDX-License-Identifier: Apache-2.0
#include "mapping/things/body.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace deltamap::mapping::things {
namespace {

constexpr double kSide_m = 0.05;

std::vector<CellChange> row(int from, int to, int at) {
  std::vector<CellChange> cells;
  for (int column = from; column <= to; ++column)
    cells.push_back({{column, at}, CellState::kFree, CellState::kOccupied});
  return cells;
}

TEST(Body, KeepsItsOutlineWhileALittleOfItIsMissingAndGoesWithTheMost) {
  OccupancyGrid map{{100, 100, kSide_m, {0.0, 0.0}}, CellState::kFree};
  Body body;
  const auto judged = [&](const std::vector<CellChange>& changes) {
    map = patched(std::move(map), changes);
    judge(body, {1, {}, map, changes, false}, {});
  };
  const std::vector<CellChange> face = row(10, 49, 20);
  own(body, face, Side::kCome);
  body.has_grown = true;
  judged(face);
  ASSERT_TRUE(is_tellable(body, {}));
  EXPECT_NEAR(body.thing.at->length_m, 39 * kSide_m, 1e-9);
  EXPECT_TRUE(differs_from_told(body, 0.1));
  body.told = body.thing;
  body.has_grown = false;
  std::vector<CellChange> freed = row(10, 24, 20);
  for (CellChange& cell : freed) {
    std::swap(cell.before, cell.after);
    body.come.drop(cell.cell);
  }
  judged(freed);
  EXPECT_FALSE(differs_from_told(body, 0.1)) << "three fifths are left";
  freed = row(25, 39, 20);
  for (CellChange& cell : freed) {
    std::swap(cell.before, cell.after);
    body.come.drop(cell.cell);
  }
  judged(freed);
  EXPECT_EQ(body.thing.kind, ThingKind::kGone);
  EXPECT_NEAR(body.thing.from->length_m, 39 * kSide_m, 1e-9) << "as it stood";
}

TEST(Body, IsToldByASingleFaceThatIsTwiceAsLongAsItMustBe) {
  const ThingsParams params;
  Body body;
  body.most_faces_come = 20;
  const auto is_told = [&](double length_m, double width_m) {
    body.thing.at = Outline{{0.0, 0.0}, length_m, width_m, 0.0, {}, {}};
    return is_tellable(body, params);
  };
  EXPECT_FALSE(is_told(1.9 * params.least_size_m, 0.1)) << "a leg";
  EXPECT_TRUE(is_told(2.1 * params.least_size_m, 0.1));
  EXPECT_TRUE(is_told(1.1 * params.least_size_m, kOneFace_m)) << "a body";
}

}  // namespace
}  // namespace deltamap::mapping::things
