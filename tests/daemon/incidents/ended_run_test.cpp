// SPDX-License-Identifier: Apache-2.0
// A daemon that ended without a word: what the next one makes of the ring that it has left.
#include "daemon/incidents/ended_run.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "daemon/incidents/incident_folder.hpp"
#include "daemon/incidents/segment_ring.hpp"
#include "drivers/port/byte_log.hpp"
#include "tests/support/daemon/incident_drive.hpp"
#include "tests/support/daemon/incident_pixels.hpp"
#include "tests/support/files/text_file.hpp"

namespace deltamap::daemon {
namespace {

namespace fs = std::filesystem;

class EndedRunTest : public test::IncidentDrive {
 protected:
  [[nodiscard]] fs::path folder() const { return settings_.incidents.folder; }

  /// As a kill, or a power cut that loses nothing: nobody closes anything.
  void end_without_a_word() {
    ended_ = world_->now();
    daemon_.reset();
  }
  /// A daemon of the next day looks at what is there, and ends as it should.
  void start_and_stop() {
    Telemetry telemetry;
    lines_.clear();
    const Timestamp now = ended_ + duration_from_seconds(86'400.0);
    const auto say = [this](const std::string& line) { lines_.push_back(line); };
    const LogTail log;
    IncidentKeeper keeper{
        {.settings = settings_, .first_notes = {"run"}, .map = map_, .began = now}, telemetry, log, {say, say}};
    keeper.look(now);
    keeper.close(now);
  }
  /// The newest segment of the ring.
  [[nodiscard]] fs::path newest_segment() const {
    std::uint64_t newest = 0;
    for (const auto& entry : fs::directory_iterator(folder() / kRingFolder)) {
      newest = std::max(newest, SegmentRing::number_of(entry.path().filename().string()).value_or(0));
    }
    return folder() / kRingFolder / SegmentRing::name_of(newest);
  }
  /// Those that have bytes.
  [[nodiscard]] static std::vector<drivers::port::ByteRecord> records_in(const StoredIncident& stored) {
    drivers::port::ByteLogReader reader{stored.folder / kIncidentRecording};
    std::vector<drivers::port::ByteRecord> records;
    while (auto record = reader.next()) {
      if (!record->bytes.empty()) records.push_back(*std::move(record));
    }
    EXPECT_TRUE(reader.faults().lines().empty()) << reader.faults().lines().front();
    return records;
  }
  [[nodiscard]] std::string told() const {
    std::string all;
    for (const std::string& line : lines_) all += line + "\n";
    return all;
  }

  Timestamp ended_;
};

TEST_F(EndedRunTest, ItsLastMinutesAreAnIncidentThatReplays) {
  start();
  drive(150.0);
  lines_.clear();
  log_.add(world_->now(), "a line before the end", false);
  drive(2.0);
  end_without_a_word();
  ASSERT_TRUE(kept().empty());
  start_and_stop();
  ASSERT_EQ(kept().size(), 1u) << told();
  const StoredIncident stored = kept().front();
  ASSERT_EQ(stored.incident.events.size(), 1u);
  EXPECT_EQ(stored.incident.events.front().kind, IncidentKind::kDaemonEnded);
  EXPECT_LT(seconds(ended_ - stored.incident.events.front().time), 0.2) << "nothing but the newest bytes is lost";
  EXPECT_TRUE(stored.incident.is_complete()) << stored.incident.lacks;
  EXPECT_GE(seconds(ended_ - stored.incident.from), 120.0);
  ASSERT_TRUE(stored.incident.map_from_robot);
  EXPECT_LT(distance_between(*stored.incident.map_from_robot, poses_.rbegin()->second), 1.2) << "of the last second";
  EXPECT_NE(test::content_of(stored.folder / kIncidentLog).find("a line before the end"), std::string::npos);
  EXPECT_NE(test::content_of(stored.folder / kIncidentWords).find("daemon-ended: the daemon ended without a word"),
            std::string::npos);
  EXPECT_NE(told().find("the daemon before ended without a word at "), std::string::npos) << told();
  EXPECT_NE(told().find("are kept as incident " + stored.incident.name), std::string::npos) << told();

  const test::Pixels pixels = test::pixels_of(test::content_of(stored.folder / kIncidentPicture));
  EXPECT_GT(pixels.count(test::incident_colours::kBlue), 50u);
  EXPECT_GT(pixels.count(test::incident_colours::kGreen), 3 * (pixels.count(test::incident_colours::kOrange) + 1))
      << "the scan of that pose";
  EXPECT_NE(test::content_of(stored.folder / kIncidentWords).find("picture.png shows that moment"), std::string::npos);

  double farthest_m = 0.0;
  std::size_t compared = 0;
  const RunReport report = replay(stored, "again", [&](const ReplayedScan& scan) {
    const auto live = poses_.find(scan.row.time);
    if (live == poses_.end()) return;
    ++compared;
    farthest_m = std::max(farthest_m, distance_between(live->second, scan.row.map_from_robot));
  });
  EXPECT_EQ(report.began, "what the recorded run began from: revision=0, kept pose, stability, wheels and mount");
  EXPECT_GT(compared, 1200u);
  EXPECT_LT(farthest_m, 0.1);
}

TEST_F(EndedRunTest, WithoutANewestPoseThereIsNoPictureAndNoWordOfOne) {
  start();
  drive(150.0);
  end_without_a_word();
  ASSERT_TRUE(fs::remove(folder() / kRingFolder / "newest.json")) << "it is not synced";
  start_and_stop();
  ASSERT_EQ(kept().size(), 1u) << told();
  EXPECT_FALSE(fs::exists(kept().front().folder / kIncidentPicture));
  EXPECT_EQ(test::content_of(kept().front().folder / kIncidentWords).find(kIncidentPicture), std::string::npos);
}

TEST_F(EndedRunTest, AYoungRunIsRepeatedFromItsBeginning) {
  start();
  drive(30.0);
  end_without_a_word();
  start_and_stop();
  ASSERT_EQ(kept().size(), 1u) << told();
  EXPECT_FALSE(kept().front().incident.begins_in_mid_run);
  EXPECT_EQ(replay(kept().front(), "again").journal, "obeyed");
}

TEST_F(EndedRunTest, TheIncidentThatWasBeingKeptGetsItsEndFromTheRing) {
  start();
  drive(150.0);
  (void)mark("before the end");
  drive(12.0);
  end_without_a_word();
  ASSERT_EQ(kept().size(), 1u);
  ASSERT_FALSE(kept().front().incident.to);
  // What a killed process had not yet handed to the kernel.
  const fs::path recording = kept().front().folder / kIncidentRecording;
  fs::resize_file(recording, fs::file_size(recording) - 3001);
  start_and_stop();
  ASSERT_EQ(kept().size(), 1u) << told();
  const StoredIncident stored = kept().front();
  ASSERT_EQ(stored.incident.events.size(), 2u);
  EXPECT_EQ(stored.incident.events[0].kind, IncidentKind::kMark);
  EXPECT_EQ(stored.incident.events[1].kind, IncidentKind::kDaemonEnded);
  ASSERT_TRUE(stored.incident.to);
  EXPECT_LT(seconds(ended_ - *stored.incident.to), 0.2);
  const auto records = records_in(stored);
  for (std::size_t i = 1; i < records.size(); ++i) {
    EXPECT_FALSE(records[i] == records[i - 1]) << "each once";
    EXPECT_LT(seconds(records[i].stamp - records[i - 1].stamp), 0.25) << "none is missing";
  }
  EXPECT_GT(replay(stored, "again").scans.localized, 1200u);
  EXPECT_NE(told().find("incident " + stored.incident.name + ", which it was keeping, has been completed"),
            std::string::npos)
      << told();
}

TEST_F(EndedRunTest, AnIncidentThatReachesBeyondTheRingIsCompleteAsItIs) {
  start();
  drive(60.0);
  (void)mark("");
  drive(12.0);
  end_without_a_word();
  const fs::path newest = newest_segment();
  fs::resize_file(newest, fs::file_size(newest) - 3001);
  const fs::path kept_aside = folder_.path() / "ring";
  fs::copy(folder() / kRingFolder, kept_aside);
  start_and_stop();
  ASSERT_EQ(kept().size(), 1u) << told();
  ASSERT_EQ(kept().front().incident.events.size(), 2u);
  EXPECT_LT(seconds(ended_ - *kept().front().incident.to), 1.2);
  const auto records = records_in(kept().front());
  EXPECT_GT(records.size(), 500u);
  EXPECT_GE(kept().front().incident.events[1].time, records.back().stamp) << "no end before what it has";
  EXPECT_EQ(kept().front().incident.events[1].time, *kept().front().incident.to);
  // As if it had been killed again before the ring was gone.
  fs::remove_all(folder() / kRingFolder);
  fs::copy(kept_aside, folder() / kRingFolder);
  start_and_stop();
  ASSERT_EQ(kept().size(), 1u) << told();
  EXPECT_EQ(kept().front().incident.events.size(), 2u) << "worked in once";
}

TEST_F(EndedRunTest, ATornLastBlockIsCutAndTold) {
  start();
  drive(150.0);
  end_without_a_word();
  const fs::path torn = newest_segment();
  fs::resize_file(torn, fs::file_size(torn) - 5);
  start_and_stop();
  ASSERT_EQ(kept().size(), 1u) << told();
  const Incident incident = kept().front().incident;
  EXPECT_NE(incident.lacks.find("its last block was torn"), std::string::npos) << incident.lacks;
  EXPECT_FALSE(incident.is_complete());
  EXPECT_NE(words_of(incident, false).find("It is not complete: its last block was torn"), std::string::npos)
      << words_of(incident, false);
  EXPECT_NE(told().find("its last block was torn"), std::string::npos) << told();
  EXPECT_FALSE(records_in(kept().front()).empty());
}

TEST_F(EndedRunTest, WhatAPowerCutHasEmptiedIsLeftOutAndTheRestReplays) {
  start();
  drive(150.0);
  end_without_a_word();
  const fs::path torn = newest_segment();
  fs::resize_file(torn, 0);
  // The oldest beginning is damaged, too: it begins with the next one.
  for (const auto& entry : fs::directory_iterator(folder() / kRingFolder)) {
    if (entry.path().filename().string() == SegmentRing::name_of_beginning(1)) fs::resize_file(entry.path(), 0);
  }
  start_and_stop();
  ASSERT_EQ(kept().size(), 1u) << told();
  EXPECT_NE(kept().front().incident.lacks.find("its last seconds never reached the disk"), std::string::npos);
  EXPECT_GT(replay(kept().front(), "again").scans.localized, 800u);
}

TEST_F(EndedRunTest, AnIncidentThatWasHalfWrittenKeepsWhyItWas) {
  start();
  drive(60.0);
  (void)mark("pallet fell");
  end_without_a_word();
  // As it was when its page stood, and its recording did not.
  const StoredIncident half = kept().front();
  const fs::path draft = folder() / (".draft-" + half.incident.name);
  fs::rename(half.folder, draft);
  fs::resize_file(draft / kIncidentRecording, 10);
  start_and_stop();
  ASSERT_EQ(kept().size(), 1u) << told();
  EXPECT_EQ(kept().front().incident.name, half.incident.name);
  ASSERT_EQ(kept().front().incident.events.size(), 2u);
  EXPECT_EQ(kept().front().incident.events[0].words, "marked by an operator: pallet fell");
  EXPECT_EQ(replay(kept().front(), "again").journal, "obeyed");
  EXPECT_FALSE(fs::exists(draft));
}

TEST_F(EndedRunTest, AnIncidentWhoseEndIsNowhereSaysSo) {
  start();
  drive(60.0);
  (void)mark("");
  drive(5.0);
  end_without_a_word();
  fs::remove_all(folder() / kRingFolder);
  start_and_stop();
  ASSERT_EQ(kept().size(), 1u);
  EXPECT_NE(kept().front().incident.lacks.find("its end was never written"), std::string::npos);
  EXPECT_TRUE(kept().front().incident.to);
  const std::size_t told_before = lines_.size();
  EXPECT_EQ(told_before, 1u) << told();
  start_and_stop();
  EXPECT_TRUE(lines_.empty()) << "told once: " << told();
}

TEST_F(EndedRunTest, ACleanStopLeavesNone) {
  start();
  drive(30.0);
  ended_ = world_->now();
  daemon_->listener()->close(ended_);
  daemon_.reset();
  start_and_stop();
  EXPECT_TRUE(kept().empty());
  EXPECT_TRUE(lines_.empty()) << told();
}

TEST_F(EndedRunTest, EndsDriveOutEachOtherAndNothingElse) {
  start();
  drive(30.0);
  (void)mark("");
  drive(31.0);
  for (std::size_t end = 0; end < kMostEnds + 3; ++end) {
    const fs::path kept_aside = folder_.path() / "ring";
    if (end == 0) {
      end_without_a_word();
      fs::copy(folder() / kRingFolder, kept_aside);
    }
    // The same ring, ended a second later each time.
    fs::remove_all(folder() / kRingFolder);
    fs::copy(kept_aside, folder() / kRingFolder);
    drivers::port::ByteRecord record;
    record.stamp = ended_ + duration_from_seconds(static_cast<double>(end) + 1.0);
    record.bytes = {1, 2, 3};
    drivers::port::ByteLogWriter{folder() / kRingFolder / SegmentRing::name_of(99), {9600, 38400}}.write(record);
    start_and_stop();
  }
  const auto all = kept();
  ASSERT_EQ(all.size(), kMostEnds + 1);
  EXPECT_EQ(all.front().incident.events.front().kind, IncidentKind::kMark);
  EXPECT_NE(told().find("goes: there are more than 10 ends of the daemon"), std::string::npos) << told();
}

TEST_F(EndedRunTest, ARingThatCannotBeWorkedOnIsNotMetForEver) {
  fs::create_directories(folder());
  for (int start = 1; start <= 6; ++start) {
    fs::create_directories(folder() / kRingFolder);
    std::ofstream(folder() / kRingFolder / "0.pcapng") << start;
    set_left_aside(folder());
  }
  std::size_t left = 0;
  for (const auto& entry : fs::directory_iterator(folder())) left += entry.is_directory() ? 1 : 0;
  EXPECT_EQ(left, 3u);
  std::vector<std::string> lines;
  keep_left(folder(), "", [&](const KeptEnd& kept) { lines.push_back(kept.line); });
  EXPECT_EQ(lines,
            std::vector<std::string>(3, "the daemon before ended without a word, before anything of it was on disk"));
  EXPECT_TRUE(fs::is_empty(folder()));
}

}  // namespace
}  // namespace deltamap::daemon
