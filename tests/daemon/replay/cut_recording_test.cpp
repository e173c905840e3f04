// SPDX-License-Identifier: Apache-2.0
// Recordings that a power cut or a full disk has ended: everything before the cut is read, decoded and replayed, and
// the cut is told with its place.
#include <gtest/gtest.h>

#include "core/files/grid_file.hpp"
#include "daemon/records/recording_decoder.hpp"
#include "daemon/replay/replay_run.hpp"
#include "drivers/port/byte_log.hpp"
#include "tests/support/bytes/cut_file.hpp"
#include "tests/support/files/temporary_folder.hpp"
#include "tests/support/files/text_file.hpp"
#include "tests/support/files/tool_run.hpp"
#include "tests/support/scans/scripted_drive.hpp"
#include "tool/import_carmen.hpp"

namespace deltamap::daemon {
namespace {

namespace fs = std::filesystem;
using test::content_of;

constexpr std::size_t kHeaderBlocks = 3;  // the section and both interfaces
constexpr std::size_t kEndMark = 1;

/// Every record, and every message that the records complete.
struct Decoded {
  std::vector<drivers::port::ByteRecord> records;
  std::vector<Timestamp> scans;
  std::size_t odometry = 0;
  std::optional<drivers::port::LogCut> cut;
};

Decoded decoded(const fs::path& recording) {
  Decoded all;
  drivers::port::ByteLogReader reader{recording};
  RecordingDecoder decoder{Settings{}};
  while (auto record = reader.next()) {
    decoder.feed(*record, {[&](Odometry&&, std::uint32_t) { ++all.odometry; },
                           [&](Scan&& scan) { all.scans.push_back(scan.time); }});
    all.records.push_back(std::move(*record));
  }
  all.cut = reader.cut();
  return all;
}

class CutRecording : public testing::Test {
 protected:
  void record(double drive_s) {
    test::write_drive(folder_.path() / "drive.log", drive_s);
    (void)tool::import_carmen(folder_.path() / "drive.log", folder_.path() / "drive.pcapng", std::nullopt);
    write_grid(test::small_room(false), folder_.path() / "room.yaml");
    whole_ = content_of(folder_.path() / "drive.pcapng");
    ends_ = test::block_ends(whole_);
  }

  [[nodiscard]] RunReport replay(const fs::path& recording, const std::string& out) const {
    ReplayJob job;
    job.recording = recording;
    job.map = folder_.path() / "room.yaml";
    job.settings.initial_pose = test::pose_on_drive(0.0);
    job.settings.localizer.particles.min = job.settings.localizer.particles.max = 100;
    job.out = folder_.path() / out;
    return run_replay(job, [](double) { return true; });
  }

  /// Replays random cuts; each must come as far as its whole records, on the same trajectory as the whole recording.
  void expect_replays_of_cuts(int cuts, std::uint64_t seed) {
    (void)replay(folder_.path() / "drive.pcapng", "whole");
    const std::string trajectory = content_of(folder_.path() / "whole/trajectory.tum");
    const std::vector<Timestamp> scans = decoded(folder_.path() / "drive.pcapng").scans;
    Random random{seed};
    const std::size_t first_scans_end = ends_[ends_.size() / 3];
    for (int i = 0; i < cuts; ++i) {
      const std::string damaged = test::cut_file(whole_, first_scans_end, random);
      const auto cut = folder_.write("cut.pcapng", damaged);
      const RunReport report = replay(cut, "cut");
      const std::size_t expected = decoded(cut).scans.size();
      ASSERT_EQ(report.scans.decoded, expected) << i;
      const std::string reached = content_of(folder_.path() / "cut/trajectory.tum");
      ASSERT_EQ(static_cast<std::size_t>(std::count(reached.begin(), reached.end(), '\n')), expected) << i;
      ASSERT_EQ(trajectory.substr(0, reached.size()), reached) << i;
      const std::size_t clean = ends_[test::whole_blocks(ends_, whole_, damaged) - 1];
      ASSERT_EQ(report.recording.cut.has_value(), clean != damaged.size()) << i;
      ASSERT_EQ(report.recording.cut ? report.recording.cut->byte : clean, clean) << i;
    }
  }

