// SPDX-License-Identifier: Apache-2.0
// One replay under way: the messages of a recording through the stages, one after another in one thread, and what comes
// out of them into an output. What is read and where it goes to stand behind run_replay() and replay_again().
#pragma once

#include <cstdint>
#include <vector>

#include "core/messages.hpp"
#include "daemon/outputs/outputs.hpp"
#include "daemon/records/journal.hpp"
#include "daemon/replay/message_source.hpp"
#include "daemon/replay/replay_output.hpp"
#include "daemon/replay/replay_run.hpp"
#include "daemon/replay/replay_start.hpp"
#include "daemon/replay/sequential_run.hpp"
#include "daemon/steps/thing_looks.hpp"

namespace deltamap::daemon {

class Replay {
 public:
  /// All must outlive it.
  struct Parts {
    const ReplayJob& job;
    const RecordedRun& recorded;
    const ReplayStart& begun;
    MessageSource& source;
    ReplayOutput& output;
  };
  explicit Replay(const Parts& parts, const RunDuties& duties = {});

  /// Throws std::runtime_error where there is no scan, the progress says to stop, or the output cannot be written.
  void run(const ReplayProgress& progress);
  [[nodiscard]] RunReport finish();

 private:
  void take(const Odometry& odometry, std::uint32_t number);
  void take(Scan&& scan);
  void warn(const Estimate& estimate) const;
  void obey_commands_before(const Scan& scan);
  void look_for_changes(const TrackedScan& tracked);
  [[nodiscard]] Site site_to_take(const Site& recorded) const;
  void update_map(const MapRequest& request, std::uint32_t scan);
  [[nodiscard]] bool reaches_map(const ScanSet& set, std::uint32_t scan);
  void keep_result(const MapStep::Result& result);

  const ReplayJob& job_;
  const Journal& journal_;
  MessageSource& source_;
  ReplayOutput& output_;
  bool lacks_end_;  // the journal's last notes are missing
  bool obeys_;
  bool tells_times_;
  std::vector<Decision>::const_iterator next_command_;
  bool has_begun_ = false;
  bool is_paused_ = false;
  SequentialRun run_;
  ThingLooks thing_looks_;
  double run_cpu_s_ = 0.0;  // in all
  double recording_cpu_s_ = 0.0;
  RunReport report_;
};

}  // namespace deltamap::daemon
