// SPDX-License-Identifier: Apache-2.0
// `ctl record stop` and `start` in the running daemon: what the file holds, and what a replay makes of it.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "drivers/port/byte_log.hpp"
#include "tests/support/daemon/control_fixture.hpp"

namespace deltamap::daemon {
namespace {

using control::Request;
using Kind = Request::Kind;
using Json = nlohmann::json;
using namespace std::chrono_literals;

class RecordOrderTest : public test::ControlDeskTest {
 protected:
  [[nodiscard]] Json recording() const { return status()["recording"]; }
  [[nodiscard]] std::string done(Kind kind) const {
    const Json reply = asked({kind, {}});
    EXPECT_EQ(reply["ok"], true) << reply;
    return reply.value("message", "");
  }
  [[nodiscard]] std::string refused(Kind kind) const {
    const Json reply = asked({kind, {}});
    EXPECT_EQ(reply["ok"], false) << reply;
    return reply.value("error", "");
  }
  [[nodiscard]] int gaps() const {
    drivers::port::ByteLogReader reader{settings_.recording.file};
    int gaps = 0;
    while (const auto record = reader.next()) gaps += record->note == kGapNote ? 1 : 0;
    EXPECT_FALSE(reader.cut());
    return gaps;
  }
};

TEST_F(RecordOrderTest, WhatIsStoppedGrowsNoMoreAndGoesOnBehindAGap) {
  const RunReport live = run_live(3ms, [&](const Pipeline&) {
    ASSERT_TRUE(reached_scan(60));
    const std::string stopped = done(Kind::kRecordStop);
    EXPECT_EQ(stopped.rfind("the recording stops: " + settings_.recording.file + ", ", 0), 0u) << stopped;
    EXPECT_EQ(recording()["goes_on"], false);
    EXPECT_EQ(status()["outputs"]["recording"]["why"], "stopped by an operator");
    const auto size = std::filesystem::file_size(settings_.recording.file);
    EXPECT_EQ(refused(Kind::kRecordStop), "the recording is stopped already");
    EXPECT_EQ(asked({Kind::kPause, {}})["ok"], true);  // said again behind the gap
    ASSERT_TRUE(reached_scan(140));
    EXPECT_EQ(std::filesystem::file_size(settings_.recording.file), size);
    EXPECT_EQ(exit_code({"record", "start"}), 0);
    EXPECT_EQ(recording()["goes_on"], true);
    EXPECT_EQ(refused(Kind::kRecordStart), "it records already: " + settings_.recording.file);
  });
  EXPECT_EQ(live.scans.recording_lost, 0u) << "nothing is lost that somebody wanted";
  EXPECT_EQ(gaps(), 1);
  const RunReport again = replay("live.pcapng", "replayed");
  EXPECT_EQ(again.journal, "not obeyed: records are missing");
  EXPECT_EQ(again.commands, 1u) << "the pause";
  EXPECT_GT(again.scans.decoded, 200u);
  EXPECT_LT(again.scans.decoded, live.scans.decoded - 50u);
  EXPECT_EQ(again.wire.at("laser.bad_checksum"), 0u);
}

TEST_F(RecordOrderTest, WhatStaysStoppedIsWholeUpToThere) {
  (void)run_live(2ms, [&](const Pipeline&) {
    ASSERT_TRUE(reached_scan(60));
    (void)done(Kind::kRecordStop);
  });
  EXPECT_EQ(gaps(), 0);
  EXPECT_GT(replay("live.pcapng", "replayed").scans.decoded, 50u);
}

TEST_F(RecordOrderTest, WithoutARecordingOrBehindItsEndThereIsNothingToDoAndThatIsSaid) {
  settings_.recording.max_gigabytes = 1e-4;
  (void)run_live(1ms, [&](const Pipeline&) {
    ASSERT_TRUE(test::comes_true([&] { return recording()["bytes"] > 90'000 && recording()["goes_on"] == false; }));
    for (const Kind kind : {Kind::kRecordStart, Kind::kRecordStop}) {
      EXPECT_EQ(refused(kind), "the recording has ended: it has reached recording.max_gigabytes");
    }
  });
  settings_.recording.file.clear();
  (void)run_live(0ms, [&](const Pipeline&) {
    EXPECT_EQ(refused(Kind::kRecordStart).rfind("'recording.file' is not set: a recording begins with the run", 0), 0u);
    testing::internal::CaptureStderr();
    EXPECT_EQ(exit_code({"record", "stop"}), 1);
    EXPECT_EQ(exit_code({"record", "pause"}), 2);
    (void)testing::internal::GetCapturedStderr();
  });
}

}  // namespace
}  // namespace deltamap::daemon
