// SPDX-License-Identifier: Apache-2.0
#include "daemon/dashboard/cells.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "daemon/dashboard/page_files.hpp"
#include "tests/support/bytes/live_decoding.hpp"
#include "tests/support/worlds/drawn_grid.hpp"

namespace deltamap::daemon::dashboard {
namespace {

TEST(DashboardCells, ABoxComesBackAsItIs) {
  const OccupancyGrid grid = test::drawn_grid({"#. #", "....", " ##."});
  const test::CellsInBox box = test::decoded_cells(cells_message(grid, {{1, 0}, {4, 3}}, 7));
  EXPECT_EQ(box.revision, 7u);
  EXPECT_EQ(box.box, (CellBox{{1, 0}, {4, 3}}));
  ASSERT_EQ(box.states.size(), 9u);
  for (int row = 0; row < 3; ++row) {
    for (int column = 1; column < 4; ++column) {
      EXPECT_EQ(box.states[static_cast<std::size_t>(3 * row + column - 1)], (grid[{column, row}])) << column << row;
    }
  }
}

TEST(DashboardCells, LongRunsAreCut) {
  const OccupancyGrid grid{{.width = 256, .height = 256, .resolution_m = 0.05}, CellState::kFree};
  const std::string message = cells_message(grid, grid.box(), 0);
  EXPECT_LT(message.size(), 64u);
  const test::CellsInBox box = test::decoded_cells(message);
  ASSERT_EQ(box.states.size(), 256u * 256u);
  for (const CellState state : box.states) ASSERT_EQ(state, CellState::kFree);
}

TEST(DashboardCells, PiecesCoverTheBoxAndLieInOneTileEach) {
  const CellBox box{{100, 300}, {700, 513}};
  long cells = 0;
  for (const CellBox& piece : pieces_of(box)) {
    cells += static_cast<long>(piece.width()) * piece.height();
    EXPECT_EQ(piece.first.column / kBoxSide, (piece.last.column - 1) / kBoxSide);
    EXPECT_EQ(piece.first.row / kBoxSide, (piece.last.row - 1) / kBoxSide);
    EXPECT_EQ(common(piece, box), piece);
  }
  EXPECT_EQ(cells, 600L * 213L);
  EXPECT_TRUE(pieces_of({}).empty());
}

TEST(DashboardPage, IsSmallAndAsksNobodyElse) {
  std::size_t bytes = 0;
  for (const PageFile& file : page_files()) {
    bytes += file.content.size();
    EXPECT_FALSE(file.content.empty()) << file.name;
    for (const char* foreign : {"http://", "https://", "//cdn", "eval(", "innerHTML"}) {
      EXPECT_EQ(file.content.find(foreign), std::string_view::npos) << file.name << ": " << foreign;
    }
  }
  EXPECT_EQ(page_files().front().name, "index.html");
  EXPECT_LT(bytes, 300u * 1024u);
}

}  // namespace
}  // namespace deltamap::daemon::dashboard
