// SPDX-License-Identifier: Apache-2.0
#include "localization/sensor/likelihood_field.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/random.hpp"
#include "tests/support/worlds/drawn_flat.hpp"
#include "tests/support/worlds/drawn_grid.hpp"
#include "tests/support/worlds/padded.hpp"

namespace deltamap::localization::sensor {
namespace {

constexpr LikelihoodFieldParams kParams{.hit_deviation_m = 0.10, .random_share = 0.1, .unknown_likelihood = 0.2};

/// Straight from the definition: look at every contour cell.
std::uint8_t expected_steps(const OccupancyGrid& map, Cell cell, const LikelihoodFieldParams& params) {
  double nearest2 = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < map.geometry().cell_count(); ++i) {
    const Cell other = map.geometry().cell_of(i);
    if (!is_contour(map, other)) continue;
    nearest2 = std::min(nearest2, std::pow(other.column - cell.column, 2) + std::pow(other.row - cell.row, 2));
  }
  const double deviation_cells = params.hit_deviation_m / map.resolution_m();
  double p = (1.0 - params.random_share) * std::exp(-0.5 * nearest2 / (deviation_cells * deviation_cells)) +
             params.random_share;
  if (map[cell] == CellState::kUnknown) p = std::max(p, params.unknown_likelihood);
  return static_cast<std::uint8_t>(std::lround(-std::log(p) / LikelihoodField::kStep));
}

OccupancyGrid random_grid(int width, int height, Random& random) {
  OccupancyGrid grid{{width, height, 0.05, {-1.0, 2.0}}};
  for (std::size_t i = 0; i < grid.geometry().cell_count(); ++i) {
    const double chance = random.uniform();
    grid.set(grid.geometry().cell_of(i), chance < 0.04  ? CellState::kOccupied
                                         : chance < 0.7 ? CellState::kFree
                                                        : CellState::kUnknown);
  }
  return grid;
}

TEST(Contour, IsTheRimOfASolidBlockOnly) {
  const OccupancyGrid map = test::drawn_grid({".......",  //
                                              ".#####.",  //
                                              ".#####.",  //
                                              ".#####.",  //
                                              "......."});
  EXPECT_TRUE(is_contour(map, {1, 1}));
  EXPECT_TRUE(is_contour(map, {3, 3}));
  EXPECT_FALSE(is_contour(map, {3, 2}));
  EXPECT_FALSE(is_contour(map, {0, 0}));
}

TEST(Contour, IsASingleRowOfCellsBetweenUnknownSpace) {
  const OccupancyGrid map = test::drawn_grid({"      ",  //
                                              " #### ",  //
                                              "      ",  //
                                              " #### ",  //
                                              " #### ",  //
                                              "      "});
  EXPECT_TRUE(is_contour(map, {2, 4}));
  EXPECT_FALSE(is_contour(map, {2, 2}));
  EXPECT_FALSE(is_contour(map, {2, 1}));
}

TEST(Contour, ReachesAcrossOneUnknownCellToFreeSpaceButNotFarther) {
  const OccupancyGrid map = test::drawn_grid({"###  ",  //
                                              "###  ",  //
                                              "     ",  //
                                              ". ...",  //
                                              "     "});
  EXPECT_TRUE(is_contour(map, {0, 3}));
  EXPECT_FALSE(is_contour(map, {0, 4}));
  const OccupancyGrid far = test::drawn_grid({"###", "###", "   ", "   ", "..."});
  EXPECT_FALSE(is_contour(far, {1, 3}));
  EXPECT_FALSE(is_contour(test::drawn_grid({"###", "###", "###"}), {1, 1}));
}

TEST(LikelihoodField, HoldsTheDefinitionInEveryCell) {
  Random random{11};
  const OccupancyGrid map = random_grid(40, 31, random);
  const LikelihoodField field{map, kParams};
  for (std::size_t i = 0; i < map.geometry().cell_count(); ++i) {
    const Cell cell = map.geometry().cell_of(i);
    ASSERT_EQ(field.steps_at(cell), expected_steps(map, cell, kParams)) << cell.column << ' ' << cell.row;
  }
}

TEST(LikelihoodField, TakesWhatLiesOutsideAsUnknown) {
  const LikelihoodField field{test::drawn_grid({"...", "...", "..."}, 0.05), kParams};
  const auto unknown =
      static_cast<std::uint8_t>(std::lround(-std::log(kParams.unknown_likelihood) / LikelihoodField::kStep));
  EXPECT_EQ(field.steps_at({-1, 0}), unknown);
  EXPECT_EQ(field.steps_at({3, 3}), unknown);
  EXPECT_GT(field.steps_at({1, 1}), unknown);
}

TEST(LikelihoodField, NamesTheDistanceThatAByteStandsFor) {
  const LikelihoodField field{test::drawn_grid({"........", "#.......", "........"}, 0.05), kParams};
  EXPECT_FLOAT_EQ(field.distance_of_steps_m()[field.steps_at({0, 1})], 0.0F);
  EXPECT_FLOAT_EQ(field.distance_of_steps_m()[field.steps_at({2, 1})], 0.10F);
  EXPECT_NEAR(field.distance_of_steps_m()[field.steps_at({1, 2})], std::sqrt(0.005F), 1e-6);
}

TEST(LikelihoodField, PatchedIsTheSameAsRebuiltWhateverChanges) {
  Random random{17};
  for (int round = 0; round < 40; ++round) {
    const int width = 5 + static_cast<int>(random.index_below(60));
    const int height = 5 + static_cast<int>(random.index_below(60));
    const OccupancyGrid before = random_grid(width, height, random);
    OccupancyGrid after = before;
    const int changes = 1 + static_cast<int>(random.index_below(30));
    for (int i = 0; i < changes; ++i) {
      const Cell cell{static_cast<int>(random.index_below(static_cast<std::uint32_t>(std::min(width, 12)))),
                      static_cast<int>(random.index_below(static_cast<std::uint32_t>(height)))};
      after.set(cell, static_cast<CellState>(random.index_below(3)));
    }
    LikelihoodField patched_field{before, kParams};
    patched_field.apply(field_patch(after, changes_between(before, after), kParams));
    const LikelihoodField rebuilt{after, kParams};
    for (std::size_t i = 0; i < after.geometry().cell_count(); ++i) {
      const Cell cell = after.geometry().cell_of(i);
      ASSERT_EQ(patched_field.steps_at(cell), rebuilt.steps_at(cell)) << "round " << round;
    }
  }
}

TEST(LikelihoodField, HoldsTheSameBytesHoweverMuchUnknownSpaceLiesAroundTheMap) {
  const OccupancyGrid map = test::drawn_flat();
  const LikelihoodField field{map, kParams};
  const LikelihoodField::Bordered own = field.bordered();
  for (const test::Padding& by :
       {test::Padding{1, 0, 0, 0}, test::Padding{37, 101, 3, 0}, test::Padding{3000, 64, 5, 700}}) {
    const LikelihoodField wide_field{test::padded(map, by), kParams};
    const LikelihoodField::Bordered wide = wide_field.bordered();
    ASSERT_EQ(wide.width, own.width);
    ASSERT_EQ(wide.height, own.height);
    EXPECT_NEAR((wide.origin - own.origin).norm(), 0.0, 1e-9);
    EXPECT_TRUE(std::equal(own.bytes, own.bytes + own.width * own.height, wide.bytes));
  }
}

TEST(LikelihoodField, GrowsWithWhatTheMapShows) {
  OccupancyGrid before{{900, 700, 0.05, {-1.0, 2.0}}};
  for (int column = 300; column < 340; ++column) before.set({column, 300}, CellState::kOccupied);
  for (const Cell& cell : {Cell{310, 301}, Cell{0, 0}, Cell{899, 699}, Cell{899, 0}}) {
    OccupancyGrid after = before;
    after.set(cell, CellState::kOccupied);
    LikelihoodField patched_field{before, kParams};
    patched_field.apply(field_patch(after, changes_between(before, after), kParams));
    const LikelihoodField rebuilt{after, kParams};
    EXPECT_EQ(patched_field.window(), rebuilt.window());
    for (std::size_t i = 0; i < after.geometry().cell_count(); ++i) {
      const Cell at = after.geometry().cell_of(i);
      ASSERT_EQ(patched_field.steps_at(at), rebuilt.steps_at(at)) << at.column << ' ' << at.row;
    }
  }
}

TEST(LikelihoodField, IsNotTouchedByAPatchWithoutChanges) {
  const OccupancyGrid map = test::drawn_grid({"..#", "..."}, 0.05);
  EXPECT_TRUE(field_patch(map, {}, kParams).box.empty());
  LikelihoodField field{map, kParams};
  field.apply({});
  EXPECT_EQ(field.steps_at({2, 1}), 0);
}

TEST(LikelihoodField, BlursByTheMapsOwnCellsWhereTheyAreCoarse) {
  const LikelihoodField field{test::drawn_grid({"...", ".#.", "..."}, 0.5), kParams};
  EXPECT_NEAR(field.hit_deviation_m(), 0.35, 1e-12);
}

}  // namespace
}  // namespace deltamap::localization::sensor
