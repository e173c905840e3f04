// SPDX-License-Identifier: Apache-2.0
// The recording of the running daemon. Where the disk is full it pauses, and goes on behind the last whole block when
// there is room again, with a note of the gap: what was sent in the meantime is lost, and a replay then knows that it
// cannot reproduce the run. An operator may stop it and start it again, with such a gap between.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/files/file_lock.hpp"
#include "daemon/outputs/retrying_output.hpp"
#include "daemon/records/checkpoint.hpp"
#include "daemon/records/recording_parts.hpp"
#include "daemon/records/run_so_far.hpp"
#include "daemon/telemetry/telemetry.hpp"
#include "drivers/port/byte_log.hpp"

namespace deltamap::daemon {

/// Looks at the place of recording.file, and at that of the recording before it. Empty, or why nothing can be written
/// now (a read-only file system). Throws StartError where only a person can mend it.
[[nodiscard]] std::string judged_recording_place(const std::filesystem::path& file);

class LiveRecording {
 public:
  struct Options {
    std::filesystem::path file;  ///< an older file is kept as NAME.previous.pcapng, or as a part of the ring
    drivers::port::FirstBauds bauds;
    std::vector<std::string> first_notes;  ///< what the run begins from
    Timestamp began;
    double max_gigabytes = 0.0;
    std::optional<RingLimits> ring{};  ///< then max_gigabytes is not looked at
    /// Of a ring: what a part begins from.
    std::function<std::vector<std::string>(const Checkpoint&)> part_notes{};
  };
  /// Throws FileInUse where another daemon records there, StartError where this user can have no file.
  LiveRecording(Options options, Telemetry& telemetry, const RetryingOutput::Warn& warn);

  void write(const drivers::port::ByteRecord& record, Timestamp now);
  /// Of a ring: a new part begins here where the one before is full.
  void begin_part(const Checkpoint& from, Timestamp now);
  /// Records never came here: the channel was full.
  void note_loss() { has_gap_ = true; }
  /// An operator wants no more of it: what was recorded is handed to the disk, and what comes is left out. Answers what
  /// there is; throws std::runtime_error with one line where it is not going on.
  std::string stop(Timestamp now);
  /// And wants more: it goes on in the same file, behind a gap. Throws std::runtime_error with one line where it is
  /// going on, or has come to its end.
  std::string start(Timestamp now);
  void flush(Timestamp now);
  /// Flushes, syncs to the disk and closes.
  void close(Timestamp now);

 private:
  /// The file with what the run begins from; all of it or nothing. Throws std::runtime_error where it cannot.
  void begin();
  /// Throws std::runtime_error where it cannot.
  void go_on();
  void attempt(Timestamp now, const std::function<void()>& write);
  Options options_;
  Telemetry& telemetry_;
  RetryingOutput output_;
  std::function<void(const std::string&)> log_;
  std::optional<FileLock> lock_;
  std::optional<drivers::port::ByteLogWriter> writer_;
  RunSoFar so_far_;
  std::vector<drivers::port::ByteRecord> beginning_;  // of the file, while it is not on disk
  Timestamp part_began_;
  Timestamp last_stamp_;
  bool is_previous_kept_ = false;
  bool has_gap_ = false;
  bool ended_ = false;    // full
  bool stopped_ = false;  // by an operator
};

}  // namespace deltamap::daemon
