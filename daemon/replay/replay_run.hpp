// SPDX-License-Identifier: Apache-2.0
// The whole pipeline on recorded bytes: the same stage functions as in pipeline.cpp, one after another in one thread,
// in virtual time. The same bytes, settings and seed give the same files, bit for bit on one machine.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>

#include "core/messages.hpp"
#include "daemon/outputs/change_note.hpp"
#include "daemon/outputs/localization_log.hpp"
#include "daemon/outputs/outputs.hpp"
#include "daemon/settings/settings.hpp"
#include "daemon/steps/bay_step.hpp"
#include "localization/particles/particle_set.hpp"
#include "mapping/store_scan.hpp"

namespace deltamap::daemon {

/// A scan that was localized, and what is known when it has been looked at. Valid during the call alone.
struct ReplayedScan {
  const TrackedScan& tracked;
  const LocalizationRow& row;
  double cost_s = 0.0;                                              ///< CPU seconds of its localization
  const localization::particles::ParticleSet* particles = nullptr;  ///< null: the pose does not rest on any
  const mapping::StoreScan& awareness;
};

/// What others may look at while a replay goes on; empty: nobody looks. Called in the replay's thread; of one scan the
/// changes first.
struct ReplayWatch {
  std::function<void(const ReplayedScan&)> scan{};
  std::function<void(const MapRevision*, const ChangeNote&)> change{};  ///< the revision may be null: refused
  std::function<void(const BayStep&, Timestamp)> bays{};                ///< after each scan that they have looked at
};

struct ReplayJob {
  std::filesystem::path recording;
  std::filesystem::path map;  ///< M_0; the settings' ports, map and store are not looked at
  Settings settings;
  std::filesystem::path out;
  double from_s = 0.0;  ///< after the first record: before it only the sessions listen
  double to_s = std::numeric_limits<double>::infinity();
  double map_delay_s = 1.0;  ///< recorded time from the end of a Δ-phase until its revision is taken, without a journal
  ReplayWatch watch{};
  std::function<void(const std::string&)> warn{};  ///< told what a person should know of map and pose, a line each
};

/// The settings of the job, as they ran: its own map and recording, and none of the files that only a live run has.
[[nodiscard]] Settings settings_that_ran(const ReplayJob& job);

/// Called now and then with the share that is done, 0 to 1; answers whether to go on.
using ReplayProgress = std::function<bool(double)>;

/// Writes the files of --out and answers what report.json says. Throws std::runtime_error with one line that names file
/// and place; nothing has been written then.
[[nodiscard]] RunReport run_replay(const ReplayJob& job, const ReplayProgress& progress);

}  // namespace deltamap::daemon
