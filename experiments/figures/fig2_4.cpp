// SPDX-License-Identifier: Apache-2.0
// `fig2-4`: the paper's Figures 2 to 4 (§3.1–3.2): w_avg, w_fast, w_slow and r_d on a lap round the hall that the map
// knows, and on the same lap once a tenth of the hall has changed; beside them what beams say of the same scans.
#include <algorithm>
#include <array>
#include <cmath>

#include "experiments/drive/first_map.hpp"
#include "experiments/drive/lived_in.hpp"
#include "experiments/drive/localizer_variants.hpp"
#include "experiments/drive/mapping_drive.hpp"
#include "experiments/drive/view_difference.hpp"
#include "experiments/pooled_runs.hpp"
#include "experiments/registry.hpp"
#include "mapping/store_scan.hpp"

namespace deltamap::experiments {
namespace {

constexpr double kLap_min = 4.5;        // 120 m at 0.5 m/s, turns included
constexpr double kChangedShare = 0.1;   // of the containers
constexpr double kNear_m = 12.0;        // a change is in view where, of the beams cut at this range, …
constexpr double kChangeInView = 0.05;  // … more than this share end elsewhere than before
constexpr double kFalseAlarms = 0.02;   // of the scans without a change: where the two indicators are compared
constexpr std::size_t kMostPoints = 1500;

/// Round the outer corridor of the paper's hall.
std::vector<Point2> lap() { return {{32.5, 2.5}, {32.5, 32.5}, {2.5, 32.5}, {2.5, 2.5}}; }

ScanTable empty_table() {
  return ScanTable{{"t_s", "w_avg", "w_fast", "w_slow", "r_d", "in_phase", "stored", "differing_share",
                    "speaking_beams", "turn_rate_rad_per_s", "error_m"}};
}

/// What the two methods think of a scan.
class Indicators {
 public:
  explicit Indicators(std::uint64_t seed)
      : paper_{params(MappingMethod::kPaper), seed}, evidence_{params(MappingMethod::kEvidence), seed} {}

  void observe(const TrackedScan& tracked) {
    const std::uint32_t kept_before = paper_.awareness().in_phase ? paper_.awareness().stored_scans : 0;
    const bool ends = paper_.observe(tracked).has_value();
    const mapping::Awareness& now = paper_.awareness();
    // The scan that ends a phase is not kept.
    stored_ = !ends && now.in_phase && now.stored_scans > kept_before ? 1 : 0;
    (void)evidence_.observe(tracked);
    const mapping::Awareness& evidence = evidence_.awareness();
    speaking_[scans_++ % speaking_.size()] = static_cast<double>(evidence.short_beams + evidence.through_beams);
  }
  [[nodiscard]] const mapping::Awareness& paper() const { return paper_.awareness(); }
  [[nodiscard]] double stored() const { return stored_; }
  /// Beams that spoke against the map in the last keyframes: the most of half a second, for not every scan is one.
  [[nodiscard]] double speaking_beams() const { return *std::max_element(speaking_.begin(), speaking_.end()); }

