// SPDX-License-Identifier: Apache-2.0
// Bays and zones that a person draws while the robot drives: written, in force from the next scan on, and taken by a
// replay before the same scan. Whatever speaks against it leaves file and daemon as they were.
#include "daemon/site_drawing.hpp"

#include <nlohmann/json.hpp>

#include "daemon/site/bays_file.hpp"
#include "daemon/site/zones_file.hpp"
#include "tests/support/daemon/control_fixture.hpp"

namespace deltamap::daemon {
namespace {

using control::Request;
using test::comes_true;
using test::content_of;
using Json = nlohmann::json;
using namespace std::chrono_literals;
namespace fs = std::filesystem;

const std::string kBoxZone = R"({"zoneId":"box","zoneType":"FROZEN","vertices":[[4.6,4.6],[6,4.6],[6,5.8],[4.6,5.8]]})";
const std::string kDrawnBay = R"({"id":"B4","polygon":[[1,1],[3,1],[3,3],[1,3]]})";

class SiteDrawingTest : public test::ControlDeskTest {
 protected:
  SiteDrawingTest() {
    settings_.zones.file = folder_.write("zones.yaml", kWritten).string();
    settings_.bays.file = folder_.write("bays.yaml", "bays:\n").string();
    live_ = std::make_shared<LiveSettings>(SettingsReading{.settings = settings_},
                                           [this] { return SettingsReading{.settings = settings_}; });
  }
  void with_run(const std::function<void()>& act) {
    (void)run_live(4ms, [&](const Pipeline& pipeline) {
      ASSERT_TRUE(comes_true([&] { return pipeline.telemetry().localized.value() > 5; }));
      act();
    });
  }
  [[nodiscard]] Json sent(const SiteEdit& edit) const {
    Request request{Request::Kind::kEditSite, {}};
    request.edit = edit;
    return asked(request);
  }
  [[nodiscard]] Site site() const {
    return {bays_of_text(content_of(settings_.bays.file), "b"), zones_of_text(content_of(settings_.zones.file), "z")};
  }
  /// By a scan that came after what was drawn last.
  [[nodiscard]] bool is_taken() const {
    const int scan = status()["localized"];
    return reached_scan(scan + 1);
  }
  /// On the list as its file has it.
  [[nodiscard]] Json drawn(PlaceKind kind, const std::string& place, const std::string& of = "") const {
    return sent({kind, version_of(site(), kind), of, place});
  }
  [[nodiscard]] std::vector<std::string> earlier_files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_.path())) {
      const std::string name = entry.path().filename().string();
      const bool is_earlier = name.starts_with("zones.") && name != "zones.yaml";
      if (is_earlier) names.push_back(name);
    }
    return names;
  }
  static std::string error_of(const Json& reply) { return reply.value("error", "done: " + reply.dump()); }

  static constexpr const char* kWritten =
      "# drawn by hand\nzones:\n  - {zoneId: far, zoneType: TEMPORARY, vertices: [[8, 1], [9, 1], [9, 2]]}\n";
};

TEST_F(SiteDrawingTest, IsWrittenAndHoldsAndAReplayTakesItBeforeTheSameScan) {
  with_run([&] {
    const Json reply = drawn(PlaceKind::kZone, kBoxZone);
    EXPECT_EQ(reply["ok"], true) << reply;
    EXPECT_TRUE(reply["message"].get<std::string>().starts_with("in force, and written: 2 zones in ")) << reply;
    ASSERT_TRUE(is_taken()) << "what is drawn before the next scan is taken with it, as one";
    EXPECT_EQ(drawn(PlaceKind::kBay, kDrawnBay)["ok"], true);
    ASSERT_TRUE(is_taken());
    EXPECT_EQ(asked({Request::Kind::kReload, {}})["ok"], true);
  });
  EXPECT_EQ(site().zones.size(), 2u);
  EXPECT_EQ(content_of(folder_.path() / "live/things.jsonl"), "") << "the box was not written";
  const RunReport again = replay("live.pcapng", "replayed");
  EXPECT_EQ(again.commands, 3u) << "the first zones, one more, a bay; the reload found nothing new";
  EXPECT_EQ(again.journal_differences, 0u);
  expect_same_files("live", "replayed");
}

TEST_F(SiteDrawingTest, WhatIsDrawnWhileNothingIsRecordedHoldsInTheReplayBehindTheGap) {
  with_run([&] {
    ASSERT_EQ(asked({Request::Kind::kRecordStop, {}})["ok"], true);
    ASSERT_EQ(drawn(PlaceKind::kZone, kBoxZone)["ok"], true);
    const int scan = status()["localized"];
    ASSERT_TRUE(reached_scan(scan + 5));
    ASSERT_EQ(asked({Request::Kind::kRecordStart, {}})["ok"], true);
  });
  EXPECT_EQ(content_of(folder_.path() / "live/things.jsonl"), "");
  EXPECT_EQ(replay("live.pcapng", "replayed").commands, 2u);
  EXPECT_EQ(content_of(folder_.path() / "replayed/things.jsonl"), "") << "the box was not written there, either";
}

