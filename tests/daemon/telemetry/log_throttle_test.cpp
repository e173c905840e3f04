// SPDX-License-Identifier: Apache-2.0
#include "daemon/telemetry/log_throttle.hpp"

#include <gtest/gtest.h>

#include "daemon/system/system_journal.hpp"

namespace deltamap::daemon {
namespace {

using Lines = std::vector<LeveledLine>;

LogThrottle::Clock::time_point at(double time_s) {
  return LogThrottle::Clock::time_point{} +
         std::chrono::duration_cast<LogThrottle::Clock::duration>(std::chrono::duration<double>(1000.0 + time_s));
}

LeveledLine warning(std::string text) { return {LogLevel::kWarn, std::move(text)}; }

/// How often a line like this is written where it comes ten times a second for so long, and how it ends.
Lines written_of(const std::string& begin, double for_s) {
  LogThrottle throttle;
  Lines written;
  for (int tenth = 0; tenth < 10 * for_s; ++tenth) {
    if (auto line = throttle.take(warning(begin + std::to_string(tenth)), at(0.1 * tenth))) written.push_back(*line);
    if (tenth % 10 != 9) continue;
    for (LeveledLine& line : throttle.due(at(0.1 * tenth))) written.push_back(std::move(line));
  }
  return written;
}

TEST(LogThrottle, WritesLinesThatDifferInTheirNumbersOnceAMinute) {
  for (const char* line : {"robot: robot has been silent for 1200 ms ", "driving stops: obstacle ",
                           "saving pauses: store: full ", "laser: laser streams again silence_ms=", "scan "}) {
    const Lines written = written_of(line, 600.0);
    EXPECT_GE(written.size(), 10u) << line;
    EXPECT_LE(written.size(), 11u) << line;
  }
}

TEST(LogThrottle, WritesTheNewestOfThoseHeldBackWhenTheMinuteIsOver) {
  LogThrottle throttle;
  EXPECT_EQ(throttle.take(warning("driving stops: bumper"), at(0)), warning("driving stops: bumper"));
  EXPECT_EQ(throttle.take(warning("driving goes on"), at(1)), warning("driving goes on"));
  EXPECT_FALSE(throttle.take(warning("driving stops: bumper"), at(2)));
  EXPECT_FALSE(throttle.take(warning("driving stops: bumper"), at(3)));
  EXPECT_TRUE(throttle.due(at(59)).empty());
  EXPECT_EQ(throttle.due(at(61)), Lines{warning("driving stops: bumper (58 s ago; such lines since the last: 2)")});
  EXPECT_FALSE(throttle.take(warning("driving stops: bumper"), at(62))) << "a minute from what was written last";
  EXPECT_EQ(throttle.rest(at(63)), Lines{warning("driving stops: bumper (1 s ago; such lines since the last: 1)")});
}

TEST(LogThrottle, WritesAtOnceWhatComesAgainAfterAMinute) {
  LogThrottle throttle;
  EXPECT_TRUE(throttle.take(warning("robot was reset"), at(0)));
  EXPECT_TRUE(throttle.due(at(61)).empty());
  EXPECT_EQ(throttle.take(warning("robot was reset"), at(61)), warning("robot was reset"));
}

TEST(LogThrottle, HoldsNothingBackThatStandsForItself) {
  for (const char* line :
       {"map changed: revision=7 phase=3", "map unchanged: phase=3 reason=too few scans", "ctl: pause",
        "reload: 2 keys wait for a restart", "thing 7: body of 2.4 × 1.2 m left 3.00, 4.00", "bay B4: empty, was full",
        "incident 20261130T030012Z-lost: kept"}) {
    LogThrottle throttle;
    for (int i = 0; i < 5; ++i) EXPECT_TRUE(throttle.take({LogLevel::kInfo, line}, at(i))) << line;
  }
}

TEST(LogThrottle, WritesAnErrorAtOnceAndThenOnceAMinuteWithTheCount) {
  LogThrottle throttle;
  const LeveledLine stuck{LogLevel::kError, "watchdog is not fed: stage=map does not move"};
  EXPECT_EQ(throttle.take(stuck, at(0)), stuck);
  for (int second = 1; second < 60; ++second) EXPECT_FALSE(throttle.take(stuck, at(second)));
  EXPECT_EQ(throttle.due(at(60)),
            (Lines{{LogLevel::kError, stuck.text + " (1 s ago; such lines since the last: 59)"}}));
}

TEST(LogThrottle, OfAMonthIsNoLargerThanOfAMinute) {
  LogThrottle throttle;
  for (int i = 0; i < 100'000; ++i) {
    (void)throttle.take(warning("line " + std::string(static_cast<std::size_t>(i % 7), 'x')), at(i));
    (void)throttle.due(at(i));
  }
  EXPECT_LE(throttle.rest(at(100'000)).size(), 7u);
}

TEST(SystemJournal, MakesAFieldOfEachKey) {
  EXPECT_EQ(
      system_journal::fields_of(
          LogLevel::kInfo,
          "map changed: revision=7 phase=3 added=41 freed=2 scans=120 acceptance=0.973 verdict=accepted"),
      (std::vector<std::string>{
          "MESSAGE=map changed: revision=7 phase=3 added=41 freed=2 scans=120 acceptance=0.973 verdict=accepted",
          "PRIORITY=6", "SYSLOG_IDENTIFIER=deltamapd", "DELTAMAP_REVISION=7", "DELTAMAP_PHASE=3", "DELTAMAP_ADDED=41",
          "DELTAMAP_FREED=2", "DELTAMAP_SCANS=120", "DELTAMAP_ACCEPTANCE=0.973", "DELTAMAP_VERDICT=accepted"}));
}

TEST(SystemJournal, TakesAReasonToTheEndOfTheLine) {
  const auto fields = system_journal::fields_of(LogLevel::kWarn, "map unchanged: phase=3 reason=too few scans");
  EXPECT_EQ(fields[1], "PRIORITY=4");
  EXPECT_EQ(fields.back(), "DELTAMAP_REASON=too few scans");
}

TEST(SystemJournal, OfTheStartTakesAFileAndASizeOfSeveralWords) {
  const auto settings =
      system_journal::fields_of(LogLevel::kInfo, "settings: file=my robot.yaml changed=3 fingerprint=9c83");
  EXPECT_EQ(
      (std::vector<std::string>{settings.begin() + 3, settings.end()}),
      (std::vector<std::string>{"DELTAMAP_FILE=my robot.yaml", "DELTAMAP_CHANGED=3", "DELTAMAP_FINGERPRINT=9c83"}));
  const auto map = system_journal::fields_of(LogLevel::kInfo, "map: file=m0.yaml size=741 x 740 cells of 0.05 m");
  EXPECT_EQ((std::vector<std::string>{map.begin() + 3, map.end()}),
            (std::vector<std::string>{"DELTAMAP_FILE=m0.yaml", "DELTAMAP_SIZE=741 x 740 cells of 0.05 m"}));
}

TEST(SystemJournal, MakesNoFieldOfWhatIsNoKey) {
  EXPECT_EQ(
      system_journal::fields_of(LogLevel::kError, "x == y, 7=8, =9, A=1, a-b=2, phase=, stage=map; phase=4 phase=5")
          .size(),
      5u)
      << "stage and the first phase with a value";
  const auto fields = system_journal::fields_of(LogLevel::kError, "stage=map; phase=4");
  EXPECT_EQ(fields[1], "PRIORITY=3");
  EXPECT_EQ(fields[3], "DELTAMAP_STAGE=map");
}

TEST(SystemJournal, IsOnlyThereWhereStandardErrorEndsInIt) {
  setenv("JOURNAL_STREAM", "1:1", 1);
  EXPECT_FALSE(system_journal::is_behind_stderr());
  setenv("JOURNAL_STREAM", "garbage", 1);
  EXPECT_FALSE(system_journal::is_behind_stderr());
  unsetenv("JOURNAL_STREAM");
  EXPECT_FALSE(system_journal::is_behind_stderr());
}

}  // namespace
}  // namespace deltamap::daemon
