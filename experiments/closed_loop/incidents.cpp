// SPDX-License-Identifier: Apache-2.0
// `incidents`: what a daemon keeps of drives in which something goes wrong, and whether replays meet the same.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>

#include "experiments/closed_loop/incident_trial.hpp"
#include "experiments/drive/first_map.hpp"
#include "experiments/pooled_runs.hpp"
#include "experiments/registry.hpp"
#include "experiments/seed_summary.hpp"

namespace deltamap::experiments {
namespace {

constexpr std::array<const char*, 4> kIncidentPlaces{"room", "hall", "depot", "racks"};
constexpr int kIncidentSeeds = 4;  // 240 drives
constexpr double kSoonS = 2.0;
constexpr double kYoungS = 1e9;  // of runs that are kept from their beginning alone

std::string joined_kinds(const std::vector<TriedIncident>& all) {
  std::string kinds;
  for (const TriedIncident& one : all) {
    for (const daemon::IncidentEvent& event : one.incident.events) {
      const std::string name{name_of(event.kind)};
      if (kinds.find(name) == std::string::npos) kinds += (kinds.empty() ? "" : ", ") + name;
    }
  }
  return kinds;
}

Outcome outcome_of_incidents(const std::vector<TriedIncident>& all) {
  double losses = 0.0;
  double met = 0.0;
  double soon = 0.0;
  double least_before_s = kYoungS;
  double bytes = 0.0;
  for (const TriedIncident& one : all) {
    losses += one.has_loss ? 1.0 : 0.0;
    met += one.met_again ? 1.0 : 0.0;
    soon += one.met_again && std::abs(one.late_s) <= kSoonS ? 1.0 : 0.0;
    if (one.incident.begins_in_mid_run) least_before_s = std::min(least_before_s, one.before_s);
    bytes = std::max(bytes, one.bytes);
  }
  Outcome outcome;
  outcome.labels = {{"kinds", joined_kinds(all)}};
  outcome.numbers = {{"incidents", static_cast<double>(all.size())},
                     {"losses", losses},
                     {"met_again", met},
                     {"met_within_2_s", soon},
                     {"least_before_s", least_before_s},
                     {"largest_mb_on_disk", 1e-6 * bytes}};
  return outcome;
}

std::vector<Run> runs_of_incidents(const Options& options) {
  std::vector<Run> runs;
  for (const std::string_view name : kIncidentCauses) {
    for (const char* place : kIncidentPlaces) {
      if (options.quick && place != kIncidentPlaces.front()) continue;
      for (const std::uint64_t seed : options.seeds(kIncidentSeeds)) {
        const std::string cause{name};
        runs.push_back({cause + "-" + place + "-" + std::to_string(seed), [=] {
                          daemon::Settings settings;
                          settings.localizer = options.localizer;
                          settings.mapping = options.mapping;
                          const auto scenario = *scenario_of(options, std::string(place) + ".yaml");
                          Outcome outcome =
                              outcome_of_incidents(incidents_of({.cause = cause, .seed = seed}, scenario, settings));
                          outcome.labels.insert(outcome.labels.begin(), {{"cause", cause}, {"place", place}});
                          return outcome;
                        }});
      }
    }
  }
  return runs;
}

double sum(const std::vector<Outcome>& outcomes, const char* name) {
  double total = 0.0;
  for (const Outcome& outcome : outcomes) total += outcome.number(name);
  return total;
}

std::string whole(double number) { return std::to_string(std::lround(number)); }

TextTable table_of_causes(const std::vector<Outcome>& outcomes) {
  TextTable table{"what befell the robot after 150 s, and what was kept",
                  {"cause", "drives", "with an incident", "kinds", "losses", "met again", "within 2 s"},
                  {}};
  for (const std::string_view cause : kIncidentCauses) {
    std::vector<Outcome> of_cause;
    std::map<std::string, int> kinds;
    int kept = 0;
    for (const Outcome& outcome : outcomes) {
      if (outcome.label("cause") != cause) continue;
      of_cause.push_back(outcome);
      kept += outcome.number("incidents") > 0.0 ? 1 : 0;
      ++kinds[outcome.label("kinds").empty() ? "none" : outcome.label("kinds")];
    }
    if (of_cause.empty()) continue;
    std::string words;
    for (const auto& [kind, count] : kinds) words += (words.empty() ? "" : "; ") + std::to_string(count) + " " + kind;
    table.rows.push_back({std::string(cause), std::to_string(of_cause.size()), std::to_string(kept), words,
                          whole(sum(of_cause, "losses")), whole(sum(of_cause, "met_again")),
                          whole(sum(of_cause, "met_within_2_s"))});
  }
  return table;
}

Report report_of_incidents(const std::vector<Outcome>& outcomes) {
  const std::vector<const Outcome*> all = runs_with(outcomes, {});
  double least_before_s = kYoungS;
  for (const Outcome& outcome : outcomes) least_before_s = std::min(least_before_s, outcome.number("least_before_s"));
  Report report;
  report.figures = {
      ratio_of_runs("losses that a replay meets within 2 s", all, {"met_within_2_s", "losses"}, Target{.least = 0.95}),
      sum_of_runs("losses", all, "losses"),
      {"kept before the first event, least", least_before_s, "s", Target{.least = 120.0}, "ros2_medkit: 5",
       Certainty{.runs = outcomes.size()}},
      most_of_runs("largest incident", all, "largest_mb_on_disk", {}, "MB")};
  report.charts.push_back(chart_in_order("largest incident of a drive, MB", "largest_mb_on_disk", outcomes));
  report.tables.push_back(table_of_causes(outcomes));
  return report;
}

}  // namespace

Experiment incidents_experiment() {
  return {"incidents", "what a daemon keeps of bad moments, and whether replays meet the same losses",
          runs_of_incidents, report_of_incidents};
}

}  // namespace deltamap::experiments