  test::TemporaryFolder folder_;
  std::string whole_;
  std::vector<std::size_t> ends_;
};

TEST_F(CutRecording, AThousandRandomCutsAreDecodedUpToTheCut) {
  record(3.0);
  const Decoded whole = decoded(folder_.path() / "drive.pcapng");
  ASSERT_EQ(kHeaderBlocks + whole.records.size() + kEndMark, ends_.size());
  ASSERT_FALSE(whole.cut);
  Random random{17};
  for (int i = 0; i < 1000; ++i) {
    const std::string damaged = test::cut_file(whole_, ends_[kHeaderBlocks - 1], random);
    const std::size_t blocks = test::whole_blocks(ends_, whole_, damaged);
    const Decoded read = decoded(folder_.write("cut.pcapng", damaged));
    ASSERT_EQ(read.records.size(), std::min(blocks - kHeaderBlocks, whole.records.size())) << i;
    ASSERT_TRUE(std::equal(read.records.begin(), read.records.end(), whole.records.begin())) << i;
    ASSERT_TRUE(std::equal(read.scans.begin(), read.scans.end(), whole.scans.begin())) << i;
    const std::size_t clean = ends_[blocks - 1];
    ASSERT_EQ(read.cut.has_value(), clean != damaged.size()) << i;
    if (!read.cut) continue;
    ASSERT_EQ(read.cut->byte, clean) << i;
    ASSERT_EQ(read.cut->unread_bytes, damaged.size() - clean) << i;
    ASSERT_EQ(read.cut->last_record.has_value(), !read.records.empty()) << i;
    ASSERT_TRUE(read.records.empty() || read.cut->last_record == read.records.back().stamp) << i;
    ASSERT_NE(read.cut->text.find("cut.pcapng: byte " + std::to_string(clean) + ": cut short, "), std::string::npos);
  }
}

TEST_F(CutRecording, IsReplayedUpToTheCutOnTheTrajectoryOfTheWhole) {
  record(3.0);
  expect_replays_of_cuts(30, 23);
}

/// The same on many more cuts, most of it waiting for the disk: `./dev test long` runs it.
TEST_F(CutRecording, DISABLED_AThousandWholeReplaysOfCuts) {
  record(1.5);
  expect_replays_of_cuts(1000, 29);
}

TEST_F(CutRecording, InsideItsHeaderIsRefusedInOneLine) {
  record(1.0);
  for (const std::size_t kept : {std::size_t{5}, std::size_t{27}, ends_[0], ends_[1] + 9, ends_[2] - 1}) {
    for (const char* tail : {"", "garbage that is longer than the head of a block"}) {
      try {
        (void)replay(folder_.write("cut.pcapng", whole_.substr(0, kept) + tail), "out");
        FAIL() << kept;
      } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what()).find("cut.pcapng: byte "), std::string::npos) << error.what();
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
      }
      EXPECT_FALSE(fs::exists(folder_.path() / "out"));
    }
  }
}

TEST_F(CutRecording, IsToldByTheToolAndByTheReport) {
  record(3.0);
  const std::size_t clean = ends_[ends_.size() / 2];
  const std::string cut = folder_.write("cut.pcapng", whole_.substr(0, clean + 9) + std::string(4096, '\0'));
  (void)folder_.write("config.yaml", "seed: 3\n");
  const std::string out = (folder_.path() / "out").string();
  const test::ToolRun run =
      test::run_deltamap({"replay", cut, "--map", (folder_.path() / "room.yaml").string(), "--config",
                          (folder_.path() / "config.yaml").string(), "--out", out, "--initial-pose", "7.6,4.6,90"});
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  const std::string place = "cut.pcapng: byte " + std::to_string(clean) + ": cut short, ";
  EXPECT_NE(run.errors.find("deltamap: warning: "), std::string::npos) << run.errors;
  EXPECT_NE(run.errors.find(place), std::string::npos) << run.errors;
  EXPECT_NE(run.errors.find("the last whole record is of 2001-09-09T01:46:4"), std::string::npos) << run.errors;
  const std::string report = content_of(folder_.path() / "out/report.json");
  EXPECT_NE(report.find("\"cut\": true"), std::string::npos) << report;
  EXPECT_NE(report.find("\"byte\": " + std::to_string(clean)), std::string::npos) << report;
}

}  // namespace
}  // namespace deltamap::daemon
