// SPDX-License-Identifier: Apache-2.0
// What a person has switched off, a person switches on: every event in every state, through the real session and a
// robot with buttons, with what is sent. docs/decisions/who-may-drive.md shows the same table.
#include "drivers/pioneer/drive_permission.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <map>

#include "tests/drivers/pioneer/session_fixture.hpp"
#include "tests/support/files/figure.hpp"
#include "tests/support/files/source_tree.hpp"
#include "tests/support/files/text_file.hpp"

namespace deltamap::drivers::pioneer {
namespace {

/// A daemon in small: a pilot that always wants to drive, a link that is opened again, a switch that is kept.
class Rig {
 public:
  explicit Rig(bool is_configured, DriveSwitch kept) : is_configured_{is_configured}, kept_{kept} {
    begin();
    run(3.0);
  }

  void run(double duration_s) {
    for (const Timestamp end = line.now + duration_from_seconds(duration_s); line.now < end;) {
      line.run_for(0.05);
      kept_ = session.permission().drive_switch();
      if (line.failed) {
        if (!try_again_at_) try_again_at_ = line.now + std::chrono::milliseconds{500};
        if (line.now < *try_again_at_) {
          line.now += std::chrono::milliseconds{50};  // nobody is there
          robot.tick(line.now);
          robot.outgoing.clear();
        } else {
          begin();
        }
      }
      line.carry_out(session.drive({line.now, 0.3, 0.0}, line.now));
    }
  }

  void press_motors() { robot.motors_on = !robot.motors_on; }
  void press_stop() {
    robot.stop_button = true;
    robot.motors_on = false;
    run(0.3);
    robot.stop_button = false;
  }
  void silence(double duration_s) {
    robot.is_mute = robot.is_deaf = true;
    run(duration_s);
    robot.is_mute = robot.is_deaf = false;
  }
  void reset() {
    robot.connected = false;
    robot.motors_on = false;
    robot.speed = robot.turn_rate = 0;
  }
  void kill_and_restart() {
    robot.outgoing.clear();
    begin_anew();
  }
  void say(bool on) { line.carry_out(session.switch_drive(on, line.now)); }

  [[nodiscard]] int times_sent(const Command& command) const {
    const auto bytes = encoded_command(command);
    return static_cast<int>(std::count_if(line.written.begin(), line.written.end(),
                                          [&](const tests::WrittenBytes& written) { return written.bytes == bytes; }));
  }

  FakeRobot robot{9600};
  TestedSession session{PioneerParams{}, SessionMode::kLive};
  tests::Conversation<TestedSession, FakeRobot> line{session, robot};

 private:
  void begin() {
    line.failed.reset();
    try_again_at_.reset();
    if (!began_) return begin_anew();
    line.start();
  }
  void begin_anew() {
    began_ = true;
    line.failed.reset();
    try_again_at_.reset();
    session = TestedSession{{.enable_motors = is_configured_, .drive_switch = kept_}, SessionMode::kLive};
    line.start();
  }

