// SPDX-License-Identifier: Apache-2.0
// /api/revision/K/…: what the store holds, and every question that has no answer.
#include "daemon/live/page_history.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/support/bytes/live_decoding.hpp"
#include "tests/support/files/temporary_folder.hpp"
#include "tests/support/worlds/drawn_grid.hpp"

namespace deltamap::daemon {
namespace {

using Json = nlohmann::json;

class PageHistoryTest : public testing::Test {
 protected:
  void append(std::uint32_t number, Cell cell, CellState after) {
    MapRevision revision;
    revision.number = number;
    revision.changes = {{cell, map_[cell], after}};
    map_ = patched(map_, revision.changes);
    revision.map = std::make_shared<const OccupancyGrid>(map_);
    store_.append(revision, {.cause = "test"});
  }
  [[nodiscard]] std::string error_of(const std::string& path) {
    const auto answer = history_.answer(path);
    EXPECT_EQ(answer.status, 404u) << path;
    EXPECT_EQ(std::count(answer.body.begin(), answer.body.end(), '\n'), 1) << answer.body;
    return answer.body;
  }
  /// The states in the order of the boxes.
  [[nodiscard]] std::vector<CellState> states_of(std::uint32_t number) {
    const auto answer = history_.answer("/api/revision/" + std::to_string(number) + "/cells");
    EXPECT_EQ(answer.status, 200u) << answer.body;
    std::vector<CellState> states;
    for (std::size_t at = 0; at < answer.body.size();) {
      const std::uint32_t size = test::u32_at(answer.body, at);
      const auto box = test::decoded_cells(answer.body.substr(at + 4, size));
      EXPECT_EQ(box.revision, number);
      states.insert(states.end(), box.states.begin(), box.states.end());
      at += 4 + size;
    }
    return states;
  }

  test::TemporaryFolder folder_;
  OccupancyGrid map_ = test::drawn_grid({"#..", "..."}, 0.5);
  std::filesystem::path file_ = folder_.path() / "store.sqlite";
  mapping::store::MapStore store_{file_, map_};
  PageHistory history_{file_};
};

TEST_F(PageHistoryTest, EveryRevisionIsAnsweredWhileAnotherConnectionWrites) {
  const auto at_first = states_of(0);
  EXPECT_EQ(std::count(at_first.begin(), at_first.end(), CellState::kOccupied), 1);
  append(1, {2, 0}, CellState::kOccupied);
  append(2, {0, 1}, CellState::kFree);
  const auto later = states_of(2);
  EXPECT_EQ(std::count(later.begin(), later.end(), CellState::kOccupied), 1);
  const auto between = states_of(1);
  EXPECT_EQ(std::count(between.begin(), between.end(), CellState::kOccupied), 2);
  append(3, {1, 1}, CellState::kUnknown);
  EXPECT_EQ(Json::parse(history_.answer("/api/revision/3/changes").body),
            (Json{{"revision", 3}, {"cells", {{1, 1, 0, 2}}}}));
  EXPECT_EQ(Json::parse(history_.answer("/api/revision/0/changes").body)["cells"], Json::array());
}

TEST_F(PageHistoryTest, WhatIsNotThereIsToldInOneLine) {
  EXPECT_NE(error_of("/api/revision/1/cells").find("no revision 1 (newest: 0)"), std::string::npos);
  for (const char* path :
       {"/api/revision/", "/api/revision/0", "/api/revision/0/", "/api/revision/x/cells", "/api/revision/-1/cells",
        "/api/revision/+1/cells", "/api/revision/ 0/cells", "/api/revision/0/cells/", "/api/revision/0/../cells",
        "/api/revision/0x0/cells", "/api/revision/99999999999999999999/cells", "/api/revision//cells"}) {
    EXPECT_EQ(error_of(path), "there is /api/revision/K/cells and /api/revision/K/changes\n") << path;
  }
  EXPECT_EQ(states_of(0).size(), 6u);
}

TEST_F(PageHistoryTest, WithoutAStoreNothingIsKept) {
  history_ = PageHistory{{}};
  EXPECT_NE(error_of("/api/revision/0/cells").find("'map.store' is empty"), std::string::npos);
  history_ = PageHistory{folder_.path() / "missing.sqlite"};
  EXPECT_NE(error_of("/api/revision/0/cells").find("missing.sqlite: no such file"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "missing.sqlite"));
  history_ = PageHistory{folder_.write("text.sqlite", "this is no store")};
  EXPECT_NE(error_of("/api/revision/0/cells").find("text.sqlite: "), std::string::npos);
}

}  // namespace
}  // namespace deltamap::daemon
