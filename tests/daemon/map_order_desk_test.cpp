// SPDX-License-Identifier: Apache-2.0
// `ctl undo K` and `ctl rollback K` in the running daemon, over a real socket: what becomes of map, store and
// recording.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "daemon/maps/store_opening.hpp"
#include "mapping/store/map_store.hpp"
#include "tests/support/daemon/control_fixture.hpp"

namespace deltamap::daemon {
namespace {

using control::Request;
using Kind = Request::Kind;
using test::comes_true;
using test::content_of;
using Json = nlohmann::json;
using namespace std::chrono_literals;

class MapOrderDeskTest : public test::ControlDeskTest {
 protected:
  MapOrderDeskTest() {
    settings_.map.store = folder_.path() / "store.sqlite";
    prepare_ = [this](Pipeline::Options& options) {
      OpenedStore opened = open_store(settings_.map.store, *options.start.map);
      options.start.map = opened.start.map;
      options.start.revision = opened.start.revision;
      options.store = std::move(opened.store);
    };
  }

  [[nodiscard]] Json ordered(Kind kind, std::uint32_t revision) const {
    Request request{kind, {}};
    request.revision = revision;
    return asked(request);
  }
  [[nodiscard]] bool has_revision(const Pipeline& pipeline, std::uint32_t number) const {
    return comes_true([&] { return pipeline.telemetry().newest_revision.value() >= number; });
  }
  [[nodiscard]] std::vector<Json> changes_of(const std::string& run) const {
    std::vector<Json> lines;
    std::ifstream file(folder_.path() / run / "changes.jsonl");
    for (std::string line; std::getline(file, line);) lines.push_back(Json::parse(line));
    return lines;
  }
  [[nodiscard]] Json operators_line(const std::string& run) const {
    for (const Json& line : changes_of(run)) {
      if (line.contains("operator")) return line;
    }
    return nullptr;
  }
  [[nodiscard]] std::string cause(std::uint32_t number) const {
    for (const auto& revision : mapping::store::MapStore{settings_.map.store}.history()) {
      if (revision.number == number && !revision.refused) return revision.note.cause;
    }
    return "";
  }
  /// The first Δ of the drive, taken back while mapping is paused; answers the number of the revision that does it.
  std::uint32_t live_with_undo() {
    std::uint32_t number = 0;
    (void)run_live(4ms, [&](const Pipeline& pipeline) {
      ASSERT_TRUE(has_revision(pipeline, 1));
      EXPECT_EQ(asked({Kind::kPause, {}})["ok"], true);
      const Json reply = ordered(Kind::kUndo, 1);
      EXPECT_EQ(reply["ok"], true) << reply;
      number = pipeline.telemetry().newest_revision.value();
      EXPECT_EQ(reply["message"].get<std::string>().rfind(
                    "revision " + std::to_string(number) + " takes revision 1 back from the next scan on: ", 0),
                0u)
          << reply;
      EXPECT_TRUE(comes_true([&] { return status()["revision"] == number; })) << "the localizer has it";
      EXPECT_EQ(status()["drive"], "off");
      EXPECT_EQ(asked({Kind::kResume, {}})["ok"], true);
    });
    return number;
  }
};

TEST_F(MapOrderDeskTest, AnUndoIsARevisionLikeAnyOtherAndAReplayDoesItBitForBit) {
  const std::uint32_t number = live_with_undo();
  const Json line = operators_line("live");
  EXPECT_EQ(line["revision"], number);
  EXPECT_EQ(line["reason"], "undo of 1 by an operator");
  EXPECT_EQ(cause(number), "undo of 1 by an operator");
  const mapping::store::MapStore store{settings_.map.store};
  for (const CellChange& change : store.changes(number)) EXPECT_EQ(store.grid(number)[change.cell], change.after);

  std::filesystem::remove(settings_.map.store);
  const RunReport again = replay("live.pcapng", "replayed");
  EXPECT_EQ(again.journal, "obeyed");
  EXPECT_EQ(again.journal_differences, 0u);
  EXPECT_EQ(again.commands, 3u);
  expect_same_files("live", "replayed");
}

TEST_F(MapOrderDeskTest, AnUndoOfAThingTakesItsCellsBackAndAReplayTellsTheSame) {
  (void)run_live(4ms, [&](const Pipeline& pipeline) {
    ASSERT_TRUE(has_revision(pipeline, 1));
    EXPECT_EQ(asked({Kind::kPause, {}})["ok"], true);
    ASSERT_TRUE(comes_true([&] { return !asked({Kind::kThings, {}})["things"].empty(); }));
    const Json thing = asked({Kind::kThings, {}})["things"][0];
    control::Request undo{Kind::kUndoThing, {}};
    undo.thing = thing["thing"];
    const Json reply = asked(undo);
    EXPECT_EQ(reply["ok"], true) << reply;
    EXPECT_NE(reply["message"].get<std::string>().find("takes thing 1 back from the next scan on: "), std::string::npos)
        << reply;
    EXPECT_TRUE(comes_true([&] { return asked({Kind::kThings, {}})["things"][0]["kind"] == "taken back"; }));
    undo.thing = 99;
    EXPECT_EQ(asked(undo)["error"], "not done: there is no thing 99");
    EXPECT_EQ(asked({Kind::kResume, {}})["ok"], true);
  });
  EXPECT_EQ(operators_line("live")["reason"], "undo of thing 1 by an operator");
  const std::string kept = test::content_of(memory_places(settings_.map.store).things);
  EXPECT_FALSE(kept.empty());
  EXPECT_EQ(test::content_of(folder_.path() / "live/things.jsonl"), kept);
  std::filesystem::remove(settings_.map.store);
  EXPECT_EQ(replay("live.pcapng", "replayed").journal_differences, 0u);
  expect_same_files("live", "replayed");
  EXPECT_EQ(test::content_of(folder_.path() / "replayed/things.jsonl"), kept);
}

TEST_F(MapOrderDeskTest, TellsOfBaysWhileItDrivesAndAReplayTellsTheSame) {
  settings_.bays.file = folder_.path() / "bays.yaml";
  std::ofstream{settings_.bays.file}
      << "bays:\n  - {id: box, polygon: [[4.75, 4.75], [5.85, 4.75], [5.85, 5.65], [4.75, 5.65]]}\n";
  (void)run_live(4ms, [&](const Pipeline&) {
    EXPECT_EQ(asked({Kind::kBays, {}})["bays"][0]["state"], "unknown");
    EXPECT_TRUE(comes_true([&] { return asked({Kind::kBays, {}})["bays"][0]["state"] == "full"; }));
    EXPECT_EQ(exit_code({"bays"}), 0);
  });
  const std::string told = test::content_of(folder_.path() / "live/bays.jsonl");
  EXPECT_NE(told.find("\"full\""), std::string::npos) << told;
  EXPECT_EQ(test::content_of(memory_places(settings_.map.store).bays), told);
  std::filesystem::remove(settings_.map.store);
  EXPECT_EQ(replay("live.pcapng", "replayed").journal_differences, 0u);
  EXPECT_EQ(test::content_of(folder_.path() / "replayed/bays.jsonl"), told);
}

TEST_F(MapOrderDeskTest, WhatWasUndoneDoesNotComeBackWithinTheDrive) {
  const std::uint32_t number = live_with_undo();
  const mapping::store::MapStore store{settings_.map.store};
  const OccupancyGrid last = read_grid(folder_.path() / "live/map.yaml");
  for (const CellChange& change : store.changes(number)) {
    EXPECT_EQ(last[change.cell], change.after) << change.cell.column << " " << change.cell.row;
  }
}

TEST_F(MapOrderDeskTest, AReplayWithOtherSettingsObeysItToo) {
  const std::uint32_t number = live_with_undo();
  const std::vector<CellChange> undone = mapping::store::MapStore{settings_.map.store}.changes(number);
  settings_.seed = 2;
  settings_.localizer.beams = 90;
  const RunReport again = replay("live.pcapng", "replayed");
  EXPECT_EQ(again.journal, "not obeyed: other settings or map");
  EXPECT_EQ(again.commands, 3u);
  EXPECT_EQ(operators_line("replayed")["reason"].get<std::string>().rfind("undo of 1 by an operator", 0), 0u);
  const OccupancyGrid last = read_grid(folder_.path() / "replayed/map.yaml");
  for (const CellChange& change : undone) EXPECT_EQ(last[change.cell], change.after);
}

TEST_F(MapOrderDeskTest, ARollbackGoesBackBehindTheStartOfTheRunAndAReplayNeedsNoStore) {
  (void)run_live(4ms, [&](const Pipeline& pipeline) { EXPECT_TRUE(has_revision(pipeline, 1)); });
  std::uint32_t number = 0;
  const RunReport second = run_live(4ms, [&](const Pipeline& pipeline) {
    const std::uint32_t first = pipeline.telemetry().newest_revision.value();
    EXPECT_GE(first, 1u);
    ASSERT_TRUE(reached_scan(30));
    const Json reply = ordered(Kind::kRollBack, 0);
    EXPECT_EQ(reply["ok"], true) << reply;
    EXPECT_NE(reply["message"].get<std::string>().find(" is revision 0 again from the next scan on: "),
              std::string::npos);
    number = operators_line("live")["revision"];
    EXPECT_GT(number, first);
  });
  EXPECT_EQ(second.scans.recording_lost, 0u);
  EXPECT_EQ(mapping::store::MapStore{settings_.map.store}.grid(number), test::small_room(false));
  EXPECT_EQ(cause(number), "rolled back to 0 by an operator");
  std::filesystem::remove(settings_.map.store);
  const RunReport again = replay("live.pcapng", "replayed");
  EXPECT_EQ(again.journal, "obeyed");
  EXPECT_EQ(again.journal_differences, 0u);
  expect_same_files("live", "replayed");
}

TEST_F(MapOrderDeskTest, WhatCannotBeDoneIsToldInOneLineAndChangesNothing) {
  const std::string store = settings_.map.store + ": ";
  const RunReport live = run_live(4ms, [&](const Pipeline&) {
    ASSERT_TRUE(reached_scan(5));
    EXPECT_EQ(asked({Kind::kPause, {}})["ok"], true);
    const auto refusal = [&](Kind kind, std::uint32_t revision) {
      const Json reply = ordered(kind, revision);
      EXPECT_EQ(reply["ok"], false) << reply;
      return reply.value("error", "");
    };
    EXPECT_EQ(refusal(Kind::kUndo, 0), "not done: " + store + "revision 0 is the first map: there is nothing to undo");
    EXPECT_EQ(refusal(Kind::kUndo, 99), "not done: " + store + "no revision 99 (newest: 0)");
    EXPECT_EQ(refusal(Kind::kRollBack, 99), "not done: " + store + "no revision 99 (newest: 0)");
    EXPECT_EQ(refusal(Kind::kRollBack, 0), "not done: the map is as revision 0 was: nothing to do");
    testing::internal::CaptureStderr();
    EXPECT_EQ(exit_code({"undo", "99"}), 1);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "deltamap: not done: " + store + "no revision 99 (newest: 0)\n");
    testing::internal::CaptureStderr();
    EXPECT_EQ(exit_code({"undo"}), 2);
    EXPECT_EQ(exit_code({"undo", "-1"}), 2);
    EXPECT_EQ(exit_code({"rollback", "two"}), 2);
    (void)testing::internal::GetCapturedStderr();
  });
  EXPECT_TRUE(live.changes.empty());
  EXPECT_EQ(mapping::store::MapStore{settings_.map.store}.newest(), 0u);
}

TEST_F(MapOrderDeskTest, WithMappingOffOrAStoreThatFailsNothingIsDoneAndThatIsSaid) {
  settings_.mapping.enabled = false;
  (void)run_live(1ms, [&](const Pipeline&) {
    ASSERT_TRUE(reached_scan(5));
    EXPECT_EQ(ordered(Kind::kUndo, 1)["error"], "'mapping.enabled' is false: nobody works on the map");
  });
  settings_.mapping.enabled = true;
  prepare_ = [](Pipeline::Options& options) {
    options.store.open = []() -> mapping::store::MapStore {
      throw std::runtime_error("store.sqlite: No space left on device");
    };
  };
  (void)run_live(4ms, [&](const Pipeline& pipeline) {
    ASSERT_TRUE(has_revision(pipeline, 1));
    EXPECT_EQ(ordered(Kind::kUndo, 1)["error"],
              "not done: the newest revisions are not in the store yet: store.sqlite: No space left on device");
  });
}

TEST_F(MapOrderDeskTest, WithoutAStoreTheHistoryOfTheRunServes) {
  settings_.map.store.clear();
  prepare_ = [](Pipeline::Options&) {};
  (void)run_live(4ms, [&](const Pipeline& pipeline) {
    ASSERT_TRUE(has_revision(pipeline, 1));
    const Json reply = ordered(Kind::kUndo, 1);
    EXPECT_EQ(reply["ok"], true) << reply;
  });
  EXPECT_EQ(operators_line("live")["reason"], "undo of 1 by an operator");
}

}  // namespace
}  // namespace deltamap::daemon
