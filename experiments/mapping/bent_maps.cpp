// SPDX-License-Identifier: Apache-2.0
// `bent-maps`: maps of known truth, good ones and others that were bent on purpose, judged by `map quality`. Buildings,
// lasers and people are those of `unseen`, two drives each.
#include <cmath>
#include <string>

#include "experiments/mapping/bent_drive.hpp"
#include "experiments/mapping/calm_drives.hpp"
#include "experiments/mapping/unseen_drive.hpp"
#include "experiments/pooled_runs.hpp"
#include "experiments/registry.hpp"
#include "experiments/seed_summary.hpp"
#include "localization/motion/odometry_buffer.hpp"
#include "mapping/alignment/local_map.hpp"
#include "simulation/drawn/unseen_world.hpp"
#include "surveying/quality/map_quality.hpp"

namespace deltamap::experiments {
namespace {

constexpr int kSeeds = 20;
constexpr int kQuickSeeds = 2;
constexpr double kMinutes = 8.0;  // both drives together
constexpr double kQuickMinutes = 4.0;
constexpr double kKeptM = 0.25;
constexpr double kKeptRad = radians(8.0);
constexpr double kResolutionM = 0.05;
// Between these a map is neither good nor worth calling false: noise draws a decimetre of wall twice.
constexpr double kGoodDoubledM = 1.0;
constexpr double kFalseDoubledM = 3.0;
constexpr double kLeastShare = 0.98;

DrivenScans driven_scans(std::uint64_t seed, double minutes, const localization::LocalizerParams& localizer) {
  localization::motion::OdometryBuffer odometry{localizer.odometry};
  DrivenScans driven;
  std::uint32_t number = 0;
  const auto take = [&](const simulation::DriveStep& now) {
    for (const Odometry& one : now.odometry) odometry.add(one);
  };
  const auto keep = [&](simulation::DriveStep&& now) {
    take(now);
    if (!driven.truth.empty() && driven.drive.back() == number) {
      const Pose2 moved = motion_between(driven.truth.back(), now.map_from_robot);
      if (moved.position().norm() < kKeptM && std::abs(moved.theta) < kKeptRad) return;
    }
    driven.scans.emplace_back(now.scan, odometry.velocity_at(now.scan.time),
                              driven.scans.empty() ? nullptr : &driven.scans.back());
    driven.drive.push_back(number);
    driven.truth.push_back(now.map_from_robot);
  };
  drive_calmly(seed, minutes, {.step = keep, .begin_second = [&](simulation::DriveStep&& now) {
                                 take(now);
                                 number = 1;
                               }});
  return driven;
}

surveying::quality::MapQuality quality_of(const DrivenScans& driven, const std::vector<Pose2>& poses) {
  TrackedScan unpacked;
  const mapping::alignment::ScanSource scan_at = [&](std::size_t k) -> const TrackedScan& {
    unpacked = driven.scans[k].tracked();
    return unpacked;
  };
  return surveying::quality::map_quality(mapping::alignment::local_map(scan_at, poses, {0, 0, kResolutionM, {0.0, 0.0}},
                                                                       {.longest_m = 25.0, .least_hits = 2}),
                                         placed_at(driven, poses));
}

/// A scale error is false however little of it two passes happen to see.
bool is_false(Bend bend, double doubled_m) { return bend == Bend::kScale || doubled_m >= kFalseDoubledM; }
bool is_good(Bend bend, double doubled_m) { return bend != Bend::kScale && doubled_m <= kGoodDoubledM; }

Outcome judged(std::uint64_t seed, double minutes, const Options& options) {
  const DrivenScans driven = driven_scans(seed, minutes, options.localizer);
  Random random{seed};
  Outcome outcome;
  outcome.labels = {{"seed", std::to_string(seed)},
                    {"layout", std::string{name_of(simulation::drawn::unseen_kind(seed).layout)}}};
  double bent_maps = 0.0;
  double called_false = 0.0;
  double good_maps = 0.0;
  double called_good = 0.0;
  std::string missed;
  for (const Bend bend : kBends) {
    const std::vector<Pose2> poses = bent(bend, driven, random);
    const double doubled_m = doubled_wall_m(driven, poses);
    const bool told = quality_of(driven, poses).is_false();
    bent_maps += is_false(bend, doubled_m) ? 1.0 : 0.0;
    called_false += is_false(bend, doubled_m) && told ? 1.0 : 0.0;
    good_maps += is_good(bend, doubled_m) ? 1.0 : 0.0;
    called_good += is_good(bend, doubled_m) && !told ? 1.0 : 0.0;
    if ((is_false(bend, doubled_m) && !told) || (is_good(bend, doubled_m) && told)) {
      missed += (missed.empty() ? "" : ", ") + std::string{name_of(bend)};
    }
  }
  outcome.labels.emplace_back("missed", missed);
  outcome.numbers = {
      {"bent", bent_maps}, {"called_false", called_false}, {"good", good_maps}, {"called_good", called_good}};
  return outcome;
}

std::vector<Run> runs_of(const Options& options) {
  return unseen_runs(options, {kSeeds, kQuickSeeds, kMinutes, kQuickMinutes},
                     [options](std::uint64_t seed, double minutes) { return judged(seed, minutes, options); });
}

Report report_of(const std::vector<Outcome>& outcomes) {
  const std::vector<const Outcome*> runs = runs_with(outcomes, {});
  constexpr Ratio called_false{"called_false", "bent"};
  constexpr Ratio called_good{"called_good", "good"};
  Report report;
  report.figures = {sum_of_runs("bent maps", runs, "bent"),
                    ratio_of_runs("of them called false", runs, called_false, Target{.least = kLeastShare}),
                    sum_of_runs("good maps", runs, "good"),
                    ratio_of_runs("of them called good", runs, called_good, Target{.least = kLeastShare})};
  report.charts.push_back(
      ratios_in_order("maps called what they are, share",
                      {{"bent ones called false", called_false}, {"good ones called good", called_good}}, runs));
  return report;
}

}  // namespace

Experiment bent_maps_experiment() {
  return {.name = "bent-maps",
          .what = "Maps that were bent on purpose, and good ones: are they called so?",
          .runs = runs_of,
          .report = report_of};
}

}  // namespace deltamap::experiments