TEST_F(SiteDrawingTest, WhatARewriteLosesIsKeptBesideItOnce) {
  with_run([&] {
    const Json reply = drawn(PlaceKind::kZone, kBoxZone);
    ASSERT_EQ(earlier_files().size(), 1u);
    EXPECT_EQ(content_of(folder_.path() / earlier_files().front()), kWritten);
    EXPECT_NE(reply["message"].get<std::string>().find(earlier_files().front()), std::string::npos) << reply;
    EXPECT_EQ(drawn(PlaceKind::kZone, "", "far")["ok"], true);
    EXPECT_EQ(earlier_files().size(), 1u) << "of its own file nothing is lost";
  });
  EXPECT_EQ(site().zones.size(), 1u);
}

TEST_F(SiteDrawingTest, WhoHasSeenAnotherListMustLookAgain) {
  with_run([&] {
    const std::string seen = version_of(site(), PlaceKind::kZone);
    ASSERT_EQ(drawn(PlaceKind::kZone, kBoxZone)["ok"], true);
    const std::string before = content_of(settings_.zones.file);
    const Json reply = sent({PlaceKind::kZone, seen, "far", ""});
    EXPECT_NE(error_of(reply).find("somebody has drawn or reloaded: look at them again"), std::string::npos) << reply;
    EXPECT_EQ(content_of(settings_.zones.file), before);
    EXPECT_EQ(sent({PlaceKind::kBay, version_of(site(), PlaceKind::kBay), "", kDrawnBay})["ok"], true)
        << "of other lists";
  });
}

TEST_F(SiteDrawingTest, WhatSomebodyWroteIntoTheFileIsNotOverwritten) {
  with_run([&] {
    const std::string seen = version_of(site(), PlaceKind::kZone);
    const std::string by_hand = "zones:\n  - {zoneId: new, zoneType: FROZEN, vertices: [[1, 1], [2, 1], [2, 2]]}\n";
    std::ofstream{settings_.zones.file} << by_hand;
    EXPECT_NE(error_of(sent({PlaceKind::kZone, seen, "", kBoxZone})).find("say `deltamap ctl reload`"),
              std::string::npos);
    EXPECT_EQ(content_of(settings_.zones.file), by_hand);
    std::ofstream{settings_.zones.file} << "zones: [\n";
    EXPECT_NE(error_of(sent({PlaceKind::kZone, seen, "", kBoxZone})).find("not YAML"), std::string::npos);
    fs::remove(settings_.zones.file);
    EXPECT_NE(error_of(sent({PlaceKind::kZone, seen, "", kBoxZone})).find("zones.yaml: "), std::string::npos);
    EXPECT_FALSE(fs::exists(settings_.zones.file));
  });
}

TEST_F(SiteDrawingTest, WhatCannotBeOrCannotBeWrittenChangesNothing) {
  with_run([&] {
    const std::string off = R"({"zoneId":"off","zoneType":"FROZEN","vertices":[[1,1],[99,1],[99,9]]})";
    EXPECT_NE(error_of(drawn(PlaceKind::kZone, off)).find("zones.yaml: zone 'off' lies off the map"),
              std::string::npos);
    fs::create_directories(fs::path{settings_.zones.file + ".part"} / "in the way");
    const std::string seen = version_of(site(), PlaceKind::kZone);
    const Json reply = sent({PlaceKind::kZone, seen, "", kBoxZone});
    EXPECT_NE(error_of(reply).find("cannot be written"), std::string::npos) << reply;
    EXPECT_NE(error_of(reply).find("name a place for 'zones.file' where the daemon may write"), std::string::npos);
    EXPECT_EQ(content_of(settings_.zones.file), kWritten);
    fs::remove_all(settings_.zones.file + ".part");
    EXPECT_EQ(sent({PlaceKind::kZone, seen, "", kBoxZone})["ok"], true) << "the same is in force as before";
  });
}

TEST_F(SiteDrawingTest, AZoneOverTheRobotIsTakenAndWarnedOf) {
  with_run([&] {
    const Json reply =
        drawn(PlaceKind::kZone, R"({"zoneId":"all","zoneType":"BLOCKED","vertices":[[0,0],[10,0],[10,8],[0,8]]})");
    EXPECT_EQ(reply["ok"], true) << reply;
    EXPECT_EQ(reply["doubt"], true) << reply;
    EXPECT_NE(reply["message"].get<std::string>().find("zone 'all' is BLOCKED and lies over the robot's own place"),
              std::string::npos)
        << reply;
  });
}

TEST_F(SiteDrawingTest, AnIdOfAnyCharactersIsDrawnOnWithoutAReload) {
  with_run([&] {
    const std::string odd = "\xEF\xBF\xBF";  // U+FFFF
    Json zone = Json::parse(kBoxZone);
    zone["zoneId"] = odd;
    EXPECT_EQ(drawn(PlaceKind::kZone, zone.dump())["ok"], true);
    const Json reply = drawn(PlaceKind::kZone, "", odd);
    EXPECT_EQ(reply["ok"], true) << reply << ": what it has written is what is in force";
  });
  EXPECT_EQ(site().zones.size(), 1u);
}

TEST_F(SiteDrawingTest, WhereNoFileIsNamedTheKeyIsTold) {
  settings_.bays.file = "";
  with_run([&] {
    const Json reply = sent({PlaceKind::kBay, version_of(Site{}, PlaceKind::kBay), "", kDrawnBay});
    EXPECT_EQ(error_of(reply), "'bays.file' names no file: set it to one that holds 'bays:', and restart");
  });
}

}  // namespace
}  // namespace deltamap::daemon
