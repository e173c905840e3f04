// SPDX-License-Identifier: Apache-2.0
#include "daemon/journal.hpp"

#include <gtest/gtest.h>

namespace deltamap::daemon {
namespace {

using Kind = Decision::Kind;

TEST(Journal, EveryDecisionSurvivesTheRecording) {
  for (const Kind kind : {Kind::kRevision, Kind::kScanDropped, Kind::kScanLost, Kind::kOdometryLost, Kind::kTrackedLost,
                          Kind::kSetLost, Kind::kPhaseClosed}) {
    Decision decision{kind, 4000000000u, 7};
    if (kind == Kind::kOdometryLost || kind == Kind::kSetLost) decision.scan = 0;
    if (kind == Kind::kScanDropped || kind == Kind::kScanLost || kind == Kind::kTrackedLost) decision.number = 0;
    EXPECT_EQ(decision_of_note(note_of(decision)), decision) << note_of(decision);
  }
  const RunIdentity run{0x0123456789ABCDEFu, 0xFEDCBA9876543210u};
  EXPECT_EQ(run_of_note(note_of(run)), run);
}

TEST(Journal, OtherNotesAreNoDecisions) {
  for (const char* note :
       {"baud 38400", "", "scan 5", "scan 5 dropped twice", "scan -x dropped", "revision 1 before"}) {
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
  journal.read("phase 4 closed at scan 8");
  EXPECT_FALSE(journal.was_dropped(1));
  EXPECT_TRUE(journal.was_dropped(3));
  EXPECT_EQ(journal.revision_before(9), 2u);
  EXPECT_FALSE(journal.revision_before(8));
  EXPECT_EQ(journal.closing_scan(4), 8u);
}

}  // namespace
}  // namespace deltamap::daemon
