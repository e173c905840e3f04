// SPDX-License-Identifier: Apache-2.0
// What the live page commands reaches the running daemon as `deltamap ctl` does; and driving by hand moves the
// simulated robot exactly as long as somebody holds it.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "daemon/dashboard/server.hpp"
#include "daemon/kept/kept_drive.hpp"
#include "drivers/port/port_clock.hpp"
#include "tests/support/daemon/control_fixture.hpp"
#include "tests/support/daemon/web_client.hpp"
#include "tests/support/files/no_descriptors.hpp"

namespace deltamap::daemon {
namespace {

using control::Request;
using drivers::port::port_clock_now;
using test::comes_true;
using test::WebClient;
using Json = nlohmann::json;

constexpr double kStandsWithin_s = 0.3;

/// Who drives: answers each beat with what is wanted.
class Hands {
 public:
  Hands(std::uint16_t port, const std::string& headers) : client_{std::make_unique<WebClient>(port)} {
    EXPECT_EQ(client_->upgraded(headers, "/drive").status, 101);
    first_ = told();
  }
  [[nodiscard]] const Json& first() const { return first_; }
  /// Null where the connection has ended.
  Json told() {
    const auto frame = client_->frame();
    return frame && frame->opcode == 1 ? Json::parse(frame->payload) : Json{};
  }
  /// Answers `beats` beats.
  void hold(double speed_m_per_s, int beats) {
    for (int i = 0; i < beats; ++i) {
      const Json beat = told();
      if (beat["type"] != "beat") return;
      say(beat["number"], speed_m_per_s);
    }
  }
  void say(const Json& beat, double speed_m_per_s) {
    (void)client_->send_frame(
        1, Json{{"beat", beat}, {"speed_m_per_s", speed_m_per_s}, {"turn_rate_rad_per_s", 0.0}}.dump());
  }
  void go_away() { client_.reset(); }

 private:
  std::unique_ptr<WebClient> client_;
  Json first_;
};

class PageCommandsTest : public test::DriveTest {
 protected:
  PageCommandsTest() {
    const dashboard::Server free_port{{.answer = {}, .open = {}}};
    settings_.dashboard.port = free_port.port();
    settings_.dashboard.control = true;
    settings_.navigation.mode = navigation::DriveMode::kWander;
    settings_.map.store = folder_.path() / "store.sqlite";
  }
  void ask_for_token() {
    const auto file = folder_.write("token", "0123456789abcdef\n");
    std::filesystem::permissions(file, std::filesystem::perms::owner_read);
    settings_.dashboard.token_file = file;
    headers_ = "Authorization: Bearer 0123456789abcdef\r\n";
  }
  struct Told {
    int status;
    Json json;
  };
  /// Asked again where a busy machine has not answered in time (504), or has looked too late at the order.
  [[nodiscard]] Told posted(const std::string& body) const {
    Told told{};
    (void)comes_true([&] {
      const auto answer = WebClient{settings_.dashboard.port}.posted("/api/command", body, headers_);
      told = {answer.status, Json::parse(answer.body, nullptr, false)};
      return told.status != 504 && !is_too_late(told.json.value("error", ""));
    });
    return told;
  }
  [[nodiscard]] Hands hands() const {
    std::optional<Hands> hands;
    (void)comes_true([&] {
      hands.emplace(settings_.dashboard.port, headers_);
      return !is_too_late(hands->first().value("why", ""));
    });
    return std::move(*hands);
  }
  static bool is_too_late(const std::string& why) {
    return why.starts_with("it was asked for too long ago") || why.starts_with("not done: no scan has come");
  }

