// SPDX-License-Identifier: Apache-2.0
// The map thread: sets and orders in their order, each becomes a revision or a refusal; out go the revision to the
// localizer, both to the disk and to the live page. What an operator has set is noted for the recording.
#pragma once

#include <deque>
#include <functional>
#include <memory>

#include "core/channel.hpp"
#include "core/messages.hpp"
#include "daemon/control/command.hpp"
#include "daemon/maps/bays_keeper.hpp"
#include "daemon/maps/map_outputs.hpp"
#include "daemon/maps/things_keeper.hpp"
#include "daemon/records/map_order.hpp"
#include "daemon/records/recorder.hpp"
#include "daemon/steps/map_step.hpp"
#include "daemon/telemetry/stage.hpp"
#include "daemon/telemetry/telemetry.hpp"

namespace deltamap::daemon {

class MapStage {
 public:
  struct Wiring {
    Channel<MapWork>& work;
    Channel<MapRevision>& revisions;
    RecorderInput& recorder;
    Telemetry& telemetry;
    std::function<void(const std::string&)> log;   ///< a short line
    std::function<void(const std::string&)> warn;  ///< a short line of what is degraded
    /// For the live page; null: refused.
    std::function<void(const MapRevision*, const ChangeNote&)> show;
    std::function<void(const control::CommandOutcome&)> answer;  ///< never waits
    ThingsBoard& things;                                         ///< for control and live page
    const BaysBoard& bays;                                       ///< of the delta thread: kept for the next run
    std::function<void(std::string line)> tell_thing = [](const std::string&) {};  ///< of things.jsonl; never waits
    std::function<void(std::string line)> tell_bay = [](const std::string&) {};    ///< of bays.jsonl; never waits
  };
  /// Begins the files of `out`.
  MapStage(const Settings& settings, const StartMap& start, std::uint64_t first_map,
           const std::optional<std::filesystem::path>& out, StoreToKeep store, Wiring wiring);

  /// The thread's work, until the channel is closed and empty; then what the delta thread could not hand over.
  void run(const std::deque<MapWork>& rest);

  [[nodiscard]] const Pulse& pulse() const { return pulse_; }
  // After run().
  [[nodiscard]] const ChangeTally& changes() const { return changes_; }
  [[nodiscard]] const std::shared_ptr<const OccupancyGrid>& map() const { return step_.map(); }

 private:
  void take(const MapWork& work);
  void tell_and_hand_on(const MapStep::Result& result);
  /// Answers whoever gave the order.
  void obey(const MapOrder& order);
  /// Throws std::runtime_error: one line that says why there is nothing to do.
  [[nodiscard]] mapping::store::MapStore::Undoing cells_of(const MapOrder& order) const;
  void note(const SetCells& set);
  void tell_things(const std::vector<mapping::things::ThingEvent>& events);
  void tell_bay(const mapping::bays::BayEvent& event);
  /// To the localizer, the live page and the disk.
  void hand_on(const MapStep::Result& result);

  Wiring wiring_;
  MapStep step_;
  ThingsKeeper things_;
  BaysKeeper bays_;
  MapOutputs outputs_;
  ChangeTally changes_;
  Pulse pulse_;
};

}  // namespace deltamap::daemon
