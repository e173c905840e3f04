// SPDX-License-Identifier: Apache-2.0
// `gate`: is anything written into the map while the robot is not where it believes to be, does it stay there, and how
// long is nothing written although all is well?
#include <algorithm>
#include <array>
#include <cmath>

#include "experiments/drive/first_map.hpp"
#include "experiments/mapping/gate_run.hpp"
#include "experiments/registry.hpp"
#include "experiments/watch/mapping_run.hpp"

namespace deltamap::experiments {
namespace {

constexpr std::array kPlaces{"hall", "depot", "changed"};
constexpr std::array kGates{"gated", "open"};

std::vector<Run> runs_of(const Options& options) {
  std::vector<Run> runs;
  for (const std::string place : kPlaces) {
    const auto scenario = scenario_of(options, place + ".yaml");
    for (const PoseEvent event : kPoseEvents) {
      for (const std::string gate : kGates) {
        for (const std::uint64_t seed : options.seeds(5)) {
          const std::string what{name_of(event)};
          GateRun run{*scenario, settings_of(options, "evidence"), event, seed};
          run.settings.mapping.store_scan.gate.enabled = gate == "gated";
          if (options.quick) run.before_s = run.after_s = 30.0;
          if (options.minutes) {
            run.after_s = 60.0 * *options.minutes;
            run.before_s = std::min(run.before_s, run.after_s);
          }
          runs.push_back(
              {place + "-" + what + "-" + gate + "-seed" + std::to_string(seed), [=] {
                 Outcome outcome = outcome_of(run);
                 outcome.labels = {{"place", place}, {"event", what}, {"gate", gate}, {"seed", std::to_string(seed)}};
                 return outcome;
               }});
        }
      }
    }
  }
  return runs;
}

/// The runs of one kind; an empty word stands for all.
class Kind {
 public:
  Kind(const std::vector<Outcome>& outcomes, const std::string& place, const std::string& event,
       const std::string& gate) {
    for (const Outcome& outcome : outcomes) {
      const auto fits = [&](const char* label, const std::string& wanted) {
        return wanted.empty() || outcome.label(label) == wanted;
      };
      if (fits("place", place) && fits("event", event) && fits("gate", gate)) chosen_.push_back(&outcome);
    }
  }
  [[nodiscard]] bool empty() const { return chosen_.empty(); }
  [[nodiscard]] double sum(const std::string& number) const {
    double sum = 0.0;
    for (const Outcome* outcome : chosen_) sum += outcome->number(number);
    return sum;
  }
  [[nodiscard]] double mean(const std::string& number) const {
    return sum(number) / static_cast<double>(chosen_.size());
  }
  [[nodiscard]] const std::vector<const Outcome*>& outcomes() const { return chosen_; }
  /// Of all runs together: without an interval.
  [[nodiscard]] Figure sum_figure(const std::string& name, const std::string& number,
                                  const std::optional<Target>& target = {}) const {
    return {name, sum(number), "", target, "", Certainty{.runs = chosen_.size()}};
  }
  [[nodiscard]] Figure mean_figure(const std::string& name, const std::string& number,
                                   const std::optional<Target>& target = {}) const {
    std::vector<double> values;
    for (const Outcome* outcome : chosen_) values.push_back(outcome->number(number));
    return {name, mean_of(values), "", target, "", certainty_of_mean(values)};
  }

