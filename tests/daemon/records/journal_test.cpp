// SPDX-License-Identifier: Apache-2.0
#include "daemon/records/journal.hpp"

#include <gtest/gtest.h>

namespace deltamap::daemon {
namespace {

using Kind = Decision::Kind;

TEST(Journal, EveryDecisionSurvivesTheRecording) {
  for (const Kind kind :
       {Kind::kRevision, Kind::kTransients, Kind::kScanDropped, Kind::kScanLost, Kind::kOdometryLost,
        Kind::kTrackedLost, Kind::kSetLost, Kind::kPhaseClosed, Kind::kPaused, Kind::kResumed, Kind::kRelocalized}) {
    Decision decision{kind, 4000000000u, 7};
    if (kind == Kind::kOdometryLost || kind == Kind::kSetLost) decision.scan = 0;
    const bool has_no_number = kind == Kind::kScanDropped || kind == Kind::kScanLost || kind == Kind::kTrackedLost ||
                               kind == Kind::kPaused || kind == Kind::kResumed || kind == Kind::kRelocalized;
    if (has_no_number) decision.number = 0;
    if (kind == Kind::kRelocalized) decision.map_from_robot = {-1.0 / 3.0, 1e-9, 2.0 / 7.0};
    EXPECT_EQ(decision_of_note(note_of(decision)), decision) << note_of(decision);
    if (kind != Kind::kPaused && kind != Kind::kResumed && kind != Kind::kRelocalized) continue;
    decision.scan_time = timestamp_from_ns(1'700'000'000'123'456'789);
    EXPECT_EQ(decision_of_note(note_of(decision)), decision) << note_of(decision);
  }
  const RunIdentity run{0x0123456789ABCDEFu, 0xFEDCBA9876543210u};
  EXPECT_EQ(run_of_note(note_of(run)), run);
  const RunIdentity with_memory{1, 2, 0xFFFFFFFFFFFFFFFFu};
  EXPECT_EQ(run_of_note(note_of(with_memory)), with_memory);
}

TEST(Journal, OtherNotesAreNoDecisions) {
  for (const char* note :
       {"baud 38400", "", "scan 5", "scan 5 dropped twice", "scan -x dropped", "revision 1 before",
        "relocalized to 1 2 before scan 3", "mapping paused before scan", "mapping paused before scan 3 at",
        "mapping paused before scan 3 at noon", "scan 5 dropped at 1700000000000000000"}) {
    EXPECT_FALSE(decision_of_note(note)) << note;
    EXPECT_FALSE(run_of_note(note)) << note;
  }
}

TEST(Journal, AnswersWhatWasDecidedInTheNewestRun) {
  Journal journal;
  journal.read("scan 1 dropped");
  journal.read(note_of(RunIdentity{1, 2}));
  journal.read("scan 3 dropped");
  journal.read("revision 2 before scan 9");
  journal.read("temporary 5 before scan 9");
  journal.read("phase 4 closed at scan 8");
  EXPECT_FALSE(journal.was_dropped(1));
  EXPECT_TRUE(journal.was_dropped(3));
  EXPECT_EQ(journal.revision_before(9), 2u);
  EXPECT_FALSE(journal.revision_before(8));
  EXPECT_EQ(journal.transients_before(9), 5u);
  EXPECT_FALSE(journal.transients_before(8));
  EXPECT_EQ(journal.closing_scan(4), 8u);
  EXPECT_TRUE(journal.commands().empty());
}

TEST(Journal, KeepsTheOperatorsCommandsInTheirOrder) {
  const Decision first{Kind::kRelocalized, 9, 0, {1.0, 2.0, 0.5}};
  const Decision second{Kind::kPaused, 9, 0};
  const Decision third{Kind::kRelocalized, 9, 0, {3.0, 4.0, -0.5}};
  Journal journal;
  for (const Decision& decision : {first, second, third}) journal.read(note_of(decision));
  const Decision fourth{Kind::kResumed, 10, 0};
  journal.read(note_of(fourth));
  EXPECT_EQ(journal.commands(), (std::vector<Decision>{first, second, third, fourth}));
}

Scan scan_at(std::uint32_t number, std::int64_t time_s) {
  Scan scan;
  scan.number = number;
  scan.time = timestamp_from_ns(time_s * 1'000'000'000);
  return scan;
}

TEST(Journal, PlacesACommandByTheNumberOfItsScanWhereNoneIsMissing) {
  Journal journal;
  journal.read(note_of(RunIdentity{1, 2}));
  const Decision paused{Kind::kPaused, 9, 0, {}, scan_at(9, 90).time};
  EXPECT_TRUE(journal.place_of(paused, scan_at(8, 90)) > 0) << "two scans of one time";
  EXPECT_TRUE(journal.place_of(paused, scan_at(9, 90)) == 0);
  EXPECT_TRUE(journal.place_of(paused, scan_at(10, 90)) < 0);
}

TEST(Journal, PlacesACommandByTheTimeOfItsScanWhereScansAreMissing) {
  const Decision paused{Kind::kPaused, 9, 0, {}, scan_at(9, 90).time};
  Journal behind_a_gap;
  behind_a_gap.read(note_of(RunIdentity{1, 2}));
  behind_a_gap.read(kGapNote);
  const Journal without_its_beginning;  // another program has cut it off
  for (const Journal& journal : {behind_a_gap, without_its_beginning}) {
    EXPECT_TRUE(journal.place_of(paused, scan_at(3, 89)) > 0);
    EXPECT_TRUE(journal.place_of(paused, scan_at(4, 90)) == 0);
    EXPECT_TRUE(journal.place_of(paused, scan_at(5, 91)) < 0);
    const Decision of_an_older_version{Kind::kPaused, 9};
    EXPECT_TRUE(journal.place_of(of_an_older_version, scan_at(5, 91)) > 0);
    EXPECT_TRUE(journal.place_of(of_an_older_version, scan_at(9, 95)) == 0);
  }
}

TEST(Journal, TakesWhatIsSaidAgainBehindAGapOnce) {
  const Decision paused{Kind::kPaused, 9, 0, {}, scan_at(9, 90).time};
  Journal journal;
  journal.read(note_of(paused));
  journal.read(kGapNote);
  journal.read(note_of(paused));
  EXPECT_EQ(journal.commands(), std::vector<Decision>{paused});
}

}  // namespace
}  // namespace deltamap::daemon
