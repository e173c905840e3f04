// SPDX-License-Identifier: Apache-2.0
// `things`: what is told of containers that come, go and are pushed aside, held against what the fork-lift did. The
// hall of Table 2, the depot, the hall of pushes, racks in which nothing changes, and unseen worlds.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "daemon/maps/stored_things.hpp"
#include "daemon/steps/thing_looks.hpp"
#include "daemon/telemetry/stage.hpp"
#include "experiments/drive/first_map.hpp"
#include "experiments/drive/mapping_drive.hpp"
#include "experiments/mapping/unseen_drive.hpp"
#include "experiments/pooled_runs.hpp"
#include "experiments/registry.hpp"
#include "experiments/seed_summary.hpp"
#include "experiments/watch/mapping_run.hpp"
#include "experiments/watch/thing_score.hpp"
#include "mapping/things/assumed.hpp"
#include "simulation/drawn/unseen_world.hpp"
#include "simulation/score/change_watch.hpp"
#include "simulation/score/map_truth.hpp"

namespace deltamap::experiments {
namespace {

constexpr double kLookEvery_s = 0.2;
constexpr int kLookBeams = 181;
constexpr int kLookFaceBeams = 3;
constexpr double kSeenForThings_s = 10.0;
constexpr double kFaceSeen_s = 3.0;  // for a change to have been seen all around
constexpr double kSolidEvery_s = 60.0;
constexpr double kThingsMinutes = 30.0;
constexpr double kQuickThingsMinutes = 5.0;

struct ThingsRun {
  simulation::Scenario scenario;
  simulation::VirtualDriveParams drive;
  std::shared_ptr<const OccupancyGrid> first;
  daemon::Settings settings;
  double minutes = kThingsMinutes;
  bool knows_start = true;
};

/// Eq. 11 with what is solid, as the map shows it and with what is assumed of things; both as sums over `looks`.
struct SolidAcceptance {
  double seen = 0.0;
  double assumed = 0.0;
  int looks = 0;
  std::size_t cells = 0;        ///< that were assumed
  std::size_t solid_cells = 0;  ///< of those: truly so

