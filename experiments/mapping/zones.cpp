// SPDX-License-Identifier: Apache-2.0
// `zones`: worlds of `unseen` with zones about some of what stands there. Frozen ones while everything goes on around
// them: is any cell within written? And ignored ones in which the map has everything half a metre off: is the pose as
// good as by the right map? Each beside the same drive without zones.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "core/random.hpp"
#include "experiments/drive/mapping_drive.hpp"
#include "experiments/mapping/unseen_drive.hpp"
#include "experiments/pooled_runs.hpp"
#include "experiments/registry.hpp"
#include "experiments/seed_summary.hpp"
#include "experiments/watch/mapping_run.hpp"
#include "simulation/drawn/unseen_world.hpp"

namespace deltamap::experiments {
namespace {

using simulation::drawn::UnseenKind;
using simulation::drawn::UnseenWorld;

constexpr UnseenRuns kZoneRuns{60, 2, 20.0, 3.0};
constexpr int kZones = 6;
constexpr double kLeastSideM = 2.0;
constexpr double kMostSideM = 6.0;
constexpr double kMovedM = 0.5;  // along both axes
constexpr double kMostWorse = 1.10;

/// Squares about things that the map knows.
Zones drawn_zones(const OccupancyGrid& map, ZoneKind kind, std::uint64_t seed) {
  std::vector<Point2> things;
  for (std::size_t i = 0; i < map.geometry().cell_count(); ++i) {
    const Cell cell = map.geometry().cell_of(i);
    if (map[cell] == CellState::kOccupied) things.push_back(map.geometry().centre_of(cell));
  }
  Random random{seed};
  Zones zones;
  while (!things.empty() && zones.size() < kZones) {
    const Point2& middle = things[random.index_below(static_cast<std::uint32_t>(things.size()))];
    const double half_m = 0.5 * random.uniform(kLeastSideM, kMostSideM);
    const double low_x = middle.x() - half_m, high_x = middle.x() + half_m;
    const double low_y = middle.y() - half_m, high_y = middle.y() + half_m;
    zones.push_back({.id = std::to_string(zones.size()),
                     .kind = kind,
                     .polygon = {{low_x, low_y}, {high_x, low_y}, {high_x, high_y}, {low_x, high_y}}});
  }
  return zones;
}

/// What the map has within the zones lies elsewhere; what it has beyond their edges does not come in.
OccupancyGrid with_all_moved(const OccupancyGrid& map, const Zones& zones) {
  const ZonedGround ground{zones, {ZoneKind::kIgnore}};
  const int cells = static_cast<int>(std::lround(kMovedM / map.resolution_m()));
  OccupancyGrid moved = map;
  for (std::size_t i = 0; i < map.geometry().cell_count(); ++i) {
    const Cell cell = map.geometry().cell_of(i);
    if (!ground.covers(map.geometry().centre_of(cell))) continue;
    const Cell from{cell.column - cells, cell.row - cells};
    const bool comes_from_within = ground.covers(map.geometry().centre_of(from));
    moved.set(cell, comes_from_within ? map.at(from) : CellState::kFree);
  }
  return moved;
}

struct Written {
  std::size_t inside = 0;  ///< cells that ever were other than in the first map
  std::size_t outside = 0;
};

/// With `zones` or, to see what they keep away, without them.
Written written(const UnseenWorld& world, double minutes, const daemon::Settings& settings, bool knows_start,
                const Zones& zones, bool are_in_force) {
  const auto first = std::make_shared<const OccupancyGrid>(world.first_map);
  daemon::StartMap start{.map = first};
  if (are_in_force) start.site = std::make_shared<const daemon::Site>(daemon::Site{{}, zones});
  MappingDrive drive{world.drawn.scenario, world.drawn.drive, settings, start, knows_start};
  const ZonedGround ground{zones, {ZoneKind::kFrozen}};
  std::vector<bool> is_written(first->geometry().cell_count(), false);
  for (double passed_s = 0.0; passed_s < 60.0 * minutes;) {
    const Mapped scan = drive.next();
    passed_s = scan.passed_s;
    if (!scan.update || !scan.update->revision) continue;
    const OccupancyGrid& map = *scan.update->revision->map;
    for (std::size_t i = 0; i < is_written.size(); ++i) {
      const Cell cell = first->geometry().cell_of(i);
      const Cell now = map.geometry().cell_at(first->geometry().centre_of(cell));  // it may have grown
      if (map.at(now) != (*first)[cell]) is_written[i] = true;
    }
  }
  Written all;
  for (std::size_t i = 0; i < is_written.size(); ++i) {
    if (!is_written[i]) continue;
    const bool is_inside = ground.covers(first->geometry().centre_of(first->geometry().cell_of(i)));
    ++(is_inside ? all.inside : all.outside);
  }
  return all;
}

/// Of the pose by a map that is not written, m.
double rms_error_m(const UnseenWorld& world, double minutes, const localization::LocalizerParams& localizer,
                   const daemon::StartMap& start) {
  MappingDrive drive{world.drawn.scenario, world.drawn.drive, localizer_alone(localizer), start};
  double sum_m2 = 0.0;
  double scans = 0.0;
  for (double passed_s = 0.0; passed_s < 60.0 * minutes; ++scans) {
    const Mapped scan = drive.next();
    passed_s = scan.passed_s;
    sum_m2 += error_of(scan).position.squaredNorm();
  }
  return std::sqrt(sum_m2 / scans);
}

Outcome zones_outcome(std::uint64_t seed, double minutes, const Options& options) {
  const UnseenKind kind = simulation::drawn::unseen_kind(seed);
  const UnseenWorld world = simulation::drawn::unseen_world(kind, seed);
  const daemon::Settings settings = settings_of(options, "evidence");
  const Zones frozen = drawn_zones(world.first_map, ZoneKind::kFrozen, seed);
  const Written with = written(world, minutes, settings, kind.knows_start, frozen, true);
  const Written without = written(world, minutes, settings, kind.knows_start, frozen, false);

  const Zones ignored = drawn_zones(world.first_map, ZoneKind::kIgnore, seed);
  const auto right = std::make_shared<const OccupancyGrid>(world.first_map);
  const auto moved = std::make_shared<const OccupancyGrid>(with_all_moved(world.first_map, ignored));
  const auto site = std::make_shared<const daemon::Site>(daemon::Site{{}, ignored});
  const double right_m = rms_error_m(world, minutes, options.localizer, {.map = right});
  const double ignored_m = rms_error_m(world, minutes, options.localizer, {.map = moved, .site = site});
  const double moved_m = rms_error_m(world, minutes, options.localizer, {.map = moved});
  Outcome outcome;
  outcome.labels = {{"seed", std::to_string(seed)}, {"layout", std::string{name_of(kind.layout)}}};
  outcome.numbers = {{"frozen_written", static_cast<double>(with.inside)},
                     {"written_beside", static_cast<double>(with.outside)},
                     {"written_without", static_cast<double>(without.inside)},
                     {"right_map_m", right_m},
                     {"moved_ignored_m", ignored_m},
                     {"moved_m", moved_m},
                     {"ignored_to_right", ignored_m / right_m},
                     {"moved_to_right", moved_m / right_m}};
  return outcome;
}

std::vector<Run> zones_runs(const Options& options) {
  return unseen_runs(options, kZoneRuns,
                     [options](std::uint64_t seed, double minutes) { return zones_outcome(seed, minutes, options); });
}

Figure median_of_worlds(const std::string& name, const std::vector<Outcome>& outcomes, const char* number,
                        const std::optional<Target>& target = {}) {
  std::vector<double> values;
  for (const Outcome& outcome : outcomes) values.push_back(outcome.number(number));
  return {name, spread_of(values, Better::kLess).median, "", target, "", certainty_of_quantile(values, 0.5)};
}

Report zones_report(const std::vector<Outcome>& outcomes) {
  const std::vector<const Outcome*> runs = runs_with(outcomes, {});
  Report report;
  report.figures = {
      sum_of_runs("cells written within frozen zones", runs, "frozen_written", Target{.most = 0.0}),
      sum_of_runs("the same ground without zones", runs, "written_without"),
      sum_of_runs("cells written beside frozen zones", runs, "written_beside"),
      median_of_worlds("RMSE where all in ignored zones has moved, to that by the right map, median of the worlds",
                       outcomes, "ignored_to_right", Target{.most = kMostWorse}),
      median_of_worlds("the same without zones", outcomes, "moved_to_right"),
      count_of_seeds("worlds in which ignored zones are better than none", outcomes, [](const Outcome& outcome) {
        return outcome.number("moved_ignored_m") < outcome.number("moved_m");
      })};
  report.charts.push_back(ratios_in_order("RMSE to that by the right map",
                                          {{"what has moved is ignored", {"moved_ignored_m", "right_map_m"}},
                                           {"without zones", {"moved_m", "right_map_m"}}},
                                          runs));
  TextTable table{"Each world", {"seed", "layout"}, {}};
  for (const auto& [name, value] : outcomes.front().numbers) table.columns.push_back(name);
  for (const Outcome& outcome : outcomes) {
    std::vector<std::string> row{outcome.label("seed"), outcome.label("layout")};
    for (const auto& [name, value] : outcome.numbers) row.push_back(text_of(value));
    table.rows.push_back(std::move(row));
  }
  report.tables.push_back(std::move(table));
  return report;
}

}  // namespace

Experiment zones_experiment() {
  return {.name = "zones",
          .what = "Frozen zones in a world that changes, and ignored zones whose map is wrong",
          .runs = zones_runs,
          .report = zones_report};
}

}  // namespace deltamap::experiments
