// SPDX-License-Identifier: Apache-2.0
// A recording read and decoded once, for many replays that differ in seed or settings: they write no files, tell no
// stage's time, and what depends on the recording alone is told once. Each gives what run_replay() gives, bit for bit,
// but none obeys the journal: else the settings and seed of the recorded run alone would.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "daemon/replay/message_source.hpp"
#include "daemon/replay/replay_output.hpp"
#include "daemon/replay/replay_run.hpp"
#include "daemon/replay/replay_start.hpp"
#include "daemon/steps/localization_step.hpp"

namespace deltamap::daemon {

struct RecordedDrive {
  RecordedRun recorded;  ///< its notes, and what it lacks
  std::vector<RecordedMessage> messages;
  std::map<std::string, std::uint64_t> wire;
  std::size_t scans = 0;
  OutsideWindow outside_window;
};

/// Reads recording and window of the job by its settings of robot and laser. Throws std::runtime_error as run_replay()
/// does: unreadable, or without a scan.
[[nodiscard]] RecordedDrive recorded_drive(const ReplayJob& job);

/// The settings that decide what recorded_drive() answers, as text: equal texts, equal drives.
[[nodiscard]] std::string decoding_settings(const Settings& settings);

/// The job's recording, map and out are not looked at: `drive` and `map` stand in their place. Any thread; several may
/// use one drive and one map at a time. CPU of the report: that of this thread as a whole. Throws as run_replay() does.
[[nodiscard]] RunReport replay_again(const ReplayJob& job, const RecordedDrive& drive, const FirstMap& map,
                                     ReplayOutput& output, const ReplayProgress& progress);

}  // namespace deltamap::daemon
