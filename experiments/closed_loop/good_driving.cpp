// SPDX-License-Identifier: Apache-2.0
// `good-driving`: hours in which nothing goes wrong on order. How often does the robot stand all the same, although its
// pose is right?
#include <array>
#include <set>

#include "experiments/closed_loop/loop_run.hpp"
#include "experiments/drive/first_map.hpp"
#include "experiments/registry.hpp"

namespace deltamap::experiments {
namespace {

constexpr double kDriveMinutes = 15.0;
constexpr int kDrivesAPlace = 8;

struct Place {
  const char* name;
  const char* file;
  double max_range_m;
  const char* variant = "180/1";
};
/// Wide halls seen by 8 m of laser, aisles, people, a map that is out of date, the laser as delivered, and a corridor
/// with a wall of glass: 20 hours in all.
constexpr std::array kPlaces{Place{"hall", "hall.yaml", 32.0},
                             Place{"hall-8m", "hall.yaml", 8.0},
                             Place{"people", "demo.yaml", 32.0},
                             Place{"people-8m", "demo.yaml", 8.0},
                             Place{"depot", "depot.yaml", 32.0},
                             Place{"depot-8m", "depot.yaml", 8.0},
                             Place{"racks", "racks.yaml", 32.0},
                             Place{"changed", "changed.yaml", 32.0},
                             Place{"hall-half-degrees", "hall.yaml", 32.0, "180/0.5"},
                             Place{"glass-corridor", "glass_corridor.yaml", 32.0}};

LoopRun run_of(const Options& options, const Place& place, std::uint64_t seed) {
  LoopRun run;
  run.scenario = *scenario_of(options, place.file);
  run.scenario.laser.max_range_m = place.max_range_m;
  run.settings = fitting(run.scenario);
  run.settings.laser.session.variant = *drivers::lms200::variant_named(place.variant);
  run.settings.localizer = options.localizer;
  run.settings.mapping = options.mapping;
  run.seed = seed;
  run.for_s = 60.0 * options.minutes.value_or(options.quick ? 1.0 : kDriveMinutes);
  return run;
}

std::vector<Run> runs_of(const Options& options) {
  std::vector<Run> runs;
  for (const Place& place : kPlaces) {
    for (const std::uint64_t seed : options.seeds(kDrivesAPlace)) {
      runs.push_back({std::string(place.name) + "-seed" + std::to_string(seed), [=] {
                        const LoopRun run = run_of(options, place, seed);
                        const LoopOutcome loop = outcome_of(run);
                        Outcome outcome;
                        outcome.labels = {{"place", place.name}, {"seed", std::to_string(seed)}};
                        int stops = 0;
                        std::string why;
                        for (const auto& [reason, count] : loop.stops) {
                          stops += count;
                          why += (why.empty() ? "" : ", ") + std::to_string(count) + " " + reason;
                        }
                        outcome.labels.emplace_back("why", why);
                        outcome.labels.emplace_back("end", std::string(name_of(loop.reason)));
                        outcome.numbers = {{"hours", run.for_s / 3600.0},
                                           {"stops", stops},
                                           {"moved_m", loop.moved_m},
                                           {"collisions", loop.collisions},
                                           {"off_m", loop.pose_off_m}};
                        return outcome;
                      }});
    }
  }
  return runs;
}

Report report_of(const std::vector<Outcome>& outcomes) {
  Report report;
  TextTable table{"stops without a fault on order while the pose was within 0.3 m of the truth",
                  {"place", "seed", "why", "at the end"},
                  {}};
  double hours = 0.0;
  double stops = 0.0;
  double collisions = 0.0;
  double moved_m = 0.0;
  std::vector<std::pair<double, double>> course;
  for (const Outcome& outcome : outcomes) {
    hours += outcome.number("hours");
    stops += outcome.number("stops");
    collisions += outcome.number("collisions");
    moved_m += outcome.number("moved_m");
    course.emplace_back(static_cast<double>(course.size() + 1), outcome.number("stops"));
    if (outcome.number("stops") > 0.0)
      table.rows.push_back({outcome.label("place"), outcome.label("seed"), outcome.label("why"), outcome.label("end")});
  }
  const Certainty runs{.runs = outcomes.size()};
  report.figures = {{"stops without a fault (180/1, 180/0.5 in the hall, a corridor of glass)", stops, "",
                     Target{.most = 1.0}, "", runs},
                    {"collisions with what stands", collisions, "", {}, "", runs},
                    {"driven", hours, "h", {}, "", runs},
                    {"way", moved_m / 1000.0, "km", {}, "", runs}};
  report.charts.push_back({"stops without a fault", "drive", "stops", {{"stops", course}}});
  report.tables.push_back(std::move(table));
  return report;
}

}  // namespace

Experiment good_driving_experiment() {
  return {"good-driving",
          "hours in which nothing goes wrong: how often does the robot stand although its pose is right?", runs_of,
          report_of};
}

}  // namespace deltamap::experiments
