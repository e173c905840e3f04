// SPDX-License-Identifier: Apache-2.0
// `deltamap score`: what a run is worth (score_runs), or what the daemon made of a simulation, changes of the map
// included. `score relations`: score_relations.cpp.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iomanip>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>

#include "core/counted.hpp"
#include "simulation/score/change_score.hpp"
#include "simulation/score/trajectory_score.hpp"
#include "tool/scenario_place.hpp"
#include "tool/score/score_runs.hpp"
#include "tool/subcommands.hpp"
#include "tool/told_grid.hpp"

namespace deltamap::tool {
namespace {

namespace score = simulation::score;
using Json = nlohmann::ordered_json;

struct ScoreOptions {
  tune::TuningOptions runs;
  std::filesystem::path truth;
  std::string world;
  std::filesystem::path trajectory;
  std::filesystem::path map;
  std::filesystem::path start_map;
  double range_m = 0.0;
  int face_beams = score::ChangeScoreParams{}.face_beams;
  bool json = false;
};

struct Tally {
  std::size_t eligible = 0;
  std::size_t found = 0;

  /// Nothing where there was nothing to find.
  [[nodiscard]] std::optional<double> recall() const {
    if (eligible == 0) return std::nullopt;
    return static_cast<double>(found) / static_cast<double>(eligible);
  }
};

/// Of new faces, or of faces that are gone.
Tally tally(const score::ChangeScore& changes, bool appears) {
  Tally counted;
  for (const auto& change : changes.changes) {
    if (change.appears != appears) continue;
    counted.eligible += change.is_eligible ? 1 : 0;
    counted.found += change.is_found ? 1 : 0;
  }
  return counted;
}

Json json_of_change(const score::ScoredChange& change, Timestamp start) {
  return {{"t_s", seconds(change.time - start)},
          {"kind", simulation::name_of(change.kind)},
          {"part", change.appears ? "appeared" : "gone"},
          {"id", change.id},
          {"at", {change.box.centre.x(), change.box.centre.y()}},
          {"seen_s", change.seen_s},
          {"overtaken", change.is_overtaken},
          {"visible_cells", change.visible_cells},
          {"right_cells", change.right_cells},
          {"eligible", change.is_eligible},
          {"found", change.is_found}};
}

Json json_of_score(const score::TrajectoryScore& trajectory, const score::ChangeScore& changes, Timestamp start) {
  const Tally all{changes.eligible, changes.found};
  const auto json_of_tally = [](const Tally& t) {
    const auto recall = t.recall();
    return Json{{"found", t.found}, {"eligible", t.eligible}, {"recall", recall ? Json(*recall) : Json(nullptr)}};
  };
  Json json;
  json["localization"] = {{"poses", trajectory.poses},
                          {"median_m", trajectory.median_m},
                          {"p95_m", trajectory.p95_m},
                          {"max_m", trajectory.max_m},
                          {"share_beyond_0.5_m", trajectory.share_beyond_half_metre},
                          {"median_heading_deg", degrees(trajectory.median_heading_rad)}};
  json["changes"] = json_of_tally(all);
  json["changes"]["appeared"] = json_of_tally(tally(changes, true));
  json["changes"]["gone"] = json_of_tally(tally(changes, false));
  json["ghosts"] = {{"m2", changes.ghosts_m2}, {"stale_m2", changes.stale_ghosts_m2}};
  json["each_change"] = Json::array();
  for (const auto& change : changes.changes) json["each_change"].push_back(json_of_change(change, start));
  return json;
}

/// "changes found: 12 of 13 seen for 10 s (92.3 %); …"
std::string changes_line(const score::ChangeScore& changes) {
  const Tally all{changes.eligible, changes.found};
  const Tally appeared = tally(changes, true);
  const Tally gone = tally(changes, false);
  std::ostringstream line;
  line << std::fixed << std::setprecision(1);
  if (const auto recall = all.recall()) {
    line << "changes found: " << all.found << " of " << all.eligible << " seen for 10 s (" << 100.0 * *recall
         << " %); appeared " << appeared.found << "/" << appeared.eligible << ", gone " << gone.found << "/"
         << gone.eligible;
  } else {
    line << "changes found: nothing to score, since no change was seen for 10 s";
  }
  line << "; not seen or overtaken: " << changes.changes.size() - all.eligible;
  return line.str();
}

void print_score(const score::TrajectoryScore& trajectory, const score::ChangeScore& changes) {
  std::cout << std::fixed << std::setprecision(3) << "localization: median " << trajectory.median_m << " m, p95 "
            << trajectory.p95_m << " m, max " << trajectory.max_m << " m, beyond 0.5 m " << std::setprecision(1)
            << 100.0 * trajectory.share_beyond_half_metre << " % of " << counted(trajectory.poses, "pose") << "\n"
            << changes_line(changes) << '\n'
            << std::setprecision(2) << "ghosts: " << changes.ghosts_m2 << " m², of which " << changes.stale_ghosts_m2
            << " m² stand since the start map\n";
}

void run_score(const ScoreOptions& options) {
  const simulation::Scenario scenario = simulation::read_scenario(scenario_file(options.world));
  const simulation::Truth truth = simulation::read_truth(options.truth);
  const auto trajectory = score::trajectory_score(score::read_trajectory(options.trajectory), truth);
  if (trajectory.poses == 0) {
    throw std::runtime_error(options.trajectory.string() + ": no pose lies within the time of " +
                             options.truth.string());
  }
  score::ChangeScoreParams params;
  params.range_m = options.range_m > 0.0 ? options.range_m : scenario.laser.max_range_m;
  params.face_beams = options.face_beams;
  const auto changes =
      score::change_score(scenario, truth, told_grid(options.start_map), told_grid(options.map), params);
  if (options.json) {
    std::cout << json_of_score(trajectory, changes, truth.poses.front().time).dump(2) << '\n';
  } else {
    print_score(trajectory, changes);
  }
}

/// With a scenario the map's changes are scored, too; that needs all of these.
void score_simulation(ScoreOptions& options) {
  const auto one = [](const std::vector<std::string>& given, const char* option) {
    if (given.size() != 1) throw CLI::RequiredError(option);
    return given.front();
  };
  options.truth = one(options.runs.truths, "--truth");
  options.map = one(options.runs.maps, "--map");
  options.json = options.runs.as_json;
  if (options.trajectory.empty()) throw CLI::RequiredError("--trajectory");
  if (options.start_map.empty()) throw CLI::RequiredError("--start-map");
  run_score(options);
}

void add_simulation_options(CLI::App& command, ScoreOptions& options) {
  const std::string group = "A simulation and its map: with --truth, --map";
  command
      .add_option("--world", options.world,
                  "the scenario that was simulated: a YAML file, or the name of a delivered one")
      ->group(group);
  command.add_option("--trajectory", options.trajectory, "TUM file")->group(group);
  command.add_option("--start-map", options.start_map, "the map at the start (YAML)")->group(group);
  command.add_option("--range", options.range_m, "how far the robot sees, m (default: the scenario's laser)")
      ->check(CLI::PositiveNumber)
      ->group(group);
  command.add_option("--face-beams", options.face_beams, "beams of one scan that make a face seen (default 3)")
      ->check(CLI::PositiveNumber)
      ->group(group);
}

}  // namespace

void add_score(CLI::App& app) {
  auto options = std::make_shared<ScoreOptions>();
  CLI::App& command = *app.add_subcommand("score", "what runs are worth: against the true way, or without any");
  command.add_option("RUN", options->runs.recordings, "folders of runs, or recordings, which are replayed");
  command.add_option("--config", options->runs.config, "settings of the replays; as delivered where it is not given");
  command.add_option("--seeds", options->runs.seeds, "each recording with seeds 1 to N (default 4)")
      ->check(CLI::Range(1, 10000));
  tune::add_tuning_options(command, options->runs);
  add_simulation_options(command, *options);
  add_score_relations(command);
  CLI::App& relations = *command.get_subcommand("relations");
  for (CLI::Option* option : command.get_options()) {
    if (option != command.get_help_ptr()) relations.excludes(option);  // its own come after its name
  }
  command.callback([options, &command] {
    if (!command.get_subcommands().empty()) return;
    if (!options->world.empty()) return score_simulation(*options);
    if (options->runs.recordings.empty()) throw CLI::RequiredError("a folder of a run, or a recording, or --world");
    tune::score_runs(options->runs);
  });
}

}  // namespace deltamap::tool
