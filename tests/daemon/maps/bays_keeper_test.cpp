// SPDX-License-Identifier: Apache-2.0
#include "daemon/maps/bays_keeper.hpp"

#include <nlohmann/json.hpp>

#include "daemon/maps/kept_bays.hpp"
#include "daemon/outputs/bay_note.hpp"
#include "tests/support/daemon/saving_fixture.hpp"
#include "tests/support/files/text_file.hpp"

namespace deltamap::daemon {
namespace {

using mapping::bays::BayEvent;
using mapping::bays::BayState;
using Json = nlohmann::json;

class BaysKeeperTest : public test::SavingFixture {
 protected:
  [[nodiscard]] static BayEvent event() {
    BayEvent told;
    told.bay = {.id = "B4", .station_id = "ST-1", .polygon = {{1.0, 1.0}, {3.4, 1.0}, {3.4, 3.4}, {1.0, 3.4}}};
    told.before = BayState::kEmpty;
    told.status = {
        .state = BayState::kFull, .share = 0.934, .confidence = 0.8, .seen = test::at_s(8), .since = test::at_s(7)};
    told.time = test::at_s(9);
    return told;
  }
  [[nodiscard]] static mapping::things::Thing thing(std::uint32_t id, Point2 middle) {
    mapping::things::Thing one;
    one.id = id;
    one.at = mapping::things::Outline{middle, 2.4, 2.4, 0.0, {}};
    return one;
  }

  std::filesystem::path kept = folder.path() / "store.bays.jsonl";
};

TEST_F(BaysKeeperTest, WritesALineAChangeIntoBothFilesAndBeginsThemAnew) {
  for (int run = 0; run < 2; ++run) {
    BaysKeeper keeper{{.out = folder.path(), .kept = kept}, telemetry.outputs, warn(), test::at_s(0)};
    EXPECT_EQ(test::content_of(kept), "");
    keeper.take(event(), {thing(3, {2.2, 2.2}), thing(4, {9.0, 2.2})}, test::at_s(9));
    const std::string lines = test::content_of(folder.path() / "bays.jsonl");
    EXPECT_EQ(test::content_of(kept), lines);
    const Json line = Json::parse(lines);
    EXPECT_EQ(line["bay"], "B4");
    EXPECT_EQ(line["stationId"], "ST-1");
    EXPECT_EQ(line["before"], "empty");
    EXPECT_EQ(line["state"], "full");
    EXPECT_EQ(line["age_s"], 1.0);
    EXPECT_EQ(line["things"], Json({3})) << "the other stands elsewhere";
  }
}

TEST_F(BaysKeeperTest, KeepsWhatIsKnownForTheNextRunSoonAfterAChangeAndNowAndThen) {
  const auto seen = folder.path() / "store.bays-seen.json";
  const auto list_at = [](double s) {
    BayList list{{event().bay}, {event().status}};
    list.statuses[0].seen = test::at_s(s);
    return list;
  };
  const auto kept_at = [&] {
    const BayList list = bays_of_kept_text(test::content_of(seen), 7, test::at_s(1000));
    return list.statuses.empty() ? std::nullopt : list.statuses[0].seen;
  };
  BaysKeeper keeper{{.seen = seen, .first_map = 7}, telemetry.outputs, warn(), test::at_s(0)};
  keeper.keep(list_at(8), test::at_s(9));
  EXPECT_FALSE(std::filesystem::exists(seen)) << "nothing has changed, and it is not time";
  keeper.take(event(), {}, test::at_s(9));
  keeper.keep(list_at(8), test::at_s(9));
  EXPECT_EQ(kept_at(), test::at_s(8));
  keeper.keep(list_at(30), test::at_s(30));
  EXPECT_EQ(kept_at(), test::at_s(8));
  keeper.keep(list_at(69), test::at_s(70));
  EXPECT_EQ(kept_at(), test::at_s(69));
  keeper.close(list_at(75), test::at_s(75));
  EXPECT_EQ(kept_at(), test::at_s(75));
}

TEST_F(BaysKeeperTest, WhatIsUnknownHasNoShare) {
  BayEvent told = event();
  told.status = {};
  const Json line = Json::parse(json_line(told, {}));
  EXPECT_EQ(line["share"], nullptr);
  EXPECT_EQ(line["last_seen"], nullptr);
  EXPECT_EQ(words_of(told), "bay B4: unknown, was empty");
  EXPECT_EQ(words_of(event()), "bay B4: full, was empty; 0.93 of its floor is taken");
}

}  // namespace
}  // namespace deltamap::daemon
