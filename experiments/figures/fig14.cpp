// SPDX-License-Identifier: Apache-2.0
// `fig14`: the paper's Figure 14 (§5): CPU and memory over time, inside and outside Δ-phases, on a drive of two hours
// in which a container changes every minute.
#include <malloc.h>

#include <algorithm>
#include <cmath>

#include "daemon/system/used_memory.hpp"
#include "experiments/drive/first_map.hpp"
#include "experiments/drive/mapping_drive.hpp"
#include "experiments/pooled_runs.hpp"
#include "experiments/registry.hpp"
#include "experiments/watch/mapping_run.hpp"

namespace deltamap::experiments {
namespace {

constexpr double kPart_s = 60.0;  // of the drive, a row each

/// Of this process, now.
double resident_mb() { return static_cast<double>(daemon::resident_bytes()) / (1024.0 * 1024.0); }

/// What a scan took, and where.
struct ScanCost {
  float localizer_ms = 0.0F;
  float awareness_ms = 0.0F;
  float update_ms = 0.0F;
  bool inside = false;  ///< a Δ-phase is open, or has just been closed

  [[nodiscard]] double mapping_ms() const { return static_cast<double>(awareness_ms + update_ms); }
  [[nodiscard]] double all_ms() const { return static_cast<double>(localizer_ms) + mapping_ms(); }
};

/// The costs of a drive. All its memory is taken at the beginning, so that the drive's own growth shows.
class CostBook {
 public:
  CostBook(double drive_s, double scan_period_s)
      : costs_(static_cast<std::size_t>(drive_s / scan_period_s) + 2), memory_(static_cast<std::size_t>(drive_s) + 2) {}

  void add(const Mapped& scan) {
    if (scans_ < costs_.size()) costs_[scans_++] = cost_of(scan);
    const auto second = static_cast<std::size_t>(scan.passed_s);
    if (seconds_ <= second && seconds_ < memory_.size()) memory_[seconds_++] = static_cast<float>(resident_mb());
  }
  [[nodiscard]] std::vector<ScanCost> costs() const {
    return {costs_.begin(), costs_.begin() + static_cast<std::ptrdiff_t>(scans_)};
  }
  /// Every second.
  [[nodiscard]] std::vector<double> memory_mb() const {
    return {memory_.begin(), memory_.begin() + static_cast<std::ptrdiff_t>(seconds_)};
  }

