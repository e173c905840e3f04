// SPDX-License-Identifier: Apache-2.0
// Keeps incidents: two minutes before each loss, kidnapping, streak of refusals, safety stop, device fault and
// operator's mark, and half a minute after. In the recorder thread. What comes while one is written belongs to it.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/files/file_lock.hpp"
#include "daemon/incidents/incident_folder.hpp"
#include "daemon/incidents/incident_watch.hpp"
#include "daemon/incidents/segment_ring.hpp"
#include "daemon/outputs/retrying_output.hpp"
#include "daemon/records/run_listener.hpp"
#include "daemon/telemetry/log_tail.hpp"
#include "daemon/telemetry/telemetry.hpp"

namespace deltamap::daemon {

class IncidentKeeper : public RunListener {
 public:
  static constexpr double kBeforeS = 120.0;
  static constexpr double kAfterS = 30.0;
  static constexpr double kLongestAfterS = 300.0;  ///< the first event, however many follow

  struct Options {
    Settings settings;
    std::vector<std::string> first_notes;  ///< what the run begins from
    std::uint64_t first_map = 0;           ///< grid_hash() of M_0
    std::shared_ptr<const OccupancyGrid> map;
    std::uint32_t revision = 0;  ///< of that map
    Timestamp began;             ///< now
  };
  struct Hooks {
    std::function<void(const std::string&)> log;   ///< a short line
    std::function<void(const std::string&)> warn;  ///< a short line of what is degraded
  };
  /// All must outlive it. Throws FileInUse where another daemon keeps its incidents there. A full disk, or a folder
  /// that cannot be had, is a warning.
  IncidentKeeper(Options options, Telemetry& telemetry, const LogTail& log, Hooks hooks);

  void hear(const drivers::port::ByteRecord& record, Timestamp now) override;
  void hear_of_loss() override { has_gap_ = true; }
  void hear(const LocalizationRow& row, Timestamp now) override;
  void hear(std::shared_ptr<const Checkpoint> checkpoint, Timestamp now) override;
  [[nodiscard]] control::CommandOutcome hear(const MarkOrder& mark, Timestamp now) override;
  void look(Timestamp now) override;
  void close(Timestamp now) override;

 private:
  void begin_ring(Timestamp now);
  /// Throws std::runtime_error where the disk is full.
  void write(const drivers::port::ByteRecord& record);
  void begin_segment(Timestamp now, std::shared_ptr<const Checkpoint> checkpoint);
  void begin_ring_segment(Timestamp now, std::shared_ptr<const Checkpoint> checkpoint);
  void raise(IncidentEvent event, Timestamp now);
  [[nodiscard]] Incident begun_incident(const IncidentEvent& event, Timestamp from, const Checkpoint* checkpoint) const;
  void open_incident(const IncidentEvent& event);
  void finish(Timestamp now);
  void flush(Timestamp now);
  /// What a daemon before this one has left: told, and kept.
  void keep_left_run(Timestamp now);
  [[nodiscard]] std::shared_ptr<const Checkpoint> without_pose() const;

  Options options_;
  Telemetry& telemetry_;
  const LogTail& log_;
  Hooks hooks_;
  RetryingOutput output_;
  std::optional<FileLock> lock_;
  RunSoFar so_far_;
  std::optional<SegmentRing> ring_;
  PoseWatch pose_watch_;
  RunWatch run_watch_;
  std::optional<LocalizationRow> newest_;
  std::shared_ptr<const Checkpoint> checkpoint_;  // the newest; null: none yet
  std::optional<IncidentFolder> open_;
  Timestamp until_;  // of the open one
  Timestamp last_flush_;
  Timestamp last_ring_flush_;
  bool is_left_aside_ = false;
  bool is_left_kept_ = false;
  Timestamp left_due_{};  // the next attempt to keep it
  bool has_gap_ = false;
};

/// Null where the settings name no folder.
[[nodiscard]] std::unique_ptr<IncidentKeeper> begun_incident_keeper(IncidentKeeper::Options options,
                                                                    Telemetry& telemetry, const LogTail& log,
                                                                    IncidentKeeper::Hooks hooks);

}  // namespace deltamap::daemon
