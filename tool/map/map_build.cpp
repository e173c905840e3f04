// SPDX-License-Identifier: Apache-2.0
// `deltamap map build`: the first map of a building from recordings of the drives through it.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <iostream>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "core/counted.hpp"
#include "core/files/grid_file.hpp"
#include "core/files/replace_file.hpp"
#include "daemon/settings/settings.hpp"
#include "daemon/steps/survey_step.hpp"
#include "surveying/slam/drawn_map.hpp"
#include "tool/map/quality_report.hpp"
#include "tool/output_file.hpp"
#include "tool/recorded_messages.hpp"
#include "tool/subcommands.hpp"

namespace deltamap::tool {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct BuildOptions {
  std::vector<std::string> files;  // recordings, and the map last
  std::string config;
  std::vector<std::string> overrides;
  std::string trajectory;
  std::string picture;
  double resolution_m = 0.05;
  bool keep_frame = false;
  bool force = false;
  bool json = false;

  [[nodiscard]] std::vector<std::string> recordings() const { return {files.begin(), files.end() - 1}; }
  [[nodiscard]] const std::string& map() const { return files.back(); }
};

struct SurveyedDrive {
  std::string recording;
  std::size_t scans = 0;
  drivers::port::LogFaults faults{};
};

SurveyedDrive surveyed(const std::string& recording, const daemon::Settings& settings, daemon::SurveyStep& survey) {
  SurveyedDrive drive{recording};
  survey.begin_drive();
  const daemon::RecordingDecoder::Sinks sinks{[&](Odometry&& odometry, std::uint32_t) { survey.observe(odometry); },
                                              [&](Scan&& scan) { survey.observe(std::move(scan)); }};
  drive.faults = read_messages(recording, settings, sinks, "surveying " + fs::path{recording}.filename().string());
  drive.scans = survey.end_drive();
  if (drive.scans == 0) {
    const std::vector<std::string> lines = drive.faults.lines();
    throw std::runtime_error((lines.empty() ? recording : lines.front()) + ": no scan for which odometry is known");
  }
  return drive;
}

/// No recording counts twice, and nothing is written over what is read or over another output.
void require_files_apart(const BuildOptions& options) {
  std::vector<std::string> read = options.recordings();
  for (auto file = read.begin(); file != read.end(); ++file) {
    if (std::find(read.begin(), file, *file) != file) throw std::runtime_error(*file + ": given twice");
  }
  if (!options.config.empty()) read.push_back(options.config);
  std::vector<std::string> outputs{options.map(), fs::path{options.map()}.replace_extension(".pgm").string()};
  const auto place = [](const std::string& file) { return fs::weakly_canonical(file); };
  for (const std::string& other : {options.trajectory, options.picture}) {
    if (other.empty()) continue;
    for (const std::string& output : outputs) {
      if (place(other) != place(output)) continue;
      const bool is_of_map = &output - outputs.data() < 2;
      throw std::runtime_error(other + (is_of_map ? ": is a file of the map; give another name" : ": given twice"));
    }
    outputs.push_back(other);
  }
  for (const std::string& output : outputs) {
    for (const std::string& file : read) require_output_beside(output, file);
  }
}

/// Nothing is written of drives that hang together by guesswork.
void require_joined(const std::vector<SurveyedDrive>& drives, const surveying::slam::Slam& slam) {
  for (std::uint32_t i = 0; i < drives.size(); ++i) {
    if (slam.is_joined(i)) continue;
    throw std::runtime_error(
        drives[i].recording +
        ": not found in what the drives before it have seen, or in several places of it; let it go "
        "for 30 m where they have been, or leave it out");
  }
}

void write_trajectory(const std::string& file, const daemon::SurveyStep& survey, const Pose2& map_from_survey) {
  std::string lines;
  for (const daemon::TrajectoryPoint& point : survey.trajectory()) {
    lines += daemon::tum_line({point.time, map_from_survey * point.map_from_robot});
  }
  replace_file(file, lines);
}

/// "x,y,deg", as --initial-pose takes it.
std::string pose_text(const Pose2& pose) {
  const auto rounded = [](double value, double unit) { return std::round(value / unit) * unit + 0.0; };  // no "-0"
  std::ostringstream text;
  text << std::fixed << std::setprecision(3) << rounded(pose.x, 1e-3) << ',' << rounded(pose.y, 1e-3) << ','
       << std::setprecision(2) << rounded(degrees(pose.theta), 1e-2);
  return text.str();
}

/// Where each drive went.
Json drives_as_json(const std::vector<SurveyedDrive>& drives, const surveying::slam::Survey& survey,
                    const Pose2& map_from_survey) {
  Json json = Json::array();
  std::uint32_t node = 0;
  for (std::uint32_t i = 0; i < drives.size(); ++i) {
    while (survey.keyframes[node].drive != i) ++node;
    const std::uint32_t last = surveying::slam::on_by(survey, node, std::numeric_limits<double>::infinity());
    json.push_back({{"recording", drives[i].recording},
                    {"scans", drives[i].scans},
                    {"keyframes", last - node + 1},
                    {"driven_m", survey.keyframes[last].driven_m},
                    {"start", pose_text(map_from_survey * survey.poses[node])},
                    {"end", pose_text(map_from_survey * survey.poses[last])}});
  }
  return json;
}

Json built_as_json(const std::string& map, const std::vector<SurveyedDrive>& drives, const surveying::slam::Slam& slam,
                   const Pose2& map_from_survey, const OccupancyGrid& grid,
                   const surveying::quality::MapQuality& quality) {
  const surveying::slam::Survey& survey = slam.survey();
  return {{"map", map},
          {"width", grid.width()},
          {"height", grid.height()},
          {"resolution_m", grid.resolution_m()},
          {"occupied_cells", count_of(grid, CellState::kOccupied)},
          {"free_cells", count_of(grid, CellState::kFree)},
          {"keyframes", survey.keyframes.size()},
          {"keyframes_by_odometry_alone", survey.keyframes.size() - drives.size() - slam.matched()},
          {"loops",
           std::count_if(survey.links.begin(), survey.links.end(), [](const auto& link) { return link.may_drop; })},
          {"loops_contradicted", slam.loops().contradicted()},
          {"quality", Json::parse(quality_as_json(quality))},
          {"drives", drives_as_json(drives, survey, map_from_survey)}};
}

void print_built(const Json& built) {
  std::cout << built["map"].get<std::string>() << ": " << built["width"] << " x " << built["height"] << " cells of "
            << built["resolution_m"].get<double>() << " m, from "
            << counted(built["keyframes"].get<std::uint64_t>(), "keyframe") << " ("
            << built["keyframes_by_odometry_alone"] << " placed by odometry alone) and "
            << counted(built["loops"].get<std::uint64_t>(), "loop") << "\n";
  for (const Json& drive : built["drives"]) {
    std::cout << drive["recording"].get<std::string>() << ": " << counted(drive["scans"].get<std::uint64_t>(), "scan")
              << ", " << std::fixed << std::setprecision(1) << drive["driven_m"].get<double>() << " m, from "
              << drive["start"].get<std::string>() << " to " << drive["end"].get<std::string>() << " (x,y,deg)\n";
  }
  if (built["loops"] == 0) std::cout << "no place was seen twice: where the way was long the map may be bent\n";
}

surveying::quality::MapQuality quality_of(const surveying::slam::Survey& survey, const Pose2& map_from_survey,
                                          const OccupancyGrid& grid) {
  std::vector<surveying::quality::PlacedScan> scans;
  for (const std::uint32_t node : survey.joined_nodes()) {
    const surveying::slam::Keyframe& keyframe = survey.keyframes[node];
    scans.push_back({&keyframe.scan, map_from_survey * survey.poses[node], keyframe.drive});
  }
  return surveying::quality::map_quality(grid, scans);
}

void run_build(const BuildOptions& options) {
  require_files_apart(options);
  const daemon::Settings settings = daemon::settings_or_defaults(options.config, options.overrides);
  daemon::SurveyStep step{settings};
  std::vector<SurveyedDrive> drives;
  for (const std::string& recording : options.recordings()) drives.push_back(surveyed(recording, settings, step));
  if (!step.finish()) throw std::runtime_error(options.recordings().front() + ": what was measured does not settle");
  for (const SurveyedDrive& drive : drives) {
    for (const std::string& line : drive.faults.lines()) std::cerr << "deltamap: warning: " << line << '\n';
  }
  require_joined(drives, step.slam());
  const surveying::slam::Survey& survey = step.slam().survey();
  const Pose2 map_from_survey{0.0, 0.0, options.keep_frame ? 0.0 : surveying::slam::turn_to_axes(survey)};
  const OccupancyGrid grid = surveying::slam::drawn_map(survey, map_from_survey, options.resolution_m);
  if (count_of(grid, CellState::kFree) == 0) {
    throw std::runtime_error(drives.front().recording + ": no scan has a valid range");
  }
  const surveying::quality::MapQuality quality = quality_of(survey, map_from_survey, grid);
  if (!options.picture.empty()) draw_quality(grid, quality, options.picture);
  if (!options.trajectory.empty()) write_trajectory(options.trajectory, step, map_from_survey);
  const bool is_written = !quality.is_false() || options.force;
  if (is_written) write_grid(grid, options.map());
  Json built = built_as_json(options.map(), drives, step.slam(), map_from_survey, grid, quality);
  built["written"] = is_written;
  if (options.json) {
    std::cout << built.dump(2) << '\n';
  } else {
    print_built(built);
  }
  for (const std::string& line : quality_lines(quality)) {
    if (quality.is_false() || !options.json) (quality.is_false() ? std::cerr : std::cout) << line << '\n';
  }
  if (!is_written) {
    throw std::runtime_error(options.map() +
                             ": not written, the map is false; drive on where it is wrong and give all " +
                             "recordings, or write it anyway by --force");
  }
}

}  // namespace