 private:
  [[nodiscard]] static mapping::StoreScanParams params(MappingMethod method) {
    mapping::StoreScanParams params;
    params.method = method;
    return params;
  }
  mapping::StoreScan paper_;
  mapping::StoreScan evidence_;
  double stored_ = 0.0;
  std::array<double, 5> speaking_{};
  std::size_t scans_ = 0;
};

double phases_begun(const ScanTable& scans) {
  const std::vector<double> in_phase = scans.column("in_phase");
  double begun = 0.0;
  for (std::size_t i = 0; i < in_phase.size(); ++i) {
    if (in_phase[i] > 0.5 && (i == 0 || in_phase[i - 1] < 0.5)) begun += 1.0;
  }
  return begun;
}

std::vector<std::pair<std::string, double>> numbers_of(const ScanTable& scans) {
  const std::vector<double> weights = scans.column("w_avg");
  const std::vector<double> ratios = scans.column("r_d");
  const std::vector<double> differing = scans.column("differing_share");
  std::vector<double> in_view;
  std::vector<double> elsewhere;
  std::vector<double> weights_in_view;
  for (std::size_t i = 0; i < ratios.size(); ++i) {
    (differing[i] > kChangeInView ? in_view : elsewhere).push_back(ratios[i]);
    if (differing[i] > kChangeInView) weights_in_view.push_back(weights[i]);
  }
  return {{"scans", static_cast<double>(scans.rows())},
          {"median_w_avg", quantile(weights, 0.5)},
          {"median_w_avg_in_view", quantile(weights_in_view, 0.5)},
          {"least_w_avg", quantile(weights, 0.0)},
          {"most_r_d", quantile(ratios, 1.0)},
          {"positive_r_d", share_above(ratios, 0.0)},
          {"in_view", share_above(differing, kChangeInView)},
          {"positive_in_view", share_above(in_view, 0.0)},
          {"positive_elsewhere", share_above(elsewhere, 0.0)},
          {"phases", phases_begun(scans)},
          {"stored_scans", mean_of(scans.column("stored")) * static_cast<double>(scans.rows())},
          {"median_error_m", quantile(scans.column("error_m"), 0.5)}};
}

/// A lap to come to rest, then the lap that counts.
Outcome two_laps(const simulation::Scenario& scenario, const localization::LocalizerParams& localizer,
                 std::uint64_t seed, bool changes, double minutes) {
  simulation::VirtualDriveParams drive;
  drive.seed = seed;
  drive.route.round = lap();
  MappingDrive pair{scenario, drive, localizer_alone(localizer), {first_map(scenario)}};
  const simulation::RayCaster as_mapped{scenario.world};
  Indicators indicators{seed};
  Outcome outcome;
  outcome.scans = empty_table();
  bool is_second = false;
  for (double passed_s = 0.0; passed_s < 120.0 * minutes;) {
    if (!is_second && passed_s >= 60.0 * minutes) {
      is_second = true;
      if (changes) (void)pair.drive().change_many(kChangedShare, busy_forklift(1.0));
    }
    const Mapped scan = pair.next();
    passed_s = scan.passed_s;
    indicators.observe(scan.tracked);
    if (!is_second) continue;
    const Pose2 map_from_laser = scan.map_from_robot * scenario.laser.optics.robot_from_laser;
    const mapping::Awareness& paper = indicators.paper();
    outcome.scans.add({passed_s - 60.0 * minutes, scan.estimate.w_avg, scan.tracked.weights.w_fast,
                       scan.tracked.weights.w_slow, scan.tracked.weights.divergence_ratio(), paper.in_phase ? 1.0 : 0.0,
                       indicators.stored(),
                       differing_share(pair.drive().surfaces(), as_mapped, map_from_laser, kNear_m),
                       indicators.speaking_beams(), scan.tracked.turn_rate_rad_per_s, error_of(scan).position.norm()});
  }
  outcome.labels = {{"world", changes ? "changed" : "still"}, {"seed", std::to_string(seed)}};
  outcome.numbers = numbers_of(outcome.scans);
  return outcome;
}

std::vector<Run> runs_of(const Options& options) {
  const auto scenario = scenario_of(options, "hall.yaml");
  const localization::LocalizerParams localizer = localizer_variants(options.localizer).front().params;
  const double minutes = options.minutes.value_or(kLap_min);
  std::vector<Run> runs;
  for (const std::uint64_t seed : options.seeds(5)) {
    for (const bool changes : {false, true}) {
      runs.push_back({std::string{changes ? "changed" : "still"} + "-seed" + std::to_string(seed),
                      [=] { return two_laps(*scenario, localizer, seed, changes, minutes); }});
    }
  }
  return runs;
}

/// The scans of all runs in one world.
struct Pooled {
  std::vector<double> r_d;
  std::vector<double> speaking_beams;
  std::vector<double> r_d_in_view;
  std::vector<double> speaking_in_view;
};

Pooled pooled_scans(const std::vector<Outcome>& outcomes, const std::string& world) {
  Pooled pooled;
  for (const Outcome& outcome : outcomes) {
    if (outcome.label("world") != world) continue;
    const std::vector<double> r_d = outcome.scans.column("r_d");
    const std::vector<double> speaking = outcome.scans.column("speaking_beams");
    const std::vector<double> differing = outcome.scans.column("differing_share");
    append(pooled.r_d, r_d);
    append(pooled.speaking_beams, speaking);
    for (std::size_t i = 0; i < differing.size(); ++i) {
      if (differing[i] <= kChangeInView) continue;
      pooled.r_d_in_view.push_back(r_d[i]);
      pooled.speaking_in_view.push_back(speaking[i]);
    }
  }
  return pooled;
}

/// Figures of the runs in one world: means over them, and what is the most or the least of all.
class World {
 public:
  World(const std::vector<Outcome>& outcomes, const std::string& world, std::string where)
      : runs_{runs_with(outcomes, {{"world", world}})}, where_{std::move(where)} {}

  [[nodiscard]] Figure mean(const std::string& what, const char* number, const std::string& peers = "") const {
    const std::vector<double> values = all(number);
    return {where_ + what, mean_of(values), "", {}, peers, certainty_of_mean(values)};
  }
  [[nodiscard]] Figure extreme(const std::string& what, const char* number, double rank,
                               const std::string& peers) const {
    const std::vector<double> values = all(number);
    return {where_ + what, quantile(values, rank), "", {}, peers, certainty_of_extreme(values)};
  }