  bool is_configured_;
  bool began_ = false;
  DriveSwitch kept_;
  std::optional<Timestamp> try_again_at_;
};

struct State {
  const char* name;
  bool is_configured;
  DriveSwitch kept;
  std::function<void(Rig&)> enter;
};

const std::vector<State>& states() {
  const auto stay = [](Rig&) {};
  const auto off_by = [](const std::function<void(Rig&)>& act) {
    return [act](Rig& rig) {
      act(rig);
      rig.run(1.0);
    };
  };
  static const std::vector<State> all{
      {"nobody has said anything", true, DriveSwitch::kUnknown, stay},
      {"on, it drives", true, DriveSwitch::kOn, stay},
      {"off by the MOTORS button", true, DriveSwitch::kOn, off_by([](Rig& rig) { rig.press_motors(); })},
      {"off by the STOP button", true, DriveSwitch::kOn, off_by([](Rig& rig) { rig.press_stop(); })},
      {"`drive off` while it drove", true, DriveSwitch::kOn, off_by([](Rig& rig) { rig.say(false); })},
      {"`drive off` in an earlier run", true, DriveSwitch::kOffByOperator, stay},
      {"`navigation.mode: off`", false, DriveSwitch::kOn, stay}};
  return all;
}

struct Event {
  const char* name;
  std::function<void(Rig&)> happen;
};

const std::vector<Event>& events() {
  static const std::vector<Event> all{{"MOTORS button", [](Rig& rig) { rig.press_motors(); }},
                                      {"STOP button, let go", [](Rig& rig) { rig.press_stop(); }},
                                      {"link silent for 2 s", [](Rig& rig) { rig.silence(2.0); }},
                                      {"controller reset", [](Rig& rig) { rig.reset(); }},
                                      {"daemon killed, started", [](Rig& rig) { rig.kill_and_restart(); }},
                                      {"`drive off`", [](Rig& rig) { rig.say(false); }},
                                      {"`drive wander`", [](Rig& rig) { rig.say(true); }}};
  return all;
}

/// What is sent to the motors, and whether the robot then drives: "drives", "ENABLE 1, drives", "stands".
std::string outcome_of(const State& state, const Event& event) {
  Rig rig{state.is_configured, state.kept};
  state.enter(rig);
  const int before = rig.times_sent({CommandNumber::kEnable, 1});
  event.happen(rig);
  rig.run(0.3);
  rig.robot.has_ever_moved = false;
  rig.run(6.0);
  EXPECT_TRUE(rig.session.is_connected()) << state.name << ", " << event.name;
  EXPECT_EQ(rig.times_sent({CommandNumber::kEnable, 0}), 0) << state.name << ", " << event.name;
  EXPECT_EQ(rig.robot.has_ever_moved, rig.robot.moves) << state.name << ", " << event.name;
  const int enables = rig.times_sent({CommandNumber::kEnable, 1}) - before;
  std::string text = rig.robot.moves ? "drives" : "stands";
  for (int i = 0; i < enables; ++i) text.insert(0, "ENABLE 1, ");
  return text;
}

/// One line of the table in Markdown.
std::string row_of(const State& state) {
  std::string row = std::string("| ") + state.name + " |";
  for (const Event& event : events()) row += " " + outcome_of(state, event) + " |";
  return row;
}

std::string document() { return test::content_of(test::source_path("docs/decisions/who-may-drive.md")); }

class DrivePermissionTable : public testing::TestWithParam<std::size_t> {};

TEST_P(DrivePermissionTable, IsWhatTheDocumentSays) {
  const std::string row = row_of(states()[GetParam()]);
  EXPECT_NE(document().find(row + "\n"), std::string::npos) << row;
}

INSTANTIATE_TEST_SUITE_P(EveryState, DrivePermissionTable, testing::Range(std::size_t{0}, states().size()));

TEST(DrivePermissionTable, HasTheDocumentsColumns) {
  std::string head = "| |";
  for (const Event& event : events()) head += std::string(" ") + event.name + " |";
  EXPECT_NE(document().find(head + "\n"), std::string::npos) << head;
}

/// After each of these three the motors were once enabled again.
TEST(DrivePermission, WhatAPersonSwitchedOffStaysOffThroughSilencesResetsAndRestartsOneAfterAnother) {
  const std::vector<std::function<void(Rig&)>> switch_off{
      [](Rig& rig) { rig.press_motors(); }, [](Rig& rig) { rig.press_stop(); }, [](Rig& rig) { rig.say(false); }};
  for (const auto& off : switch_off) {
    Rig rig{true, DriveSwitch::kOn};
    ASSERT_TRUE(rig.robot.moves);
    off(rig);
    rig.run(0.5);
    rig.robot.has_ever_moved = false;
    const int before = rig.times_sent({CommandNumber::kEnable, 1});
    rig.silence(2.0);
    rig.run(4.0);
    rig.reset();
    rig.run(4.0);
    rig.kill_and_restart();
    rig.run(4.0);
    rig.silence(5.0);
    rig.kill_and_restart();
    rig.run(4.0);
    EXPECT_TRUE(rig.session.is_connected());
    EXPECT_EQ(rig.times_sent({CommandNumber::kEnable, 1}), before);
    EXPECT_FALSE(rig.robot.has_ever_moved);
  }
}

TEST(DrivePermission, MotorsSwitchedOffWhileTheLinkWasSilentOrTheDaemonDeadStayOff) {
  Rig silent{true, DriveSwitch::kOn};
  silent.robot.is_mute = silent.robot.is_deaf = true;
  silent.run(1.0);
  silent.press_motors();
  silent.run(1.0);
  silent.robot.is_mute = silent.robot.is_deaf = false;
  silent.run(5.0);
  EXPECT_EQ(silent.session.permission().drive_switch(), DriveSwitch::kOffAtRobot);
  EXPECT_FALSE(silent.robot.motors_on);

  Rig dead{true, DriveSwitch::kOn};
  dead.press_motors();  // no SIP has told it when the daemon dies
  dead.kill_and_restart();
  dead.run(5.0);
  EXPECT_EQ(dead.session.permission().drive_switch(), DriveSwitch::kOffAtRobot);
  EXPECT_FALSE(dead.robot.motors_on);
}

TEST(DrivePermission, MotorsSwitchedOffWhileOnlyTheRobotHearsUsStayOff) {
  Rig rig{true, DriveSwitch::kOn};
  ASSERT_TRUE(rig.robot.moves);
  const int before = rig.times_sent({CommandNumber::kEnable, 1});
  rig.robot.is_mute = true;  // half a cable
  rig.run(0.4);
  rig.press_motors();
  rig.run(1.6);
  rig.robot.is_mute = false;
  rig.run(8.0);
  EXPECT_TRUE(rig.session.is_connected());
  EXPECT_EQ(rig.session.permission().drive_switch(), DriveSwitch::kOffAtRobot);
  EXPECT_EQ(rig.times_sent({CommandNumber::kEnable, 1}), before);
  EXPECT_FALSE(rig.robot.motors_on);
}

/// In each millisecond after a restart. A SIP of 9600 baud is 30 ms on the line: what is done between its beginning
/// and CLOSE, nothing tells.
TEST(DrivePermission, MotorsSwitchedOffBeforeALeftOverConnectionIsClosedStayOff) {
  int presses = 0;
  int overlooked = 0;
  for (int ms = 0; ms < 1000; ++ms) {
    Rig rig{true, DriveSwitch::kOn};
    rig.kill_and_restart();
    rig.line.run_for(1e-3 * ms);
    if (!rig.robot.motors_on || !rig.robot.connected) break;  // closed
    ++presses;
    rig.press_motors();
    rig.run(5.0);
    overlooked += rig.robot.motors_on ? 1 : 0;
  }
  test::tell_figure("presses_before_close", presses, "times");
  test::tell_figure("overlooked_before_close", overlooked, "times");
  EXPECT_GT(presses, 100);
  EXPECT_LE(overlooked, 45);
}

TEST(DrivePermission, MotorsSwitchedOffBeforeAnySipHasShownOurEnableStayOff) {
  Rig rig{true, DriveSwitch::kOffByOperator};
  rig.robot.is_mute = true;
  rig.say(true);
  rig.run(0.1);
  ASSERT_TRUE(rig.robot.motors_on);
  rig.line.carry_out(rig.session.on_bytes(encoded_sip(rig.robot.sip), rig.line.now));  // from before the ENABLE
  rig.press_motors();
  rig.robot.is_deaf = true;
  rig.run(3.0);
  rig.robot.is_mute = rig.robot.is_deaf = false;
  rig.run(5.0);
  EXPECT_TRUE(rig.session.is_connected());
  EXPECT_FALSE(rig.robot.motors_on);
  EXPECT_EQ(rig.session.permission().drive_switch(), DriveSwitch::kOffAtRobot);
}

TEST(DrivePermission, AnEnableThatWasStillOnItsWayIsTakenBack) {
  Rig rig{true, DriveSwitch::kOffAtRobot};
  rig.say(true);
  rig.run(0.05);
  ASSERT_EQ(rig.times_sent({CommandNumber::kEnable, 1}), 1);
  rig.robot.motors_on = false;  // it lies in the adapter's buffer
  rig.press_stop();
  rig.robot.motors_on = true;  // and arrives now
  rig.run(0.3);
  EXPECT_EQ(rig.session.permission().drive_switch(), DriveSwitch::kOffAtRobot);
  EXPECT_GE(rig.times_sent({CommandNumber::kEnable, 0}), 1);
  EXPECT_FALSE(rig.robot.motors_on);
  EXPECT_EQ(rig.robot.speed, 0);
  rig.run(1.0);
  rig.press_motors();
  rig.run(1.0);
  EXPECT_TRUE(rig.robot.moves) << "a person is heard again";
}

TEST(DrivePermission, MotorsThatAreOffAfterOpenWereSwitchedOffByNobodyHoweverLongTheyStayOff) {
  using From = MotorReport::From;
  DrivePermission permission{true, DriveSwitch::kOn};
  permission.observe({.motors_on = true, .from = From::kLeftOver});
  permission.observe({.motors_on = false, .from = From::kOpening, .may_be_our_disable = true});
  permission.observe({.motors_on = false, .from = From::kConnection, .may_be_our_disable = true});
  permission.observe({.motors_on = false, .from = From::kConnection});
  EXPECT_TRUE(permission.holds());
}

TEST(DrivePermission, ASwitchHasItsNameAndIsFoundByIt) {
  for (const auto value :
       {DriveSwitch::kUnknown, DriveSwitch::kOn, DriveSwitch::kOffAtRobot, DriveSwitch::kOffByOperator})
    EXPECT_EQ(drive_switch_named(name_of(value)), value);
  EXPECT_FALSE(drive_switch_named("perhaps"));
}

}  // namespace
}  // namespace deltamap::drivers::pioneer
