// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <sqlite3.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/files/file_lock.hpp"
#include "core/files/grid_file.hpp"
#include "mapping/store/map_store.hpp"
#include "tests/support/files/not_root.hpp"
#include "tests/support/files/temporary_folder.hpp"
#include "tests/support/files/tool_run.hpp"

namespace deltamap::tool {
namespace {

using test::ToolRun;

/// `deltamap map history WORDS…`
ToolRun history(std::vector<std::string> words) {
  words.insert(words.begin(), {"map", "history"});
  return test::run_deltamap(words);
}

class MapHistory : public testing::Test {
 protected:
  MapHistory() {
    mapping::store::MapStore store{file, first};
    store.append_refusal(timestamp_from_ns(500), {1, 0.3, "low acceptance"});
    second.set({2, 3}, CellState::kOccupied);
    second.set({4, 3}, CellState::kFree);
    MapRevision revision;
    revision.number = 1;
    revision.time = timestamp_from_ns(1'000'000'000);
    revision.changes = changes_between(first, second);
    revision.map = std::make_shared<const OccupancyGrid>(second);
    store.append(revision, {2, 0.9, "evidence"});
  }

  ~MapHistory() override { std::filesystem::permissions(folder.path(), std::filesystem::perms{0700}); }

  test::TemporaryFolder folder;
  test::TemporaryFolder elsewhere;
  std::string file = (folder.path() / "store.sqlite").string();
  OccupancyGrid first{{10, 8, 0.1, {0.0, 0.0}}, CellState::kUnknown};
  OccupancyGrid second = first;
};

TEST_F(MapHistory, ListsRevisionsAndRefusalsAsJsonLines) {
  const ToolRun run = history({file, "list", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  std::istringstream lines{run.output};
  std::string line;
  std::vector<nlohmann::json> rows;
  while (std::getline(lines, line)) rows.push_back(nlohmann::json::parse(line));
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0]["cause"], "first map");
  EXPECT_EQ(rows[1]["refused"], true);
  EXPECT_EQ(rows[2]["number"], 1);
  EXPECT_EQ(rows[2]["occupied"], 1);
  EXPECT_EQ(rows[2]["freed"], 1);
  EXPECT_EQ(rows[2]["box"], (nlohmann::json{2, 3, 4, 3}));
}

TEST_F(MapHistory, ListsForPeopleToo) {
  const ToolRun run = history({file, "list"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_NE(run.output.find("refused: low acceptance"), std::string::npos);
  EXPECT_NE(run.output.find("1970-01-01 00:00:01"), std::string::npos);
}

TEST_F(MapHistory, WritesARevisionAsAMap) {
  const std::string out = (folder.path() / "one.yaml").string();
  EXPECT_EQ(history({file, "export", "1", out}).exit_code, 0);
  EXPECT_EQ(read_grid(out), second);
}

TEST_F(MapHistory, TellsWhatChangedBetweenTwo) {
  const ToolRun run = history({file, "diff", "0", "1", "--json"});
  const auto result = nlohmann::json::parse(run.output);
  EXPECT_EQ(result["cells"], 2);
  EXPECT_EQ(result["occupied"], 1);
  EXPECT_EQ(result["freed"], 1);
}

TEST_F(MapHistory, GoesBackToAnEarlierMap) {
  const ToolRun run = history({file, "rollback", "0", "--json"});
  EXPECT_EQ(nlohmann::json::parse(run.output)["number"], 2);
  EXPECT_EQ((mapping::store::MapStore{file, first}.grid(2)), first);
}

TEST_F(MapHistory, TellsEachCellThatChanged) {
  const ToolRun run = history({file, "diff", "0", "1", "--cells", "--json"});
  EXPECT_EQ(nlohmann::json::parse(run.output)["changes"],
            (nlohmann::json{{2, 3, "unknown", "occupied"}, {4, 3, "unknown", "free"}}));
  EXPECT_NE(history({file, "diff", "0", "1", "--cells"}).output.find("\n2 3 unknown occupied\n4 3 unknown free\n"),
            std::string::npos);
}

TEST_F(MapHistory, TakesARevisionBack) {
  const ToolRun run = history({file, "undo", "1", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_EQ(nlohmann::json::parse(run.output), (nlohmann::json{{"number", 2}, {"undone", 1}, {"cells", 2}}));
  EXPECT_EQ((mapping::store::MapStore{file, first}.grid(2)), first);
  const ToolRun difference = history({file, "diff", "1", "2", "--cells", "--json"});
  EXPECT_EQ(nlohmann::json::parse(difference.output)["changes"],
            (nlohmann::json{{2, 3, "occupied", "unknown"}, {4, 3, "free", "unknown"}}));
}

TEST_F(MapHistory, OfAStoreInUseIsReadAndNotWritten) {
  const auto lock = lock_of_file(file);
  mapping::store::MapStore store{file, first};  // the daemon
  for (const std::string what : {"rollback", "undo"}) {
    const ToolRun run = history({file, what, what == "undo" ? "1" : "0"});
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_NE(run.errors.find(file + ": is in use by "), std::string::npos) << run.errors;
    EXPECT_NE(run.errors.find("(pid " + std::to_string(getpid()) + ")"), std::string::npos) << run.errors;
  }
  EXPECT_EQ(history({file, "list"}).exit_code, 0);
  EXPECT_EQ(history({file, "diff", "0", "1"}).exit_code, 0);
  EXPECT_EQ(history({file, "export", "1", (folder.path() / "one.yaml").string()}).exit_code, 0);
  store.append_refusal(timestamp_from_ns(7), {3, 0.2, "implausible"});  // it goes on storing
  EXPECT_EQ(store.history().size(), 4u);
}

TEST_F(MapHistory, OfAnotherUserIsReadAsItIsAndNotWritten) {
  const std::string out = (elsewhere.path() / "one.yaml").string();
  const std::string picture = (elsewhere.path() / "one.png").string();
  std::filesystem::permissions(elsewhere.path(), std::filesystem::perms::all);
  std::filesystem::permissions(folder.path(), std::filesystem::perms{0555});
  std::filesystem::permissions(file, std::filesystem::perms{0444});
  const test::NotRoot another_user;
  for (const auto& words : std::vector<std::vector<std::string>>{
           {"list"}, {"diff", "0", "1"}, {"export", "1", out}, {"picture", "1", picture}}) {
    std::vector<std::string> all{file};
    all.insert(all.end(), words.begin(), words.end());
    const ToolRun run = history(all);
    EXPECT_EQ(run.exit_code, 0) << words[0] << ": " << run.errors;
  }
  EXPECT_EQ(read_grid(out), second);
  const ToolRun naming = history({file, "name", "1", "as built"});
  EXPECT_EQ(naming.exit_code, 1);
  EXPECT_EQ(naming.errors, "deltamap: " + file + ": cannot be written: Permission denied\n");
  for (const char* what : {"rollback", "undo"}) {
    const ToolRun run = history({file, what, what == std::string("undo") ? "1" : "0"});
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_NE(run.errors.find("Permission denied"), std::string::npos) << run.errors;
  }
}

TEST_F(MapHistory, NeverWritesOverTheStoreNorIntoAPicturesName) {
  for (const auto& words : std::vector<std::vector<std::string>>{{"export", "1", file}, {"picture", "1", file}}) {
    std::vector<std::string> all{file};
    all.insert(all.end(), words.begin(), words.end());
    const ToolRun run = history(all);
    EXPECT_EQ(run.exit_code, 1) << words[0];
    EXPECT_EQ(run.errors, "deltamap: " + file + ": is what is read; give another name\n");
  }
  const std::string picture = (folder.path() / "one.pgm").string();
  const ToolRun run = history({file, "export", "1", picture});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_EQ(run.errors, "deltamap: " + picture + ": must name a description, NAME.yaml: its picture is NAME.pgm\n");
  EXPECT_FALSE(std::filesystem::exists(picture));
  EXPECT_EQ(history({file, "list"}).exit_code, 0) << "the store is as it was";
}

TEST_F(MapHistory, WithALogThatCannotBeReadIsNotReadWithoutIt) {
  (void)folder.write("store.sqlite-wal", "written by a daemon that was killed");
  std::filesystem::permissions(folder.path(), std::filesystem::perms{0555});
  std::filesystem::permissions(file, std::filesystem::perms{0444});
  const test::NotRoot another_user;
  const ToolRun run = history({file, "list"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_NE(run.errors.find("Permission denied"), std::string::npos) << run.errors;
}

TEST_F(MapHistory, OfADamagedStoreIsReadAndNotWritten) {
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(file.c_str(), &database), SQLITE_OK);
  EXPECT_EQ(sqlite3_exec(database, "UPDATE revision SET changes = x'FF' WHERE number = 1", nullptr, nullptr, nullptr),
            SQLITE_OK);
  sqlite3_close(database);
  const std::string what = file + ": damaged: revision 1 is not what was written";
  const std::string out = (elsewhere.path() / "one.yaml").string();
  const ToolRun read = history({file, "export", "1", out});
  EXPECT_EQ(read.exit_code, 0) << read.errors;
  EXPECT_EQ(read.errors, "deltamap: " + what + "; 1 revision recovered; the file is left as it is\n");
  EXPECT_EQ(read_grid(out), second);
  for (const char* act : {"rollback", "undo"}) {
    const ToolRun written = history({file, act, "1"});
    EXPECT_EQ(written.exit_code, 1);
    EXPECT_NE(written.errors.find(what), std::string::npos) << written.errors;
  }
}

TEST_F(MapHistory, TellsThePoseCovarianceOfEachRevision) {
  PoseCovariance covariance;
  covariance << 1, 2, 3, 2, 4, 5, 3, 5, 6;
  mapping::store::MapStore store{file, first};
  store.append_refusal(timestamp_from_ns(7), {3, 0.2, "implausible", covariance});
  std::istringstream lines{history({file, "list", "--json"}).output};
  std::vector<nlohmann::json> rows;
  for (std::string line; std::getline(lines, line);) rows.push_back(nlohmann::json::parse(line));
  EXPECT_EQ(rows.back()["covariance"]["xh_m_rad"], 3.0);
  EXPECT_EQ(rows.back()["covariance"]["hh_rad2"], 6.0);
  EXPECT_TRUE(rows.front()["covariance"].is_null());
}

TEST_F(MapHistory, AnswersInOneLineWhatItCannotDo) {
  const std::string out = (folder.path() / "nine.yaml").string();
  const std::string text = folder.write("notes.txt", "no store").string();
  for (const auto& words : std::vector<std::vector<std::string>>{{file, "export", "9", out},
                                                                 {file, "undo", "0"},
                                                                 {file, "undo", "9"},
                                                                 {text, "list"},
                                                                 {folder.path() / "none.sqlite", "list"}}) {
    const ToolRun run = history(words);
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_NE(run.errors.find(words[0] + ": "), std::string::npos) << run.errors;
    EXPECT_EQ(std::count(run.errors.begin(), run.errors.end(), '\n'), 1) << run.errors;
  }
  EXPECT_FALSE(std::filesystem::exists(out));
  EXPECT_EQ(history({file, "explode"}).exit_code, 2);
  EXPECT_EQ(history({file, "export", "one", out}).exit_code, 2);
}

}  // namespace
}  // namespace deltamap::tool
