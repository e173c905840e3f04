// SPDX-License-Identifier: Apache-2.0
// The localization thread: sensor messages in their order, before each scan the revisions and the operator's commands
// that have come; out go the tracked scan, what the pilot wants, and what is worth keeping. Decisions that depend on
// the clock are noted for the recording.
#pragma once

#include <functional>
#include <optional>

#include "core/channel.hpp"
#include "core/messages.hpp"
#include "daemon/control/command.hpp"
#include "daemon/records/map_order.hpp"
#include "daemon/records/recorder.hpp"
#include "daemon/settings/settings.hpp"
#include "daemon/steps/localization_step.hpp"
#include "daemon/steps/pilot_step.hpp"
#include "daemon/telemetry/latency_histogram.hpp"
#include "daemon/telemetry/stage.hpp"
#include "daemon/telemetry/telemetry.hpp"
#include "navigation/wander.hpp"

namespace deltamap::daemon {

class LocalizationStage {
 public:
  struct Wiring {
    Channel<SensorMessage>& sensors;
    Channel<MapRevision>& revisions;
    Channel<std::shared_ptr<const TransientObstacles>>& transients;
    Channel<control::Command>& commands;
    Channel<navigation::WanderParams>& wander;
    Channel<SharedSite>& sites;         ///< of a reload: the newest is taken
    Channel<DeltaWork>& tracked_scans;  ///< and what an operator wants of the map
    RecorderInput& recorder;
    Telemetry& telemetry;
    std::function<void(const PilotWord&)> drive;  ///< after each scan; never waits
    /// For the live page: a scan, what is known of it, its latency in s, and the particles or null. Never waits.
    std::function<void(const TrackedScan&, const LocalizationRow&, double, const localization::particles::ParticleSet*)>
        show;
    std::function<void(const control::CommandOutcome&)> answer;  ///< never waits
  };
  /// Throws std::runtime_error where the map has no free cell.
  LocalizationStage(const Settings& settings, const StartMap& start, std::uint64_t first_map, Wiring wiring);

  /// The thread's work, until the sensor channel is closed and empty.
  void run();

  [[nodiscard]] const Pulse& pulse() const { return pulse_; }
  // After run().
  [[nodiscard]] const LocalizationStep& step() const { return step_; }
  [[nodiscard]] const LatencyHistogram& latency() const { return latency_; }

 private:
  void work_off(std::vector<SensorMessage>& batch);
  void pass_over(const Scan& scan);
  void localize(Scan scan);
  void take_revisions(std::uint32_t scan);
  void take_transients(std::uint32_t scan);
  void pilot(const TrackedScan& tracked);
  void hear_of_sites();
  void take_sites(const Scan& scan);
  void note(const SetSite& set);
  void take_commands(const Scan& scan);
  /// No scan comes: a save is done, everything else is answered as not done.
  void take_commands_without_scan();
  void pause(const control::Command& command, const Scan& scan);
  /// Passed on before the scan, whether or not Δ-mapping sees that.
  void order_map(const control::Command& command, MapOrder::Kind kind, const Scan& scan);
  void relocalize(const control::Command& command, const Scan& scan);
  /// How well the scan fits there.
  void answer_relocalize(std::uint32_t scan);
  void save(const control::Command& command);
  void show(const Estimate& estimate, Timestamp received);
  void tell_changes();
  void keep_now_and_then(Timestamp time);
  void keep_pose();
  void keep_stability();
  void send_checkpoint();
  [[nodiscard]] KeptPose pose_to_keep() const;
  void note(const Decision& decision) { (void)wiring_.recorder.try_send(note_of(decision)); }

  Wiring wiring_;
  LocalizationStep step_;
  PilotStep pilot_;
  LatencyHistogram latency_;
  Pulse pulse_;
  bool mapping_enabled_;
  bool is_paused_ = false;
  SharedSite site_to_take_;     // before the next scan; null: none
  SharedSite site_to_hand_on_;  // the delta thread has it not yet; null: it has
  std::uint32_t first_revision_;
  std::uint64_t first_map_;
  std::shared_ptr<const OccupancyGrid> map_;
  std::shared_ptr<const TransientObstacles> transients_;  // may be null
  MemorySettings memory_;
  bool is_kept_;                        // there is a store to keep it beside
  bool wants_checkpoints_;              // a recording may begin in mid-run
  std::optional<Timestamp> checked_;    // when the newest checkpoint was sent
  std::optional<Timestamp> pose_kept_;  // nothing until the first scan
  std::optional<Timestamp> stability_kept_;
  std::optional<std::uint64_t> relocalized_;  // the ticket of a pose that the next scan tells the fit of
  Timestamp last_scan_came_;                  // or the start of the run
  bool has_tracked_ = false;                  // until then what an earlier run has kept is the better answer
  std::optional<LocalizerState> told_state_;
  std::optional<PoseVerdict> told_verdict_;
};

}  // namespace deltamap::daemon
