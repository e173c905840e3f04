// SPDX-License-Identifier: Apache-2.0
// Takes what must reach the disk (or the log) from the threads that cannot wait for it: chunks of bytes and journal
// notes for the recording, lines for trajectory.tum and localization.csv, the pose that outlives the run. Where the
// disk is too slow, a channel fills and refuses, and that is counted. Where it is full, saving pauses.
#pragma once

#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "core/channel.hpp"
#include "daemon/kept/memory_keeper.hpp"
#include "daemon/outputs/line_file.hpp"
#include "daemon/outputs/localization_log.hpp"
#include "daemon/outputs/outputs.hpp"
#include "daemon/records/journal.hpp"
#include "daemon/records/live_recording.hpp"
#include "daemon/records/run_listener.hpp"
#include "daemon/settings/memory_places.hpp"
#include "daemon/site/site_edit.hpp"
#include "daemon/telemetry/log_line.hpp"
#include "daemon/telemetry/stage.hpp"
#include "daemon/telemetry/telemetry.hpp"
#include "drivers/port/byte_record.hpp"

namespace deltamap::daemon {

using JournalNote = std::string;

/// `ctl record start`, `stop`.
struct RecordOrder {
  bool goes_on = false;
  std::uint64_t ticket = 0;
};

/// `ctl bay`, `ctl zone`, the page: a list of places is written.
struct SiteEditOrder {
  SiteEdit edit;
  std::uint64_t ticket = 0;
};

using RecorderItem =
    std::variant<drivers::port::ByteRecord, JournalNote, TrajectoryPoint, std::unique_ptr<const LocalizationRow>,
                 std::unique_ptr<const KeptPose>, std::unique_ptr<const KeptStability>,
                 std::unique_ptr<const SaveOrder>, RecordOrder, LogLine, std::shared_ptr<const Checkpoint>,
                 std::unique_ptr<const MarkOrder>, std::unique_ptr<const SiteEditOrder>>;

/// One sender's way to the recorder.
using RecorderInput = Channel<RecorderItem>;

class Recorder {
 public:
  struct Options {
    std::filesystem::path recording;  ///< empty: none; an older file is kept as NAME.previous.pcapng
    drivers::port::FirstBauds bauds;
    Timestamp began;                       ///< now
    std::vector<std::string> first_notes;  ///< what the run begins from
    double max_gigabytes = 0.0;
    std::optional<RingLimits> ring{};  ///< of the recording
    std::function<std::vector<std::string>(const Checkpoint&)> part_notes{};
    std::filesystem::path trajectory{};    ///< empty: none
    std::filesystem::path localization{};  ///< localization.csv; empty: none
    MemoryPlaces memory{};                 ///< empty: nothing is kept
    RunListener* listener = nullptr;       ///< outlives the recorder; null: nobody
  };
  struct Hooks {
    std::function<void(const std::string&)> log;                  ///< a short line
    std::function<void(const control::CommandOutcome&)> saved{};  ///< an operator's order is done; may be empty
    std::function<void(const std::string&)> warn{};               ///< a short line of what is degraded; empty: log
    std::function<control::CommandOutcome(const SiteEditOrder&)> draw{};  ///< waits for the disk; may be empty
  };
  /// Throws FileInUse and StartError as LiveRecording does. A full disk is no reason.
  Recorder(const Options& options, Telemetry& telemetry, Hooks hooks);

  // One a thread that sends.
  RecorderInput& from_io() { return from_io_; }
  RecorderInput& from_localization() { return from_localization_; }
  RecorderInput& from_awareness() { return from_awareness_; }
  RecorderInput& from_map() { return from_map_; }
  RecorderInput& from_control() { return from_control_; }

  /// The recorder thread's work, until close(): looks for items every 50 ms, whatever comes meanwhile.
  void run();
  [[nodiscard]] const Pulse& pulse() const { return pulse_; }
  /// When all senders have ended: what they sent is still written.
  void close();

  [[nodiscard]] std::uint64_t refused() const {
    return from_io_.refused() + from_localization_.refused() + from_awareness_.refused() + from_map_.refused();
  }

 private:
  bool drain(RecorderInput& input);
  void write(RecorderItem&& item);
  void record(const drivers::port::ByteRecord& record);
  void save(const SaveOrder& order);
  void obey(const RecordOrder& order);
  void keep(const MarkOrder& mark);
  /// Once a second: everything to the disk, and another attempt where one has failed.
  void flush();

  Hooks hooks_;
  RunListener* listener_;
  Pulse pulse_;
  std::optional<LiveRecording> recording_;
  std::optional<LiveLines> trajectory_;
  std::optional<LiveLines> localization_;
  MemoryKeeper memory_;
  Timestamp now_;  // of the newest look at the clock
  Timestamp last_stamp_;
  std::uint64_t refused_before_ = 0;
  std::atomic<bool> closed_{false};
  RecorderInput from_io_{4096};            // full: bytes are missing from the recording
  RecorderInput from_localization_{2048};  // full: lines and decisions are missing
  RecorderInput from_awareness_{256};      // full: decisions are missing
  RecorderInput from_map_{256};            // full: an operator's cells are missing
  RecorderInput from_control_{16};         // full: whoever asked is told
};

}  // namespace deltamap::daemon