 private:
  [[nodiscard]] static ScanCost cost_of(const Mapped& scan) {
    const auto milliseconds = [](double seconds) { return static_cast<float>(1e3 * seconds); };
    return {milliseconds(scan.costs.localization_s), milliseconds(scan.costs.awareness_s),
            milliseconds(scan.costs.map_update_s), scan.awareness.in_phase || scan.update.has_value()};
  }
  std::vector<ScanCost> costs_;
  std::vector<float> memory_;
  std::size_t scans_ = 0;
  std::size_t seconds_ = 0;
};

template <typename Of>
std::vector<double> values_of(const std::vector<ScanCost>& costs, Of&& of) {
  std::vector<double> values;
  values.reserve(costs.size());
  for (const ScanCost& cost : costs) values.push_back(of(cost));
  return values;
}

std::vector<ScanCost> chosen(const std::vector<ScanCost>& costs, bool inside) {
  std::vector<ScanCost> some;
  std::copy_if(costs.begin(), costs.end(), std::back_inserter(some),
               [&](const ScanCost& cost) { return cost.inside == inside; });
  return some;
}

std::vector<std::pair<std::string, double>> numbers_of(const std::vector<ScanCost>& costs,
                                                       const std::vector<double>& memory_mb, double before_mb) {
  std::vector<std::pair<std::string, double>> numbers{{"scans", static_cast<double>(costs.size())}};
  numbers.emplace_back("inside", mean_of(values_of(costs, [](const ScanCost& c) { return c.inside ? 1.0 : 0.0; })));
  for (const bool inside : {false, true}) {
    const std::string where = inside ? "inside_" : "outside_";
    const std::vector<ScanCost> some = chosen(costs, inside);
    const std::vector<double> all = values_of(some, [](const ScanCost& c) { return c.all_ms(); });
    const std::vector<double> mapping = values_of(some, [](const ScanCost& c) { return c.mapping_ms(); });
    numbers.emplace_back(where + "mean_ms", mean_of(all));
    numbers.emplace_back(where + "p99_ms", quantile(all, 0.99));
    numbers.emplace_back(where + "peak_ms", quantile(all, 1.0));
    numbers.emplace_back(where + "mapping_mean_ms", mean_of(mapping));
    numbers.emplace_back(where + "mapping_peak_ms", quantile(mapping, 1.0));
  }
  std::vector<double> updates = values_of(costs, [](const ScanCost& c) { return double{c.update_ms}; });
  std::erase(updates, 0.0);
  numbers.emplace_back("updates", static_cast<double>(updates.size()));
  numbers.emplace_back("update_mean_ms", mean_of(updates));
  numbers.emplace_back("update_peak_ms", quantile(updates, 1.0));
  numbers.emplace_back("localizer_mean_ms",
                       mean_of(values_of(costs, [](const ScanCost& c) { return double{c.localizer_ms}; })));
  numbers.emplace_back("awareness_mean_ms",
                       mean_of(values_of(costs, [](const ScanCost& c) { return double{c.awareness_ms}; })));
  numbers.emplace_back("before_mb", before_mb);
  numbers.emplace_back("half_way_mb", memory_mb[memory_mb.size() / 2]);
  numbers.emplace_back("end_mb", memory_mb.back());
  numbers.emplace_back("peak_mb", quantile(memory_mb, 1.0));
  return numbers;
}

ScanTable parts_of(const std::vector<ScanCost>& costs, const std::vector<double>& memory_mb, double scan_period_s) {
  ScanTable table{{"t_s", "inside", "mean_ms", "peak_ms", "outside_mean_ms", "inside_mean_ms", "resident_mb"}};
  const auto a_part = static_cast<std::size_t>(kPart_s / scan_period_s);
  for (std::size_t first = 0; first < costs.size(); first += a_part) {
    const std::size_t last = std::min(first + a_part, costs.size());
    const std::vector<ScanCost> part{costs.begin() + static_cast<std::ptrdiff_t>(first),
                                     costs.begin() + static_cast<std::ptrdiff_t>(last)};
    const auto all = [](const ScanCost& c) { return c.all_ms(); };
    const double t_s = static_cast<double>(first) * scan_period_s;
    const std::size_t second = std::min(static_cast<std::size_t>(t_s), memory_mb.size() - 1);
    table.add({t_s, mean_of(values_of(part, [](const ScanCost& c) { return c.inside ? 1.0 : 0.0; })),
               mean_of(values_of(part, all)), quantile(values_of(part, all), 1.0),
               mean_of(values_of(chosen(part, false), all)), mean_of(values_of(chosen(part, true), all)),
               memory_mb[second]});
  }
  return table;
}

Outcome measured_drive(const simulation::Scenario& scenario, const daemon::Settings& settings,
                       const std::string& method, std::uint64_t seed, double minutes) {
  simulation::VirtualDriveParams params;
  params.seed = seed;
  params.forklift = scenario.forklift;
  CostBook book{60.0 * minutes, params.scan_period_s};
  (void)malloc_trim(0);  // what earlier runs have left
  const double before_mb = resident_mb();
  {
    MappingDrive drive{scenario, params, settings, {first_map(scenario)}};
    for (double passed_s = 0.0; passed_s < 60.0 * minutes;) {
      const Mapped scan = drive.next();
      passed_s = scan.passed_s;
      book.add(scan);
    }
  }
  const std::vector<ScanCost> costs = book.costs();
  const std::vector<double> memory_mb = book.memory_mb();
  Outcome outcome;
  outcome.labels = {{"method", method}, {"seed", std::to_string(seed)}};
  outcome.numbers = numbers_of(costs, memory_mb, before_mb);
  outcome.scans = parts_of(costs, memory_mb, params.scan_period_s);
  return outcome;
}

std::vector<Run> runs_of(const Options& options) {
  const auto scenario = scenario_of(options, "hall.yaml");
  const double minutes = options.minutes.value_or(options.quick ? 10.0 : 120.0);
  std::vector<Run> runs;
  for (const std::uint64_t seed : options.seeds(1)) {
    for (const std::string method : {"evidence", "paper"}) {
      runs.push_back({method + "-seed" + std::to_string(seed), [=, settings = settings_of(options, method)] {
                        return measured_drive(*scenario, settings, method, seed, minutes);
                      }});
    }
  }
  return runs;
}

using Values = std::vector<double>;

/// A number of each run of the method.
Values numbers(const std::vector<Outcome>& outcomes, const std::string& method, const std::string& number) {
  Values values;
  for (const Outcome* run : runs_with(outcomes, {{"method", method}})) values.push_back(run->number(number));
  return values;
}

Values scaled(Values values, double factor) {
  for (double& value : values) value *= factor;
  return values;
}

Values difference(Values values, const Values& others) {
  for (std::size_t i = 0; i < values.size(); ++i) values[i] -= others[i];
  return values;
}

/// What is known of it: runs without it say nothing.
double mean_of_known(Values values) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
  return mean_of(values);
}

void add_figures(Report& report, const std::vector<Outcome>& outcomes, const std::string& method) {
  const auto of = [&](const std::string& number) { return numbers(outcomes, method, number); };
  const double scan_ms = 1e3 * simulation::VirtualDriveParams{}.scan_period_s;
  const bool ours = method == "evidence";
  const auto add = [&](const std::string& what, const Values& values, const std::string& unit,
                       const std::string& peers = "", std::optional<Target> target = std::nullopt) {
    report.figures.push_back({method + ": " + what, mean_of_known(values), unit, ours ? target : std::nullopt, peers,
                              certainty_of_mean(values)});
  };
  add("scans inside Δ-phases", of("inside"), "");
  for (const std::string where : {"outside", "inside"}) {
    add("CPU a scan " + where + ", mean", of(where + "_mean_ms"), "ms",
        where == "inside" ? "paper: peaks of an Atom of 1.6 GHz, no number" : "paper: low");
    add("CPU a scan " + where + ", 99 % within", of(where + "_p99_ms"), "ms");
    add("CPU a scan " + where + ", peak", of(where + "_peak_ms"), "ms");
    add("of one processor " + where, scaled(of(where + "_mean_ms"), 100.0 / scan_ms), "%");
    add("awareness and map update a scan " + where + ", mean", of(where + "_mapping_mean_ms"), "ms");
  }
  add("localizer a scan, mean", of("localizer_mean_ms"), "ms");
  add("awareness a scan, mean", of("awareness_mean_ms"), "ms");
  add("map updates", of("updates"), "");
  add("CPU a map update, mean", of("update_mean_ms"), "ms");
  add("CPU a map update, peak", of("update_peak_ms"), "ms");
  add("resident memory, simulator and all, peak", of("peak_mb"), "MB", "paper: 92 MB for a short time",
      Target{.most = 30.0});
  add("resident memory, grown by since before the drive, peak", difference(of("peak_mb"), of("before_mb")), "MB");
  add("resident memory, grown by in the second half", difference(of("end_mb"), of("half_way_mb")), "MB", "",
      Target{.most = 1.0});
}

Chart chart_of(const std::vector<Outcome>& outcomes, const std::string& title, const std::string& y,
               const std::vector<std::pair<std::string, std::string>>& columns) {
  Chart chart{title, "time, min", y, {}};
  for (const Outcome& outcome : outcomes) {
    if (outcome.label("seed") != outcomes.front().label("seed")) continue;
    const std::vector<double> time_s = outcome.scans.column("t_s");
    for (const auto& [column, name] : columns) {
      Series series{outcome.label("method") + name, {}};
      const std::vector<double> values = outcome.scans.column(column);
      for (std::size_t i = 0; i < values.size(); ++i) series.points.emplace_back(time_s[i] / 60.0, values[i]);
      chart.series.push_back(std::move(series));
    }
  }
  return chart;
}

Report report_of(const std::vector<Outcome>& outcomes) {
  Report report;
  for (const std::string method : {"evidence", "paper"}) {
    if (!runs_with(outcomes, {{"method", method}}).empty()) add_figures(report, outcomes, method);
  }
  report.charts.push_back(chart_of(outcomes, "CPU a scan inside and outside Δ-phases", "mean of a minute, ms",
                                   {{"outside_mean_ms", ", outside"}, {"inside_mean_ms", ", inside"}}));
  report.charts.push_back(chart_of(outcomes, "CPU a scan, peaks", "most of a minute, ms", {{"peak_ms", ""}}));
  report.charts.push_back(chart_of(outcomes, "Time inside Δ-phases", "share of a minute", {{"inside", ""}}));
  report.charts.push_back(chart_of(outcomes, "Resident memory, simulator and all", "MB", {{"resident_mb", ""}}));
  return report;
}

}  // namespace

Experiment fig14_experiment() {
  return {.name = "fig14",
          .what = "Figure 14 of the paper: CPU and memory over time, inside and outside Δ-phases",
          .runs = runs_of,
          .report = report_of,
          .times = Experiment::Times::kMachine};
}

}  // namespace deltamap::experiments
