// SPDX-License-Identifier: Apache-2.0
// Drives of hours through worlds that change, by both methods: the paper's Table 2 and Figures 9 to 12, and what it did
// not try. Each experiment is a list of drives and of what is asked of them.
#include <algorithm>
#include <cmath>
#include <functional>

#include "experiments/drive/lived_in.hpp"
#include "experiments/registry.hpp"
#include "experiments/watch/mapping_run.hpp"
#include "experiments/watch/pipeline_day.hpp"

namespace deltamap::experiments {
namespace {

struct Drive {
  std::string name;      ///< of the kind of drive
  std::string scenario;  ///< file
  double minutes = 60.0;
  int seeds = 1;
  double range_m = 80.0;
  int restarts = 0;
  std::vector<std::string> methods{"evidence", "paper"};
  std::function<void(simulation::VirtualDriveParams&, simulation::Scenario&)> arrange{};
  bool by_pipeline = false;  ///< the daemon's own, with threads and files, in place of the stages in step
};

enum class Over : std::uint8_t { kMean, kLeast, kMost };

/// A number that is asked of a kind of drive, for the evidence method.
struct Asked {
  std::string drive;   ///< empty: of every kind
  std::string number;  ///< or a difference "a - b"
  Over over = Over::kMean;
  Target target;
  std::string unit{};
  std::string peers{};
};

struct Plan {
  std::string name;
  std::string what;
  std::vector<Drive> drives;
  std::vector<Asked> asked;
  bool measures_machine = false;
};

double value_of(const Outcome& outcome, const std::string& number) {
  const auto minus = number.find(" - ");
  if (minus == std::string::npos) return outcome.number(number);
  return outcome.number(number.substr(0, minus)) - outcome.number(number.substr(minus + 3));
}

double over_all(const std::vector<double>& values, Over over) {
  switch (over) {
    case Over::kLeast:
      return quantile(values, 0.0);
    case Over::kMost:
      return quantile(values, 1.0);
    case Over::kMean:
      break;
  }
  return mean_of(values);
}

Certainty certainty_of(const std::vector<double>& values, Over over) {
  return over == Over::kMean ? certainty_of_mean(values) : certainty_of_extreme(values);
}

const char* name_of(Over over) { return over == Over::kLeast ? "least" : over == Over::kMost ? "most" : "mean"; }

/// Nothing where the number is only shown.
std::optional<Target> target_of(const Asked& asked) {
  if (!asked.target.least && !asked.target.most) return std::nullopt;
  return asked.target;
}

std::vector<Run> runs_of(const Plan& plan, const Options& options) {
  std::vector<Run> runs;
  for (const Drive& kind : plan.drives) {
    const simulation::Scenario scenario = simulation::read_scenario(options.scenarios / kind.scenario);
    for (const std::uint64_t seed : options.seeds(kind.seeds)) {
      for (const std::string& method : kind.methods) {
        MappingRun run{scenario, {}, settings_of(options, method)};
        run.drive.seed = seed;
        run.drive.max_range_m = kind.range_m;
        run.drive.forklift = scenario.forklift;
        run.drive.creep = scenario.creep;
        if (kind.arrange) kind.arrange(run.drive, run.scenario);
        run.minutes = options.minutes.value_or(options.quick ? std::min(5.0, kind.minutes) : kind.minutes);
        run.restarts = kind.restarts;
        runs.push_back({kind.name + "-seed" + std::to_string(seed) + "-" + method, [=] {
                          Outcome outcome = kind.by_pipeline ? outcome_of(pipeline_day(run)) : outcome_of(run);
                          outcome.labels = {{"drive", kind.name}, {"seed", std::to_string(seed)}, {"method", method}};
                          return outcome;
                        }});
      }
    }
  }
  return runs;
}

std::vector<const Outcome*> chosen(const std::vector<Outcome>& outcomes, const std::string& drive,
                                   const std::string& method) {
  std::vector<const Outcome*> some;
  for (const Outcome& outcome : outcomes) {
    if ((drive.empty() || outcome.label("drive") == drive) && outcome.label("method") == method)
      some.push_back(&outcome);
  }
  return some;
}

std::vector<double> values_of(const std::vector<const Outcome*>& outcomes, const std::string& number) {
  std::vector<double> values;
  for (const Outcome* outcome : outcomes) {
    const double value = value_of(*outcome, number);
    if (!std::isnan(value)) values.push_back(value);
  }
  return values;
}

Chart course_chart(const std::string& title, const std::string& y, const std::vector<const Outcome*>& outcomes,
                   const std::vector<std::string>& columns) {
  Chart chart{title, "time, h", y};
  for (const Outcome* outcome : outcomes) {
    const std::vector<double> time_s = outcome->scans.column("t_s");
    for (const std::string& column : columns) {
      Series series{outcome->label("method") + " seed " + outcome->label("seed") + " " + column, {}};
      const std::vector<double> value = outcome->scans.column(column);
      for (std::size_t i = 0; i < value.size(); ++i) series.points.emplace_back(time_s[i] / 3600.0, value[i]);
      chart.series.push_back(std::move(series));
    }
  }
  return chart;
}

void add_charts(Report& report, const Drive& kind, const std::vector<const Outcome*>& ours,
                const std::vector<const Outcome*>& both) {
  const auto add = [&](const std::string& title, const std::string& y, const std::vector<const Outcome*>& outcomes,
                       const std::vector<std::string>& columns) {
    report.charts.push_back(course_chart(kind.name + ": " + title, y, outcomes, columns));
  };
  if (kind.by_pipeline) return add("memory, simulator and all", "MB", ours, {"heap_mb", "resident_mb"});
  add("error", "position, mean of five minutes, m", both, {"error_mean_m"});
  add("acceptance", "Eq. 11", both, {"acceptance"});
  add("contour F1, ours, stale, perfect", "F1", ours, {"f1", "f1_stale", "f1_perfect"});
}

/// Every number of every run, the methods side by side.
TextTable table_of(const std::string& drive, const std::vector<const Outcome*>& ours,
                   const std::vector<const Outcome*>& paper) {
  TextTable table{drive + ": every number, mean (least … most) over the drives", {"number", "evidence", "paper"}, {}};
  if (ours.empty()) return table;
  const auto text = [](const std::vector<double>& values) {
    if (values.empty()) return std::string{"–"};
    return text_of(mean_of(values)) + " (" + text_of(quantile(values, 0.0)) + " … " + text_of(quantile(values, 1.0)) +
           ")";
  };
  for (const auto& [number, value] : ours.front()->numbers)
    table.rows.push_back({number, text(values_of(ours, number)), text(values_of(paper, number))});
  return table;
}

Report report_of(const Plan& plan, const std::vector<Outcome>& outcomes) {
  Report report;
  for (const Drive& kind : plan.drives) {
    const auto ours = chosen(outcomes, kind.name, "evidence");
    const auto paper = chosen(outcomes, kind.name, "paper");
    if (ours.empty()) continue;  // not asked for
    for (const Asked& asked : plan.asked) {
      if (!asked.drive.empty() && asked.drive != kind.name) continue;
      const std::vector<double> values = values_of(ours, asked.number);
      if (values.empty()) continue;
      std::string peers = asked.peers;
      const std::vector<double> papers = values_of(paper, asked.number);
      if (!papers.empty())
        peers += (peers.empty() ? "" : "; ") + std::string{"method paper: "} + text_of(over_all(papers, asked.over));
      report.figures.push_back({kind.name + ": " + asked.number + ", " + name_of(asked.over),
                                over_all(values, asked.over), asked.unit, target_of(asked), peers,
                                certainty_of(values, asked.over)});
    }
    auto both = ours;
    both.insert(both.end(), paper.begin(), paper.end());
    add_charts(report, kind, ours, both);
    report.tables.push_back(table_of(kind.name, ours, paper));
    for (const Outcome* one : {ours.front(), paper.empty() ? nullptr : paper.front()}) {
      if (one == nullptr) continue;
      for (const Picture& picture : one->pictures)
        report.pictures.push_back({kind.name + ", " + one->label("method") + ": " + picture.title, picture.svg});
    }
  }
  return report;
}

const std::string kPaperTable2 = "paper 0.968–0.980";

std::vector<Asked> asked_of_lasting_drives(const std::string& drive) {
  return {{drive, "error_mean_m", Over::kMost, {.most = 0.05}, "m", "paper < 0.5, lost once in ten"},
          {drive, "error_p99_m", Over::kMost, {.most = 0.20}, "m"},
          {drive, "not_tracking", Over::kMost, {.most = 0.0}},
          {drive, "recall", Over::kMean, {.least = 0.98}},
          {drive, "precision", Over::kMean, {.least = 0.98}},
          {drive, "follow_median_s", Over::kMean, {.most = 8.0}, "s"},
          {drive, "layer_recall", Over::kMean, {.least = 0.98}},
          {drive, "layer_median_s", Over::kMean, {.most = 3.0}, "s"},
          {drive, "layer_gone_within_10s", Over::kMean, {}},
          {drive, "cells_written_astray", Over::kMost, {.most = 0.0}},
          {drive, "walls_kept", Over::kLeast, {.least = 1.0}},
          {drive, "wall_drift_m", Over::kMost, {.most = 0.02}, "m"}};
}

std::vector<Asked> operator+(std::vector<Asked> all, const std::vector<Asked>& more) {
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

Plan table2() {
  return {"table2",
          "The paper's Table 2 and Figure 9: ten drives of two hours, a container a minute",
          {{.name = "hall", .scenario = "hall.yaml", .minutes = 120.0, .seeds = 10}},
          std::vector<Asked>{{"", "acceptance", Over::kLeast, {}, "", kPaperTable2},
                             {"", "acceptance_perfect - acceptance", Over::kMost, {.most = 0.003}},
                             {"", "skill", Over::kLeast, {.least = 0.9}},
                             {"", "skill", Over::kMean, {.least = 0.95}},
                             {"", "acceptance_solid", Over::kLeast, {.least = 0.97}}} +
              asked_of_lasting_drives("")};
}

Plan seven_hours() {
  return {"fig10-12",
          "The paper's Figures 10 to 12: seven hours, 420 changes",
          {{.name = "hall", .scenario = "hall.yaml", .minutes = 420.0}},
          std::vector<Asked>{{"", "acceptance_perfect - acceptance", Over::kMost, {.most = 0.004}},
                             {"", "shortfall_growth", Over::kMost, {.most = 0.001}},
                             {"", "skill", Over::kLeast, {.least = 0.9}}} +
              asked_of_lasting_drives("")};
}

/// The daemon's own pipeline over a day at a fifth of the laser's rate, so that it takes minutes.
Drive day_of_pipeline() {
  return {.name = "pipeline",
          .scenario = "endurance.yaml",
          .minutes = 1440.0,
          .range_m = 30.0,
          .methods = {"evidence"},
          .arrange = [](simulation::VirtualDriveParams& drive, simulation::Scenario&) { drive.scan_period_s = 0.5; },
          .by_pipeline = true};
}

Plan endurance() {
  const auto every = [](double seconds) {
    return [seconds](simulation::VirtualDriveParams& drive, simulation::Scenario&) {
      drive.forklift->change_every_s = seconds;
    };
  };
  Plan plan{"endurance",
            "24 hours with ten restarts among racks, doors and passers-by, 24 hours of the daemon's own pipeline, and "
            "changes twice as often until it breaks",
            {{.name = "24h", .scenario = "endurance.yaml", .minutes = 1440.0, .restarts = 10, .methods = {"evidence"}},
             day_of_pipeline()},
            asked_of_lasting_drives("24h") +
                std::vector<Asked>{{"24h", "acceptance_perfect - acceptance", Over::kMost, {.most = 0.004}},
                                   {"24h", "shortfall_growth", Over::kMost, {.most = 0.001}},
                                   {"24h", "skill", Over::kLeast, {}},
                                   {"pipeline", "heap_growth_mb", Over::kMost, {.most = kMostHeapGrowth_mb}, "MB"},
                                   {"pipeline", "resident_growth_mb", Over::kMost, {}, "MB"},
                                   {"pipeline", "last_heap_mb", Over::kMost, {}, "MB"},
                                   {"pipeline", "revisions", Over::kLeast, {}},
                                   {"pipeline", "not_followed_s", Over::kMost, {}, "s"},
                                   {"pipeline", "warnings", Over::kMost, {.most = 0.0}}},
            true};
  for (const double seconds : {30.0, 15.0, 7.5, 3.75}) {
    const std::string name = "every-" + text_of(seconds) + "s";
    plan.drives.push_back(
        {.name = name, .scenario = "hall.yaml", .minutes = 60.0, .methods = {"evidence"}, .arrange = every(seconds)});
    plan.asked.push_back({name, "cells_written_astray", Over::kMost, {.most = 0.0}});
    plan.asked.push_back({name, "error_p99_m", Over::kMost, {}, "m"});
    plan.asked.push_back({name, "skill", Over::kLeast, {}});
  }
  return plan;
}

Plan live_map() {
  const auto with_people = [](simulation::VirtualDriveParams&, simulation::Scenario& hall) { hall.people = walkers(); };
  return {"live-map",
          "An hour of containers pushed aside by at most 0.8 m, a laser of 80 m and of 8 m, the map following",
          {{.name = "80m", .scenario = "hall_shifts.yaml", .seeds = 3, .arrange = with_people},
           {.name = "8m", .scenario = "hall_shifts.yaml", .seeds = 3, .range_m = 8.0, .arrange = with_people}},
          {{"80m", "error_rms_m", Over::kMost, {.most = 0.03}, "m"},
           {"8m", "error_rms_m", Over::kMost, {.most = 0.08}, "m", "nobody survives; always-on SLAM: 21 m"},
           {"", "not_tracking", Over::kMost, {.most = 0.0}},
           {"", "recall", Over::kMean, {.least = 0.95}},
           {"", "cells_written_astray", Over::kMost, {.most = 0.0}}}};
}

Plan passers() {
  return {"passers",
          "Ten people and fork-lifts that walk, stop for 5 s to 60 min and leave; racks, glass, doors",
          {{.name = "passers", .scenario = "endurance.yaml", .minutes = 120.0, .seeds = 2}},
          {{"", "ghost_cells_at_end", Over::kMost, {.most = 5.0}},
           {"", "ghost_cell_minutes", Over::kMean, {}},
           {"", "passer_ghosts_of_override", Over::kMost, {.most = 0.01}},
           {"", "skill", Over::kLeast, {}},
           {"", "walls_kept", Over::kLeast, {.least = 1.0}},
           {"", "error_p99_m", Over::kMost, {.most = 0.2}, "m"},
           {"", "cells_written_astray", Over::kMost, {.most = 0.0}}}};
}

Plan standing_still() {
  return {"static",
          "Seven hours in which nothing changes, among rack posts, glass and doors",
          {{.name = "racks", .scenario = "racks.yaml", .minutes = 420.0, .methods = {"evidence"}},
           {.name = "doors",
            .scenario = "endurance.yaml",
            .minutes = 420.0,
            .methods = {"evidence"},
            .arrange =
                [](simulation::VirtualDriveParams& drive, simulation::Scenario& hall) {
                  drive.forklift.reset();
                  hall.actors.clear();
                }}},
          {{"", "writes_per_cell_hour", Over::kMost, {.most = 0.1}},
           {"", "most_writes_of_a_cell", Over::kMost, {}},
           {"", "walls_kept", Over::kLeast, {.least = 1.0}},
           {"", "cells_written_astray", Over::kMost, {.most = 0.0}}}};
}

Plan creeping() {
  return {"creep",
          "Containers that creep 20 times by 5 cm in one direction",
          {{.name = "creep", .scenario = "creep.yaml", .minutes = 60.0, .seeds = 2, .methods = {"evidence"}}},
          {{"", "wall_drift_m", Over::kMost, {.most = 0.02}, "m"},
           {"", "error_mean_m", Over::kMost, {.most = 0.05}, "m"},
           {"", "error_p99_m", Over::kMost, {.most = 0.20}, "m"},
           {"", "skill", Over::kLeast, {}},
           {"", "cells_written_astray", Over::kMost, {.most = 0.0}}}};
}

Plan fast() {
  return {"fast",
          "An hour at 1.5 m/s, a container a minute: few looks must do",
          {{.name = "hall",
            .scenario = "hall.yaml",
            .minutes = 60.0,
            .seeds = 2,
            .methods = {"evidence"},
            .arrange = [](simulation::VirtualDriveParams& drive,
                          simulation::Scenario&) { drive.route.speed_m_per_s = 1.5; }}},
          std::vector<Asked>{{"", "skill", Over::kLeast, {}}} + asked_of_lasting_drives("")};
}

Plan changed_start() {
  Plan plan{"changed-start", "Begun in a hall of which 25, 50 or 75 % has changed since M_0", {}, {}};
  for (const double share : {0.25, 0.5, 0.75}) {
    plan.drives.push_back({.name = text_of(100.0 * share) + "%",
                           .scenario = "changed.yaml",
                           .minutes = 15.0,
                           .seeds = 3,
                           .arrange = [share](simulation::VirtualDriveParams& drive, simulation::Scenario& hall) {
                             drive.changed_at_start = hall.changed_at_start;
                             drive.changed_at_start->share = share;
                           }});
  }
  plan.asked = {{"25%", "skill", Over::kLeast, {}},
                {"50%", "skill", Over::kLeast, {.least = 0.8}},
                {"75%", "skill", Over::kLeast, {}},
                {"", "longest_start_check_s", Over::kMost, {.most = 5.0}, "s"},
                {"", "not_tracking", Over::kMost, {.most = 0.0}},
                {"", "error_p99_m", Over::kMost, {}, "m"},
                {"", "cells_written_astray", Over::kMost, {.most = 0.0}}};
  return plan;
}

}  // namespace

std::vector<Experiment> changing_world_experiments() {
  std::vector<Experiment> all;
  for (const Plan& plan : {table2(), seven_hours(), endurance(), live_map(), passers(), standing_still(), creeping(),
                           changed_start(), fast()}) {
    all.push_back({.name = plan.name,
                   .what = plan.what,
                   .runs = [plan](const Options& options) { return runs_of(plan, options); },
                   .report = [plan](const std::vector<Outcome>& outcomes) { return report_of(plan, outcomes); },
                   .times = plan.measures_machine ? Experiment::Times::kMachine : Experiment::Times::kNothing});
  }
  return all;
}

}  // namespace deltamap::experiments
