// SPDX-License-Identifier: Apache-2.0
// `deltamap map film STORE OUT.png`: a run as an animated PNG: the robot on its way, and the map that follows.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "daemon/maps/png_bytes.hpp"
#include "mapping/store/map_store.hpp"
#include "simulation/score/trajectory_score.hpp"
#include "tool/output_file.hpp"
#include "tool/picture/animated_png.hpp"
#include "tool/picture/scene.hpp"
#include "tool/subcommands.hpp"

namespace deltamap::tool {
namespace {

using simulation::score::StampedPose;

constexpr int kLastFrame_ms = 2500;  // so that the end can be looked at
constexpr std::size_t kPathPoints = 400;

struct FilmOptions {
  std::string store;
  std::string png;
  std::string trajectory;
  int frames = 60;
  int frame_ms = 120;
  int scale = 0;
};

struct Step {
  Timestamp time;
  std::uint32_t revision;
};

/// M_0 from the beginning, each revision from its time on.
std::vector<Step> steps_of(const mapping::store::MapStore& store) {
  std::vector<Step> steps;
  for (const auto& revision : store.history()) {
    if (!revision.refused) steps.push_back({revision.time, revision.number});
  }
  return steps;
}

/// The newest at that time. Those of a run before count too. M_0 where none was ever accepted.
std::uint32_t revision_at(const std::vector<Step>& steps, Timestamp time) {
  std::uint32_t newest = steps.empty() ? 0 : steps.front().revision;
  for (const Step& step : steps) {
    if (step.time <= time) newest = step.revision;
  }
  return newest;
}

std::string title(std::uint32_t revision, double passed_s, double whole_s) {
  const auto clock = [](double time_s) {
    const int s = static_cast<int>(time_s);
    char text[32];
    (void)std::snprintf(text, sizeof text, "%d:%02d", s / 60, s % 60);
    return std::string{text};
  };
  return "M" + std::to_string(revision) + ", " + clock(passed_s) + " of " + clock(whole_s) + " min";
}

/// Up to that pose, thinned.
std::vector<Point2> path_to(const std::vector<StampedPose>& poses, std::size_t last) {
  std::vector<Point2> path;
  const std::size_t every = last / kPathPoints + 1;
  for (std::size_t i = 0; i < last; i += every) path.push_back(poses[i].map_from_robot.position());
  path.push_back(poses[last].map_from_robot.position());
  return path;
}

void film(const FilmOptions& options) {
  require_png(options.png);
  require_output_beside(options.png, options.store);
  const auto store = mapping::store::MapStore::to_read(options.store);
  if (!store.damage().empty()) std::cerr << "deltamap: " << store.damage() << "; the file is left as it is\n";
  const std::vector<Step> steps = steps_of(store);
  const bool has_changed = std::any_of(steps.begin(), steps.end(), [](const Step& step) { return step.revision > 0; });
  if (!has_changed) std::cerr << "deltamap: " << options.store << ": no revision was accepted; the film shows M_0\n";
  const std::vector<StampedPose> poses = simulation::score::read_trajectory(options.trajectory);
  if (poses.empty()) throw std::runtime_error(options.trajectory + ": holds no pose");
  const Timestamp began = poses.front().time;
  const double whole_s = seconds(poses.back().time - began);
  std::uint32_t number = revision_at(steps, began);
  const OccupancyGrid first = store.grid(number);
  const CellBox shown = picture::known_part(store.grid(revision_at(steps, poses.back().time)), &first);
  OccupancyGrid map = first;
  std::vector<picture::Frame> frames;
  for (int i = 0; i < options.frames; ++i) {
    const double passed_s = whole_s * i / std::max(1, options.frames - 1);
    const Timestamp now = began + duration_from_seconds(passed_s);
    const auto next = std::upper_bound(poses.begin(), poses.end(), now,
                                       [](Timestamp time, const StampedPose& pose) { return time < pose.time; });
    const auto at = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, next - poses.begin() - 1));
    if (const std::uint32_t newest = revision_at(steps, now); newest != number) {
      number = newest;
      map = store.grid(number);
    }
    picture::Scene scene{.map = map, .before = &first};
    scene.robot = poses[at].map_from_robot;
    scene.path = path_to(poses, at);
    scene.title = title(number, passed_s, whole_s);
    scene.shown = shown;
    scene.cell_pixels = options.scale;
    frames.push_back({drawn(scene), i + 1 < options.frames ? options.frame_ms : kLastFrame_ms});
  }
  daemon::write_bytes(picture::animated_png(frames), options.png);
}

}  // namespace

void add_map_film(CLI::App& map) {
  auto options = std::make_shared<FilmOptions>();
  CLI::App* command = map.add_subcommand("film", "draw a run as an animated PNG: the robot's way, and the map's");
  command->add_option("STORE", options->store, "map store (SQLite) of the run")->required();
  command->add_option("PNG", options->png, "picture to write")->required();
  command->add_option("--trajectory", options->trajectory, "trajectory.tum of the run")->required();
  command->add_option("--frames", options->frames, "pictures, evenly over the run")->check(CLI::Range(2, 500));
  command->add_option("--frame-ms", options->frame_ms, "how long each is shown")->check(CLI::Range(20, 5000));
  command->add_option("--scale", options->scale, "pixels a cell; as fits a page where it is not given")
      ->check(CLI::Range(1, 16));
  command->callback([options] { film(*options); });
}

}  // namespace deltamap::tool
