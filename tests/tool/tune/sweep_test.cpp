// SPDX-License-Identifier: Apache-2.0
// `deltamap sweep` on a short drive through a small room.
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/files/grid_file.hpp"
#include "daemon/settings/fingerprint.hpp"
#include "daemon/steps/run_begin.hpp"
#include "drivers/port/byte_log.hpp"
#include "drivers/port/replay_port.hpp"
#include "tests/support/files/temporary_folder.hpp"
#include "tests/support/files/text_file.hpp"
#include "tests/support/files/tool_run.hpp"
#include "tests/support/scans/scripted_drive.hpp"
#include "tests/tool/tune/tuned_drive.hpp"
#include "tool/tune/sweep_folder.hpp"

namespace deltamap::tool {
namespace {

namespace fs = std::filesystem;

using test::content_of;
using test::run_deltamap;
using test::ToolRun;
using test::Words;
using Json = nlohmann::json;

using SweepTest = test::TunedDriveTest;

TEST_F(SweepTest, RunsAreThoseOfReplayByteForByte) {
  const ToolRun swept = sweep({"--json"});
  ASSERT_EQ(swept.exit_code, 0) << swept.errors;
  const Json json = Json::parse(swept.output);
  ASSERT_EQ(json["runs"].size(), 4u);
  const Pose2 start = test::pose_on_drive(0.0);
  char pose[96];
  (void)std::snprintf(pose, sizeof pose, "--initial-pose=%.3f,%.3f,%.1f", start.x, start.y, degrees(start.theta));
  std::vector<std::string> found;
  for (const Json& run : json["runs"]) {
    const std::string seed = std::to_string(run["seed"].get<int>());
    const ToolRun replayed = run_deltamap({"replay", file("drive.pcapng"), "--map", file("room.yaml"), pose, "--seed",
                                           seed, "--set", run["setting"].get<std::string>(), "--out", file("run")});
    ASSERT_EQ(replayed.exit_code, 0) << replayed.errors;
    EXPECT_EQ(run["trajectory"], daemon::hex_of(daemon::fingerprint_of(content_of(file("run/trajectory.tum")))));
    EXPECT_EQ(run["map"], daemon::hex_of(grid_hash(read_grid(file("run/map.yaml")))));
    found.push_back(run["trajectory"]);
  }
  std::sort(found.begin(), found.end());
  EXPECT_GT(std::unique(found.begin(), found.end()) - found.begin(), 1) << "settings and seeds make a difference";
}

TEST_F(SweepTest, TellsEachValueAndKeepsTheResult) {
  const ToolRun swept = sweep({});
  ASSERT_EQ(swept.exit_code, 0) << swept.errors;
  EXPECT_NE(swept.output.find("localization.beams=20 "), std::string::npos) << swept.output;
  EXPECT_NE(swept.output.find("localization.beams=60 "), std::string::npos) << swept.output;
  EXPECT_NE(swept.output.find("error_rmse_m"), std::string::npos) << swept.output;
  const Json kept = Json::parse(content_of(file("sweep/sweep.json")));
  EXPECT_EQ(kept["settings"][0]["values"]["localization.beams"], 20);
  EXPECT_LT(kept["settings"][1]["mean"].get<double>(), 0.05) << "a pose that is tracked";
}

TEST_F(SweepTest, LeavesAPageWithTheBestMarkedAndAChart) {
  ASSERT_EQ(sweep({}).exit_code, 0);
  const std::string page = content_of(file("sweep/index.html"));
  EXPECT_NE(page.find("class=\"met\""), std::string::npos) << "the best";
  EXPECT_NE(page.find("error_rmse_m over localization.beams"), std::string::npos);
  EXPECT_NE(page.find("--page"), std::string::npos) << "the look of the reports";
  EXPECT_EQ(page.find("nan"), std::string::npos);
}

TEST_F(SweepTest, GoesOnWhereItWasInterruptedWithTheSameResult) {
  ASSERT_EQ(sweep({}).exit_code, 0);
  const std::string whole = content_of(file("sweep/sweep.json"));
  const auto lines = lines_of_book();
  ASSERT_EQ(lines.size(), 5u) << "a header and a line a run";
  (void)folder_.write("sweep/runs.jsonl", lines[0] + "\n" + lines[1] + "\n" + lines[2].substr(0, 40));
  ASSERT_EQ(sweep({}).exit_code, 0);
  const auto again = lines_of_book();
  ASSERT_EQ(again.size(), 5u);
  EXPECT_EQ(again[1], lines[1]) << "what was done is not done again";
  const Json a = Json::parse(whole);
  const Json b = Json::parse(content_of(file("sweep/sweep.json")));
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(a["runs"][i]["trajectory"], b["runs"][i]["trajectory"]);
}

TEST_F(SweepTest, RefusesToGoOnWithOtherSettingsAndSaysWhich) {
  ASSERT_EQ(sweep({}).exit_code, 0);
  const ToolRun other = sweep({"--set", "localization.field.random_share=0.1"});
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_NE(other.errors.find("was begun with something else"), std::string::npos) << other.errors;
  EXPECT_NE(other.errors.find("localization.field.random_share: not given, now"), std::string::npos) << other.errors;
  EXPECT_EQ(sweep({"--set", "localization.field.random_share=0.1", "--anew"}).exit_code, 0);
}

TEST_F(SweepTest, RefusesKeysAndValuesThatThereAreNot) {
  const auto error_of = [&](const std::string& param) {
    const ToolRun refused = run("sweep", {"--param", param, "--out", file("none")});
    EXPECT_EQ(refused.exit_code, 2) << param;
    EXPECT_FALSE(fs::exists(file("none"))) << param;
    return refused.errors;
  };
  const auto expect = [&](const std::string& param, const std::string& what) {
    EXPECT_NE(error_of(param).find(what), std::string::npos) << param << ": " << error_of(param);
  };
  expect("localization.beems=1:9:3", "nearest key localization.beams");
  expect("localization.beams=-5:9:3", "needs a whole number in its range (0 to 1000), not '-5'");
  expect("localization.beams=9:1:3", "a range goes up");
  expect("localization.beams=0:9:3:log", "begins above 0");
  expect("localization.beams=1:9", "needs a whole number");
  expect("localization.beams=1:9:1", "n is a whole number from 2");
  expect("recording.file=a,b", "changes nothing of a replay");
  expect("seed=1:9:3", "--seeds");
  expect("mapping.method=paper,vidence", "mapping.method: needs");
}

TEST_F(SweepTest, NamesWhatIsMissing) {
  const ToolRun no_recording = run_deltamap({"sweep", file("nothing.pcapng"), "--map", file("room.yaml"), "--param",
                                             "localization.beams=1,2", "--out", file("sweep")});
  EXPECT_EQ(no_recording.exit_code, 1);
  EXPECT_NE(no_recording.errors.find("nothing.pcapng"), std::string::npos) << no_recording.errors;
  const ToolRun no_map =
      run_deltamap({"sweep", file("drive.pcapng"), "--param", "localization.beams=1,2", "--out", file("sweep")});
  EXPECT_EQ(no_map.exit_code, 2);
  EXPECT_NE(no_map.errors.find("needs --map"), std::string::npos) << no_map.errors;
  (void)folder_.write("truth.txt", "5 1 1 0\n");
  const ToolRun other_truth = sweep({});
  EXPECT_EQ(other_truth.exit_code, 1);
  EXPECT_NE(other_truth.errors.find("is it of another recording?"), std::string::npos) << other_truth.errors;
  EXPECT_EQ(sweep({"--by", "error_rms_m"}).exit_code, 1);
  EXPECT_NE(sweep({"--by", "error_rms_m"}).errors.find("nearest error_rmse_m"), std::string::npos);
}

TEST_F(SweepTest, RefusesAMeasureThatNoRecordingGivesBeforeAnyRun) {
  const auto expect_refused = [&](const Words& words, const std::string& what) {
    const ToolRun refused = run_deltamap(words);
    EXPECT_EQ(refused.exit_code, 2) << words[0] << refused.output;
    EXPECT_NE(refused.errors.find(what), std::string::npos) << refused.errors;
    EXPECT_FALSE(fs::exists(file("none"))) << words[0];
  };
  const Words drive{file("drive.pcapng"), "--map", file("room.yaml"), "--by"};
  const auto with = [&](Words words, const std::string& by, const Words& more) {
    words.insert(words.end(), drive.begin(), drive.end());
    words.push_back(by);
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  const Words range{"--param", "localization.beams=20:60:2", "--out", file("none")};
  const Words search{"--param", "localization.beams=20:60:9", "--out", file("none"), "--optimize", "30"};
  const std::string config = folder_.write("a.yaml", "seed: 1\n").string();
  for (const char* by : {"error_rmse_m", "lost_share"}) {
    expect_refused(with({"sweep"}, by, range), "needs --reference or --truth");
    expect_refused(with({"sweep"}, by, search), "needs --reference or --truth");
    expect_refused(with({"compare"}, by, {"--config", config, "--config", config}), "needs --reference or --truth");
  }
  expect_refused(with({"sweep"}, "relation_deg", range), "needs --relations");
  expect_refused(with({"sweep"}, "repeatability_m", search), "`deltamap score` alone");
  Words half = with({"sweep", file("drive.pcapng")}, "error_rmse_m", search);
  for (const std::string& way : {file("truth.txt"), std::string{"-"}}) half.insert(half.end(), {"--reference", way});
  expect_refused(half, "every recording");
}

TEST_F(SweepTest, RefusesMoreCombinationsThanCanBeCounted) {
  Words keys{"--out", file("none")};
  for (const char* key :
       {"motion.metre_per_metre", "motion.turn_per_turn", "motion.slip_probability", "motion.turn_per_metre_deg",
        "wheels.learning_share", "field.random_share", "field.hit_deviation_m", "update.distance_m"}) {
    std::string values;  // 256 for each of eight keys: 2^64, which is 0 in 64 bit
    for (int i = 0; i < 256; ++i) values += (i == 0 ? "" : ",") + std::to_string(0.05 + 0.0001 * i);
    keys.insert(keys.end(), {"--param", std::string{"localization."} + key + "=" + values});
  }
  const ToolRun refused = run("sweep", keys);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.errors.find("more than 10000"), std::string::npos) << refused.errors.substr(0, 300);
}

TEST_F(SweepTest, ScoresAFolderWithKeysThatAreUnknownAndTextsThatNeedQuotes) {
  const ToolRun replayed =
      run_deltamap({"replay", file("drive.pcapng"), "--map", file("room.yaml"), "--out", file("run")});
  ASSERT_EQ(replayed.exit_code, 0) << replayed.errors;
  Json report = Json::parse(content_of(file("run/report.json")));
  report["settings"]["changed"]["localization.of_another_version"] = 3;
  report["settings"]["changed"]["recording.file"] = "a \"quoted\" name.pcapng";
  (void)folder_.write("run/report.json", report.dump());
  const ToolRun scored = run_deltamap({"score", file("run"), "--json"});
  EXPECT_EQ(scored.exit_code, 0) << scored.errors;
}

TEST_F(SweepTest, HeedsAnInterruptBetweenTwoBatches) {
  tune::SweepOptions options;
  options.common.recordings = {file("drive.pcapng")};
  options.common.maps = {file("room.yaml")};
  options.out = file("sweep");
  tune::Drives drives = tune::drives_of(options.common);
  const std::vector<tune::Variant> as_given{tune::variant_of("as given", "", {}, drives)};
  tune::RunBook book{options.out, tune::header_of(drives, as_given.front()), false};
  const auto is_interrupted = tune::watch_for_interrupt();
  const auto batch = [&](std::uint64_t seed) {
    return tune::kept_results({{0, 0, seed}}, as_given, drives, book, options, is_interrupted);
  };
  EXPECT_EQ(batch(1).size(), 1u);
  (void)std::raise(SIGINT);
  EXPECT_THROW((void)batch(2), std::runtime_error);
  EXPECT_EQ(book.size(), 1u);
}

TEST_F(SweepTest, NoRunObeysTheJournalOfARecordingButAllItsCommands) {
  daemon::Settings settings;
  settings.recording.file = file("run.pcapng");
  const daemon::FirstMap map = daemon::first_map(std::make_shared<const OccupancyGrid>(test::small_room(false)));
  drivers::port::ReplayPort imported{file("drive.pcapng"), {}};
  drivers::port::ByteLogWriter writer{file("run.pcapng"), drivers::port::FirstBauds{38400, 38400}};
  bool has_begun = false;
  while (const auto replayed = imported.next()) {
    drivers::port::ByteRecord note = replayed->record;
    note.bytes.clear();
    std::vector<std::string> notes{"relocalized to 1 2 0 before scan 4"};
    for (const std::string& first : daemon::first_notes(settings, map.hash, {})) notes.insert(notes.end() - 1, first);
    for (const std::string& text : notes) {
      note.note = text;
      if (!has_begun) writer.write(note);
    }
    has_begun = true;
    writer.write(replayed->record);
  }
  writer.close();
  daemon::ReplayJob job;
  job.recording = file("run.pcapng");
  job.map = file("room.yaml");
  job.out = file("replayed");
  const auto go_on = [](double) { return true; };
  ASSERT_EQ(daemon::run_replay(job, go_on).journal, "obeyed") << "by a replay it is";
  fs::create_directories(file("again"));
  daemon::FolderOutput output{file("again"), *map.grid, 0};
  const daemon::RunReport again = daemon::replay_again(job, daemon::recorded_drive(job), map, output, go_on);
  EXPECT_NE(again.journal, "obeyed");
  EXPECT_EQ(again.commands, 1u);
}

TEST_F(SweepTest, KeepsNoMoreRecordingsInMemoryThanAreAtWork) {
  fs::copy_file(file("drive.pcapng"), file("other.pcapng"));
  tune::TuningOptions options;
  options.recordings = {file("drive.pcapng"), file("other.pcapng")};
  options.maps = {file("room.yaml")};
  tune::Drives drives = tune::drives_of(options);
  const std::vector<tune::Variant> as_given{tune::variant_of("as given", "", {}, drives)};
  const auto decoded = [&] {
    return std::count_if(drives.begin(), drives.end(), [](const auto& drive) { return drive->is_decoded(); });
  };
  tune::warn_of(drives, as_given.front());
  EXPECT_LE(decoded(), 1);
  std::ptrdiff_t most = 0;
  const auto look = [&] {
    most = std::max(most, decoded());
    return false;
  };
  const auto runs = tune::results_of(tune::every_run(1, 2, {1, 2}), as_given, drives, nullptr, {1, false, false, look});
  EXPECT_EQ(runs.size(), 4u);
  EXPECT_EQ(most, 1);
}

TEST_F(SweepTest, SuspectsAMapOfAnotherSite) {
  OccupancyGrid other{{200, 160, 0.05, {0.0, 0.0}}, CellState::kFree};
  for (int column = 100; column < 200; ++column) {
    for (int row = 0; row < 160; row += 20) other.set({column, row}, CellState::kOccupied);
  }
  write_grid(other, file("room.yaml"));
  const ToolRun swept = sweep({"--set", "mapping.enabled=false"});
  EXPECT_NE(swept.errors.find("is that the map of another site"), std::string::npos) << swept.errors << swept.output;
}

TEST_F(SweepTest, FindsABetterSettingWithinABudgetAndConfirmsItOnOtherSeeds) {
  const Words keys{"--param",    "localization.motion.metre_per_metre=0.01:0.5:9:log",
                   "--param",    "localization.beams=5:100:9",
                   "--optimize", "30",
                   "--out",      file("sweep"),
                   "--json"};
  const ToolRun searched = run("sweep", keys);
  ASSERT_EQ(searched.exit_code, 0) << searched.errors;
  const Json json = Json::parse(searched.output);
  EXPECT_LE(lines_of_book().size() - 1, 30u) << "the budget";
  for (const Json& run : json["runs"]) EXPECT_GE(run["seed"].get<int>(), 1001) << "seeds that the search has not seen";
  const std::string last = json["words"].back();
  EXPECT_TRUE(last.starts_with("confirmed") || last.starts_with("nothing")) << last;
  const auto lines = lines_of_book();
  ASSERT_EQ(run("sweep", keys).exit_code, 0);
  EXPECT_EQ(lines_of_book(), lines) << "the same search needs no run again";
  const ToolRun few = run("sweep", {"--param", "localization.beams=5:100:9", "--optimize", "8", "--out", file("few")});
  EXPECT_EQ(few.exit_code, 2);
  EXPECT_NE(few.errors.find("are too few"), std::string::npos) << few.errors;
}

}  // namespace
}  // namespace deltamap::tool
