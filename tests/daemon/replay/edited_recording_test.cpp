// SPDX-License-Identifier: Apache-2.0
// Recordings that went through other programs: the replay is that of the recording as it was written, or it is told why
// it is not. In the recorded run an operator has said where the robot is, which is an order that a replay must repeat.
#include <gtest/gtest.h>

#include "core/files/grid_file.hpp"
#include "daemon/records/journal.hpp"
#include "daemon/replay/replay_run.hpp"
#include "daemon/settings/fingerprint.hpp"
#include "drivers/port/byte_log.hpp"
#include "tests/support/bytes/edited_recording.hpp"
#include "tests/support/files/temporary_folder.hpp"
#include "tests/support/files/text_file.hpp"
#include "tests/support/files/tool_run.hpp"
#include "tests/support/scans/scripted_drive.hpp"
#include "tool/import_carmen.hpp"

namespace deltamap::daemon {
namespace {

using test::CapturePacket;
using test::content_of;

constexpr const char* kUnchecked = "not obeyed: whether records are missing cannot be checked";

class EditedRecording : public testing::Test {
 protected:
  EditedRecording() {
    test::write_drive(folder_.path() / "drive.log", 6.0);
    (void)tool::import_carmen(folder_.path() / "drive.log", folder_.path() / "drive.pcapng", std::nullopt);
    write_grid(test::small_room(false), folder_.path() / "room.yaml");
    (void)folder_.write("config.yaml", "seed: 3\nlocalization: {particles: {min: 100, max: 100}}\n");
    settings_ = read_settings(folder_.path() / "config.yaml", {"localization.initial_pose=[7.6,4.6,90]"});
    write_with_an_order();
    whole_ = content_of(folder_.path() / "ordered.pcapng");
    const RunReport report = replay(whole_);
    EXPECT_EQ(report.journal, "obeyed");
    EXPECT_EQ(report.commands, 1u);
    EXPECT_TRUE(report.recording.lines().empty()) << testing::PrintToString(report.recording.lines());
    trajectory_ = content_of(folder_.path() / "out/trajectory.tum");
  }

  void write_with_an_order() const {
    drivers::port::ByteLogReader reader{folder_.path() / "drive.pcapng"};
    drivers::port::ByteLogWriter writer{folder_.path() / "ordered.pcapng", {500'000, 500'000}};
    const RunIdentity run{settings_fingerprint(settings_), grid_hash(read_grid(folder_.path() / "room.yaml"))};
    const Decision order{.kind = Decision::Kind::kRelocalized,
                         .scan = 20,
                         .map_from_robot = test::pose_on_drive(20 * 0.106) * Pose2{0.4, -0.3, 0.2}};
    std::size_t count = 0;
    while (const auto record = reader.next()) {
      for (const std::string& note : count == 0    ? std::vector{note_of(run)}
                                     : count == 30 ? std::vector{note_of(order)}
                                                   : std::vector<std::string>{}) {
        drivers::port::ByteRecord noted;
        noted.stamp = record->stamp;
        noted.note = note;
        writer.write(noted);
      }
      ++count;
      writer.write(*record);
    }
    writer.close();
  }

  RunReport replay(const std::string& recording) {
    ReplayJob job;
    job.recording = folder_.write("r.pcapng", recording);
    job.map = folder_.path() / "room.yaml";
    job.settings = settings_;
    job.out = folder_.path() / "out";
    return run_replay(job, [](double) { return true; });
  }

  void expect_the_same_replay(const std::string& recording, const char* journal = "obeyed") {
    const RunReport report = replay(recording);
    EXPECT_EQ(report.journal, journal);
    EXPECT_EQ(report.commands, 1u);
    EXPECT_TRUE(content_of(folder_.path() / "out/trajectory.tum") == trajectory_);
  }

  void expect_told(const std::string& recording, const std::string& what) {
    const RunReport report = replay(recording);
    EXPECT_NE(testing::PrintToString(report.recording.lines()).find(what), std::string::npos)
        << testing::PrintToString(report.recording.lines());
    EXPECT_NE(report.journal, "obeyed");
  }

  test::TemporaryFolder folder_;
  Settings settings_;
  std::string whole_;
  std::string trajectory_;
};

bool carries_note(const CapturePacket& packet) { return !packet.comment().empty(); }

TEST_F(EditedRecording, RemarksBesideNotesLeaveEveryOrder) {
  const std::string older = test::without_option(whole_, CapturePacket::kId);
  for (const auto& [recording, journal] : {std::pair{whole_, "obeyed"}, {older, kUnchecked}}) {
    expect_the_same_replay(test::with_remark(recording, carries_note, "here it was carried"), journal);
    expect_the_same_replay(test::with_comments_rewritten(
                               recording, [](const std::string& note) { return note + "\r\nhere it was carried"; }),
                           journal);
  }
}

TEST_F(EditedRecording, WithoutPacketNumbersItIsNotHeldForWhole) {
  const std::string older = test::without_option(whole_, CapturePacket::kId);
  const std::string by_others = test::with_writer(older, "Editcap 4.0.6");
  for (const std::string& recording : {older, test::without_packets(older, 40, 60), by_others}) {
    expect_told(recording, "whether packets are missing cannot be checked");
    EXPECT_EQ(replay(recording).journal, kUnchecked);
  }
}

TEST_F(EditedRecording, ForeignPacketsAndBlocksAreNoPartOfIt) {
  expect_the_same_replay(test::with_other_blocks(whole_));
  expect_the_same_replay(test::merged_behind_foreign(whole_, 7));
}

TEST_F(EditedRecording, WhatIsMissingOrChangedIsToldAndTheJournalIsNotObeyed) {
  expect_told(test::without_packets(whole_, 40, 60), "21 packets missing");
  expect_told(test::without_option(whole_, CapturePacket::kComment), "changed since they were written");
  expect_told(whole_ + whole_, "out of order");
}

TEST_F(EditedRecording, WithoutAWholeScanItIsRefusedWithTheReason) {
  try {
    (void)replay(test::with_snap_length(whole_, 40));
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("cut by a snap length"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("; no scan is left"), std::string::npos) << error.what();
  }
}

TEST_F(EditedRecording, IsReplayedToItsLastPacketAndTheMissingEndIsTold) {
  const RunReport report = replay(test::without_packets(whole_, 70, test::packets_in(whole_)));
  const std::string reached = content_of(folder_.path() / "out/trajectory.tum");
  EXPECT_GT(report.scans.decoded, 15u);
  EXPECT_EQ(trajectory_.substr(0, reached.size()), reached);
  EXPECT_EQ(report.recording.doubts.size(), 1u);
  EXPECT_TRUE(report.recording.lacks_end);
}

TEST_F(EditedRecording, IsToldByTheToolAndByTheReport) {
  const std::string recording = folder_.write("hole.pcapng", test::without_packets(whole_, 40, 60)).string();
  const test::ToolRun run = test::run_deltamap({"replay", recording, "--map", (folder_.path() / "room.yaml").string(),
                                                "--config", (folder_.path() / "config.yaml").string(), "--out",
                                                (folder_.path() / "told").string(), "--initial-pose", "7.6,4.6,90"});
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_NE(run.errors.find("deltamap: warning: " + recording + ": 21 packets missing"), std::string::npos)
      << run.errors;
  EXPECT_NE(run.output.find("journal not obeyed: records are missing"), std::string::npos) << run.output;
  EXPECT_NE(content_of(folder_.path() / "told/report.json").find(": 21 packets missing"), std::string::npos);
}

}  // namespace
}  // namespace deltamap::daemon
