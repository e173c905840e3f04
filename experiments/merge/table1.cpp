// SPDX-License-Identifier: Apache-2.0
// `table1`: the paper's Table 1 (§3.4.2), MA1 to MA4 on two parts of a hall, turned and shifted: by whole degrees as
// published, and over continuous angles, which do not fall on Hough bins; in the paper's hall and three unlike it.
#include <array>
#include <map>

#include "experiments/merge/merge_layouts.hpp"
#include "experiments/merge/merge_table.hpp"
#include "experiments/registry.hpp"
#include "experiments/report/svg_map.hpp"
#include "mapping/merge/map_merge.hpp"

namespace deltamap::experiments {
namespace {

using mapping::merge::MergeMethod;

struct Method {
  const char* name;
  MergeMethod method;
  double published_acceptance;
  double published_s;  // on a Core 2 of 2.5 GHz
};
constexpr std::array<Method, 4> kMethods{{{"MA1", MergeMethod::kMa1, 0.9977, 0.67},
                                          {"MA2", MergeMethod::kMa2, 0.998, 1.38},
                                          {"MA3", MergeMethod::kMa3, 0.998, 1.99},
                                          {"MA4", MergeMethod::kMa4, 0.998, 2.01}}};
constexpr const char* kPaperHall = "warehouse";

mapping::merge::MapMerge merged(const MergePlace& place, const OccupancyGrid& local, MergeMethod method) {
  mapping::merge::MapMergeParams params;
  params.method = method;
  return map_merge(place.map, local, params);
}

/// The same seed gives every method the same transforms.
Outcome merge_often(const std::string& layout, std::uint64_t seed, bool whole, const Method& method, int transforms) {
  const MergePlace place = drawn_place(layout, seed);
  Random random{seed};
  Outcome outcome;
  outcome.scans = empty_merge_table();
  for (int i = 0; i < transforms; ++i) {
    const LocalMap local = turned_local(place, whole, random);
    mapping::merge::MapMerge merge;
    const double taken_ms = cpu_ms([&] { merge = merged(place, local.grid, method.method); });
    add_merge(outcome.scans, degrees(local.local_from_other.theta), measured(place, local, merge.map_from_local),
              !merge.accepted(), taken_ms);
  }
  outcome.labels = {{"place", layout},
                    {"angles", whole ? "whole" : "continuous"},
                    {"method", method.name},
                    {"seed", std::to_string(seed)}};
  outcome.numbers = merge_numbers(outcome.scans);
  return outcome;
}

std::vector<Run> runs_of(const Options& options) {
  const int transforms = options.repeats.value_or(options.quick ? 10 : 100);
  const int seeds = options.quick || options.repeats ? 1 : 2;
  std::vector<Run> runs;
  for (const MergeLayout& layout : merge_layouts()) {
    for (const bool whole : {true, false}) {
      for (const Method& method : kMethods) {
        for (int i = 0; i < seeds; ++i) {
          const std::uint64_t seed = 1000 * options.seed + static_cast<std::uint64_t>(i);
          runs.push_back(
              {layout.name + (whole ? "-whole-" : "-continuous-") + method.name + "-seed" + std::to_string(seed),
               [=] { return merge_often(layout.name, seed, whole, method, transforms); }});
        }
      }
    }
  }
  return runs;
}

/// Mean acceptance by parts: `part_of` answers which one a turn in degrees lies in, `place_of` where it is drawn.
template <typename PartOf, typename PlaceOf>
Series mean_acceptance_by(const ScanTable& merges, const std::string& name, PartOf&& part_of, PlaceOf&& place_of) {
  std::map<int, std::vector<double>> parts;
  for (std::size_t row = 0; row < merges.rows(); ++row) {
    const double turn_deg = merges.at(row, merges.index_of("true_turn_deg"));
    parts[part_of(turn_deg)].push_back(merges.at(row, merges.index_of("acceptance")));
  }
  Series series{name, {}};
  for (const auto& [part, values] : parts) series.points.emplace_back(place_of(part), mean_of(values));
  return series;
}

/// By what whole degrees leave over of the turn.
Series by_rest_of_a_degree(const ScanTable& merges, const std::string& name) {
  constexpr int kParts = 10;
  const auto part_of = [](double turn_deg) {
    return std::min(kParts - 1, static_cast<int>(kParts * (turn_deg - std::floor(turn_deg))));
  };
  return mean_acceptance_by(merges, name, part_of, [](int part) { return (part + 0.5) / kParts; });
}

/// By tens of degrees.
Series by_turn(const ScanTable& merges, const std::string& name) {
  constexpr double kPart_deg = 10.0;
  const auto part_of = [](double turn_deg) { return static_cast<int>(std::floor((turn_deg + 180.0) / kPart_deg)); };
  return mean_acceptance_by(merges, name, part_of, [](int part) { return (part + 0.5) * kPart_deg; });
}

void add_targets(Report& report, const std::vector<Outcome>& outcomes) {
  const PooledRuns hall = pooled_merges(outcomes, {{"place", kPaperHall}, {"angles", "continuous"}, {"method", "MA1"}});
  const PooledRuns all = pooled_merges(outcomes, {{"angles", "continuous"}, {"method", "MA1"}});
  const std::string in_hall = "MA1, the paper's hall, continuous angles: ";
  const std::string in_all = "MA1, all four layouts, continuous angles: ";
  if (!hall.empty()) {
    report.figures = {
        hall.figure(in_hall + "mean acceptance", "acceptance", "", Target{.least = 0.992},
                    "paper 0.9977, whole degrees"),
        hall.figure(in_hall + "pose right", "right", "", Target{.least = 0.96}),
        hall.figure(in_hall + "mean CPU time", "mean_ms", "ms", Target{.most = 50.0}, "paper 670 ms, 2.5 GHz Core 2")};
  }
  if (all.empty()) return;  // not asked for
  report.figures.push_back(all.figure(in_all + "pose right", "right", "", Target{.least = 0.96}));
  report.figures.push_back(all.figure(in_all + "mean acceptance", "acceptance"));
  report.figures.push_back(all.figure(in_all + "mean acceptance of the true pose", "true_acceptance"));
  report.figures.push_back(all.figure(in_all + "mean CPU time", "mean_ms", "ms", Target{.most = 50.0}));
  report.figures.push_back(all.figure_of_extreme(in_all + "wrong and not refused", "wrong_not_refused"));
}

std::vector<std::string> table_row(const std::vector<Outcome>& outcomes, const std::string& place,
                                   const std::string& angles, const Method& method) {
  const ScanTable merges = merges_of(outcomes, {{"place", place}, {"angles", angles}, {"method", method.name}});
  if (merges.rows() == 0) return {};
  const Outcome all = together(merges);
  const auto of = [&](const char* number) { return text_of(all.number(number)); };
  const bool is_published = place == kPaperHall;
  return {place,
          angles,
          method.name,
          of("transforms"),
          of("acceptance"),
          of("least_acceptance"),
          of("true_acceptance"),
          is_published ? text_of(method.published_acceptance) : "",
          of("right"),
          of("refused"),
          of("wrong_not_refused"),
          of("off_cells"),
          of("turn_error_deg"),
          of("mean_ms"),
          of("p99_ms"),
          is_published ? text_of(1e3 * method.published_s) : ""};
}

void add_pictures(Report& report, const std::vector<Outcome>& outcomes) {
  for (const MergeLayout& layout : merge_layouts()) {
    const ScanTable merges = merges_of(outcomes, {{"place", layout.name}, {"angles", "continuous"}, {"method", "MA1"}});
    if (merges.rows() == 0) continue;
    const auto run = std::find_if(outcomes.begin(), outcomes.end(), [&](const Outcome& outcome) {
      return outcome.label("place") == layout.name && outcome.label("angles") == "continuous";
    });
    const std::uint64_t seed = std::stoull(run->label("seed"));
    const MergePlace place = drawn_place(layout.name, seed);
    Random random{seed};
    const LocalMap local = turned_local(place, false, random);
    const mapping::merge::MapMerge merge = merged(place, local.grid, MergeMethod::kMa1);
    report.pictures.push_back({layout.name + ": the map, and the local map's contour where MA1 lays it",
                               svg_of_merge(place.map, local.grid, merge.map_from_local)});
  }
}

Report report_of(const std::vector<Outcome>& outcomes) {
  Report report;
  TextTable table{"Merges without a prior",
                  {"place", "angles", "method", "transforms", "mean acceptance", "worst", "true pose's own", "paper",
                   "right", "refused", "wrong, not refused", "off, cells", "off, deg", "CPU ms", "p99 ms", "paper ms"},
                  {}};
  Chart rests{"Acceptance by what whole degrees leave over, all layouts",
              "turn less its whole degrees, deg",
              "mean acceptance",
              {}};
  Chart turns{"Acceptance in the paper's hall by turn", "turn, deg", "mean acceptance", {}};
  for (const MergeLayout& layout : merge_layouts()) {
    for (const char* angles : {"whole", "continuous"}) {
      for (const Method& method : kMethods) {
        const auto row = table_row(outcomes, layout.name, angles, method);
        if (!row.empty()) table.rows.push_back(row);
      }
    }
  }
  for (const Method& method : kMethods) {
    rests.series.push_back(
        by_rest_of_a_degree(merges_of(outcomes, {{"angles", "continuous"}, {"method", method.name}}), method.name));
    turns.series.push_back(by_turn(
        merges_of(outcomes, {{"place", kPaperHall}, {"angles", "continuous"}, {"method", method.name}}), method.name));
  }
  add_targets(report, outcomes);
  report.tables.push_back(std::move(table));
  report.charts = {std::move(rests), std::move(turns)};
  add_pictures(report, outcomes);
  return report;
}

}  // namespace

Experiment table1_experiment() {
  return {.name = "table1",
          .what = "Table 1 of the paper: maps merged without a prior by MA1 to MA4, two parts that share two thirds",
          .runs = runs_of,
          .report = report_of,
          .times = Experiment::Times::kMachine};
}

}  // namespace deltamap::experiments