  /// The newest speed that the robot was told, mm/s.
  struct Speed {
    int mm_per_s = 0;
    Timestamp sent{};
  };
  static Speed newest_speed(const test::SimulatedPorts& ports) {
    Speed newest;
    for (const auto& command : ports.commands()) {
      if (command.number != static_cast<std::uint8_t>(drivers::pioneer::CommandNumber::kVel)) continue;
      newest = {command.argument.at(1) | command.argument.at(2) << 8, command.sent};
    }
    return newest;
  }
  /// A busy machine can only be slower than we are: the quickest of some trials, of which the first usually does.
  template <typename Trial>
  static double quickest_s(const Trial& trial) {
    double quickest = 1e9;
    for (int i = 0; i < 20 && quickest >= kStandsWithin_s; ++i) quickest = std::min(quickest, trial());
    return quickest;
  }
  /// When the first zero after `from` was sent, s later.
  static double stands_after_s(const test::SimulatedPorts& ports, Timestamp from) {
    EXPECT_TRUE(comes_true([&] { return newest_speed(ports).mm_per_s == 0; }));
    for (const auto& command : ports.commands()) {
      const bool is_speed = command.number == static_cast<std::uint8_t>(drivers::pioneer::CommandNumber::kVel) ||
                            command.number == static_cast<std::uint8_t>(drivers::pioneer::CommandNumber::kEstop);
      const bool is_zero = command.argument.size() < 3 || (command.argument[1] == 0 && command.argument[2] == 0);
      if (!is_speed || !is_zero || command.sent < from) continue;
      RecordProperty("stood_after_ms", static_cast<int>(1e3 * seconds(command.sent - from)));
      return seconds(command.sent - from);
    }
    return 1e9;
  }
  void drive_until_it_moves(Hands& hands, const test::SimulatedPorts& ports) {
    EXPECT_EQ(hands.first()["type"], "taken") << hands.first();
    for (int i = 0; i < 600 && newest_speed(ports).mm_per_s <= 50; ++i) hands.hold(0.2, 1);
    ASSERT_GT(newest_speed(ports).mm_per_s, 50);
    EXPECT_EQ(status()["drive"], "by hand");
  }
  /// Nothing but standing follows, although the pilot is asked all the while.
  void expect_it_stays(const test::SimulatedPorts& ports) {
    EXPECT_TRUE(comes_true([&] { return status()["drive"] == "off"; }));
    const std::size_t from = ports.commands().size();
    const int scan = status()["localized"];
    EXPECT_TRUE(reached_scan(scan + 10));
    EXPECT_FALSE(moves(ports, from));
    EXPECT_EQ(status()["drive_switch"], "off by the operator");
  }
  [[nodiscard]] drivers::pioneer::DriveSwitch switch_on_disk() const {
    return read_kept_drive(drive_place(settings_.map.store, settings_.robot.port)).value;
  }

