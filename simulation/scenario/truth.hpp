// SPDX-License-Identifier: Apache-2.0
// What truly happened in a simulation: where the robot was and what the fork-lift changed. Written as JSON lines while
// it runs, read back for scoring.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

#include "core/geometry/pose2.hpp"
#include "core/time.hpp"
#include "simulation/changes/change.hpp"
#include "simulation/movers/movers.hpp"
#include "simulation/robot/collision_watch.hpp"

namespace deltamap::simulation {

struct TruthPose {
  Timestamp time;
  Pose2 map_from_robot;
  double odom_speed_m_per_s = 0.0;  ///< by the wheels' encoders
  bool at_scan = false;             ///< the moment of a sent scan's first beam
};

struct TruthChange {
  Timestamp time;
  Change change;
};

/// No change of the map: an actor that stands or has gone on, a door that is shut or no longer is.
struct TruthEvent {
  Timestamp time;
  MoverEvent event;
};

using TruthRecord = std::variant<TruthPose, TruthChange, TruthEvent, Collision>;

struct Truth {
  std::string world;  ///< the scenario's file
  std::uint64_t seed = 0;
  std::vector<TruthPose> poses;       ///< in order of time
  std::vector<TruthChange> changes;   ///< in order of time
  std::vector<TruthEvent> events;     ///< in order of time
  std::vector<Collision> collisions;  ///< in order of time
};

/// The first line: {"world": ..., "seed": ...}.
[[nodiscard]] std::string truth_header(const std::string& world, std::uint64_t seed);
/// {"t_ns": ..., "pose": [x, y, theta], "odom_v": ...} or {"t_ns": ..., "change": {"kind", "id", "box", "from"}}; a box
/// is [centre x, centre y, width, height, theta], radians. Or {"t_ns": ..., "mover": {"kind", "index", "box"}}, its
/// kind stopped, went, opened or shut. Or {"t_ns": ..., "collision": {"with", "speed", "pose"}}, with an object's id,
/// -1 for what moves. Without the line's end.
[[nodiscard]] std::string truth_line(const TruthRecord& record);

/// A last line that was cut short is left out. Throws std::runtime_error naming file and line.
[[nodiscard]] Truth read_truth(const std::filesystem::path& file);

/// Where the robot was; the nearest end outside of the recorded time. There must be poses.
[[nodiscard]] Pose2 pose_at(const Truth& truth, Timestamp time);

}  // namespace deltamap::simulation