 private:
  std::vector<const Outcome*> chosen_;
};

/// Of the sum over one kind's runs by that over another's, seed by seed.
Certainty certainty_of_ratio(const Kind& kind, const Kind& other, const std::string& number) {
  if (kind.outcomes().size() != other.outcomes().size()) return {.runs = kind.outcomes().size()};
  const auto ratio = [&](const std::vector<std::size_t>& drawn) {
    double above = 0.0;
    double below = 0.0;
    for (const std::size_t run : drawn) {
      above += kind.outcomes()[run]->number(number);
      below += other.outcomes()[run]->number(number);
    }
    return std::vector<double>{above / below};
  };
  return certainties_of_runs(kind.outcomes().size(), ratio).front();
}

/// Why it was shut, the longest first left to the reader: every reason that was.
std::vector<std::vector<std::string>> reasons_of(const Kind& kind, const std::string& where, const std::string& when) {
  std::vector<std::vector<std::string>> rows;
  for (std::size_t i = 1; i < mapping::gate::kGateReasons; ++i) {
    const std::string reason{name_of(static_cast<mapping::gate::GateReason>(i))};
    const double share = kind.mean("shut_" + when + "_" + reason);
    if (share > 0.0)
      rows.push_back({where, when == "before" ? "all is well" : "after the event", reason, text_of(share)});
  }
  return rows;
}

Chart course_of(const Kind& kind, const std::string& title) {
  Chart chart{title, "time, s", "error of the pose, m (at most 1)", {}};
  for (const Outcome* outcome : kind.outcomes()) {
    Series series{"seed " + outcome->label("seed"), {}};
    const std::vector<double> time_s = outcome->scans.column("t_s");
    const std::vector<double> error_m = outcome->scans.column("error_m");
    for (std::size_t i = 0; i < time_s.size(); i += 10)
      series.points.emplace_back(time_s[i], std::min(1.0, error_m[i]));
    chart.series.push_back(std::move(series));
  }
  return chart;
}

std::vector<std::string> row_of(const Kind& kind, const std::string& place, const std::string& event,
                                const std::string& gate) {
  std::vector<std::string> row{place, event, gate};
  for (const char* number : {"revisions", "cells", "cells_astray", "cells_astray_that_stood", "revisions_withdrawn",
                             "sets_refused_in_doubt", "wrong_s", "wrong_and_open_s"}) {
    row.push_back(text_of(kind.sum(number)));
  }
  row.push_back(text_of(kind.mean("shut_after")));
  return row;
}

/// What is written where it should not be, with the gate and without it.
void add_astray(Report& report, const std::string& place, const Kind& gated, const Kind& open) {
  const auto add_sum = [&](const Kind& kind, const std::string& what, const char* number,
                           const std::optional<Target>& target = {}) {
    report.figures.push_back(kind.sum_figure(std::string{place}.append(": ").append(what), number, target));
  };
  const std::string astray = "cells written while the pose was off by more than 0.3 m";
  const std::string stood = "cells written while off by more than 0.3 m that are there 60 s later";
  add_sum(gated, astray, "cells_astray", Target{.most = 0.0});
  add_sum(gated, stood, "cells_astray_that_stood", Target{.most = 0.0});
  add_sum(gated, "cells drawn from scans taken so far off", "cells_drawn_astray", Target{.most = 0.0});
  add_sum(open, astray + ", without the gate", "cells_astray");
  add_sum(open, stood + ", without the gate", "cells_astray_that_stood");
}

/// What the gate holds up while all is well.
void add_held_up(Report& report, const std::vector<Outcome>& outcomes, const std::string& place) {
  const std::string nothing{name_of(PoseEvent::kNothing)};
  const Kind gated{outcomes, place, nothing, "gated"};
  if (gated.empty()) return;
  const Kind open{outcomes, place, nothing, "open"};
  report.figures.push_back(gated.mean_figure(place + ": share of the time shut while nothing befalls the robot",
                                             "shut_after", Target{.most = 0.02}));
  if (open.empty()) return;
  report.figures.push_back({place + ": cells written while nothing befalls it, of those without the gate",
                            gated.sum("cells") / open.sum("cells"),
                            "",
                            {},
                            "",
                            certainty_of_ratio(gated, open, "cells")});
}

void add_figures(Report& report, const std::vector<Outcome>& outcomes, const std::string& place) {
  const Kind gated{outcomes, place, "", "gated"};
  const Kind open{outcomes, place, "", "open"};
  if (gated.empty() || open.empty()) return;
  add_astray(report, place, gated, open);
  add_held_up(report, outcomes, place);
}

Report report_of(const std::vector<Outcome>& outcomes) {
  Report report;
  TextTable table{
      "By place and event, all seeds",
      {"place", "event", "gate", "revisions", "cells", "written astray", "of them still there after 60 s",
       "revisions withdrawn", "sets refused", "pose wrong, s", "of that gate open, s", "shut after the event"},
      {}};
  TextTable reasons{"Why the gate was shut, share of the time", {"place and event", "when", "reason", "share"}, {}};
  for (const std::string place : kPlaces) {
    for (const PoseEvent event : kPoseEvents) {
      const std::string what{name_of(event)};
      for (const std::string gate : kGates) {
        const Kind kind{outcomes, place, what, gate};
        if (kind.empty()) continue;
        table.rows.push_back(row_of(kind, place, what, gate));
        if (gate != "gated") continue;
        for (auto& row : reasons_of(kind, place + ", " + what, "after")) reasons.rows.push_back(std::move(row));
        if (event != PoseEvent::kNothing) report.charts.push_back(course_of(kind, place + ", " + what));
      }
    }
    add_figures(report, outcomes, place);
  }
  report.tables = {std::move(table), std::move(reasons)};
  return report;
}

}  // namespace

Experiment gate_experiment() {
  return {.name = "gate",
          .what =
              "A robot that maps while a fork-lift works is carried by one bay or anywhere, or slips: what is written "
              "while its pose is wrong",
          .runs = runs_of,
          .report = report_of};
}

}  // namespace deltamap::experiments
