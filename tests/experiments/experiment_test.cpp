// SPDX-License-Identifier: Apache-2.0
// `deltamap-lab` at the command line, with drives of seconds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "daemon/telemetry/version.hpp"
#include "experiments/localization/weakest_axis.hpp"
#include "experiments/pooled_runs.hpp"
#include "experiments/registry.hpp"
#include "experiments/report/result_files.hpp"
#include "tests/support/files/lab_run.hpp"
#include "tests/support/files/temporary_folder.hpp"
#include "tests/support/files/text_file.hpp"

namespace deltamap::experiments {
namespace {

namespace fs = std::filesystem;

using test::content_of;
using test::run_lab;
using test::ToolRun;

ToolRun experiment(const std::string& name, const fs::path& out, std::vector<std::string> more = {}) {
  if (name == "ablation") more.emplace_back("--quick");  // a hundred rows that differ in one setting each
  return test::run_experiment(name, out.string(), "0.1", more);
}

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

TEST(Experiment, EachLeavesATableASummaryAndAPage) {
  for (const auto& known : experiments::experiments()) {
    const test::TemporaryFolder folder;
    const ToolRun answer = experiment(known.name, folder.path(), {"--json"});
    ASSERT_EQ(answer.exit_code, 0) << answer.errors;
    std::vector<std::string> expected{known.name + ".csv", "index.html", "summary.json"};
    std::sort(expected.begin(), expected.end());
    EXPECT_EQ(names_in(folder.path()), expected);
    EXPECT_EQ(answer.output, content_of(folder.path() / "summary.json"));
    const auto summary = nlohmann::json::parse(answer.output);
    EXPECT_EQ(summary["experiment"], known.name);
    EXPECT_GT(summary["runs"], 0);
    EXPECT_GE(summary["figures"].size(), 3u) << known.name;
    std::vector<std::string> names;
    for (const auto& figure : summary["figures"]) {
      EXPECT_EQ(figure.contains("target"), figure.contains("met"));
      // What ablation tells first is how it was done.
      EXPECT_TRUE(figure.contains("runs") || known.name == "ablation") << known.name << ": " << figure["name"];
      names.push_back(figure["name"]);
    }
    std::sort(names.begin(), names.end());
    EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end()) << known.name << ": a name for two figures";
    const std::string page = content_of(folder.path() / "index.html");
    EXPECT_NE(page.find("<svg"), std::string::npos);
    EXPECT_EQ(page.find("src="), std::string::npos) << "a page stands alone";
    EXPECT_EQ(page.find("http"), std::string::npos) << "a page stands alone";
  }
}

TEST(Experiment, SummaryAndPageSayWhichProgramMadeThemWithWhichSettings) {
  const experiments::Results results{"name", "what", 1,  false,
                                     {},     {},     {}, daemon::parse_settings("{mapping: {method: paper}}", "f")};
  const auto summary = nlohmann::json::parse(experiments::summary_json(results));
  EXPECT_EQ(summary["version"], daemon::version());
  EXPECT_EQ(summary["commit"], daemon::commit());
  EXPECT_EQ(summary["settings"]["changed"], nlohmann::json::parse(R"({"mapping.method": "paper"})"));
  const std::string told =
      "commit " + std::string(daemon::commit()) + "; settings as delivered, but mapping.method: paper.";
  EXPECT_NE(experiments::page_html(results).find(told), std::string::npos);
}

TEST(Experiment, TableHasAColumnForEveryNumberThatAnyRunHas) {
  const experiments::Results results{
      "name",
      "what",
      1,
      false,
      {{"one", {}}, {"two", {}}},
      {{{{"drive", "x"}}, {{"a", 1.0}, {"b", 2.0}}, {}}, {{{"drive", "y"}}, {{"b", 3.0}, {"c", 4.0}}, {}}},
      {},
      {}};
  EXPECT_EQ(experiments::runs_csv(results), "run,drive,a,b,c\none,x,1,2,\ntwo,y,,3,4\n");
}

/// A table without the columns whose names end in _ms or _mb.
std::vector<std::string> without_times(const std::string& csv) {
  std::vector<bool> is_time;
  std::vector<std::string> left;
  std::istringstream lines{csv};
  for (std::string line; std::getline(lines, line);) {
    std::istringstream cells{line};
    std::size_t column = 0;
    for (std::string cell; std::getline(cells, cell, ','); ++column) {
      if (is_time.size() == column)
        is_time.push_back(cell.ends_with("_ms") || cell.ends_with("_mb"));  // the first line names them
      if (!is_time[column]) left.push_back(cell);
    }
  }
  return left;
}

TEST(Experiment, GivesTheSameFilesHoweverManyRunsGoOnAtOnce) {
  for (const auto& known : experiments::experiments()) {
    const test::TemporaryFolder one;
    const test::TemporaryFolder three;
    ASSERT_EQ(experiment(known.name, one.path(), {"--jobs", "1"}).exit_code, 0);
    ASSERT_EQ(experiment(known.name, three.path(), {"--jobs", "3"}).exit_code, 0);
    if (known.times != experiments::Experiment::Times::kNothing) {
      const std::string table = known.name + ".csv";
      EXPECT_EQ(without_times(content_of(one.path() / table)), without_times(content_of(three.path() / table)));
      continue;
    }
    for (const std::string& name : names_in(one.path())) {
      EXPECT_EQ(content_of(one.path() / name), content_of(three.path() / name)) << name;
    }
  }
}

TEST(Experiment, WritesEveryScanOnRequest) {
  const test::TemporaryFolder folder;
  ASSERT_EQ(experiment("hall", folder.path(), {"--scans"}).exit_code, 0);
  const auto files = names_in(folder.path() / "scans");
  ASSERT_EQ(files.size(), 4u);
  const std::string scans = content_of(folder.path() / "scans" / files.front());
  EXPECT_EQ(scans.substr(0, 4), "t_s,");
  EXPECT_GT(std::count(scans.begin(), scans.end(), '\n'), 50);
}

TEST(Experiment, RefusesAnUnknownNameAndListsThoseThatThereAre) {
  const test::TemporaryFolder folder;
  const ToolRun answer = experiment("hal", folder.path() / "new");
  EXPECT_EQ(answer.exit_code, 2);
  EXPECT_NE(answer.errors.find("'hal'"), std::string::npos) << answer.errors;
  for (const auto& known : experiments::experiments()) {
    EXPECT_NE(answer.errors.find(known.name), std::string::npos) << answer.errors;
  }
  EXPECT_FALSE(fs::exists(folder.path() / "new"));
}

TEST(Experiment, ListsThoseThatThereAreALineEach) {
  const ToolRun answer = run_lab({"--list"});
  ASSERT_EQ(answer.exit_code, 0) << answer.errors;
  std::istringstream lines{answer.output};
  for (const auto& known : experiments::experiments()) {
    std::string line;
    ASSERT_TRUE(std::getline(lines, line));
    EXPECT_EQ(line, known.name + "\t" + (known.times == experiments::Experiment::Times::kMachine ? "times" : "") +
                        "\t" + known.what);
  }
  EXPECT_EQ(lines.peek(), EOF);
}

TEST(Experiment, RefusesAFolderThatCannotBeWrittenInOneLine) {
  const test::TemporaryFolder folder;
  const ToolRun answer = experiment("hall", folder.write("file", "x") / "below");
  EXPECT_EQ(answer.exit_code, 1);
  EXPECT_EQ(std::count(answer.errors.begin(), answer.errors.end(), '\n'), 1) << answer.errors;
  EXPECT_NE(answer.errors.find("below"), std::string::npos) << answer.errors;
}

TEST(Experiment, RefusesAFolderWithoutScenariosInOneLine) {
  const test::TemporaryFolder folder;
  const ToolRun answer =
      run_lab({"hall", "--out", (folder.path() / "out").string(), "--scenarios", folder.path().string()});
  EXPECT_EQ(answer.exit_code, 1);
  EXPECT_NE(answer.errors.find("hall.yaml"), std::string::npos) << answer.errors;
}

TEST(Experiment, RefusesASettingThatThereIsNot) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(experiment("hall", folder.path() / "out", {"--set", "localization.no_such_key=1"}).exit_code, 2);
  EXPECT_EQ(experiment("hall", folder.path() / "out", {"--jobs", "0"}).exit_code, 2);
  EXPECT_EQ(run_lab({"hall", "--out", folder.path().string(), "--minutes", "-1"}).exit_code, 2);
}

