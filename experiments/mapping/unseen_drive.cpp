// SPDX-License-Identifier: Apache-2.0
#include "experiments/mapping/unseen_drive.hpp"

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "daemon/settings/settings.hpp"
#include "experiments/watch/watched_drive.hpp"
#include "simulation/drawn/unseen_world.hpp"

namespace deltamap::experiments {
namespace {

using simulation::drawn::UnseenKind;

constexpr std::uint64_t kFirstFinal = 1000;  // below: for development
constexpr std::uint64_t kLastFinal = 1059;

/// "180/0.5 8m 12.5Hz"
std::string laser_text(const UnseenKind& kind) {
  return drivers::lms200::name_of(kind.fan) + " " + text_of(kind.range_m) + "m " +
         text_of(std::round(10.0 / kind.scan_period_s) / 10.0) + "Hz";
}

std::string map_text(const UnseenKind& kind) {
  std::string text = kind.from_first_drive ? "first drive" : "exact";
  if (kind.outdated_share > 0.0) text += " " + text_of(std::round(100.0 * kind.outdated_share)) + "% outdated";
  return text;
}

void add_kind(Outcome& outcome, const UnseenKind& kind, std::uint64_t seed) {
  outcome.labels.insert(outcome.labels.begin(), {{"seed", std::to_string(seed)},
                                                 {"layout", std::string{name_of(kind.layout)}},
                                                 {"laser", laser_text(kind)},
                                                 {"map", map_text(kind)},
                                                 {"start", kind.knows_start ? "given" : "global"}});
  const std::vector<std::pair<std::string, double>> drawn{
      {"resolution_m", kind.resolution_m},
      {"outdated_share", kind.outdated_share},
      {"range_noise_m", kind.range_noise_m},
      {"mount_off_m", kind.told_from_true_mount.position().norm()},
      {"mount_off_deg", degrees(kind.told_from_true_mount.theta)},
      {"speed_m_per_s", kind.speed_m_per_s},
      {"wheel_scale", kind.wheels.scale},
      {"wheel_turn", kind.wheels.turn},
      {"wheel_drift_deg_per_m", degrees(kind.wheels.drift_rad_per_m)},
      {"wheel_noise_m_per_sqrt_m", kind.wheel_noise_m_per_sqrt_m},
      {"odometry_lag_s", kind.odometry_lag_s},
      {"people", kind.people.all},
      {"changes_per_min", kind.changes_per_min}};
  outcome.numbers.insert(outcome.numbers.end(), drawn.begin(), drawn.end());
}

}  // namespace

void expect_one_set(std::uint64_t first, std::uint64_t last) {
  const bool is_development = first >= 1 && last < kFirstFinal;
  const bool is_final = first >= kFirstFinal && last <= kLastFinal;
  if (is_development || is_final) return;
  throw daemon::SettingsError("--seed " + std::to_string(first) + " with " + std::to_string(last - first + 1) +
                              " seeds: 1 to 999 for development and 1000 to 1059 for final figures alone");
}

std::vector<Run> unseen_runs(const Options& options, const UnseenRuns& usual,
                             const std::function<Outcome(std::uint64_t seed, double minutes)>& drive) {
  const auto seeds =
      static_cast<std::uint64_t>(options.repeats.value_or(options.quick ? usual.quick_seeds : usual.seeds));
  const double minutes = options.minutes.value_or(options.quick ? usual.quick_minutes : usual.minutes);
  expect_one_set(options.seed, options.seed + seeds - 1);
  std::vector<Run> runs;
  for (std::uint64_t seed = options.seed; seed < options.seed + seeds; ++seed) {
    runs.push_back({"seed" + std::to_string(seed), [=] { return drive(seed, minutes); }});
  }
  return runs;
}

Outcome unseen_drive(std::uint64_t seed, double minutes, const localization::LocalizerParams& localizer,
                     const daemon::MappingSettings& mapping) {
  const UnseenKind kind = simulation::drawn::unseen_kind(seed);
  simulation::drawn::UnseenWorld world = simulation::drawn::unseen_world(kind, seed);
  WatchedRun run{world.drawn.scenario,
                 world.drawn.drive,
                 std::make_shared<const OccupancyGrid>(std::move(world.first_map)),
                 {},
                 minutes,
                 kind.knows_start};
  run.settings.localizer = localizer;
  run.settings.mapping = mapping;
  Outcome outcome = watched_drive(run);
  add_kind(outcome, kind, seed);
  return outcome;
}

}  // namespace deltamap::experiments
