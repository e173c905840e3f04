// SPDX-License-Identifier: Apache-2.0
// The files of --out (docs/operating/files.md): trajectory.tum, localization.csv, changes.jsonl, map, report.json. A
// replay writes them aside and moves them in place when all is done, so that a failure leaves nothing half-written; the
// daemon writes them while it runs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "core/files/file_lock.hpp"
#include "core/messages.hpp"
#include "daemon/outputs/change_note.hpp"
#include "daemon/telemetry/latency_histogram.hpp"
#include "daemon/telemetry/scan_counts.hpp"
#include "drivers/port/log_faults.hpp"
#include "mapping/gate/write_gate.hpp"

namespace deltamap::daemon {

struct Settings;

/// The robot's pose in the map at the time of a scan's first beam.
struct TrajectoryPoint {
  Timestamp time;
  Pose2 map_from_robot;
};

/// One line of trajectory.tum: "t x y 0 0 0 qz qw" and a line end.
[[nodiscard]] std::string tum_line(const TrajectoryPoint& point);

struct StageCpu {
  double decoding_s = 0.0;  ///< live: the whole io thread; of a replay all that the others are not
  double localization_s = 0.0;
  double awareness_s = 0.0;
  double map_update_s = 0.0;
  double recording_s = 0.0;  ///< recording and output files

  [[nodiscard]] double sum_s() const { return decoding_s + localization_s + awareness_s + map_update_s + recording_s; }
};

/// How long the localizer held its pose for what (Belief::verdict).
struct VerdictTimes {
  double right_s = 0.0;
  double undecided_s = 0.0;
  double wrong_s = 0.0;
};

/// Of a recording, what a replay of a part of it leaves out.
struct OutsideWindow {
  std::uint64_t packets_before = 0;
  std::uint64_t scans_before = 0;  ///< decoded
  std::uint64_t packets_after = 0;
};

/// Everything that report.json says.
struct RunReport {
  ScanCounts scans;
  std::uint32_t phases = 0;
  ChangeTally changes;
  double time_lost_s = 0.0;
  double time_global_s = 0.0;
  VerdictTimes verdict_times;
  mapping::gate::GateTimes gate_times{};           ///< how long the write gate was open, and shut by reason
  std::map<std::string, std::uint64_t> localizer;  ///< what befell it, by name
  double recorded_s = 0.0;                         ///< from the first scan to the last
  StageCpu cpu;
  double cpu_total_s = 0.0;
  double wall_s = 0.0;
  std::uint64_t peak_resident_bytes = 0;
  std::string latency_of;  ///< "last byte to pose" or "step", the time that localizing took
  LatencyHistogram latency;
  std::string journal;  ///< replay: "obeyed", "none" or why it was not obeyed
  std::uint32_t journal_differences = 0;
  std::uint32_t commands = 0;                 ///< replay: of an operator, obeyed
  std::string began;                          ///< replay: what of the recorded run's beginning is used, or why not
  std::string recording_file;                 ///< replay: what was replayed
  drivers::port::LogFaults recording;         ///< replay: what it lacks
  OutsideWindow outside_window;               ///< replay: of the recording, and not replayed
  std::map<std::string, std::uint64_t> wire;  ///< decoder counts by cause
};

/// `settings` are those of the run: they stand in the report, with version and commit.
[[nodiscard]] std::string json_text(const RunReport& report, const Settings& settings);

/// Throws std::runtime_error where `out` is the folder of the map that the run begins with: it would be overwritten.
void require_map_elsewhere(const std::filesystem::path& map, const std::filesystem::path& out);

/// Throws FileInUse where another program keeps its maps in `out`, std::runtime_error where a store lies there that no
/// run with --out has left: both would be replaced. A store that the settings name is the run's own.
void require_no_other_maps(const std::filesystem::path& out, const std::filesystem::path& own_store = {});

/// A folder that comes into being whole: files are written to path() and moved into place by commit(). What was not
/// committed disappears.
class StagingFolder {
 public:
  /// Throws std::runtime_error naming the folder, FileInUse where a daemon writes there; so does commit().
  explicit StagingFolder(const std::filesystem::path& target);
  ~StagingFolder();
  StagingFolder(const StagingFolder&) = delete;
  StagingFolder& operator=(const StagingFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return staging_; }
  void commit();

 private:
  std::filesystem::path target_;
  std::filesystem::path staging_;
  std::optional<FileLock> lock_;
};

}  // namespace deltamap::daemon