TEST(Experiment, TriesTheFolderWithoutLeavingATrace) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(experiments::expect_writable(folder.write("file", "x") / "below"), std::runtime_error);
  experiments::expect_writable(folder.path() / "made");
  EXPECT_TRUE(names_in(folder.path() / "made").empty());
}

TEST(Experiment, DoesOnlyTheRunsThatAreAskedFor) {
  const test::TemporaryFolder folder;
  const ToolRun answer = experiment("hall", folder.path(), {"--only", "500x60-8m", "--json"});
  ASSERT_EQ(answer.exit_code, 0) << answer.errors;
  EXPECT_EQ(nlohmann::json::parse(answer.output)["runs"], 1);
  EXPECT_EQ(experiment("hall", folder.path(), {"--only", "no such run"}).exit_code, 2);
}

TEST(Target, IsMetOnlyByAMeasuredFigureWithinItsLimits) {
  const experiments::Target target{.least = 0.9, .most = 0.98};
  EXPECT_EQ(experiments::text_of(target), "≥ 0.9, ≤ 0.98");
  EXPECT_TRUE(target.is_met_by(0.95));
  EXPECT_FALSE(target.is_met_by(0.89));
  EXPECT_FALSE(target.is_met_by(1.0));
  EXPECT_FALSE(target.is_met_by(std::nan("")));
}

