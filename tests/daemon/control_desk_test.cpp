// SPDX-License-Identifier: Apache-2.0
// The operator and the running daemon, over a real socket: what is answered, what a replay repeats, and who may drive.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <thread>

#include "daemon/control/request.hpp"
#include "daemon/control/server.hpp"
#include "daemon/kept_drive.hpp"
#include "tests/support/control_fixture.hpp"

namespace deltamap::daemon {
namespace {

using control::Request;
using test::comes_true;
using test::content_of;
using test::ControlDeskTest;
using test::DriveTest;
using test::SocketClient;
using Json = nlohmann::json;
using namespace std::chrono_literals;

TEST_F(ControlDeskTest, WhatTheOperatorDidIsRepeatedByTheReplayBitForBit) {
  const RunReport live = run_live(3ms, [&](const Pipeline&) {
    ASSERT_TRUE(reached_scan(20));
    EXPECT_EQ(asked({Request::Kind::kPause, {}})["ok"], true);
    EXPECT_EQ(status()["mapping"], "paused");
    ASSERT_TRUE(reached_scan(60));
    const Pose2 aside = test::pose_on_drive(6.0) * Pose2{0.3, -0.2, 0.1};
    EXPECT_EQ(asked({Request::Kind::kRelocalize, aside})["ok"], true);
    ASSERT_TRUE(reached_scan(120));
    EXPECT_EQ(asked({Request::Kind::kResume, {}})["ok"], true);
    EXPECT_EQ(status()["mapping"], "on");
  });
  const RunReport again = replay("live.pcapng", "replayed");
  EXPECT_EQ(again.journal, "obeyed");
  EXPECT_EQ(again.journal_differences, 0u);
  expect_same_files("live", "replayed");
  EXPECT_EQ(live.scans.recording_lost, 0u);

  // It did make a difference.
  (void)replay("drive.pcapng", "untouched");
  EXPECT_NE(content_of(folder_.path() / "untouched/trajectory.tum"),
            content_of(folder_.path() / "live/trajectory.tum"));
}

TEST_F(ControlDeskTest, WhatTheOperatorDidIsRepeatedWithOtherSettingsAndAnotherSeed) {
  const Pose2 far{5.0, 4.6, 0.0};  // in the middle of the drive, 1.7 m from it at least
  const auto nearest_to_far = [&](const std::string& run) {
    std::ifstream lines(folder_.path() / run / "trajectory.tum");
    double nearest_m = 1e9;
    for (double t, x, y; lines >> t >> x >> y; lines.ignore(1000, '\n')) {
      nearest_m = std::min(nearest_m, std::hypot(x - far.x, y - far.y));
    }
    return nearest_m;
  };
  (void)run_live(3ms, [&](const Pipeline&) {
    ASSERT_TRUE(reached_scan(20));
    EXPECT_EQ(asked({Request::Kind::kPause, {}})["ok"], true);
    ASSERT_TRUE(reached_scan(60));
    EXPECT_EQ(asked({Request::Kind::kRelocalize, far})["ok"], true);
  });
  settings_.seed = 2;
  settings_.localizer.beams = 90;
  const RunReport again = replay("live.pcapng", "replayed");
  EXPECT_EQ(again.journal, "not obeyed: other settings or map");
  EXPECT_EQ(again.commands, 2u);
  EXPECT_EQ(again.phases, 0u) << "mapping was paused before the box came";
  EXPECT_LT(nearest_to_far("replayed"), 0.7);

  (void)replay("drive.pcapng", "untouched");
  EXPECT_GT(nearest_to_far("untouched"), 1.5);
}

TEST_F(ControlDeskTest, WhatAWrongPoseHasWrittenIsWithdrawnAndAReplayDoesTheSame) {
  settings_.mapping.store_scan.gate.provisional.time_s = 60.0;  // the whole drive
  const RunReport live = run_live(2ms, [&](const Pipeline& pipeline) {
    const auto give_up_at = std::chrono::steady_clock::now() + 60s;
    while (pipeline.telemetry().newest_revision.value() == 0 && std::chrono::steady_clock::now() < give_up_at) {
      std::this_thread::sleep_for(1ms);
    }
    const Pose2 far_away =
        test::pose_on_drive(0.106 * static_cast<double>(pipeline.telemetry().scans.value())) * Pose2{2.0, 0.0, 0.0};
    EXPECT_EQ(asked({Request::Kind::kRelocalize, far_away})["ok"], true);
  });
  EXPECT_EQ(live.changes.withdrawals(), 1u);
  const RunReport again = replay("live.pcapng", "replayed");
  EXPECT_EQ(again.journal, "obeyed");
  EXPECT_EQ(again.journal_differences, 0u);
  expect_same_files("live", "replayed");
  EXPECT_GT(mapping::shut_s(again.gate_times), 0.0);
}

TEST_F(ControlDeskTest, WhileMappingIsPausedTheMapStaysAsItIs) {
  const RunReport live = run_live(2ms, [&](const Pipeline&) {
    ASSERT_TRUE(reached_scan(0));
    EXPECT_EQ(exit_code({"pause"}), 0);
  });
  EXPECT_GT(live.scans.localized, 300u);
  EXPECT_TRUE(live.changes.empty()) << "without the pause the box becomes map";
}

TEST_F(ControlDeskTest, StatusTellsPoseBeliefAndCounts) {
  (void)run_live(2ms, [&](const Pipeline&) {
    ASSERT_TRUE(reached_scan(50));
    const Json told = status();
    EXPECT_EQ(told["ok"], true);
    EXPECT_EQ(told["state"], "tracking");
    EXPECT_GT(told["pose"]["x_m"], 2.0);
    EXPECT_GT(told["covariance"]["xx_m2"], 0.0);
    EXPECT_TRUE(told["belief"]["verdict"].is_string());
    EXPECT_GE(told["belief"]["pose_right"], 0.0);
    EXPECT_EQ(told["particles"], 200);
    EXPECT_GE(told["n_eff"], 1.0);
    EXPECT_GT(told["w_avg"], 0.0);
    EXPECT_EQ(told["revision"], 0);
    EXPECT_EQ(told["drive"], "off");
    EXPECT_EQ(told["recording"]["file"], settings_.recording.file);
    EXPECT_EQ(told["recording"]["goes_on"], true);
    for (const char* output : {"trajectory", "localization", "changes", "map", "history", "recording"}) {
      EXPECT_EQ(told["outputs"][output]["written"], true) << output << told["outputs"];
    }
    EXPECT_GT(told["since_start_s"], 0.0);
    EXPECT_EQ(told["drops"].size(), 6u);

    testing::internal::CaptureStdout();
    EXPECT_EQ(exit_code({"status"}), 0);
    const std::string table = testing::internal::GetCapturedStdout();
    for (const char* topic :
         {"state        tracking", "pose         x=", "belief       pose ", "map          revision 0",
          "ports        robot ", "drive        off", "recording    ", "saving       "}) {
      EXPECT_NE(table.find(topic), std::string::npos) << topic << '\n' << table;
    }
    testing::internal::CaptureStdout();
    EXPECT_EQ(exit_code({"status", "--json"}), 0);
    EXPECT_EQ(Json::parse(testing::internal::GetCapturedStdout())["state"], "tracking");
  });
}

TEST_F(ControlDeskTest, SaveWritesMapAndPoseBesideTheStoreAndSaysWhere) {
  settings_.map.store = folder_.path() / "kept.sqlite";
  (void)run_live(2ms, [&](const Pipeline&) {
    ASSERT_TRUE(reached_scan(10));
    const Json reply = asked({Request::Kind::kSave, {}});
    EXPECT_EQ(reply["ok"], true) << reply;
    const auto map = folder_.path() / "kept.saved.yaml";
    EXPECT_NE(reply["message"].get<std::string>().find(map.string()), std::string::npos) << reply;
    EXPECT_EQ(read_grid(map), test::small_room(false));
    EXPECT_FALSE(content_of(folder_.path() / "kept.pose.json").empty());
  });
}

TEST_F(ControlDeskTest, GarbageAndWrongRequestsAreAnsweredAndHarmNothing) {
  const RunReport live = run_live(2ms, [&](const Pipeline&) {
    SocketClient client{settings_.control.socket};
    EXPECT_EQ(client.asked("hello"), R"({"ok":false,"error":"a request is one JSON object in one line"})");
    EXPECT_EQ(client.asked(R"({"command":"explode"})"), R"({"ok":false,"error":"unknown command 'explode'"})");
    EXPECT_EQ(asked({Request::Kind::kRelocalize, {99.0, 1.0, 0.0}})["error"], "that pose lies outside the map");
    testing::internal::CaptureStderr();
    EXPECT_EQ(exit_code({"relocalize", "99,1,0"}), 1);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "deltamap: that pose lies outside the map\n");
    testing::internal::CaptureStderr();
    EXPECT_EQ(exit_code({"relocalize", "1,2"}), 2);
    EXPECT_EQ(exit_code({"drive", "patrol"}), 2);
    EXPECT_EQ(exit_code({"explode"}), 2);
    (void)testing::internal::GetCapturedStderr();
    SocketClient asks_and_goes{settings_.control.socket};
    (void)asks_and_goes.send(control::line_of({Request::Kind::kPause, {}}) + "\n");
    asks_and_goes.vanish();
  });
  EXPECT_GT(live.scans.localized, 300u);
}

/// The recording has been played: no scan comes any more, as from a laser that has gone.
TEST_F(ControlDeskTest, WithoutScansWhatIsNotDoneIsToldWithinASecondAndSaveSavesAnyway) {
  settings_.map.store = folder_.path() / "kept.sqlite";
  (void)run_live(0ms, [&](const Pipeline& pipeline) {
    std::uint64_t localized = 0;
    ASSERT_TRUE(comes_true([&] { return pipeline.telemetry().scans.value() > 350; }));
    do {
      localized = pipeline.telemetry().localized.value();
      std::this_thread::sleep_for(1200ms);
    } while (pipeline.telemetry().localized.value() != localized);
    const auto asked_in_time = [&](const Request& request) {
      const auto began = std::chrono::steady_clock::now();
      const Json reply = asked(request);
      EXPECT_LT(std::chrono::steady_clock::now() - began, 1500ms) << reply;
      return reply;
    };
    for (const Request::Kind kind : {Request::Kind::kPause, Request::Kind::kRelocalize}) {
      const Json reply = asked_in_time({kind, test::pose_on_drive(0.0)});
      EXPECT_EQ(reply["ok"], false);
      EXPECT_EQ(reply["error"].get<std::string>().rfind("not done: no scan has come for ", 0), 0u) << reply;
    }
    EXPECT_EQ(status()["mapping"], "on");
    const Json saved = asked_in_time({Request::Kind::kSave, {}});
    EXPECT_EQ(saved["ok"], true) << saved;
    EXPECT_TRUE(std::filesystem::exists(folder_.path() / "kept.saved.yaml"));
  });
}

TEST_F(ControlDeskTest, APoseIsAnsweredWithHowWellItFits) {
  (void)run_live(3ms, [&](const Pipeline& pipeline) {
    ASSERT_TRUE(reached_scan(20));
    const auto message_at = [&](double off_m) {
      const double driven_s = kDrive_s * static_cast<double>(pipeline.telemetry().scans.value()) / 422.0;
      const Json reply = asked({Request::Kind::kRelocalize, test::pose_on_drive(driven_s) * Pose2{off_m, 0.0, 0.0}});
      EXPECT_EQ(reply["ok"], true) << reply;
      return reply.value("message", "");
    };
    const std::string right = message_at(0.0);
    EXPECT_NE(right.find(" % of its beams fit"), std::string::npos) << right;
    EXPECT_EQ(right.find("only"), std::string::npos) << right;
    const std::string wrong = message_at(-1.5);
    EXPECT_NE(wrong.find("is it the right place, and the right map?"), std::string::npos) << wrong;
    EXPECT_GT(status()["fit"], 0.0);
  });
}

TEST_F(ControlDeskTest, WithoutADaemonTheToolSaysSoInOneLineAndEndsWithOne) {
  testing::internal::CaptureStderr();
  EXPECT_EQ(exit_code({"status"}), 1);
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "deltamap: " + settings_.control.socket + ": no daemon listens there (No such file or directory)\n");
}

