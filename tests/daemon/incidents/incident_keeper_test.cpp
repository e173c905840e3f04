// SPDX-License-Identifier: Apache-2.0
// Incidents of a daemon that drives in virtual time: what is kept, and what a replay makes of it.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <fstream>

#include "daemon/incidents/incident_folder.hpp"
#include "drivers/port/byte_log.hpp"
#include "tests/support/daemon/incident_drive.hpp"
#include "tests/support/files/text_file.hpp"

namespace deltamap::daemon {
namespace {

namespace fs = std::filesystem;

class IncidentKeeperTest : public test::IncidentDrive {
 protected:
  struct Span {
    Timestamp from = Timestamp::max();
    Timestamp to = Timestamp::min();
    std::size_t bytes = 0;
  };
  [[nodiscard]] static Span span_of(const StoredIncident& stored) {
    drivers::port::ByteLogReader reader{stored.folder / kIncidentRecording};
    Span span;
    while (const auto record = reader.next()) {
      span.from = std::min(span.from, record->stamp);
      span.to = std::max(span.to, record->stamp);
      span.bytes += record->bytes.size();
    }
    EXPECT_TRUE(reader.faults().lines().empty()) << reader.faults().lines().front();
    return span;
  }
};

TEST_F(IncidentKeeperTest, KeepsTwoMinutesBeforeAMarkAndHalfAMinuteAfterIt) {
  start();
  drive(150.0);
  const Timestamp marked = world_->now();
  const control::CommandOutcome outcome = mark("pallet fell");
  EXPECT_TRUE(outcome.done) << outcome.message;
  ASSERT_EQ(kept().size(), 1u) << "on disk at once";
  EXPECT_FALSE(kept().front().incident.to);
  drive(32.0);
  ASSERT_EQ(kept().size(), 1u);
  const StoredIncident stored = kept().front();
  EXPECT_EQ(stored.incident.name, outcome.message.substr(outcome.message.find("2023"), 21));
  ASSERT_EQ(stored.incident.events.size(), 1u);
  EXPECT_EQ(stored.incident.events.front().kind, IncidentKind::kMark);
  EXPECT_EQ(stored.incident.events.front().words, "marked by an operator: pallet fell");
  EXPECT_TRUE(stored.incident.begins_in_mid_run);
  const Span span = span_of(stored);
  EXPECT_GE(seconds(marked - span.from), 120.0);
  EXPECT_LE(seconds(marked - span.from), 120.0 + kCheckpointPeriodS + 1.0);
  EXPECT_NEAR(seconds(span.to - marked), 30.0, 1.0);
  EXPECT_EQ(stored.incident.to, span.to + (*stored.incident.to - span.to));
  const std::string words = test::content_of(stored.folder / kIncidentWords);
  EXPECT_NE(words.find("pallet fell"), std::string::npos) << words;
  EXPECT_NE(test::content_of(stored.folder / kIncidentLog).find("incident " + stored.incident.name), std::string::npos);
}

TEST_F(IncidentKeeperTest, AReplayFollowsTheSamePosesFromItsBeginningOn) {
  start();
  drive(150.0);
  (void)mark("");
  drive(32.0);
  double farthest_m = 0.0;
  std::size_t compared = 0;
  std::size_t untracked = 0;
  const auto watch = [&](const ReplayedScan& scan) {
    untracked += scan.row.state == LocalizerState::kTracking ? 0 : 1;
    const auto live = poses_.find(scan.row.time);
    if (live == poses_.end()) return;
    ++compared;
    farthest_m = std::max(farthest_m, distance_between(live->second, scan.row.map_from_robot));
  };
  const RunReport report = replay(kept().front(), "again", watch);
  EXPECT_EQ(report.journal, "not obeyed: the recording begins in mid-run");
  EXPECT_EQ(report.began, "what the recorded run began from: revision=0, kept pose, stability, wheels and mount");
  EXPECT_GT(compared, 1300u) << "the same scans at the same times";
  EXPECT_EQ(untracked, 0u);
  EXPECT_LT(farthest_m, 0.1);
  (void)replay(kept().front(), "once_more");
  EXPECT_EQ(test::content_of(folder_.path() / "again/trajectory.tum"),
            test::content_of(folder_.path() / "once_more/trajectory.tum"));
}

TEST_F(IncidentKeeperTest, AYoungRunIsKeptFromItsBeginning) {
  start();
  drive(60.0);
  (void)mark("");
  drive(32.0);
  const StoredIncident stored = kept().front();
  EXPECT_FALSE(stored.incident.begins_in_mid_run);
  EXPECT_EQ(stored.incident.from, test::kIncidentStart);
  EXPECT_EQ(replay(stored, "again").journal, "obeyed");
}

TEST_F(IncidentKeeperTest, ARobotThatIsCarriedAwayIsKeptAndItsReplayMeetsItAtTheSameTime) {
  start();
  drive(140.0);
  ASSERT_TRUE(kept().empty()) << kept().front().incident.events.front().words;
  world_->carry_robot_to({1.2, 3.2, -1.0});
  drive(100.0);
  ASSERT_GE(kept().size(), 1u);
  const StoredIncident stored = kept().front();
  const IncidentEvent live = stored.incident.events.front();
  EXPECT_TRUE(live.kind == IncidentKind::kKidnapped || live.kind == IncidentKind::kLost)
      << words_of(stored.incident, false);
  PoseWatch watch;
  std::optional<IncidentEvent> again;
  (void)replay(stored, "again", [&](const ReplayedScan& scan) {
    const auto event = watch.observe(scan.row);
    if (event && !again) again = event;
  });
  ASSERT_TRUE(again);
  EXPECT_EQ(again->kind, live.kind);
  EXPECT_NEAR(seconds(again->time - live.time), 0.0, 2.0);
}

TEST_F(IncidentKeeperTest, ALaserThatFallsSilentIsADeviceFault) {
  start();
  drive(20.0);
  world_->laser().cut_power(world_->now(), 60.0);
  drive(10.0);
  ASSERT_EQ(kept().size(), 1u);
  EXPECT_EQ(kept().front().incident.events.front().kind, IncidentKind::kDeviceFault);
}

TEST_F(IncidentKeeperTest, WhatComesMeanwhileBelongsToIt) {
  start();
  drive(20.0);
  (void)mark("one");
  drive(20.0);
  (void)mark("two");
  drive(20.0);
  ASSERT_EQ(kept().size(), 1u);
  EXPECT_FALSE(kept().front().incident.to) << "the second mark has its half minute, too";
  drive(12.0);
  ASSERT_EQ(kept().size(), 1u);
  EXPECT_TRUE(kept().front().incident.to);
  EXPECT_EQ(kept().front().incident.events.size(), 2u);
  (void)mark("three");
  EXPECT_EQ(kept().size(), 2u);
}

TEST_F(IncidentKeeperTest, TheOldestThatIsNotPinnedGoesFirstAndThatIsSaid) {
  settings_.incidents.max_count = 2;
  start();
  for (const char* words : {"one", "two", "three"}) {
    drive(20.0);
    (void)mark(words);
    if (std::string(words) == "one") std::ofstream(kept().front().folder / kIncidentPin) << "";
    drive(32.0);
  }
  ASSERT_EQ(kept().size(), 2u);
  EXPECT_EQ(kept()[0].incident.events.front().words, "marked by an operator: one");
  EXPECT_EQ(kept()[1].incident.events.front().words, "marked by an operator: three");
  EXPECT_TRUE(std::any_of(lines_.begin(), lines_.end(), [](const std::string& line) {
    return line.starts_with("incident ") && line.ends_with("-mark goes: there are more than incidents.max_count");
  }));
}

TEST_F(IncidentKeeperTest, MarksAndLostPosesGoLast) {
  const fs::path parent = settings_.incidents.folder;
  double time_s = 0.0;
  const auto keep = [&](std::vector<IncidentKind> kinds) {
    Incident incident;
    incident.name = std::to_string(++time_s);
    for (const IncidentKind kind : kinds) incident.events.push_back({kind, test::kIncidentStart, incident.name});
    incident.from = test::kIncidentStart;
    fs::create_directories(parent / incident.name);
    write_page(parent / incident.name, incident);
  };
  keep({IncidentKind::kMark});
  keep({IncidentKind::kDeviceFault, IncidentKind::kLost});
  for (const IncidentKind kind : {IncidentKind::kRefusals, IncidentKind::kKidnapped, IncidentKind::kSafetyStop,
                                  IncidentKind::kDeviceFault, IncidentKind::kRefusals})
    keep({kind});
  settings_.incidents.max_count = 4;
  const std::string newest = kept().back().incident.name;
  EXPECT_EQ(within_limits(settings_.incidents, newest).size(), 3u);
  ASSERT_EQ(kept().size(), 4u);
  EXPECT_EQ(kept()[0].incident.events.front().kind, IncidentKind::kMark);
  EXPECT_EQ(kept()[1].incident.events.back().kind, IncidentKind::kLost);
  EXPECT_EQ(kept()[2].incident.events.front().kind, IncidentKind::kKidnapped);
  EXPECT_EQ(kept()[3].incident.name, newest);
  settings_.incidents.max_count = 2;
  (void)within_limits(settings_.incidents, newest);
  ASSERT_EQ(kept().size(), 2u);
  EXPECT_EQ(kept()[0].incident.events.front().kind, IncidentKind::kKidnapped) << "the oldest of them went";
}

TEST_F(IncidentKeeperTest, AFolderThatCannotBeIsToldAndAMarkIsRefusedUntilItCan) {
  std::ofstream(folder_.path() / "incidents") << "a file";
  start();
  drive(20.0);
  const control::CommandOutcome refused = mark("");
  EXPECT_FALSE(refused.done);
  EXPECT_TRUE(refused.message.starts_with("not kept: ")) << refused.message;
  EXPECT_TRUE(lines_.front().starts_with("saving pauses: incidents: ")) << lines_.front();
  fs::remove(folder_.path() / "incidents");
  drive(12.0);
  EXPECT_TRUE(mark("").done);
  ASSERT_EQ(kept().size(), 1u);
  EXPECT_TRUE(kept().front().incident.begins_in_mid_run);
  drive(32.0);
  EXPECT_GT(replay(kept().front(), "again").scans.localized, 300u);
}

/// As a full disk: no file grows beyond some bytes.
class NoRoom {
 public:
  NoRoom() {
    before_ = std::signal(SIGXFSZ, SIG_IGN);
    (void)::getrlimit(RLIMIT_FSIZE, &limit_);
    rlimit small = limit_;
    small.rlim_cur = 64;
    (void)::setrlimit(RLIMIT_FSIZE, &small);
  }
  ~NoRoom() {
    (void)::setrlimit(RLIMIT_FSIZE, &limit_);
    (void)std::signal(SIGXFSZ, before_);
  }
  NoRoom(const NoRoom&) = delete;
  NoRoom& operator=(const NoRoom&) = delete;