 private:
  [[nodiscard]] std::vector<double> all(const char* number) const {
    std::vector<double> values;
    for (const Outcome* run : runs_) {
      if (std::isfinite(run->number(number))) values.push_back(run->number(number));
    }
    return values;
  }
  std::vector<const Outcome*> runs_;
  std::string where_;
};

/// What the scans of all seeds tell together. A seed's two worlds are one run.
std::vector<double> shares_in_view(const std::vector<Outcome>& outcomes) {
  const Pooled still = pooled_scans(outcomes, "still");
  const Pooled changed = pooled_scans(outcomes, "changed");
  return {share_above(changed.r_d_in_view, 0.0),
          share_above(changed.r_d_in_view, quantile(still.r_d, 1.0 - kFalseAlarms)),
          share_above(changed.speaking_in_view, quantile(still.speaking_beams, 1.0 - kFalseAlarms))};
}

std::vector<Certainty> certainties_in_view(const std::vector<Outcome>& outcomes) {
  std::vector<std::vector<Outcome>> by_seed;
  for (const Outcome* run : runs_with(outcomes, {{"world", "changed"}})) {
    by_seed.emplace_back();
    for (const Outcome* one : runs_with(outcomes, {{"seed", run->label("seed")}})) by_seed.back().push_back(*one);
  }
  return certainties_of_runs(by_seed.size(), [&](const std::vector<std::size_t>& drawn) {
    std::vector<Outcome> chosen;
    for (const std::size_t seed : drawn) chosen.insert(chosen.end(), by_seed[seed].begin(), by_seed[seed].end());
    return shares_in_view(chosen);
  });
}

std::vector<Figure> figures_of(const std::vector<Outcome>& outcomes) {
  const World still{outcomes, "still", "no change: "};
  const World changed{outcomes, "changed", "change: "};
  const std::vector<double> shares = shares_in_view(outcomes);
  const std::vector<Certainty> certainties = certainties_in_view(outcomes);
  return {
      still.mean("scans with r_d > 0", "positive_r_d", "paper: none (Fig. 3)"),
      still.extreme("largest r_d", "most_r_d", 1.0, "paper: below 0, drawn as 0 (Fig. 3)"),
      still.mean("w_avg, median", "median_w_avg"),
      still.extreme("least w_avg", "least_w_avg", 0.0, "paper: steady (Fig. 2a)"),
      still.mean("Δ-phases begun in a lap", "phases", "paper: 0"),
      still.mean("scans stored in a lap", "stored_scans"),
      changed.mean("scans with a change in view", "in_view"),
      changed.mean("scans with r_d > 0", "positive_r_d"),
      {"change: scans with r_d > 0 with the change in view", shares[0], "", {}, "paper: all (Fig. 4)", certainties[0]},
      changed.mean("scans with r_d > 0 with none in view", "positive_elsewhere", "paper: none"),
      changed.extreme("largest r_d", "most_r_d", 1.0, "paper: above 0 (Fig. 4)"),
      changed.mean("w_avg, median with the change in view", "median_w_avg_in_view"),
      changed.extreme("least w_avg", "least_w_avg", 0.0, "paper: sudden falls (Fig. 2b)"),
      changed.mean("Δ-phases begun in a lap", "phases"),
      changed.mean("scans stored in a lap", "stored_scans"),
      {"scans with a change in view that r_d tells, 2 % false alarms", shares[1], "", {}, "", certainties[1]},
      {"scans with the change in view that beams tell (evidence), no more false alarms",
       shares[2],
       "",
       {},
       "",
       certainties[2]}};
}

Series drawn(const ScanTable& scans, const std::string& column, const std::string& name, double least) {
  Series series{name, {}};
  const std::vector<double> time_s = scans.column("t_s");
  const std::vector<double> values = scans.column(column);
  const std::size_t every = std::max<std::size_t>(1, values.size() / kMostPoints);
  for (std::size_t i = 0; i < values.size(); i += every) {
    series.points.emplace_back(time_s[i], std::max(least, values[i]));
  }
  return series;
}

Chart averages(const Outcome& outcome, const std::string& title) {
  Chart chart{title, "time, s", "", {}};
  for (const char* column : {"w_avg", "w_fast", "w_slow"}) {
    chart.series.push_back(drawn(outcome.scans, column, column, -1.0));
  }
  chart.series.push_back(drawn(outcome.scans, "r_d", "r_d, at least 0", 0.0));
  if (outcome.label("world") == "changed") {
    chart.series.push_back(drawn(outcome.scans, "differing_share", "beams that see it", 0.0));
  }
  return chart;
}

Report report_of(const std::vector<Outcome>& outcomes) {
  Report report;
  report.figures = figures_of(outcomes);
  Chart figure2{"Figure 2: w_avg without and with a change", "time, s", "w_avg", {}};
  const std::string first_seed = outcomes.front().label("seed");
  for (const Outcome& outcome : outcomes) {
    if (outcome.label("seed") != first_seed) continue;
    const bool changes = outcome.label("world") == "changed";
    figure2.series.push_back(drawn(outcome.scans, "w_avg", changes ? "change" : "no change", 0.0));
    report.charts.push_back(
        averages(outcome, changes ? "Figure 4: a tenth of the hall has changed" : "Figure 3: nothing has changed"));
  }
  report.charts.insert(report.charts.begin(), std::move(figure2));
  return report;
}

}  // namespace

Experiment fig2_4_experiment() {
  return {.name = "fig2-4",
          .what = "Figures 2 to 4 of the paper: w_avg, w_fast, w_slow and r_d on a lap with and without a change",
          .runs = runs_of,
          .report = report_of};
}

}  // namespace deltamap::experiments