TEST(Target, IsToldApartWhereNothingWasMeasured) {
  const auto verdict = [](double value) {
    return experiments::verdict_on({.name = "share", .value = value, .target = experiments::Target{.least = 0.9}});
  };
  EXPECT_EQ(verdict(0.95), "met");
  EXPECT_EQ(verdict(0.89), "missed");
  EXPECT_EQ(verdict(std::nan("")), "nothing measured");
  EXPECT_EQ(experiments::verdict_on({.name = "share", .value = 0.95}), "");
}

/// A run whose scans have these values in one column.
experiments::Outcome run_of(const std::string& place, std::initializer_list<double> values) {
  experiments::Outcome run{{{"place", place}}, {}, experiments::ScanTable{{"error_m"}}};
  for (const double value : values) run.scans.add({value});
  return run;
}

experiments::PooledRuns::Numbers mean_and_p90(const experiments::ScanTable& scans) {
  const std::vector<double> error_m = scans.column("error_m");
  return {{"mean_m", mean_of(error_m)}, {"p90_m", quantile(error_m, 0.9)}};
}

TEST(PooledRuns, DrawWholeRunsAgain) {
  std::vector<experiments::Outcome> outcomes;
  for (int i = 0; i < 8; ++i) outcomes.push_back(run_of("hall", {1.0 + i % 2, 1.0 + i % 2, 1.0 + i % 2}));
  outcomes.push_back(run_of("depot", {100.0}));
  const experiments::PooledRuns runs{experiments::runs_with(outcomes, {{"place", "hall"}}), mean_and_p90};
  const experiments::Figure mean = runs.figure("error", "mean_m", "m");
  EXPECT_EQ(mean.value, 1.5);
  ASSERT_TRUE(mean.certainty);
  EXPECT_EQ(mean.certainty->runs, 8u) << "not 24: the scans of a run are like each other";
  EXPECT_NEAR(mean.certainty->low, 1.5 - 1.96 * 0.5 / std::sqrt(8.0), 0.05);
  EXPECT_NEAR(mean.certainty->high, 1.5 + 1.96 * 0.5 / std::sqrt(8.0), 0.05);
  EXPECT_EQ(runs.figure("error, nine of ten within", "p90_m").value, 2.0);
  EXPECT_FALSE(runs.figure_of_extreme("error, most", "p90_m").certainty->has_interval());
  EXPECT_TRUE(experiments::PooledRuns(experiments::runs_with(outcomes, {{"place", "yard"}}), mean_and_p90).empty());
}

TEST(PooledRuns, FewRunsAreCountedAndHaveNoInterval) {
  const std::vector<experiments::Outcome> outcomes{run_of("hall", {1.0, 3.0})};
  const experiments::Figure mean =
      experiments::PooledRuns{experiments::runs_with(outcomes, {}), mean_and_p90}.figure("error", "mean_m");
  EXPECT_EQ(mean.certainty->runs, 1u);
  EXPECT_FALSE(mean.certainty->has_interval());
}

TEST(Experiment, PageTellsIntervalAndRunsBesideAFigure) {
  experiments::Results results{"name", "what", 1, false, {}, {}, {}, {}};
  results.report.figures = {{"error, mean", 0.0312345, "m", {}, "", Certainty{36, 0.02, 0.04}},
                            {"worst", 0.5, "m", {}, "", Certainty{.runs = 36}}};
  const std::string page = experiments::page_html(results);
  EXPECT_NE(page.find("0.0312 m</td><td class=\"number\">0.02 … 0.04</td><td>36</td>"), std::string::npos) << page;
  const auto summary = nlohmann::json::parse(experiments::summary_json(results));
  EXPECT_EQ(summary["figures"][0]["interval_95"], nlohmann::json({0.02, 0.04}));
  EXPECT_EQ(summary["figures"][1]["runs"], 36);
  EXPECT_FALSE(summary["figures"][1].contains("interval_95"));
  EXPECT_NE(page.find("--accent"), std::string::npos) << "the live page's colours";
  EXPECT_NE(page.find("prefers-color-scheme"), std::string::npos);
}

TEST(WeakestAxis, LiesAlongACorridorWithoutEnd) {
  const simulation::World corridor{{{1, simulation::ObjectKind::kWall, simulation::Polyline{{{-50, 0}, {50, 0}}}},
                                    {2, simulation::ObjectKind::kWall, simulation::Polyline{{{-50, 4}, {50, 4}}}}}};
  const auto axis = experiments::weakest_axis(corridor, simulation::RayCaster{corridor}, {0.0, 1.5, 0.3}, 8.0);
  EXPECT_NEAR(std::abs(axis.direction.x()), 1.0, 1e-6);
  EXPECT_NEAR(axis.share, 0.0, 1e-9);
}

TEST(WeakestAxis, IsWellObservedInARoom) {
  const simulation::World room{
      {{1, simulation::ObjectKind::kWall, simulation::Polyline{{{0, 0}, {6, 0}, {6, 6}, {0, 6}, {0, 0}}}}}};
  EXPECT_GT(experiments::weakest_axis(room, simulation::RayCaster{room}, {3.0, 3.0, 0.3}, 8.0).share, 0.1);
}

}  // namespace
}  // namespace deltamap::experiments
