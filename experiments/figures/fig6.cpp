// SPDX-License-Identifier: Apache-2.0
// `fig6`: the paper's Figure 6 (§3.2.1): N_eff (Eq. 5) while the robot goes straight past changes, turns on the spot
// where nothing has changed, and follows a winding path; and the scans that store-scan rejects for it.
#include <algorithm>
#include <array>
#include <cmath>

#include "experiments/drive/first_map.hpp"
#include "experiments/drive/lived_in.hpp"
#include "experiments/drive/localizer_variants.hpp"
#include "experiments/drive/mapping_drive.hpp"
#include "experiments/pooled_runs.hpp"
#include "experiments/registry.hpp"
#include "mapping/paper/delta_phase.hpp"

namespace deltamap::experiments {
namespace {

constexpr double kTurning_rad_per_s = 0.1;  // beyond this a scan of any path counts as taken while turning
constexpr double kSettle_s = 5.0;           // before the first scan that counts
constexpr double kChangedShare = 0.25;      // of the containers

constexpr const char* kWinding = "winding";

struct Path {
  const char* name;
  std::vector<Point2> round;
  std::optional<double> turn_rad_per_s;  // on the spot, in place of the round
  bool changes = false;
  double minutes = 1.0;
  const char* published = "";
};

/// Straight: along the hall's wall, about 29 m, and no farther than a minute takes it.
const std::array<Path, 6>& paths() {
  static const std::vector<Point2> straight{{33.0, 2.5}};
  static const std::vector<Point2> winding{{17.5, 2.5},  {17.5, 17.5}, {32.5, 17.5}, {32.5, 32.5},
                                           {17.5, 32.5}, {17.5, 17.5}, {2.5, 17.5},  {2.5, 2.5}};
  static const std::array<Path, 6> all{{{"straight", straight, {}, false, 0.85, ""},
                                        {"past-changes", straight, {}, true, 0.85, "paper: high (Fig. 6, blue)"},
                                        {"turning-0.4", {}, 0.4, false, 0.85, "paper: low (Fig. 6, red)"},
                                        {"turning-0.8", {}, 0.8, false, 0.85, "paper: low (Fig. 6, red)"},
                                        {"turning-1.6", {}, 1.6, false, 0.85, "paper: low (Fig. 6, red)"},
                                        {kWinding, winding, {}, false, 4.0, "paper: falls in turns (Fig. 6, black)"}}};
  return all;
}

ScanTable empty_table() { return ScanTable{{"t_s", "n_eff_share", "turn_rate_rad_per_s", "tracking"}}; }

std::vector<std::pair<std::string, double>> numbers_of(const ScanTable& scans) {
  const double gate = mapping::paper::DeltaPhaseParams{}.least_n_eff_share;
  const std::vector<double> shares = scans.column("n_eff_share");
  const std::vector<double> rates = scans.column("turn_rate_rad_per_s");
  std::vector<double> turning;
  std::vector<double> straight;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    (std::abs(rates[i]) > kTurning_rad_per_s ? turning : straight).push_back(shares[i]);
  }
  const auto below = [&](const std::vector<double>& values) { return 1.0 - share_above(values, gate); };
  return {{"scans", static_cast<double>(scans.rows())},
          {"n_eff_share", mean_of(shares)},
          {"p5_n_eff_share", quantile(shares, 0.05)},
          {"rejected", below(shares)},
          {"turning_scans", static_cast<double>(turning.size())},
          {"turning_n_eff_share", mean_of(turning)},
          {"turning_rejected", below(turning)},
          {"straight_n_eff_share", mean_of(straight)},
          {"straight_rejected", below(straight)},
          {"tracking", mean_of(scans.column("tracking"))}};
}

Outcome follow(const simulation::Scenario& scenario, const LocalizerVariant& variant, const Path& path,
               std::uint64_t seed, double minutes) {
  simulation::VirtualDriveParams drive;
  drive.seed = seed;
  drive.route.round = path.round;
  localization::LocalizerParams params = variant.params;
  params.follow_surfaces = false;  // N_eff is the particles'; where surfaces lead they rest
  MappingDrive pair{scenario, drive, localizer_alone(params), {first_map(scenario)}};
  if (path.changes) (void)pair.drive().change_many(kChangedShare, busy_forklift(1.0));
  if (path.turn_rad_per_s) pair.drive().hold({.turn_rate_rad_per_s = *path.turn_rad_per_s});
  const double settle_s = std::min(kSettle_s, 0.5 * 60.0 * minutes);
  Outcome outcome;
  outcome.scans = empty_table();
  for (double passed_s = 0.0; passed_s < 60.0 * minutes;) {
    const Mapped scan = pair.next();
    passed_s = scan.passed_s;
    if (passed_s < settle_s) continue;
    outcome.scans.add({passed_s, scan.estimate.n_eff / scan.estimate.particles, scan.tracked.turn_rate_rad_per_s,
                       scan.estimate.state == LocalizerState::kTracking ? 1.0 : 0.0});
  }
  outcome.labels = {{"localizer", variant.name}, {"path", path.name}, {"seed", std::to_string(seed)}};
  outcome.numbers = numbers_of(outcome.scans);
  return outcome;
}

std::vector<Run> runs_of(const Options& options) {
  const auto scenario = scenario_of(options, "hall.yaml");
  std::vector<Run> runs;
  for (const LocalizerVariant& variant : localizer_variants(options.localizer)) {
    for (const Path& path : paths()) {
      for (const std::uint64_t seed : options.seeds(5)) {
        const double minutes = options.minutes.value_or(options.quick ? 0.5 * path.minutes : path.minutes);
        runs.push_back({variant.name + "-" + path.name + "-seed" + std::to_string(seed),
                        [=, &path] { return follow(*scenario, variant, path, seed, minutes); }});
      }
    }
  }
  return runs;
}

void add_figures(Report& report, const std::string& variant, const Path& path, const PooledRuns& all) {
  const std::string where = variant + ", " + path.name + ": ";
  report.figures.push_back(all.figure(where + "N_eff / particles", "n_eff_share", "", {}, path.published));
  report.figures.push_back(all.figure(where + "rejected by the gate", "rejected"));
  if (std::string{path.name} != kWinding) return;
  for (const std::string part : {"turning", "straight"}) {
    const std::string of_scans = where + (part == "turning" ? "in turns" : "between turns");
    report.figures.push_back(all.figure(of_scans + ", N_eff / particles", part + "_n_eff_share"));
    report.figures.push_back(all.figure(of_scans + ", rejected by the gate", part + "_rejected"));
  }
}

Report report_of(const std::vector<Outcome>& outcomes) {
  Report report;
  const std::string first_seed = outcomes.front().label("seed");
  for (const std::string variant : {"500x60", "delivered"}) {
    Chart chart{"Figure 6, " + variant, "time, s", "N_eff / particles", {}};
    for (const Path& path : paths()) {
      const PooledRuns all{runs_with(outcomes, {{"localizer", variant}, {"path", path.name}}), numbers_of};
      if (all.empty()) continue;  // not asked for
      add_figures(report, variant, path, all);
      for (const Outcome* outcome : all.runs()) {
        if (outcome->label("seed") != first_seed) continue;
        Series series{path.name, {}};
        const std::vector<double> time_s = outcome->scans.column("t_s");
        const std::vector<double> share = outcome->scans.column("n_eff_share");
        for (std::size_t i = 0; i < share.size(); ++i) series.points.emplace_back(time_s[i], share[i]);
        chart.series.push_back(std::move(series));
      }
    }
    if (!chart.series.empty()) report.charts.push_back(std::move(chart));
  }
  return report;
}

}  // namespace

Experiment fig6_experiment() {
  return {
      .name = "fig6",
      .what = "Figure 6 of the paper: N_eff straight past changes, turning and on a winding path, and what it rejects",
      .runs = runs_of,
      .report = report_of};
}

}  // namespace deltamap::experiments
