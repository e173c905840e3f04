// SPDX-License-Identifier: Apache-2.0
// Zones that are drawn while the robot drives: `ctl reload` takes them, and a replay takes them before the same scan.
#include "daemon/site_reload.hpp"

#include <nlohmann/json.hpp>

#include "tests/support/daemon/control_fixture.hpp"

namespace deltamap::daemon {
namespace {

using control::Request;
using test::comes_true;
using Json = nlohmann::json;
using namespace std::chrono_literals;

class SiteReloadTest : public test::ControlDeskTest {
 protected:
  SiteReloadTest() {
    settings_.zones.file = folder_.path() / "zones.yaml";
    write_zones("");
    live_ = std::make_shared<LiveSettings>(SettingsReading{.settings = settings_},
                                           [this] { return SettingsReading{.settings = settings_}; });
  }
  void write_zones(const std::string& zones) const { std::ofstream{settings_.zones.file} << "zones:\n" << zones; }
  [[nodiscard]] Json reloaded() const { return asked({Request::Kind::kReload, {}}); }
};

const std::string kFrozenBox =
    "  - {zoneId: box, zoneType: FROZEN, vertices: [[4.6, 4.6], [6, 4.6], [6, 5.8], [4.6, 5.8]]}\n";

TEST_F(SiteReloadTest, TakesZonesWhileItDrivesAndAReplayDoesSoBeforeTheSameScan) {
  (void)run_live(4ms, [&](const Pipeline& pipeline) {
    ASSERT_TRUE(comes_true([&] { return pipeline.telemetry().localized.value() > 20; }));
    write_zones(kFrozenBox);
    const Json reply = reloaded();
    EXPECT_EQ(reply["ok"], true) << reply;
    EXPECT_NE(reply["message"].get<std::string>().find("taken: 0 bays, 1 zone"), std::string::npos) << reply;
  });
  EXPECT_EQ(test::content_of(folder_.path() / "live/things.jsonl"), "") << "the box was not written";
  write_zones("");  // of the recording, not of the file as it is now
  const RunReport again = replay("live.pcapng", "replayed");
  EXPECT_EQ(again.commands, 1u);
  EXPECT_EQ(again.journal_differences, 0u);
  expect_same_files("live", "replayed");
}

TEST_F(SiteReloadTest, WhatCannotBeIsRefusedAndTheOldZonesStay) {
  (void)run_live(4ms, [&](const Pipeline& pipeline) {
    ASSERT_TRUE(comes_true([&] { return pipeline.telemetry().localized.value() > 5; }));
    write_zones("  - {zoneId: off, zoneType: FROZEN, vertices: [[1, 1], [99, 1], [99, 9]]}\n");
    Json reply = reloaded();
    EXPECT_EQ(reply["ok"], false);
    EXPECT_NE(reply["error"].get<std::string>().find("bays and zones stay as they are: "), std::string::npos) << reply;
    EXPECT_NE(reply["error"].get<std::string>().find("zone 'off' lies off the map"), std::string::npos) << reply;
    write_zones("  - {zoneId: all, zoneType: BLOCKED, vertices: [[0, 0], [10, 0], [10, 8], [0, 8]]}\n");
    reply = reloaded();
    EXPECT_EQ(reply["ok"], true);
    EXPECT_NE(reply["message"].get<std::string>().find("zone 'all' is BLOCKED and lies over the robot's own place"),
              std::string::npos)
        << reply;
  });
}

TEST(ZonesOver, TellOfBlockedZonesAroundTheRobotAndWhatItCanDoThere) {
  const navigation::SafetyParams safety;
  const Zones zones{{.id = "X", .kind = ZoneKind::kBlocked, .polygon = {{1, 1}, {3, 1}, {3, 3}, {1, 3}}},
                    {.id = "Y", .kind = ZoneKind::kIgnore, .polygon = {{0, 0}, {9, 0}, {9, 9}}},
                    {.id = "Z", .kind = ZoneKind::kBlocked, .polygon = {{3.4, 1}, {5, 1}, {5, 3}, {3.4, 3}}}};
  using Lines = std::vector<std::string>;
  EXPECT_EQ(zones_over({0.6, 2.0}, zones, safety), Lines{});
  EXPECT_EQ(zones_over({2.0, 2.0}, zones, safety),
            Lines{"zone 'X' is BLOCKED and lies over the robot's own place: it may leave, and does not come back"});
  EXPECT_EQ(
      zones_over({0.8, 2.0}, zones, safety),
      Lines{"the border of blocked zone 'X' is within 0.34 m of the robot's middle, where its hull and its margin "
            "reach: it turns, and drives straight away from the border alone"});
  EXPECT_EQ(zones_over({3.2, 2.0}, zones, safety),
            Lines{"the border of blocked zone 'X', 'Z' is within 0.34 m of the robot's middle, where its hull and its "
                  "margin reach: it turns, and no way ahead is left: draw the border farther away"});
}

}  // namespace
}  // namespace deltamap::daemon
