// SPDX-License-Identifier: Apache-2.0
// `faults`: lasers, wheels, mounts and robots that go wrong while the daemon drives, or before it does, in five places
// each. Does the robot bump into anything, and what does it tell?
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "experiments/closed_loop/fault_trial.hpp"
#include "experiments/drive/first_map.hpp"
#include "experiments/registry.hpp"

namespace deltamap::experiments {
namespace {

struct Place {
  const char* name;
  const char* file;
  double max_range_m;
};
constexpr std::array kPlaces{Place{"room", "room.yaml", 32.0}, Place{"hall", "hall.yaml", 32.0},
                             Place{"hall-8m", "hall.yaml", 8.0}, Place{"depot", "depot.yaml", 32.0},
                             Place{"racks", "racks.yaml", 32.0}};

simulation::Scenario scenario_in(const Options& options, const Place& place) {
  simulation::Scenario scenario = *scenario_of(options, place.file);
  scenario.laser.max_range_m = place.max_range_m;
  return scenario;
}

/// The fault begins with the run, or while it drives.
LoopRun run_in(const Options& options, const Place& place, const std::string& fault, bool from_start,
               std::uint64_t seed) {
  FaultTrial trial{.fault = fault, .seed = seed};
  if (options.quick) trial.before_s = 10.0, trial.for_s = 20.0;
  if (from_start) trial.before_s = 0.0;
  daemon::Settings settings;
  settings.localizer = options.localizer;
  settings.mapping = options.mapping;
  return run_of(trial, scenario_in(options, place), settings);
}

Outcome outcome_of_fault(const LoopRun& run) {
  const LoopOutcome loop = outcome_of(run);
  Outcome outcome;
  outcome.numbers = {{"collisions", loop.collisions},
                     {"fastest_m_per_s", loop.fastest_collision_m_per_s},
                     {"driven_before_m", loop.driven_before_m},
                     {"moved_m", loop.moved_m},
                     {"allowed_until_s", loop.stopped_after_s},
                     {"off_m", loop.pose_off_m},
                     {"may_drive_share", loop.may_drive_at_end_share}};
  outcome.labels = {{"reason", std::string(name_of(loop.reason))}, {"told", loop.told}};
  return outcome;
}

std::vector<Run> runs_of(const Options& options) {
  std::vector<Run> runs;
  for (const std::string_view name : kTrialFaults) {
    const std::string fault{name};
    for (const bool from_start : {true, false}) {
      if (options.quick && from_start) continue;
      for (std::size_t i = 0; i < (options.quick ? 1 : kPlaces.size()); ++i) {
        const std::string begins = from_start ? "from-the-start" : "while-driving";
        const std::uint64_t seed = options.seed + runs.size();  // another for each fault and place
        runs.push_back({std::string{fault}.append("-").append(begins).append("-").append(kPlaces[i].name), [=] {
                          Outcome outcome = outcome_of_fault(run_in(options, kPlaces[i], fault, from_start, seed));
                          outcome.labels.insert(outcome.labels.begin(),
                                                {{"fault", fault}, {"begins", begins}, {"place", kPlaces[i].name}});
                          return outcome;
                        }});
      }
    }
  }
  return runs;
}

std::string text(double number) {
  char written[32];
  (void)std::snprintf(written, sizeof written, "%.2f", number);
  return written;
}

/// Of one fault, begun in one way, in all places.
struct FaultSums {
  std::size_t runs = 0;
  double collisions = 0.0;
  double moved_m = 0.0;    ///< most
  double may_drive = 0.0;  ///< most
  std::string reasons;
};

FaultSums sums_of(const std::vector<Outcome>& outcomes, const std::string& fault, const std::string& begins) {
  FaultSums sums;
  for (const Outcome& outcome : outcomes) {
    if (outcome.label("fault") != fault || outcome.label("begins") != begins) continue;
    ++sums.runs;
    sums.collisions += outcome.number("collisions");
    sums.moved_m = std::max(sums.moved_m, outcome.number("moved_m"));
    sums.may_drive = std::max(sums.may_drive, outcome.number("may_drive_share"));
    if (sums.reasons.find(outcome.label("reason")) == std::string::npos)
      sums.reasons += (sums.reasons.empty() ? "" : ", ") + outcome.label("reason");
  }
  return sums;
}

TextTable table_of_faults(const std::vector<Outcome>& outcomes) {
  TextTable table{
      "each fault in five places: most collisions of one, longest way after it began, and reasons at the end",
      {"fault", "begins", "collisions", "moved at most, m", "reasons", "may drive"},
      {}};
  for (const std::string_view name : kTrialFaults) {
    const std::string fault{name};
    for (const std::string begins : {"from-the-start", "while-driving"}) {
      const FaultSums sums = sums_of(outcomes, fault, begins);
      if (sums.runs == 0) continue;
      table.rows.push_back(
          {fault, begins, text(sums.collisions), text(sums.moved_m), sums.reasons, text(sums.may_drive)});
    }
  }
  return table;
}

std::vector<double> numbers(const std::vector<Outcome>& outcomes, const char* name) {
  std::vector<double> values;
  values.reserve(outcomes.size());
  for (const Outcome& outcome : outcomes) values.push_back(outcome.number(name));
  return values;
}

double sum_of(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

Chart chart_of_ways(std::vector<double> ways_m) {
  std::sort(ways_m.begin(), ways_m.end());
  std::vector<std::pair<double, double>> ways;
  ways.reserve(ways_m.size());
  for (const double way_m : ways_m) ways.emplace_back(static_cast<double>(ways.size() + 1), way_m);
  return {"the way of the body after a fault began", "run, from the shortest", "m", {{"way", ways}}};
}

Report report_of(const std::vector<Outcome>& outcomes) {
  const std::vector<double> ways_m = numbers(outcomes, "moved_m");
  const double longest_m = std::accumulate(ways_m.begin(), ways_m.end(), 0.0,
                                           [](double longest, double way) { return std::max(longest, way); });
  const double may_drive = sum_of(numbers(outcomes, "may_drive_share"));
  const Certainty runs{.runs = outcomes.size()};
  Report report;
  report.figures = {{"collisions", sum_of(numbers(outcomes, "collisions")), "", Target{.most = 0.0}, "", runs},
                    {"longest way after a fault", longest_m, "m", {}, "", runs},
                    {"planners are told that they may drive, at the end",
                     may_drive / std::max(1.0, static_cast<double>(outcomes.size())),
                     "",
                     {},
                     "",
                     runs}};
  report.charts.push_back(chart_of_ways(ways_m));
  report.tables.push_back(table_of_faults(outcomes));
  return report;
}

}  // namespace

Experiment faults_experiment() {
  return {"faults",
          "lasers, wheels, mounts and robots that go wrong while the daemon drives: collisions, and what stops it",
          runs_of, report_of};
}

}  // namespace deltamap::experiments
