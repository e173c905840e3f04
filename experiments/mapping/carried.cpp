// SPDX-License-Identifier: Apache-2.0
// `carried`: robots that somebody carries elsewhere 1 to 30 s after their start, while nothing is known yet of how
// their scans usually fit. Is anything wrong in the map a minute after a stop and a start?
#include <array>

#include "core/random.hpp"
#include "experiments/drive/first_map.hpp"
#include "experiments/mapping/carried_run.hpp"
#include "experiments/registry.hpp"
#include "experiments/watch/mapping_run.hpp"

namespace deltamap::experiments {
namespace {

constexpr std::array kPlaces{"room", "hall", "depot"};  // no glass: that is freed by whoever looks through it
constexpr std::array kStops{"kept", "given", "none"};   // the pose at the second start, or no stop at all
constexpr std::array kSummed{"revisions",   "withdrawn",      "walls_wrong_at_stop",
                             "walls_wrong", "ghosts_at_stop", "ghosts"};
constexpr double kSoonest_s = 1.0;
constexpr double kLatest_s = 30.0;
constexpr double kStopSoonest_s = 5.0;
constexpr double kStopLatest_s = 60.0;

std::vector<Run> runs_of(const Options& options) {
  std::vector<Run> runs;
  for (const std::string place : kPlaces) {
    const auto scenario = scenario_of(options, place + ".yaml");
    for (const std::string stop : kStops) {
      for (const std::uint64_t seed : options.seeds(20)) {
        CarriedRun run{*scenario, settings_of(options, "evidence"), seed};
        Random random{seed};
        run.carried_after_s = random.uniform(kSoonest_s, kLatest_s);
        run.stopped_after_s = random.uniform(kStopSoonest_s, kStopLatest_s);
        run.restarts = stop != "none";
        run.is_given_again = stop == "given";
        const std::string name = std::string(place).append("-").append(stop).append("-seed") + std::to_string(seed);
        runs.push_back({name, [=] {
                          Outcome outcome = outcome_of(run);
                          outcome.labels = {{"place", place}, {"stop", stop}, {"seed", std::to_string(seed)}};
                          return outcome;
                        }});
      }
    }
  }
  return runs;
}

/// Of all robots of one place and one kind of stop.
struct Sums {
  std::size_t robots = 0;
  std::array<double, kSummed.size()> of{};  ///< kSummed
};

Sums sums_of(const std::vector<Outcome>& outcomes, const std::string& place, const std::string& stop) {
  Sums sums;
  for (const Outcome& outcome : outcomes) {
    if (outcome.label("place") != place || outcome.label("stop") != stop) continue;
    ++sums.robots;
    for (std::size_t column = 0; column < kSummed.size(); ++column) sums.of[column] += outcome.number(kSummed[column]);
  }
  return sums;
}

Chart chart_of_robots(const std::vector<Outcome>& outcomes) {
  std::vector<std::pair<double, double>> course;
  course.reserve(outcomes.size());
  for (const Outcome& outcome : outcomes) {
    course.emplace_back(static_cast<double>(course.size() + 1), outcome.number("walls_wrong"));
  }
  return {"wall cells wrong a minute after the start", "robot", "cells", {{"robots", course}}};
}

Report report_of(const std::vector<Outcome>& outcomes) {
  Report report;
  TextTable table{"By place and pose at the second start, all seeds",
                  {"place", "pose", "robots", "revisions", "withdrawn", "wall cells wrong at the stop",
                   "a minute after the start", "ghost cells at the stop", "a minute after the start"},
                  {}};
  for (const std::string stop : kStops) {
    double wrong = 0.0;
    double ghosts = 0.0;
    std::size_t robots = 0;
    for (const std::string place : kPlaces) {
      const Sums sums = sums_of(outcomes, place, stop);
      if (sums.robots == 0) continue;
      std::vector<std::string> row{place, stop, std::to_string(sums.robots)};
      for (const double sum : sums.of) row.push_back(text_of(sum));
      table.rows.push_back(std::move(row));
      wrong += sums.of[3];
      ghosts += sums.of[5];
      robots += sums.robots;
    }
    if (robots == 0) continue;
    report.figures.push_back(
        {stop + ": wall cells wrong", wrong, "", Target{.most = 0.0}, "", Certainty{.runs = robots}});
    report.figures.push_back({stop + ": ghost cells", ghosts, "", {}, "", Certainty{.runs = robots}});
  }
  report.charts.push_back(chart_of_robots(outcomes));
  report.tables.push_back(std::move(table));
  return report;
}

}  // namespace

Experiment carried_experiment() {
  return {"carried", "robots carried right after their start, stopped and started: does their map stay right?", runs_of,
          report_of};
}

}  // namespace deltamap::experiments