  void add(const simulation::score::MapTruth& truth, OccupancyGrid map, const std::vector<Cell>& assumed_cells) {
    const simulation::score::CellMask where = truth.seen();
    const OccupancyGrid solid = truth.solid();
    seen += simulation::score::map_score(solid, map, where).acceptance;
    for (const Cell cell : assumed_cells) {
      map.set(cell, CellState::kOccupied);
      solid_cells += solid[cell] == CellState::kOccupied ? 1 : 0;
    }
    cells += assumed_cells.size();
    assumed += simulation::score::map_score(solid, map, where).acceptance;
    ++looks;
  }
};

/// What a drive tells of things, and what is true.
struct Followed {
  std::vector<mapping::things::ThingEvent> events;
  std::vector<TrueChange> changes;
  std::size_t revisions = 0;
  std::size_t things = 0;
  std::size_t most_cell_bytes = 0;
  double cpu_s = 0.0;
  SolidAcceptance solid;
  AssumedScore assumed;
};

void add(std::vector<mapping::things::ThingEvent>& events, const std::vector<mapping::things::ThingEvent>& more) {
  events.insert(events.end(), more.begin(), more.end());
}

std::vector<simulation::Box> boxes_in(const simulation::World& world) {
  std::vector<simulation::Box> boxes;
  for (const simulation::Object& object : world.objects) {
    if (const auto* box = std::get_if<simulation::Box>(&object.shape)) boxes.push_back(*box);
  }
  return boxes;
}

Followed followed(const ThingsRun& run) {
  Followed all;
  MappingDrive drive{run.scenario, run.drive, run.settings, {run.first}, run.knows_start};
  simulation::score::ChangeWatch watch{run.scenario, run.first->geometry()};
  simulation::score::MapTruth truth{run.scenario, *run.first};
  mapping::things::Things things;
  daemon::ThingLooks thing_looks;
  double next_look_s = 0.0;
  double next_solid_s = kSolidEvery_s;
  for (double passed_s = 0.0; passed_s < 60.0 * run.minutes;) {
    const Mapped scan = drive.next();
    passed_s = scan.passed_s;
    for (const simulation::Change& change : scan.changes)
      watch.apply(change, scan.time, scan.map_from_robot.position());
    for (const simulation::MoverEvent& event : scan.events) watch.apply(event);
    if (!scan.changes.empty()) truth.see(watch.world());
    if (passed_s >= next_look_s) {
      next_look_s += kLookEvery_s;
      const Pose2 map_from_laser = scan.map_from_robot * run.scenario.laser.optics.robot_from_laser;
      const auto view = watch.view_from(map_from_laser, run.drive.max_range_m, kLookBeams, scan.about.surfaces());
      watch.look(view, kLookEvery_s, kLookFaceBeams);
      truth.touch(view);
    }
    const double began_s = daemon::thread_cpu_s();
    if (scan.update && scan.update->revision) {
      ++all.revisions;
      add(all.events, daemon::take_result(things, *scan.update));
    }
    if (thing_looks.is_due(scan.tracked, drive.pose_holds())) add(all.events, things.look(scan.tracked));
    all.cpu_s += daemon::thread_cpu_s() - began_s;
    all.most_cell_bytes = std::max(all.most_cell_bytes, things.cell_bytes());
    if (passed_s >= next_solid_s) {
      next_solid_s += kSolidEvery_s;
      all.solid.add(truth, drive.map(), mapping::things::assumed_cells(things.all(), drive.map()));
    }
  }
  all.changes = true_changes(watch.watched(), kSeenForThings_s, kFaceSeen_s);
  all.things = things.all().size();
  all.assumed = assumed_score_of(things.all(), boxes_in(watch.world()));
  return all;
}

double whole(std::size_t number) { return static_cast<double>(number); }

/// Of the changes that the score is of, under names that begin with `of`.
void add_change_numbers(Outcome& outcome, const std::string& of, const ThingScore& score) {
  const std::array<std::pair<const char*, std::size_t>, 8> numbers{{{"changes", score.changes},
                                                                    {"unfound", score.unfound},
                                                                    {"events", score.events},
                                                                    {"most_events", score.most_events},
                                                                    {"right", score.right},
                                                                    {"right_size", score.right_size},
                                                                    {"moved", score.moved},
                                                                    {"moved_right", score.moved_right}}};
  for (const auto& [name, number] : numbers) outcome.numbers.emplace_back(of + name, whole(number));
}

Outcome outcome_of(const ThingsRun& run, const std::string& world, std::uint64_t seed) {
  const Followed all = followed(run);
  const std::vector<Told> told = told_at_last(all.events, mapping::things::ThingsParams{}.one_look_s);
  const ThingScore score = score_of(told, all.changes);
  const ThingScore around = score_of(told, only_seen_all_around(all.changes));
  Outcome outcome;
  outcome.labels = {{"world", world}, {"seed", std::to_string(seed)}};
  outcome.numbers = {{"told", whole(score.told)},
                     {"told_of_nothing", whole(score.wrong)},
                     {"told_moved", whole(score.told_moved)},
                     {"wrong_pairs", whole(score.wrong_pairs)},
                     {"revisions", whole(all.revisions)},
                     {"things", whole(all.things)},
                     {"solid_looks", whole(static_cast<std::size_t>(all.solid.looks))},
                     {"solid_seen", all.solid.seen},
                     {"solid_assumed", all.solid.assumed},
                     {"assumed_cells", whole(all.solid.cells)},
                     {"assumed_solid", whole(all.solid.solid_cells)},
                     {"assumed_sides", whole(all.assumed.sides)},
                     {"assumed_right", whole(all.assumed.right)},
                     {"assumed_of_seen", whole(all.assumed.of_seen)},
                     {"minutes", run.minutes},
                     {"cell_kb", whole(all.most_cell_bytes) / 1e3},
                     {"revision_cpu_ms", all.revisions == 0 ? 0.0 : 1e3 * all.cpu_s / whole(all.revisions)}};
  add_change_numbers(outcome, "", score);
  add_change_numbers(outcome, "around_", around);
  return outcome;
}

struct ThingsWorld {
  std::string name;
  std::string scenario;
  int seeds;
};

const std::array kThingsWorlds{ThingsWorld{"hall", "hall.yaml", 3}, ThingsWorld{"depot", "depot.yaml", 3},
                               ThingsWorld{"pushes", "hall_shifts.yaml", 2}, ThingsWorld{"racks", "racks.yaml", 1}};
constexpr UnseenRuns kThingsUnseen{10, 1, kThingsMinutes, kQuickThingsMinutes};

ThingsRun unseen_things_run(std::uint64_t seed, double minutes, const Options& options) {
  const simulation::drawn::UnseenKind kind = simulation::drawn::unseen_kind(seed);
  simulation::drawn::UnseenWorld world = simulation::drawn::unseen_world(kind, seed);
  return {world.drawn.scenario,
          world.drawn.drive,
          std::make_shared<const OccupancyGrid>(std::move(world.first_map)),
          settings_of(options, "evidence"),
          minutes,
          kind.knows_start};
}

std::vector<Run> things_runs(const Options& options) {
  const double minutes = options.minutes.value_or(options.quick ? kQuickThingsMinutes : kThingsMinutes);
  std::vector<Run> runs;
  for (const ThingsWorld& world : kThingsWorlds) {
    const auto scenario = scenario_of(options, world.scenario);
    for (const std::uint64_t seed : options.seeds(world.seeds)) {
      runs.push_back({world.name + "-seed" + std::to_string(seed), [=] {
                        ThingsRun run{*scenario, {}, first_map(*scenario), settings_of(options, "evidence"), minutes};
                        run.drive.seed = seed;
                        run.drive.forklift = scenario->forklift;
                        return outcome_of(run, world.name, seed);
                      }});
    }
  }
  for (Run& run : unseen_runs(options, kThingsUnseen, [options](std::uint64_t seed, double drive_minutes) {
         return outcome_of(unseen_things_run(seed, drive_minutes, options), "unseen", seed);
       })) {
    run.name = "unseen-" + run.name;
    runs.push_back(std::move(run));
  }
  return runs;
}

constexpr Ratio kSolidSeen{"solid_seen", "solid_looks"};
constexpr Ratio kSolidAssumed{"solid_assumed", "solid_looks"};
constexpr Ratio kChangesRight{"right", "changes"};

/// Of the changes whose numbers begin with `of`.
void add_change_figures(Report& report, const std::string& world, const std::vector<const Outcome*>& of_it,
                        const std::string& which, const std::string& of) {
  const std::string changes = of + "changes";
  const std::string head = world + ": " + which + ": ";
  const auto ratio = [&](const char* name, const std::string& number, const std::string& to,
                         const std::optional<Target>& target = {}) {
    report.figures.push_back(ratio_of_runs(head + name, of_it, {number, to}, target));
  };
  report.figures.push_back(sum_of_runs(head + "changes", of_it, changes));
  ratio("events a change, mean", of + "events", changes, Target{.most = 1.1});
  report.figures.push_back(
      most_of_runs(head + "events of one change, most", of_it, of + "most_events", Target{.most = 3.0}));
  ratio("changes of which nothing was told", of + "unfound", changes);
  ratio("kind and place right", of + "right", changes, Target{.least = 0.97});
  ratio("of those: both sides within 0.15 m", of + "right_size", of + "right", Target{.least = 0.9});
  ratio("moved things told as moved", of + "moved_right", of + "moved", Target{.least = 0.9});
}

void add_figures(Report& report, const std::string& world, const std::vector<const Outcome*>& of_it) {
  const auto ratio = [&](const char* name, const Ratio& of, const std::optional<Target>& target = {}) {
    report.figures.push_back(ratio_of_runs(world + ": " + name, of_it, of, target));
  };
  const auto sum = [&](const char* name, const char* number, const std::optional<Target>& target = {}) {
    report.figures.push_back(sum_of_runs(world + ": " + name, of_it, number, target));
  };
  ratio("events told that belong to no change, an hour", {"told_of_nothing", "minutes", 60.0});
  ratio("revisions an hour", {"revisions", "minutes", 60.0});
  ratio("solid acceptance, as the map shows it", kSolidSeen);
  ratio("solid acceptance, with what is assumed", kSolidAssumed,
        world == "hall" ? std::optional{Target{.least = 0.985}} : std::nullopt);
  ratio("assumed cells that are solid", {"assumed_solid", "assumed_cells"});
  ratio("assumed sides within 0.15 m at the end", {"assumed_right", "assumed_sides"});
  sum("assumed sides of what was seen all around", "assumed_of_seen", Target{.most = 0.0});
  if (std::all_of(of_it.begin(), of_it.end(), [](const Outcome* run) { return run->number("changes") == 0.0; })) return;
  add_change_figures(report, world, of_it, "seen for 10 s", "");
  add_change_figures(report, world, of_it, "seen all around", "around_");
  ratio("events \"moved\" that were none", {"wrong_pairs", "told"}, Target{.most = 0.02});
}

TextTable table_of_runs(const std::vector<Outcome>& outcomes) {
  constexpr std::array kColumns{"changes",   "unfound",         "events",        "most_events",
                                "right",     "right_size",      "moved",         "moved_right",
                                "told",      "told_of_nothing", "told_moved",    "wrong_pairs",
                                "revisions", "things",          "assumed_sides", "assumed_right"};
  TextTable table{"Each run", {"world", "seed"}, {}};
  table.columns.insert(table.columns.end(), kColumns.begin(), kColumns.end());
  for (const Outcome& outcome : outcomes) {
    std::vector<std::string> row{outcome.label("world"), outcome.label("seed")};
    for (const char* column : kColumns) row.push_back(text_of(outcome.number(column)));
    table.rows.push_back(std::move(row));
  }
  return table;
}

Report things_report(const std::vector<Outcome>& outcomes) {
  Report report;
  for (const std::string world : {"hall", "depot", "pushes", "racks", "unseen"}) {
    if (const auto of_it = runs_with(outcomes, {{"world", world}}); !of_it.empty()) add_figures(report, world, of_it);
  }
  const std::vector<const Outcome*> all = runs_with(outcomes, {});
  report.figures.push_back(most_of_runs("processor a revision, most", all, "revision_cpu_ms", {}, "ms"));
  report.figures.push_back(most_of_runs("cells that are followed, most", all, "cell_kb", Target{.most = 3000.0}, "kB"));
  report.charts.push_back(ratios_in_order("of all worlds, share",
                                          {{"solid acceptance, as the map shows it", kSolidSeen},
                                           {"solid acceptance, with what is assumed", kSolidAssumed},
                                           {"changes: kind and place right", kChangesRight}},
                                          all));
  report.tables.push_back(table_of_runs(outcomes));
  return report;
}

}  // namespace

Experiment things_experiment() {
  return {.name = "things",
          .what = "Containers that come, go and are pushed aside: told once, rightly, in their size?",
          .runs = things_runs,
          .report = things_report,
          .times = Experiment::Times::kThread};
}

}  // namespace deltamap::experiments