TEST_F(ControlDeskTest, ASecondDaemonEndsBeforeItTouchesAnything) {
  (void)run_live(2ms, [&](const Pipeline&) {
    const auto recorded = std::filesystem::path(settings_.recording.file);
    EXPECT_THROW((Pipeline{settings_, options()}), control::AlreadyServed);
    EXPECT_TRUE(std::filesystem::exists(recorded));
    EXPECT_FALSE(std::filesystem::exists(folder_.path() / "live.previous.pcapng"));
    EXPECT_TRUE(reached_scan(0)) << "the first one still answers";
  });
}

TEST_F(ControlDeskTest, ASocketThatCannotBeIsToldAndTheDaemonWorksWithoutIt) {
  settings_.control.socket = folder_.path() / "missing/ctl.sock";
  EXPECT_GT(run_live(0ms).scans.decoded, 300u);
}

// --- who drives ---

TEST_F(DriveTest, WhereTheSettingsSayOffNothingEnablesTheMotors) {
  run([&](test::SimulatedPorts& ports) {
    const Json refused = asked({Request::Kind::kDriveWander, {}});
    EXPECT_EQ(refused["ok"], false);
    EXPECT_EQ(refused["error"], "'navigation.mode' is not wander: this daemon never drives");
    EXPECT_EQ(asked({Request::Kind::kDriveOff, {}})["ok"], true);
    const int scan = status()["localized"];
    EXPECT_TRUE(reached_scan(scan + 10));
    EXPECT_FALSE(moves(ports));
    EXPECT_EQ(status()["drive"], "off");
  });
}

