// SPDX-License-Identifier: Apache-2.0
// What a replay starts on: the given map, or, where the recorded run began from that map, what it began from; and
// whether its journal can be obeyed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "daemon/records/journal.hpp"
#include "daemon/replay/replay_run.hpp"
#include "daemon/steps/run_begin.hpp"
#include "drivers/port/log_faults.hpp"

namespace deltamap::daemon {

/// What the notes of a recording say.
struct RecordedRun {
  Journal journal;
  BeginReader begin;
  drivers::port::LogFaults faults;
};
/// Reads the recording once for its notes alone, so that what is wrong with it shows before anything is done. Throws
/// std::runtime_error as ByteLogReader does.
[[nodiscard]] RecordedRun recorded_run(const ReplayJob& job);

/// Why no settings and map make a replay obey its journal: "none" where there is none, "not obeyed: …"; empty: those of
/// the run do.
[[nodiscard]] std::string why_never_obeyed(const RecordedRun& recorded);
/// A map that a replay is given.
struct FirstMap {
  std::shared_ptr<const OccupancyGrid> grid;
  std::uint64_t hash = 0;  ///< grid_hash()
};
[[nodiscard]] FirstMap first_map(std::shared_ptr<const OccupancyGrid> grid);

struct ReplayStart {
  StartMap start;
  std::string began;    ///< what of the recorded run's beginning is used, or why not
  std::string journal;  ///< "obeyed", "none" or why it is not obeyed
};
[[nodiscard]] ReplayStart replay_start(const RecordedRun& recorded, const ReplayJob& job, FirstMap given);
[[nodiscard]] ReplayStart replay_start(const RecordedRun& recorded, const ReplayJob& job,
                                       std::shared_ptr<const OccupancyGrid> given);

/// Why no scan was replayed, in one line that names the recording.
[[nodiscard]] std::string why_no_scan(const drivers::port::LogFaults& faults, const std::filesystem::path& recording);

}  // namespace deltamap::daemon
