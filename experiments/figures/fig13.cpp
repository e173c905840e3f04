// SPDX-License-Identifier: Apache-2.0
// `fig13`: the paper's real test (§5, Figure 13) in a simulated room: boxes are taken out of an obstacle one after
// another and put back to where they were. The map must lose them, and then be again what it was.
#include <algorithm>
#include <cmath>

#include "experiments/drive/first_map.hpp"
#include "experiments/drive/mapping_drive.hpp"
#include "experiments/drive/room_changes.hpp"
#include "experiments/registry.hpp"
#include "experiments/report/svg_map.hpp"
#include "experiments/watch/mapping_run.hpp"
#include "experiments/watch/mapping_watch.hpp"
#include "simulation/scenario/start_map.hpp"
#include "simulation/score/map_score.hpp"

namespace deltamap::experiments {
namespace {

namespace score = simulation::score;

constexpr double kWhole_min = 14.0;  // of the schedule as it stands in RoomChangesParams
constexpr double kComfort_m = 0.55;  // the room's passages are 1.4 m wide
constexpr double kMaxRange_m = 32.0;
constexpr std::uint64_t kBoxes = 311;  // whose chance draws them

/// From corner to corner, past every obstacle.
std::vector<Point2> round_of_the_room() { return {{9.2, 3.2}, {9.2, 0.8}, {0.8, 0.8}, {0.8, 3.2}}; }

RoomChangesParams schedule(double minutes) {
  RoomChangesParams params;
  const double share = minutes / kWhole_min;
  params.settle_s *= share;
  params.every_s *= share;
  params.look_s *= share;
  return params;
}

/// The cells whose state `map` knows.
score::CellMask known_cells(const OccupancyGrid& map) {
  score::CellMask known(map.geometry().cell_count(), 0);
  for_each_known(map, [&](Cell cell, CellState) { known[map.geometry().index_of(cell)] = 1; });
  return known;
}

struct Likeness {
  double same = 0.0;       ///< share of the cells known in the first that are the same
  double differing = 0;    ///< cells known in the first that are not the same
  double inside = 0;       ///< cells unknown in the first that are occupied
  double free_inside = 0;  ///< the same that are free
  score::MapScore score;
};

Likeness likeness(const OccupancyGrid& first, const OccupancyGrid& map) {
  Likeness like;
  double known = 0.0;
  for (std::size_t i = 0; i < first.geometry().cell_count(); ++i) {
    const CellState before = first[first.geometry().cell_of(i)];
    const CellState now = map[first.geometry().cell_of(i)];
    if (before == CellState::kUnknown) {
      like.inside += now == CellState::kOccupied ? 1.0 : 0.0;
      like.free_inside += now == CellState::kFree ? 1.0 : 0.0;
      continue;
    }
    known += 1.0;
    like.differing += before == now ? 0.0 : 1.0;
  }
  like.same = 1.0 - like.differing / known;
  like.score = score::map_score(first, map, known_cells(first));
  return like;
}

/// The state of affairs when all boxes had gone.
struct Emptied {
  OccupancyGrid map;
  OccupancyGrid truth;
};

std::vector<Picture> pictures_of(const std::string& method, const OccupancyGrid& first,
                                 const std::optional<Emptied>& emptied, const OccupancyGrid& restored) {
  std::vector<Picture> pictures;
  pictures.push_back({"The first map", svg_of_map(first)});
  if (emptied) {
    pictures.push_back(
        {method + ": the map without the boxes; blue: in it and not in the room, orange: in the room alone",
         svg_of_difference(emptied->map, emptied->truth)});
  }
  pictures.push_back(
      {method + ": the map with the boxes back; blue: not in the first map, orange: in the first map alone",
       svg_of_difference(restored, first)});
  return pictures;
}

simulation::VirtualDriveParams drive_params(std::uint64_t seed) {
  simulation::VirtualDriveParams params;
  params.seed = seed;
  params.max_range_m = kMaxRange_m;
  params.route.round = round_of_the_room();
  params.route.comfort_m = kComfort_m;
  return params;
}

/// Drives until all boxes are back; answers how it was when all had gone.
std::optional<Emptied> drive_through(MappingDrive& drive, MappingWatch& watch, RoomChanges changes, const Point2& start,
                                     const GridGeometry& geometry) {
  std::optional<Emptied> emptied;
  for (double passed_s = 0.0; !changes.is_over(passed_s);) {
    if (!emptied && changes.is_emptied(passed_s)) {
      emptied = Emptied{drive.map(), simulation::surveyed_map(drive.drive().world(), start, geometry)};
    }
    const auto change = changes.due(passed_s, drive.drive());
    if (change) drive.drive().change(*change);
    Mapped scan = drive.next();
    if (change) scan.changes.push_back(*change);
    passed_s = scan.passed_s;
    watch.observe(scan, drive.map());
  }
  return emptied;
}

std::vector<std::pair<std::string, double>> numbers_of(const OccupancyGrid& first, const Emptied& emptied,
                                                       const OccupancyGrid& restored) {
  const score::CellMask room = known_cells(emptied.truth);
  const score::MapScore gone = score::map_score(emptied.truth, emptied.map, room);
  const score::MapScore stale = score::map_score(emptied.truth, first, room);
  const Likeness back = likeness(first, restored);
  return {{"emptied_f1", gone.contour_f1},
          {"emptied_f1_stale", stale.contour_f1},
          {"emptied_skill", score::skill(gone.contour_f1, stale.contour_f1, 1.0)},
          {"emptied_acceptance", gone.acceptance},
          {"emptied_wrong_m2", gone.wrong_m2},
          {"restored_same", back.same},
          {"restored_differing_cells", back.differing},
          {"restored_cells_inside", back.inside},
          {"restored_free_inside", back.free_inside},
          {"restored_f1", back.score.contour_f1},
          {"restored_acceptance", back.score.acceptance},
          {"restored_wrong_m2", back.score.wrong_m2}};
}

Outcome take_out_and_put_back(const simulation::Scenario& scenario, const daemon::Settings& settings,
                              const std::string& method, std::uint64_t seed, double minutes) {
  const auto first = first_map(scenario);
  MappingDrive drive{scenario, drive_params(seed), settings, {first}};
  MappingWatch watch{scenario, first, {.range_m = kMaxRange_m}};
  const std::optional<Emptied> emptied =
      drive_through(drive, watch, RoomChanges{schedule(minutes), scenario, Random{kBoxes + seed}},
                    scenario.robot.map_from_start.position(), first->geometry());
  Outcome outcome;
  outcome.labels = {{"method", method}, {"seed", std::to_string(seed)}};
  outcome.numbers = numbers_of(*first, *emptied, drive.map());
  for (const auto& number : watch.numbers(drive.map())) outcome.numbers.push_back(number);
  outcome.pictures = pictures_of(method, *first, emptied, drive.map());
  return outcome;
}

std::vector<Run> runs_of(const Options& options) {
  const auto scenario = scenario_of(options, "room.yaml");
  const double minutes = options.minutes.value_or(options.quick ? 6.0 : kWhole_min);
  std::vector<Run> runs;
  for (const std::string method : {"evidence", "paper"}) {
    for (const std::uint64_t seed : options.seeds(10)) {
      runs.push_back({method + "-seed" + std::to_string(seed), [=, settings = settings_of(options, method)] {
                        return take_out_and_put_back(*scenario, settings, method, seed, minutes);
                      }});
    }
  }
  return runs;
}

std::vector<double> numbers(const std::vector<Outcome>& outcomes, const std::string& method, const char* name) {
  std::vector<double> values;
  for (const Outcome& outcome : outcomes) {
    if (outcome.label("method") == method && !std::isnan(outcome.number(name))) values.push_back(outcome.number(name));
  }
  return values;
}

void add_figures(Report& report, const std::vector<Outcome>& outcomes, const std::string& method) {
  const bool ours = method == "evidence";
  const auto add = [&](const std::string& what, const char* name, double rank, const std::string& unit,
                       std::optional<Target> target, const std::string& peers = "") {
    const std::vector<double> values = numbers(outcomes, method, name);
    const double value = rank < 0.0 ? mean_of(values) : quantile(values, rank);
    report.figures.push_back({method + ": " + what, value, unit, ours ? target : std::nullopt, peers,
                              rank < 0.0 ? certainty_of_mean(values) : certainty_of_extreme(values)});
  };
  constexpr double kMean = -1.0;
  constexpr double kLeast = 0.0;
  constexpr double kMost = 1.0;
  const std::string by_eye = "paper: by visual inspection";
  add("boxes gone, contour F1 against the truth, mean", "emptied_f1", kMean, "", std::nullopt, by_eye);
  add("boxes gone, contour F1 of the first map against the truth, mean", "emptied_f1_stale", kMean, "", std::nullopt);
  add("boxes gone, skill: 0 is the first map, 1 the truth; mean", "emptied_skill", kMean, "", std::nullopt);
  add("boxes gone, skill: 0 is the first map, 1 the truth; worst", "emptied_skill", kLeast, "", std::nullopt);
  add("boxes back, contour F1 against the first map, mean", "restored_f1", kMean, "", std::nullopt, by_eye);
  add("boxes back, contour F1 against the first map, worst", "restored_f1", kLeast, "", Target{.least = 0.99});
  add("boxes back, acceptance against the first map, worst", "restored_acceptance", kLeast, "", Target{.least = 0.99});
  add("boxes back, cells that are as they were, worst", "restored_same", kLeast, "", std::nullopt);
  add("boxes back, cells that are not, mean", "restored_differing_cells", kMean, "", std::nullopt);
  add("boxes back, wrong beside no neighbour, most", "restored_wrong_m2", kMost, "m²", Target{.most = 0.05});
  add("boxes back, occupied where nobody can see, mean", "restored_cells_inside", kMean, "", std::nullopt);
  add("boxes back, free where nobody can see, mean", "restored_free_inside", kMean, "", std::nullopt);
  add("changes seen for 10 s that were followed", "recall", kMean, "", Target{.least = 0.98});
  add("until followed, median, of being in view", "follow_median_s", kMean, "s", Target{.most = 8.0});
  add("error of position, mean", "error_mean_m", kMean, "m", std::nullopt);
  add("revisions a run", "revisions", kMean, "", std::nullopt);
  add("refused Δ-phases a run", "refused", kMean, "", std::nullopt);
}

Report report_of(const std::vector<Outcome>& outcomes) {
  Report report;
  TextTable table{"Runs",
                  {"method", "seed", "boxes gone: F1", "stale F1", "boxes back: F1", "cells that differ", "wrong m²",
                   "revisions", "refused"},
                  {}};
  for (const std::string method : {"evidence", "paper"}) {
    if (numbers(outcomes, method, "restored_f1").empty()) continue;  // not asked for
    add_figures(report, outcomes, method);
    bool is_first = true;
    for (const Outcome& outcome : outcomes) {
      if (outcome.label("method") != method) continue;
      std::vector<std::string> row{method, outcome.label("seed")};
      for (const char* number : {"emptied_f1", "emptied_f1_stale", "restored_f1", "restored_differing_cells",
                                 "restored_wrong_m2", "revisions", "refused"})
        row.push_back(text_of(outcome.number(number)));
      table.rows.push_back(std::move(row));
      const auto from = outcome.pictures.begin() + (report.pictures.empty() ? 0 : 1);  // the first map once
      if (is_first) report.pictures.insert(report.pictures.end(), from, outcome.pictures.end());
      is_first = false;
    }
  }
  report.tables.push_back(std::move(table));
  return report;
}

}  // namespace

Experiment fig13_experiment() {
  return {.name = "fig13",
          .what = "Figure 13 of the paper: a room of 10 by 4 m, four boxes of an obstacle taken away and put back",
          .runs = runs_of,
          .report = report_of};
}

}  // namespace deltamap::experiments
