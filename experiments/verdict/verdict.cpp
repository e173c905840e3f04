// SPDX-License-Identifier: Apache-2.0
// `verdict`: does the robot know whether it is lost or the map is out of date? In the paper's hall, whose four-fold
// symmetry leaves a carried robot no way to know, and in a depot where every place is its own.
#include <algorithm>
#include <array>
#include <cmath>

#include "experiments/drive/first_map.hpp"
#include "experiments/registry.hpp"
#include "experiments/verdict/verdict_report.hpp"
#include "experiments/verdict/verdict_run.hpp"
#include "experiments/verdict/verdict_score.hpp"

namespace deltamap::experiments {
namespace {

struct Place {
  std::string name;
  VerdictPlace place;
  std::array<std::shared_ptr<LivedIn>, kVerdictRanges_m.size()> lived_in;
};

std::shared_ptr<const Place> place_of(const std::string& name, const Options& options) {
  auto made = std::make_shared<Place>();
  made->name = name;
  VerdictPlace& place = made->place;
  place.scenario = simulation::read_scenario(options.scenarios / (name + ".yaml"));
  place.people = place.scenario.people.empty() ? walkers() : std::vector<simulation::PersonParams>{};
  place.map = first_map(place.scenario);
  place.oracle = std::make_shared<const AmbiguityOracle>(*place.map, AmbiguityParams{});
  place.localizer = options.localizer;
  LivedInParams lived_in;
  lived_in.seed = options.seed;
  lived_in.minutes = options.minutes.value_or(options.quick ? 15.0 : 60.0);
  for (std::size_t i = 0; i < kVerdictRanges_m.size(); ++i) {
    lived_in.max_range_m = kVerdictRanges_m[i];
    made->lived_in[i] = std::make_shared<LivedIn>(place.scenario, place.people, place.localizer, place.map, lived_in);
  }
  return made;
}

Outcome outcome_of(const Place& place, const VerdictRun& run, std::size_t range) {
  Outcome outcome;
  VerdictScans seen = verdict_scans(place.place, place.lived_in[range]->stability(), run);
  outcome.scans = std::move(seen.scans);
  outcome.labels = {{"place", place.name},
                    {"event", std::string{name_of(run.event)}},
                    {"changed", text_of(run.changed_share)},
                    {"range_m", text_of(run.max_range_m)},
                    {"seed", std::to_string(run.seed)}};
  outcome.numbers = verdict_numbers(outcome.scans);
  const std::vector<std::pair<std::string, double>> more{
      {"ambiguous", seen.path.ambiguous ? 1.0 : 0.0},
      {"oracle_log_odds", seen.path.log_odds},
      {"oracle_pieces", seen.path.pieces},
      {"oracle_unexplained", seen.path.unexplained},
      {"oracle_changed_at_once", seen.path.changed_at_once},
      {"oracle_judged", static_cast<double>(seen.path.judged_poses)},
      {"rival_x_m", seen.path.map_from_rival.x},
      {"rival_y_m", seen.path.map_from_rival.y},
      {"rival_theta_rad", seen.path.map_from_rival.theta},
      {"unique_after_s", seen.unique_after_s},
      {"proven_tiles", static_cast<double>(place.lived_in[range]->proven_tiles())}};
  outcome.numbers.insert(outcome.numbers.end(), more.begin(), more.end());
  return outcome;
}

std::vector<Run> runs_of(const Options& options) {
  const int repeats = options.repeats.value_or(options.quick ? 5 : 50);
  std::vector<Run> runs;
  for (const std::string name : {"hall", "depot"}) {
    const auto place = place_of(name, options);
    for (const PoseEvent event : kPoseEvents) {
      for (const double changed : kVerdictChangedShares) {
        for (int i = 0; i < repeats; ++i) {
          const std::size_t range = static_cast<std::size_t>(i) % kVerdictRanges_m.size();
          VerdictRun run;
          run.seed = options.seed + 1000 + runs.size();  // each begins elsewhere
          run.event = event;
          run.changed_share = changed;
          run.max_range_m = kVerdictRanges_m[range];
          if (options.minutes) run.before_s = std::min(run.before_s, 60.0 * *options.minutes / 7.0);
          if (options.minutes) run.after_driving_s = std::min(run.after_driving_s, 6.0 * run.before_s);
          runs.push_back({name + "-" + std::string{name_of(event)} + "-changed" + text_of(100.0 * changed) + "-" +
                              std::to_string(i),
                          [=] { return outcome_of(*place, run, range); }});
        }
      }
    }
  }
  return runs;
}

}  // namespace

Experiment verdict_experiment() {
  return {
      .name = "verdict",
      .what =
          "Lost, or the map out of date? Poses right, a bay off, slipped and elsewhere, in halls that changed and did "
          "not",
      .runs = runs_of,
      .report = verdict_report};
}

}  // namespace deltamap::experiments