TEST_F(DriveTest, WithoutAPoseItStandsAndSaysWhy) {
  settings_.navigation.mode = navigation::DriveMode::kWander;
  settings_.initial_pose.reset();
  run([&](test::SimulatedPorts& ports) {
    EXPECT_EQ(asked({Request::Kind::kDriveWander, {}})["ok"], true);
    EXPECT_TRUE(comes_true([&] { return status()["stopped_by"] == "pose unknown"; }));
    const std::size_t from = ports.commands().size();
    const int scan = status()["localized"];
    EXPECT_TRUE(reached_scan(scan + 10));
    EXPECT_FALSE(moves(ports, from));
  });
}

TEST_F(DriveTest, WithoutAPoseItDrivesWhereTheSettingsSaySo) {
  settings_.navigation.mode = navigation::DriveMode::kWander;
  settings_.navigation.drive_without_pose = true;
  settings_.initial_pose.reset();
  run([&](test::SimulatedPorts& ports) {
    EXPECT_EQ(asked({Request::Kind::kDriveWander, {}})["ok"], true);
    EXPECT_TRUE(comes_true([&] { return status()["stopped_by"] == "none"; }));
    EXPECT_TRUE(comes_true([&] { return moves(ports); }));
  });
}

TEST_F(DriveTest, ARefusedWanderDoesNotSwitchOn) {
  settings_.navigation.mode = navigation::DriveMode::kWander;
  settings_.navigation.safety.low_battery_s = 0.2;
  run([&](test::SimulatedPorts& ports) {
    ports.drain_battery();
    EXPECT_TRUE(comes_true([&] { return status()["stopped_by"] == "low battery"; }));
    EXPECT_EQ(asked({Request::Kind::kDriveWander, {}})["ok"], false);
    EXPECT_EQ(status()["drive_switch"], "unknown") << "else it would drive later, by itself";
    EXPECT_FALSE(moves(ports));
  });
}