 private:
  rlimit limit_{};
  void (*before_)(int) = SIG_DFL;
};

TEST_F(IncidentKeeperTest, ADiskThatIsFullAtTheStartIsBorneAndWhatComesLaterReplays) {
  {
    const NoRoom full;
    start();
    drive(5.0);
    EXPECT_FALSE(mark("").done);
  }
  ASSERT_FALSE(lines_.empty());
  EXPECT_TRUE(lines_.front().starts_with("saving pauses: incidents: ")) << lines_.front();
  drive(20.0);
  EXPECT_TRUE(mark("room again").done);
  drive(32.0);
  ASSERT_EQ(kept().size(), 1u);
  EXPECT_GT(replay(kept().front(), "again").scans.localized, 300u);
}

TEST_F(IncidentKeeperTest, TheRingGoesWithTheRun) {
  start();
  drive(200.0);
  const fs::path ring = fs::path(settings_.incidents.folder) / ".ring";
  std::size_t segments = 0;
  for (const auto& entry : fs::directory_iterator(ring))
    segments += SegmentRing::number_of(entry.path().filename().string()) ? 1 : 0;
  EXPECT_LE(segments, 16u);
  daemon_->listener()->close(world_->now());
  EXPECT_FALSE(fs::exists(ring));
}

TEST(IncidentText, PromisesNoRepeatOfWhatIsNotWholeAndNoPlaceOfAPoseInDoubt) {
  StoredIncident stored;
  Incident& incident = stored.incident;
  incident.name = "20261130T030012Z-lost";
  incident.events = {{IncidentKind::kLost, Timestamp{}, "lost"}};
  incident.begins_in_mid_run = false;
  incident.to = Timestamp{};
  incident.map_from_robot = Pose2{1.0, 2.0, 0.0};
  incident.deviation_m = 10.0;
  const std::string promise = "repeats it bit for bit";
  EXPECT_NE(words_of(incident, false).find(promise), std::string::npos);
  EXPECT_NE(line_of(stored).find("at 1.00, 2.00, 0° in doubt (deviation 10.00 m)"), std::string::npos);
  incident.lacks = "some seconds before its end";
  incident.is_sure = true;
  EXPECT_EQ(words_of(incident, false).find(promise), std::string::npos);
  EXPECT_EQ(line_of(stored).find("in doubt"), std::string::npos);
}

}  // namespace
}  // namespace deltamap::daemon
