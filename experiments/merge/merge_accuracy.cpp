// SPDX-License-Identifier: Apache-2.0
// `merge`: the merges beyond the paper against the true pose's own acceptance, with a prior and without, on four
// layouts and on recorded maps.
#include <Eigen/Cholesky>
#include <cmath>
#include <iostream>

#include "experiments/merge/merge_layouts.hpp"
#include "experiments/merge/merge_table.hpp"
#include "experiments/registry.hpp"
#include "experiments/report/svg_map.hpp"
#include "surveying/grid_registration/global_merge.hpp"
#include "surveying/grid_registration/prior_merge.hpp"

namespace deltamap::experiments {
namespace {

constexpr double kPriorDeviation_m = 0.15;
constexpr double kPriorDeviation_deg = 2.0;
constexpr double kMostChi2 = 11.345;  // 99 % of 3 degrees of freedom: what lies within the prior
constexpr int kTransformsOfARun = 100;

PoseCovariance prior_covariance() {
  const double heading_rad = radians(kPriorDeviation_deg);
  return Eigen::Vector3d{kPriorDeviation_m * kPriorDeviation_m, kPriorDeviation_m * kPriorDeviation_m,
                         heading_rad * heading_rad}
      .asDiagonal();
}

/// The true pose with an error about the local map's middle that the prior allows.
Pose2 guess_of(const Pose2& map_from_local, const Point2& middle_in_local, Random& random) {
  double x = 0.0;
  double y = 0.0;
  double turn = 0.0;
  do {
    x = random.normal();
    y = random.normal();
    turn = random.normal();
  } while (x * x + y * y + turn * turn > kMostChi2);
  const Point2 middle = map_from_local * middle_in_local;
  const Pose2 about{middle.x(), middle.y(), 0.0};
  return about * Pose2{kPriorDeviation_m * x, kPriorDeviation_m * y, radians(kPriorDeviation_deg * turn)} *
         inverse(about) * map_from_local;
}

MergePlace place_named(const std::string& name, std::uint64_t seed, const Options& options) {
  for (const std::string& recorded : recorded_places()) {
    if (recorded == name) return recorded_place(name, options.data.value()).value();
  }
  return drawn_place(name, seed);
}

Outcome merge_often(const std::string& name, bool with_prior, std::uint64_t layout_seed, std::uint64_t seed,
                    int transforms, const Options& options) {
  const MergePlace place = place_named(name, layout_seed, options);
  Random random{seed};
  Outcome outcome;
  outcome.scans = empty_merge_table();
  for (int i = 0; i < transforms; ++i) {
    const LocalMap local = turned_local(place, false, random);
    const Pose2 truth = place.map_from_other * inverse(local.local_from_other);
    Pose2 found;
    bool is_refused = false;
    double taken_ms = 0.0;
    if (with_prior) {
      const Pose2 guess = guess_of(truth, mapping::merge::LocalCells{local.grid}.middle_in_local(), random);
      taken_ms = cpu_ms([&] {
        const auto merge =
            surveying::grid_registration::prior_merge(place.map, local.grid, guess, prior_covariance(), {});
        found = merge.map_from_guess * guess;
        is_refused = !merge.accepted();
      });
    } else {
      taken_ms = cpu_ms([&] {
        const auto merge = surveying::grid_registration::global_merge(place.map, local.grid);
        found = merge.map_from_local;
        is_refused = !merge.accepted();
      });
    }
    add_merge(outcome.scans, degrees(local.local_from_other.theta), measured(place, local, found), is_refused,
              taken_ms);
  }
  outcome.labels = {{"prior", with_prior ? "with" : "without"},
                    {"place", name},
                    {"layout", std::to_string(layout_seed)},
                    {"seed", std::to_string(seed)}};
  outcome.numbers = merge_numbers(outcome.scans);
  return outcome;
}

std::vector<std::string> places_for(const Options& options) {
  std::vector<std::string> places;
  for (const MergeLayout& layout : merge_layouts()) places.push_back(layout.name);
  for (const std::string& name : recorded_places()) {
    if (options.data && recorded_place(name, *options.data)) {
      places.push_back(name);
    } else {
      std::cerr << "merge: no map " << name << " (--data or DELTAMAP_DATA): NOT measured on it\n";
    }
  }
  return places;
}

std::vector<Run> runs_of(const Options& options) {
  const std::vector<std::string> places = places_for(options);
  const int all = options.quick ? 300 : 10000;
  const int of_a_place =
      options.repeats.value_or((all + static_cast<int>(places.size()) - 1) / static_cast<int>(places.size()));
  std::vector<Run> runs;
  for (const bool with_prior : {true, false}) {
    for (const std::string& place : places) {
      for (int done = 0, i = 0; done < of_a_place; done += kTransformsOfARun, ++i) {
        const int transforms = std::min(kTransformsOfARun, of_a_place - done);
        const std::uint64_t seed = 1000 * options.seed + static_cast<std::uint64_t>(i);
        // Another layout for every fourth run, but always the same recorded map.
        const std::uint64_t layout_seed = 1000 * options.seed + static_cast<std::uint64_t>(i / 4);
        runs.push_back({std::string{with_prior ? "prior-" : "global-"} + place + "-" + std::to_string(i),
                        [=] { return merge_often(place, with_prior, layout_seed, seed, transforms, options); }});
      }
    }
  }
  return runs;
}

void add_figures(Report& report, const std::vector<Outcome>& outcomes, const std::string& prior, double most_ms) {
  const PooledRuns all = pooled_merges(outcomes, {{"prior", prior}});
  if (all.empty()) return;  // not asked for
  const std::string what = prior + (prior == "with" ? " prior: " : " a prior: ");
  const auto add = [&](const std::string& name, const char* number, const char* unit, std::optional<Target> target) {
    report.figures.push_back(all.figure(what + name, number, unit, target));
  };
  report.figures.push_back(all.figure_of_extreme(what + "transforms", "transforms"));
  add("mean acceptance", "acceptance", "", std::nullopt);
  add("surface agreement, mean", "agreement", "", std::nullopt);
  add("acceptance short of the true pose's own, mean", "short_of_truth", "", Target{.most = 0.0003});
  report.figures.push_back(all.figure_of_extreme(what + "acceptance short of the true pose's own, worst",
                                                 "most_short_of_truth", "", Target{.most = 0.001}));
  add("off, mean", "off_cells", "cells", Target{.most = 0.1});
  add("off, 99 % within", "off_cells_p99", "cells", std::nullopt);
  add("off in heading, mean", "turn_error_deg", "deg", std::nullopt);
  add("refused", "refused", "", std::nullopt);
  report.figures.push_back({what + "wrong and not refused, of 10 000",
                            1e4 * all.number("wrong_not_refused") / all.number("transforms"), "", Target{.most = 1.0},
                            "", Certainty{.runs = all.runs().size()}});
  add("CPU time, mean", "mean_ms", "ms", Target{.most = most_ms});
  add("CPU time, 99 % within", "p99_ms", "ms", std::nullopt);
}

std::vector<std::string> places_in(const std::vector<Outcome>& outcomes) {
  std::vector<std::string> places;
  for (const Outcome& outcome : outcomes) {
    const std::string& place = outcome.label("place");
    if (std::find(places.begin(), places.end(), place) == places.end()) places.push_back(place);
  }
  return places;
}

Report report_of(const std::vector<Outcome>& outcomes) {
  Report report;
  add_figures(report, outcomes, "with", 3.0);
  add_figures(report, outcomes, "without", 25.0);
  TextTable table{"By place",
                  {"prior", "place", "transforms", "mean acceptance", "true pose's own", "short, mean", "short, worst",
                   "off, cells", "p99", "off, deg", "refused", "wrong, not refused", "CPU ms", "p99 ms"},
                  {}};
  Chart chart{"Acceptance short of the true pose's own", "share of the merges", "short of it", {}};
  for (const std::string prior : {"with", "without"}) {
    for (const std::string& place : places_in(outcomes)) {
      const ScanTable merges = merges_of(outcomes, {{"prior", prior}, {"place", place}});
      if (merges.rows() == 0) continue;
      const Outcome all = together(merges);
      std::vector<std::string> row{prior, place};
      for (const char* number :
           {"transforms", "acceptance", "true_acceptance", "short_of_truth", "most_short_of_truth", "off_cells",
            "off_cells_p99", "turn_error_deg", "refused", "wrong_not_refused", "mean_ms", "p99_ms"}) {
        row.push_back(text_of(all.number(number)));
      }
      table.rows.push_back(std::move(row));
      const std::vector<double> shortfall = shortfalls(merges);
      Series series{std::string{place}.append(", ").append(prior), {}};
      for (int percent = 1; percent <= 99; ++percent)
        series.points.emplace_back(0.01 * percent, quantile(shortfall, 0.01 * percent));
      chart.series.push_back(std::move(series));
    }
  }
  report.tables.push_back(std::move(table));
  report.charts.push_back(std::move(chart));
  return report;
}

}  // namespace

Experiment merge_experiment() {
  return {.name = "merge",
          .what = "Maps merged with a prior (sigma 0.15 m, 2 deg) and without, two parts that share two thirds",
          .runs = runs_of,
          .report = report_of,
          .times = Experiment::Times::kMachine};
}

}  // namespace deltamap::experiments