TEST_F(DriveTest, OffStopsTheRobotAndWanderStartsItAgain) {
  settings_.navigation.mode = navigation::DriveMode::kWander;
  settings_.map.store = folder_.path() / "kept.sqlite";
  const auto kept = [&] { return content_of(drive_place(settings_.map.store, settings_.robot.port).file); };
  run([&](test::SimulatedPorts& ports) {
    EXPECT_FALSE(moves(ports)) << "nobody has said anything yet";
    EXPECT_EQ(status()["drive"], "off");
    EXPECT_EQ(status()["drive_switch"], "unknown");
    EXPECT_EQ(asked({Request::Kind::kDriveWander, {}})["ok"], true);
    EXPECT_TRUE(comes_true([&] { return moves(ports); }));
    EXPECT_EQ(kept(), "{\"drive\":\"on\",\"robot_port\":\"/dev/ttyUSB0\"}\n");
    EXPECT_EQ(asked({Request::Kind::kDriveOff, {}})["ok"], true);
    EXPECT_EQ(kept(), "{\"drive\":\"off by the operator\",\"robot_port\":\"/dev/ttyUSB0\"}\n")
        << "on disk when it is answered";
    EXPECT_TRUE(comes_true([&] { return status()["stopped_by"] == "no command"; }));
    EXPECT_EQ(status()["drive"], "off");
    const std::size_t stopped = ports.commands().size();
    const int scan = status()["localized"];
    EXPECT_TRUE(reached_scan(scan + 10));
    EXPECT_FALSE(moves(ports, stopped)) << "the pilot is not listened to";
    EXPECT_EQ(asked({Request::Kind::kDriveWander, {}})["ok"], true);
    EXPECT_TRUE(comes_true([&] { return moves(ports, stopped); }));
    EXPECT_EQ(status()["drive"], "wander");
    EXPECT_EQ(asked({Request::Kind::kDriveOff, {}})["ok"], true);
  });
  run([&](test::SimulatedPorts& ports) {
    const int scan = status()["localized"];
    EXPECT_TRUE(reached_scan(scan + 10));
    EXPECT_FALSE(moves(ports)) << "a restart is no person";
    EXPECT_EQ(status()["drive_switch"], "off by the operator");
  });
}

}  // namespace
}  // namespace deltamap::daemon
