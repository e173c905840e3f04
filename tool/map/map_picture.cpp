// SPDX-License-Identifier: Apache-2.0
// `deltamap map picture MAP OUT.png`: a map for people, with what has changed in it and where the robot is.
#include <CLI/CLI.hpp>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "core/files/grid_file.hpp"
#include "core/geometry/angle.hpp"
#include "daemon/maps/png_bytes.hpp"
#include "simulation/score/trajectory_score.hpp"
#include "tool/output_file.hpp"
#include "tool/picture/scene.hpp"
#include "tool/subcommands.hpp"
#include "tool/told_grid.hpp"

namespace deltamap::tool {
namespace {

using picture::Scene;

struct PictureOptions {
  std::string map;
  std::string before;
  std::string png;
  std::vector<double> pose;  // x, y in m, heading in degrees
  std::string trajectory;
  std::string scan;
  std::string title;
  int scale = 0;
};

/// The robot is at its end.
void add_path(Scene& scene, const std::string& tum_file) {
  scene.path.emplace();
  for (const auto& stamped : simulation::score::read_trajectory(tum_file)) {
    scene.path->push_back(stamped.map_from_robot.position());
    scene.robot = stamped.map_from_robot;
  }
}

/// As /api/scan answers it. The robot is where it was taken.
void add_scan_from(Scene& scene, const std::string& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error(file + ": cannot be read");
  try {
    const auto json = nlohmann::json::parse(in);
    const auto& pose = json.at("pose");
    scene.robot = Pose2{pose.at("x_m"), pose.at("y_m"), pose.at("heading_rad")};
    for (const auto& end : json.at("ends_m")) {
      scene.scan_ends.push_back(*scene.robot * Point2{end.at(0).get<double>(), end.at(1).get<double>()});
    }
  } catch (const nlohmann::json::exception& error) {
    throw std::runtime_error(file + ": is no scan as /api/scan tells it: " + error.what());
  }
}

void draw(const PictureOptions& options) {
  require_png(options.png);
  require_output_beside(options.png, options.map);
  require_output_beside(options.png, picture_named_in(options.map));
  const OccupancyGrid map = told_grid(options.map);
  const OccupancyGrid before = options.before.empty() ? OccupancyGrid{} : told_grid(options.before);
  Scene scene{.map = map};
  if (!options.before.empty()) scene.before = &before;
  scene.title = options.title;
  scene.cell_pixels = options.scale;
  if (!options.trajectory.empty()) add_path(scene, options.trajectory);
  if (!options.scan.empty()) add_scan_from(scene, options.scan);
  if (!options.pose.empty()) scene.robot = Pose2{options.pose[0], options.pose[1], radians(options.pose[2])};
  picture::Raster raster;
  try {
    raster = drawn(scene);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(options.png + ": cannot be drawn: " + error.what());
  }
  daemon::write_bytes(daemon::png_of(raster.width, raster.height, raster.rgb), options.png);
}

}  // namespace

void add_map_picture(CLI::App& map) {
  auto options = std::make_shared<PictureOptions>();
  CLI::App* command = map.add_subcommand("picture", "draw a map as a PNG, with scale bar and legend");
  command->add_option("MAP", options->map, "map_server YAML")->required();
  command->add_option("PNG", options->png, "picture to write")->required();
  command->add_option("--before", options->before, "an earlier map of the same place: what has changed is coloured");
  command->add_option("--pose", options->pose, "the robot: X,Y,DEG in m and degrees")->delimiter(',')->expected(3);
  command->add_option("--trajectory", options->trajectory, "path, as trajectory.tum; the robot is at its end");
  command->add_option("--scan", options->scan, "a scan and its pose, as /api/scan answers");
  command->add_option("--title", options->title, "a line above the map (ASCII)");
  command->add_option("--scale", options->scale, "pixels a cell; as fits a page where it is not given")
      ->check(CLI::Range(1, 16));
  command->callback([options] { draw(*options); });
}

}  // namespace deltamap::tool