void add_map_build(CLI::App& map) {
  auto options = std::make_shared<BuildOptions>();
  CLI::App& command = *map.add_subcommand("build", "the first map of a building, from recordings of drives through it");
  command.add_option("FILES", options->files, "REC.pcapng ... OUT.yaml: recordings, and the map to write")
      ->required()
      ->expected(2, -1);
  command.add_option("--config", options->config, "settings, YAML");
  command.add_option("--set", options->overrides, "key=value over the settings; repeatable")->allow_extra_args(false);
  command.add_option("--resolution", options->resolution_m, "side of a cell, m")
      ->check(CLI::Range(0.01, 1.0))
      ->capture_default_str();
  command.add_option("--trajectory", options->trajectory, "where every scan was taken, to write (TUM)");
  command.add_option("--picture", options->picture, "the map with a ring where it contradicts itself, to write (PNG)");
  command.add_flag("--force", options->force, "write the map even if it is false");
  command.add_flag("--keep-frame", options->keep_frame,
                   "x points to where the robot looked at first; else along most of the walls");
  command.add_flag("--json", options->json, "print the result as JSON");
  command.callback([options] {
    const fs::path ending = fs::path(options->map()).extension();
    if (ending != ".yaml" && ending != ".yml") {
      throw CLI::ValidationError("FILES", options->map() + ": the last one is the map to write and must end in .yaml");
    }
    run_build(*options);
  });
}

}  // namespace deltamap::tool