  std::string headers_;
};

TEST_F(PageCommandsTest, CommandsTakeTheWayOfCtl) {
  run([&](test::SimulatedPorts&) {
    EXPECT_EQ(posted(R"({"command":"pause"})").status, 200);
    EXPECT_EQ(status()["mapping"], "paused");
    EXPECT_EQ(posted(R"({"command":"resume"})").json["ok"], true);
    EXPECT_EQ(status()["mapping"], "on");
    const Told moved = posted(R"({"command":"relocalize","x_m":1.5,"y_m":2,"heading_deg":10})");
    EXPECT_EQ(moved.status, 200) << moved.json;
    EXPECT_EQ(posted(R"({"command":"status"})").json["ports"]["laser"], "up");
    EXPECT_EQ(posted(R"({"command":"drive","mode":"off"})").status, 200) << "stopping needs no token";
  });
}

TEST_F(PageCommandsTest, WhatTheDeskRefusesIsToldInItsWords) {
  run([&](test::SimulatedPorts&) {
    const std::vector<std::pair<std::string, std::string>> bad{
        {"", "a request is one JSON object in one line"},
        {"[1]", "a request is one JSON object in one line"},
        {"{\"command\":\"pause\"", "a request is one JSON object in one line"},
        {"{\"command\":\"\xFF\"}", "a request is one JSON object in one line"},
        {"{}", "a request needs a command"},
        {R"({"command":"explode"})", "unknown command 'explode'"},
        {R"({"command":"drive"})", "'drive' needs the mode off or wander"},
        {R"({"command":"relocalize","x_m":1})", "'relocalize' needs the numbers x_m, y_m and heading_deg"},
        {R"({"command":"relocalize","x_m":900,"y_m":2,"heading_deg":0})", "that pose lies outside the map"}};
    for (const auto& [body, why] : bad) {
      const Told told = posted(body);
      EXPECT_EQ(told.status, 409) << body;
      EXPECT_EQ(told.json["ok"], false) << body;
      EXPECT_EQ(told.json["error"], why) << body;
    }
  });
}

TEST_F(PageCommandsTest, WithoutATokenNothingThatMovesTheRobotIsDone) {
  run([&](test::SimulatedPorts& ports) {
    const Told told = posted(R"({"command":"drive","mode":"wander"})");
    EXPECT_EQ(told.status, 403);
    EXPECT_EQ(told.json["error"], "what moves the robot needs 'dashboard.token_file'");
    EXPECT_EQ(WebClient{settings_.dashboard.port}.upgraded("", "/drive").status, 403);
    const int scan = status()["localized"];
    EXPECT_TRUE(reached_scan(scan + 10));
    EXPECT_FALSE(moves(ports));
  });
}

TEST_F(PageCommandsTest, BaysAndZonesAreDrawnOverTheListThatThePageReads) {
  settings_.zones.file = folder_.write("zones.yaml", "zones:\n").string();
  const auto site = [&] {
    return Json::parse(WebClient{settings_.dashboard.port}.got("/api/site", headers_).body)["zones"];
  };
  const auto draw = [&](const std::string& version) {
    return posted(Json{{"command", "zone"},
                       {"version", version},
                       {"place", {{"zoneId", "dock"}, {"zoneType", "FROZEN"}, {"vertices", {{1, 1}, {2, 1}, {2, 2}}}}}}
                      .dump());
  };
  run([&](test::SimulatedPorts&) {
    const Told told = draw(site()["version"]);
    EXPECT_EQ(told.status, 403) << "as whatever changes where the robot drives";
    EXPECT_EQ(told.json["error"], "what changes where the robot drives needs 'dashboard.token_file'");
  });
  ask_for_token();
  run([&](test::SimulatedPorts&) {
    const std::string version = site()["version"];
    EXPECT_EQ(site()["file"], settings_.zones.file);
    EXPECT_EQ(draw(version).status, 200);
    EXPECT_EQ(site()["places"][0],
              (Json{{"zoneId", "dock"}, {"zoneType", "FROZEN"}, {"vertices", {{1.0, 1.0}, {2.0, 1.0}, {2.0, 2.0}}}}));
    const Told late = draw(version);
    EXPECT_EQ(late.status, 409) << late.json;
    EXPECT_NE(late.json["error"].get<std::string>().find("look at them again"), std::string::npos);
    headers_ = "";
    EXPECT_EQ(WebClient{settings_.dashboard.port}.posted("/api/command", "{}", "").status, 401) << "a wrong token";
  });
}

TEST_F(PageCommandsTest, ByHandItMovesAndStandsAtReleaseAndAgainstNobodysWill) {
  ask_for_token();
  run([&](test::SimulatedPorts& ports) {
    Hands hands = this->hands();
    const double stands_s = quickest_s([&] {
      drive_until_it_moves(hands, ports);
      const Json beat = hands.told();
      const Timestamp released = port_clock_now();
      hands.say(beat["number"], 0.0);
      return stands_after_s(ports, released);
    });
    EXPECT_LT(stands_s, kStandsWithin_s);
    EXPECT_EQ(switch_on_disk(), drivers::pioneer::DriveSwitch::kOffByOperator) << "a restart must not drive by itself";
    EXPECT_EQ(asked({Request::Kind::kDriveWander, {}})["error"], "it is driven by hand: that must end first");
    Hands second = this->hands();
    EXPECT_EQ(second.first()["why"], "somebody else drives it by hand");
    hands.hold(0.2, 3);
    EXPECT_EQ(status()["drive"], "by hand") << "who was refused did not let it go";
    hands.go_away();
    expect_it_stays(ports);
  });
}

TEST_F(PageCommandsTest, ByHandItComesToRestBeforeABlockedZoneAndIsSlowInASlowOne) {
  ask_for_token();
  settings_.zones.file =
      folder_
          .write("zones.yaml",
                 "zones:\n  - {zoneId: slow, zoneType: SPEED_LIMIT, maximumSpeed: 0.15, vertices: [[0, 0], [2.6, 0], "
                 "[2.6, 4], [0, 4]]}\n"
                 "  - {zoneId: dock, zoneType: BLOCKED, vertices: [[2, 0.5], [3, 0.5], [3, 3.5], [2, 3.5]]}\n")
          .string();
  run([&](test::SimulatedPorts& ports) {
    Hands hands = this->hands();
    drive_until_it_moves(hands, ports);
    EXPECT_EQ(status()["zone_limit_m_per_s"], 0.15);
    Json now = status();
    for (int i = 0; i < 600 && now["stopped_by"] != "blocked zone"; ++i) {
      hands.hold(0.4, 1);
      EXPECT_LE(newest_speed(ports).mm_per_s, 150);
      now = status();
    }
    EXPECT_EQ(now["stopped_by"], "blocked zone");
    const double before_it_m = 2.0 - now["pose"]["x_m"].get<double>();
    EXPECT_GT(before_it_m, settings_.navigation.safety.robot_radius_m) << "its hull is not in it";
    EXPECT_LT(before_it_m, 0.6);
  });
}

TEST_F(PageCommandsTest, AConnectionThatIsLostOrSilentMakesItStand) {
  ask_for_token();
  run([&](test::SimulatedPorts& ports) {
    const double closed_s = quickest_s([&] {
      Hands hands = this->hands();
      drive_until_it_moves(hands, ports);
      const Timestamp gone = port_clock_now();
      hands.go_away();
      const double stands_s = stands_after_s(ports, gone);
      expect_it_stays(ports);
      return stands_s;
    });
    EXPECT_LT(closed_s, kStandsWithin_s) << "a closed tab";
    const double pulled_s = quickest_s([&] {
      Hands hands = this->hands();
      drive_until_it_moves(hands, ports);
      const Timestamp silent = port_clock_now();
      const double stands_s = stands_after_s(ports, silent);
      expect_it_stays(ports);
      return stands_s;
    });
    EXPECT_LT(pulled_s, kStandsWithin_s) << "a cable that was pulled: open, and nothing comes";
  });
}

TEST_F(PageCommandsTest, AnswersThatWereLongOnTheirWayDoNotDrive) {
  ask_for_token();
  run([&](test::SimulatedPorts& ports) {
    Hands hands = this->hands();
    ASSERT_EQ(hands.first()["type"], "taken");
    std::vector<Json> beats;
    for (int i = 0; i < 4; ++i) beats.push_back(hands.told()["number"]);
    hands.hold(0.0, 4);  // 0.4 s later
    const std::size_t from = ports.commands().size();
    for (const Json& beat : beats) hands.say(beat, 0.3);
    hands.hold(0.0, 5);
    for (std::size_t i = from; i < ports.commands().size(); ++i) {
      const auto command = ports.commands()[i];
      if (command.number != static_cast<std::uint8_t>(drivers::pioneer::CommandNumber::kVel)) continue;
      EXPECT_EQ(command.argument[1] | command.argument[2] << 8, 0);
    }
  });
}

TEST_F(PageCommandsTest, StopEndsDrivingByHandAndWandering) {
  ask_for_token();
  run([&](test::SimulatedPorts& ports) {
    const double stands_s = quickest_s([&] {
      EXPECT_EQ(posted(R"({"command":"drive","mode":"wander"})").status, 200);
      EXPECT_TRUE(comes_true([&] { return newest_speed(ports).mm_per_s > 0; }));
      Hands hands = this->hands();
      drive_until_it_moves(hands, ports);
      const Timestamp stopped = port_clock_now();
      EXPECT_EQ(posted(R"({"command":"drive","mode":"off"})").status, 200);
      const double after_s = stands_after_s(ports, stopped);
      Json told = hands.told();
      while (told["type"] == "beat") told = hands.told();
      EXPECT_EQ(told["why"], "driving was switched off");
      expect_it_stays(ports);
      return after_s;
    });
    EXPECT_LT(stands_s, kStandsWithin_s);
    EXPECT_EQ(switch_on_disk(), drivers::pioneer::DriveSwitch::kOffByOperator);
  });
}

TEST_F(PageCommandsTest, StopAndDriveOffAreDoneAndKeptWhereTheDaemonCanOpenNothingMore) {
  ask_for_token();
  for (const bool by_page : {true, false}) {
    run([&](test::SimulatedPorts& ports) {
      ASSERT_EQ(posted(R"({"command":"drive","mode":"wander"})").status, 200);
      EXPECT_TRUE(comes_true([&] { return newest_speed(ports).mm_per_s > 0; }));
      WebClient page;
      test::SocketClient ctl;
      std::optional<test::NoDescriptors> none_left{std::in_place};
      const std::string stop = control::line_of({Request::Kind::kDriveOff, {}});
      const Timestamp stopped = port_clock_now();
      if (by_page) {
        page.connect(settings_.dashboard.port);
        EXPECT_EQ(page.posted("/api/command", stop).status, 200) << "without the token, too";
      } else {
        ctl.connect(settings_.control.socket);
        EXPECT_EQ(ctl.asked(stop), control::done_line("the robot is told to stand"));
      }
      EXPECT_LT(stands_after_s(ports, stopped), kStandsWithin_s);
      none_left.reset();
      EXPECT_EQ(switch_on_disk(), drivers::pioneer::DriveSwitch::kOffByOperator);
    });
  }
}

TEST_F(PageCommandsTest, WhereTheOffCannotBeKeptOnDiskNobodyTakesIt) {
  ask_for_token();
  const auto file = drive_place(settings_.map.store, settings_.robot.port).file;
  std::filesystem::create_directories(std::filesystem::path{file.string() + ".part"} / "in the way");
  run([&](test::SimulatedPorts& ports) {
    Hands hands = this->hands();
    const std::string why = hands.first().value("why", "");
    EXPECT_TRUE(why.starts_with("that the pilot stays off cannot be kept on disk: ")) << hands.first();
    const int scan = status()["localized"];
    EXPECT_TRUE(reached_scan(scan + 5));
    EXPECT_FALSE(moves(ports));
  });
}

TEST_F(PageCommandsTest, WhereTheSettingsSayOffNobodyTakesIt) {
  ask_for_token();
  settings_.navigation.mode = navigation::DriveMode::kOff;
  run([&](test::SimulatedPorts& ports) {
    Hands hands = this->hands();
    EXPECT_EQ(hands.first()["why"],
              "'navigation.mode' is off: this daemon never drives (set it to wander, and restart)");
    EXPECT_FALSE(moves(ports));
  });
}

}  // namespace
}  // namespace deltamap::daemon
