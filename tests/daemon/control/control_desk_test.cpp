// SPDX-License-Identifier: Apache-2.0
// The operator and the running daemon, over a real socket: what is answered, what a replay repeats.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "daemon/control/request.hpp"
#include "daemon/control/server.hpp"
#include "drivers/port/byte_log.hpp"
#include "tests/support/daemon/control_fixture.hpp"

namespace deltamap::daemon::control {
namespace {

using control::Request;
using test::comes_true;
using test::content_of;
using test::ControlDeskTest;
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

constexpr Pose2 kOffTheDrive{5.0, 4.6, 0.0};  // in its middle, 1.7 m from it at least

TEST_F(ControlDeskTest, WhatTheOperatorDidIsRepeatedWithOtherSettingsAndAnotherSeed) {
  const Pose2 far = kOffTheDrive;
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

/// Leaves out the bytes of some seconds, as a full disk does.
void write_with_a_gap(const std::filesystem::path& recording, double from_s, double to_s,
                      const std::filesystem::path& gapped) {
  drivers::port::ByteLogReader reader{recording};
  drivers::port::ByteLogWriter writer{gapped, {500'000, 500'000}};
  std::optional<Timestamp> began;
  bool is_noted = false;
  while (const auto record = reader.next()) {
    if (!began && !record->bytes.empty()) began = record->stamp;
    const double at_s = began ? seconds(record->stamp - *began) : 0.0;
    if (at_s >= from_s && at_s < to_s && !record->bytes.empty()) continue;
    if (at_s >= to_s && !is_noted) {
      drivers::port::ByteRecord gap;
      gap.stamp = record->stamp;
      gap.note = kGapNote;
      writer.write(gap);
      is_noted = true;
    }
    writer.write(*record);
  }
  writer.close();
}

TEST_F(ControlDeskTest, WhatTheOperatorDidBehindAGapIsRepeatedAtItsTime) {
  // The times of the first scan near the pose that the operator gave, and of the scan before it.
  const auto jumped_at = [&](const std::string& run) {
    std::ifstream lines(folder_.path() / run / "trajectory.tum");
    std::string before;
    double x = 0.0;
    double y = 0.0;
    for (std::string time; lines >> time >> x >> y; lines.ignore(1000, '\n')) {
      if (std::hypot(x - kOffTheDrive.x, y - kOffTheDrive.y) < 0.7) return before + " " + time;
      before = time;
    }
    return std::string("never");
  };
  (void)run_live(3ms, [&](const Pipeline&) {
    ASSERT_TRUE(reached_scan(120));  // behind the gap, at 11 s
    EXPECT_EQ(asked({Request::Kind::kRelocalize, kOffTheDrive})["ok"], true);
  });
  write_with_a_gap(folder_.path() / "live.pcapng", 4.0, 10.0, folder_.path() / "gapped.pcapng");
  const RunReport again = replay("gapped.pcapng", "replayed");
  EXPECT_EQ(again.journal, "not obeyed: records are missing");
  EXPECT_EQ(again.commands, 1u);
  EXPECT_NE(jumped_at("live"), "never");
  EXPECT_EQ(jumped_at("replayed"), jumped_at("live"));
}

TEST_F(ControlDeskTest, WhatAWrongPoseHasWrittenIsWithdrawnAndAReplayDoesTheSame) {
  settings_.mapping.store_scan.gate.provisional.time_s = 60.0;  // the whole drive
  const RunReport live = run_live(2ms, [&](const Pipeline& pipeline) {
    ASSERT_TRUE(comes_true([&] { return pipeline.telemetry().newest_revision.value() > 0; }));
    const Pose2 far_away =
        test::pose_on_drive(0.106 * static_cast<double>(pipeline.telemetry().scans.value())) * Pose2{2.0, 0.0, 0.0};
    EXPECT_EQ(asked({Request::Kind::kRelocalize, far_away})["ok"], true);
  });
  EXPECT_EQ(live.changes.withdrawals(), 1u);
  const RunReport again = replay("live.pcapng", "replayed");
  EXPECT_EQ(again.journal, "obeyed");
  EXPECT_EQ(again.journal_differences, 0u);
  expect_same_files("live", "replayed");
  EXPECT_GT(mapping::gate::shut_s(again.gate_times), 0.0);
}

TEST_F(ControlDeskTest, WhileMappingIsPausedTheMapStaysAsItIs) {
  const RunReport live = run_live(4ms, [&](const Pipeline&) {
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
    EXPECT_EQ(told["line"].get<std::string>().rfind("robot=", 0), 0u) << told["line"];
    EXPECT_EQ(told["particles"], 200);
    EXPECT_GE(told["n_eff"], 1.0);
    EXPECT_GT(told["w_avg"], 0.0);
    EXPECT_EQ(told["revision"], 0);
    EXPECT_EQ(told["drive"], "off");
    EXPECT_LT(std::abs(told["calibration"]["distance_percent"].get<double>()), 10.0);
    EXPECT_GT(told["calibration"]["deviations"]["mount"]["yaw_deg"], 0.0);
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
    for (const char* topic : {"tracking", "pose         x=", "belief       pose ", "map          revision 0",
                              "ports        robot ", "drive        off", "recording    ", "saving       "}) {
      EXPECT_NE(table.find(topic), std::string::npos) << topic << '\n' << table;
    }
    testing::internal::CaptureStdout();
    EXPECT_EQ(exit_code({"status", "--json"}), 0);
    EXPECT_EQ(Json::parse(testing::internal::GetCapturedStdout())["state"], "tracking");
  });
}

TEST_F(ControlDeskTest, TheLogLevelChangesWhileItRunsAndIsTold) {
  std::vector<LogLevel> set;  // by the control thread, which has ended before they are read
  prepare_ = [&](Pipeline::Options& options) {
    options.set_log_level = [&set](LogLevel level) { set.push_back(level); };
  };
  (void)run_live(1ms, [&](const Pipeline&) {
    EXPECT_EQ(status()["log_level"], "info");
    EXPECT_EQ(exit_code({"log-level", "debug"}), 0);
    EXPECT_EQ(status()["log_level"], "debug");
    const Json reply = asked({.kind = Request::Kind::kLogLevel, .log_level = LogLevel::kError});
    EXPECT_EQ(reply["message"], "the log shows error and above until the next start");
    testing::internal::CaptureStderr();
    EXPECT_EQ(exit_code({"log-level", "off"}), 2);
    EXPECT_EQ(exit_code({"log-level"}), 2);
    (void)testing::internal::GetCapturedStderr();
    EXPECT_EQ(status()["log_level"], "error");
  });
  EXPECT_EQ(set, (std::vector{LogLevel::kDebug, LogLevel::kError}));
  prepare_ = [](Pipeline::Options&) {};
  (void)run_live(0ms, [&](const Pipeline&) {
    EXPECT_EQ(status()["log_level"], "info") << "not kept";
    EXPECT_EQ(asked({.kind = Request::Kind::kLogLevel})["error"], "the log of this run has no levels");
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
    ASSERT_TRUE(comes_true([&] { return pipeline.telemetry().scans.value() > 350; }));
    ASSERT_TRUE(comes_true([&] {
      return asked_once({Request::Kind::kResume, {}}).value("error", "").starts_with("not done");
    }));
    const auto asked_in_time = [&](const Request& request) {
      Json reply;
      EXPECT_TRUE(comes_true([&] {  // unless this machine is busy
        const auto began = std::chrono::steady_clock::now();
        reply = asked_once(request);
        return std::chrono::steady_clock::now() - began < 1500ms;
      })) << reply;
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
    const auto message_at = [&](double off_m, bool doubt) {
      const double driven_s = kDrive_s * static_cast<double>(pipeline.telemetry().scans.value()) / 422.0;
      const Json reply = asked({Request::Kind::kRelocalize, test::pose_on_drive(driven_s) * Pose2{off_m, 0.0, 0.0}});
      EXPECT_EQ(reply["ok"], true) << reply;
      EXPECT_EQ(reply.value("doubt", false), doubt) << reply;
      return reply.value("message", "");
    };
    const std::string right = message_at(0.0, false);
    EXPECT_NE(right.find(" % of its beams fit"), std::string::npos) << right;
    EXPECT_EQ(right.find("only"), std::string::npos) << right;
    const std::string wrong = message_at(-1.5, true);
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
    EXPECT_THROW((Pipeline{settings_, options()}), sockets::AlreadyServed);
    EXPECT_TRUE(std::filesystem::exists(recorded));
    EXPECT_FALSE(std::filesystem::exists(folder_.path() / "live.previous.pcapng"));
    EXPECT_TRUE(reached_scan(0)) << "the first one still answers";
  });
}

TEST_F(ControlDeskTest, ASocketThatCannotBeIsToldAndTheDaemonWorksWithoutIt) {
  settings_.control.socket = folder_.path() / "missing/ctl.sock";
  EXPECT_GT(run_live(0ms).scans.decoded, 300u);
}

}  // namespace
}  // namespace deltamap::daemon::control
