// SPDX-License-Identifier: Apache-2.0
// The live page's messages (docs/api.md), from what the stages have shown.
#pragma once

#include <optional>
#include <string>

#include "daemon/live/live_board.hpp"
#include "daemon/settings/settings.hpp"
#include "daemon/telemetry/telemetry.hpp"

namespace deltamap::daemon {

/// A run that is not live.
struct RunName {
  std::string kind;  ///< "recording", "folder", "map"
  std::string name;  ///< for people
  std::uint32_t first_revision = 0;
  bool has_history = false;  ///< earlier revisions can be asked for
};

/// "hello": version, thresholds and the names of a sample's columns. `run`: nothing of a live daemon.
[[nodiscard]] std::string hello_message(const Settings& settings, const std::optional<RunName>& run = std::nullopt);
/// "map": the frame in which boxes of cells lie. Whoever gets it forgets all cells.
[[nodiscard]] std::string map_message(const GridGeometry& geometry, std::uint32_t revision);
/// "pose": the newest pose, what is believed of it, and the write gate.
[[nodiscard]] std::string pose_message(const LiveScan& scan, const Telemetry& telemetry, bool mapping_enabled);
/// Binary: the pose of a scan and where its beams ended.
[[nodiscard]] std::string scan_message(const LiveScan& scan);
/// Binary: the particles that stand for all of them.
[[nodiscard]] std::string particles_message(const LiveScan& scan);
/// Binary: where the scans that are kept for a map update were taken and what they saw, thinned to 20 kB at most.
[[nodiscard]] std::string stored_message(const mapping::StoredScans& stored);
/// /api/scan: the newest scan in words.
[[nodiscard]] std::string scan_json(const LiveScan& scan);
/// "transient": blocks that differ from the map for now. `transients` may be null.
[[nodiscard]] std::string transient_message(const TransientObstacles* transients);
/// "status": /api/status, and the memory that this process has now.
[[nodiscard]] std::string status_message(const std::string& status_json);
/// Binary: rows of figures, oldest first.
[[nodiscard]] std::string samples_message(const LiveBoard::Past<LiveSample>& past);
/// "changes": a list as in changes.jsonl, oldest first, the number of its first, and how many there were since the
/// start.
[[nodiscard]] std::string changes_message(const LiveBoard::Past<ChangeNote>& past,
                                          const LiveBoard::ChangeCounts& counts);

/// /api/history: M_0 … M_k of this run.
[[nodiscard]] std::string history_json(const LiveBoard& board);

}  // namespace deltamap::daemon
