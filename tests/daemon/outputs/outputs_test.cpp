// SPDX-License-Identifier: Apache-2.0
#include "daemon/outputs/outputs.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/files/file_lock.hpp"
#include "daemon/outputs/line_file.hpp"
#include "daemon/settings/settings.hpp"
#include "daemon/telemetry/latency_histogram.hpp"
#include "daemon/telemetry/version.hpp"
#include "tests/support/files/temporary_folder.hpp"
#include "tests/support/files/text_file.hpp"

namespace deltamap::daemon {
namespace {

TEST(Trajectory, ALineHasTheExactTimeAndTheHeadingAsQuaternion) {
  EXPECT_EQ(tum_line({timestamp_from_ns(976052857'123456789), {1.5, -2.25, radians(90.0)}}),
            "976052857.123456789 1.500000 -2.250000 0 0 0 0.707106781 0.707106781\n");
  EXPECT_EQ(tum_line({timestamp_from_ns(5'000'000'007), {}}),
            "5.000000007 0.000000 0.000000 0 0 0 0.000000000 1.000000000\n");
}

TEST(Report, SaysWhichProgramMadeItWithWhichSettings) {
  const Settings settings = parse_settings("{seed: 7, laser: {variant: 100/1}, map: {store: \"a b\"}}", "f");
  const auto report = nlohmann::json::parse(json_text(RunReport{}, settings));
  EXPECT_EQ(report["version"], version());
  EXPECT_EQ(report["commit"], commit());
  EXPECT_EQ(report["settings"]["changed"],
            nlohmann::json::parse(R"({"seed": 7, "laser.variant": "100/1", "map.store": "a b"})"));
  EXPECT_EQ(report["settings"]["fingerprint"].get<std::string>().size(), 16u);
  const auto as_delivered = nlohmann::json::parse(json_text(RunReport{}, Settings{}));
  EXPECT_TRUE(as_delivered["settings"]["changed"].empty());
  EXPECT_NE(as_delivered["settings"]["fingerprint"], report["settings"]["fingerprint"]);
}

TEST(Version, HasNumberCommitCompilerAndBits) {
  EXPECT_EQ(version_text().find(std::string(version()) + " (commit " + std::string(commit()) + ", "), 0u);
  EXPECT_TRUE(version_text().ends_with(" bit)")) << version_text();
  EXPECT_FALSE(commit().empty());
}

TEST(StagingFolder, WhatIsNotCommittedDisappears) {
  const test::TemporaryFolder folder;
  {
    const StagingFolder staging{folder.path() / "out"};
    LineFile{staging.path() / "trajectory.tum"}.write("x\n");
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(StagingFolder, ACommittedFolderReplacesFilesAndKeepsTheOthers) {
  const test::TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "out");
  (void)folder.write("out/trajectory.tum", "old");
  (void)folder.write("out/notes.txt", "mine");
  {
    StagingFolder staging{folder.path() / "out/"};
    LineFile{staging.path() / "trajectory.tum"}.write("new");
    staging.commit();
  }
  EXPECT_EQ(std::filesystem::file_size(folder.path() / "out/trajectory.tum"), 3u);
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "out/notes.txt"));
}

/// What a folder says to a run that would write there.
std::string refusal_of(const std::filesystem::path& folder) {
  try {
    const StagingFolder staging{folder};
    return {};
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

TEST(StagingFolder, AStoreThatNoSuchRunHasLeftIsNotReplaced) {
  const test::TemporaryFolder folder;
  const auto store = folder.write("map_store.sqlite", "years of work");
  EXPECT_EQ(refusal_of(folder.path()),
            store.string() + ": --out would replace it, and no run with --out has left it; give another folder");
  (void)folder.write("changes.jsonl", "");
  EXPECT_EQ(refusal_of(folder.path()), "") << "an earlier run with --out";
  EXPECT_NO_THROW(require_no_other_maps(folder.path(), store));
}

TEST(StagingFolder, MapsThatADaemonKeepsThereAreNotReplaced) {
  const test::TemporaryFolder folder;
  (void)folder.write("changes.jsonl", "");
  for (const char* name : {"map_store.sqlite", "map.pgm"}) {
    const auto lock = lock_of_file(folder.write(name, "x"));
    EXPECT_NE(refusal_of(folder.path()).find(std::string{name} + ": is in use by "), std::string::npos) << name;
  }
  StagingFolder staging{folder.path()};
  LineFile{staging.path() / "map_store.sqlite"}.write("new");
  const auto lock = lock_of_file(folder.path() / "map_store.sqlite");  // a daemon that has begun meanwhile
  EXPECT_THROW(staging.commit(), FileInUse);
  EXPECT_EQ(test::content_of(folder.path() / "map_store.sqlite"), "x");
}

TEST(StagingFolder, AFileInPlaceOfTheFolderIsRefusedByName) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("out", "a file");
  try {
    const StagingFolder staging{file};
    FAIL() << "must refuse";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(error.what(), file.string() + ": is no folder");
  }
}

TEST(ChangeTally, OfAMonthIsNoLargerThanOfADay) {
  ChangeTally tally;
  for (std::uint32_t i = 1; i <= 100'000; ++i) {
    ChangeNote note;
    note.reason = i % 3 == 0 ? "no merge" : "too few scans";
    if (i % 10 == 0) note.revision = i;
    tally.add(note);
  }
  EXPECT_EQ(tally.accepted(), 10'000u);
  EXPECT_EQ(tally.refused(), 90'000u);
  EXPECT_EQ(tally.refusals().at("no merge") + tally.refusals().at("too few scans"), 90'000u);
  EXPECT_EQ(tally.revisions().size(), ChangeTally::kKept);
  EXPECT_EQ(tally.revisions().back().number, 100'000u);
  RunReport report;
  report.changes = tally;
  EXPECT_LT(json_text(report, Settings{}).size(), 200'000u);
  EXPECT_NE(json_text(report, Settings{}).find("\"revisions_total\": 10000"), std::string::npos);
}

TEST(LatencyHistogram, AnswersQuantilesWithinOnePercent) {
  LatencyHistogram histogram;
  for (int i = 1; i <= 1000; ++i) histogram.add(i * 1e-5);
  EXPECT_NEAR(histogram.quantile_s(0.5), 5e-3, 5e-5 * 1.1);
  EXPECT_NEAR(histogram.quantile_s(0.99), 9.9e-3, 9.9e-5 * 1.1);
  EXPECT_DOUBLE_EQ(histogram.max_s(), 1e-2);
  EXPECT_DOUBLE_EQ(LatencyHistogram{}.quantile_s(0.99), 0.0);
}

}  // namespace
}  // namespace deltamap::daemon
