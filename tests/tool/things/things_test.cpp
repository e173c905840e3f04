// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <fstream>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/files/grid_file.hpp"
#include "mapping/store/map_store.hpp"
#include "tests/mapping/things/drawn_site.hpp"
#include "tests/support/files/temporary_folder.hpp"
#include "tests/support/files/tool_run.hpp"

namespace deltamap::tool {
namespace {

using mapping::things::DrawnSite;
using test::ToolRun;

ToolRun things(std::vector<std::string> words) {
  words.insert(words.begin(), "things");
  return test::run_deltamap(words);
}

std::vector<nlohmann::json> lines_of(const std::string& output) {
  std::istringstream lines{output};
  std::vector<nlohmann::json> all;
  for (std::string line; std::getline(lines, line);) all.push_back(nlohmann::json::parse(line));
  return all;
}

class ThingsCommand : public testing::Test {
 protected:
  /// A box comes, goes, and the going is undone.
  ThingsCommand() {
    const OccupancyGrid first = site.map;
    store.emplace(file, first);
    write_grid(first, map);
    site.box({4.0, 4.0, 6.4, 5.6});
    append("evidence");
    site.clear({4.0, 4.0, 6.4, 5.6});
    append("evidence");
    (void)store->undo(2, DrawnSite::at(30.0));
  }

  void append(const std::string& cause) {
    (void)site.revision(10.0 * (site.number + 1));
    store->append({.number = site.number,
                   .time = DrawnSite::at(10.0 * site.number),
                   .map = std::make_shared<const OccupancyGrid>(site.map),
                   .changes = site.revisions.back(),
                   .field_patch = {}},
                  {.phase = site.number, .acceptance = 0.9, .cause = cause});
  }

  test::TemporaryFolder folder;
  std::string file = (folder.path() / "map_store.sqlite").string();
  std::string map = (folder.path() / "first.yaml").string();
  DrawnSite site;
  std::optional<mapping::store::MapStore> store;
};

TEST_F(ThingsCommand, TellsOfEachEventInItsOrder) {
  const ToolRun run = things({file, "--events", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  const auto events = lines_of(run.output);
  ASSERT_EQ(events.size(), 3u);
  EXPECT_EQ(events[0]["kind"], "appeared");
  EXPECT_EQ(events[0]["revision"], 1);
  EXPECT_EQ(events[1]["kind"], "gone");
  EXPECT_EQ(events[1]["at"], nullptr);
  EXPECT_EQ(events[2]["kind"], "appeared") << "that it went was taken back";
  for (const auto& event : events) EXPECT_EQ(event["thing"], 1);
}

TEST_F(ThingsCommand, TellsWhatStandsWhere) {
  const auto all = lines_of(things({folder.path().string(), "--json"}).output);  // the folder of a run
  ASSERT_EQ(all.size(), 1u);
  ASSERT_EQ(all[0]["things"].size(), 1u);
  const nlohmann::json& thing = all[0]["things"][0];
  EXPECT_NEAR(thing["at"]["length_m"].get<double>(), 2.4, 0.1);
  EXPECT_NEAR(thing["at"]["x_m"].get<double>(), 5.2, 0.1);
  EXPECT_EQ(thing["at"]["polygon_m"].size(), 4u);
  EXPECT_EQ(thing["revisions"], (nlohmann::json{1, 2, 3}));
  const ToolRun table = things({file});
  EXPECT_EQ(table.exit_code, 0);
  EXPECT_NE(table.output.find("container-like body of 2.4"), std::string::npos) << table.output;
  EXPECT_NE(table.output.find("1 thing; 0 changed cells belong to none"), std::string::npos) << table.output;
}

TEST_F(ThingsCommand, WhatIsAssumedIsToldAndExportedAsSuch) {
  site.box({4.0, 4.0, 6.4, 5.6}).begin_with_what_is_drawn();  // the undo was revision 3
  site.number = 3;
  site.south({8.0, 4.0, 10.0, 6.0}).west({8.0, 4.0, 10.0, 6.0});
  append("evidence");
  const auto assumed_of = [](const ToolRun& run) {
    return lines_of(run.output)[0]["things"][1]["at"]["sides_assumed"];
  };
  EXPECT_EQ(assumed_of(things({file, "--json"})), (nlohmann::json{true, true, false, false}));
  EXPECT_EQ(assumed_of(things({file, "--json", "--seen-only"})), (nlohmann::json{false, false, false, false}));

  const std::string plain = (folder.path() / "plain.yaml").string();
  const std::string marked = (folder.path() / "marked.yaml").string();
  const std::string newest = std::to_string(site.number);
  const ToolRun without = test::run_deltamap({"map", "history", file, "export", newest, plain});
  ASSERT_EQ(without.exit_code, 0) << without.errors;
  const ToolRun with = test::run_deltamap({"map", "history", file, "export", newest, marked, "--assumed"});
  ASSERT_EQ(with.exit_code, 0) << with.errors;
  const Cell inside = site.map.geometry().cell_at({9.5, 5.5});
  EXPECT_EQ(read_grid(plain).at(inside), CellState::kFree);
  EXPECT_EQ(read_grid(marked).at(inside), CellState::kUnknown) << "marked, and never free";
  EXPECT_EQ(read_grid(marked).at(site.map.geometry().cell_at({8.5, 4.0})), CellState::kOccupied);
  EXPECT_EQ(read_grid(marked).at(site.map.geometry().cell_at({8.5, 3.5})), CellState::kFree);
}

TEST_F(ThingsCommand, RefusesAStoreOfAnotherSite) {
  EXPECT_EQ(things({file, "--map", map}).exit_code, 0);
  const std::string other = (folder.path() / "other.yaml").string();
  write_grid(OccupancyGrid{{50, 50, 0.05, {0.0, 0.0}}, CellState::kFree}, other);
  const ToolRun run = things({file, "--map", other});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_NE(run.errors.find("belongs to another first map"), std::string::npos) << run.errors;
}

TEST_F(ThingsCommand, WithoutRevisionsThereIsNothingToTell) {
  const std::string empty = (folder.path() / "empty.sqlite").string();
  mapping::store::MapStore{empty, site.map};
  const ToolRun run = things({empty});
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_NE(run.output.find("0 things; 0 changed cells belong to none"), std::string::npos) << run.output;
}

TEST_F(ThingsCommand, AnEmptyFileIsNoStoreWithAndWithoutAMap) {
  const std::string nothing = (folder.path() / "nothing.sqlite").string();
  std::ofstream{nothing};
  for (const ToolRun& run : {things({nothing}), things({nothing, "--map", map})}) {
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_NE(run.errors.find("nothing.sqlite: is empty"), std::string::npos) << run.errors;
  }
}

TEST_F(ThingsCommand, AFolderWithoutAStoreIsRefused) {
  const test::TemporaryFolder nothing;
  const ToolRun run = things({nothing.path().string()});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_NE(run.errors.find("holds no map_store.sqlite"), std::string::npos) << run.errors;
}

}  // namespace
}  // namespace deltamap::tool
