// SPDX-License-Identifier: Apache-2.0
// The delta thread: each scan is held against the map; out go the sets of scans and the orders to the map thread, and
// what is there for now to the localizer and the live page. It never waits for the map.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <string>

#include "core/channel.hpp"
#include "core/messages.hpp"
#include "daemon/maps/kept_bays.hpp"
#include "daemon/records/map_order.hpp"
#include "daemon/records/recorder.hpp"
#include "daemon/settings/settings.hpp"
#include "daemon/stages/gate_watch.hpp"
#include "daemon/steps/bay_step.hpp"
#include "daemon/steps/thing_looks.hpp"
#include "daemon/telemetry/stage.hpp"
#include "daemon/telemetry/telemetry.hpp"
#include "mapping/store_scan.hpp"

namespace deltamap::daemon {

class DeltaStage {
 public:
  struct Wiring {
    Channel<DeltaWork>& work;
    Channel<MapWork>& sets;
    Channel<std::shared_ptr<const TransientObstacles>>& transients;
    RecorderInput& recorder;
    Telemetry& telemetry;
    // A short line each; warn: the map is not written.
    std::function<void(const std::string&)> log;
    std::function<void(const std::string&)> warn;
    /// For the live page. False: refused, it is shown again at the next scan.
    std::function<bool(const std::shared_ptr<const TransientObstacles>&)> show;
    std::function<bool()> shows_scans;                     ///< for the live page: somebody looks at the next
    std::function<void(mapping::StoredScans)> show_scans;  ///< never waits
    BaysBoard& bays;                                       ///< for control and live page
    RememberedBays remembered{};                           ///< shown until this run has looked itself
  };
  DeltaStage(const Settings& settings, const StartMap& start, Wiring wiring);

  /// The thread's work, until the channel is closed and empty.
  void run();

  [[nodiscard]] const Pulse& pulse() const { return pulse_; }
  // After run().
  [[nodiscard]] const std::deque<MapWork>& waiting() const { return waiting_; }  ///< could not be handed over
  [[nodiscard]] const mapping::Awareness& awareness() const { return store_scan_.awareness(); }

 private:
  void look_for_changes(const TrackedScan& tracked);
  void show_bays(std::vector<mapping::bays::BayEvent> events, Timestamp now);
  void show_bays() { wiring_.bays.set(wiring_.remembered.beside(*bays_.list())); }
  void take(const SharedSite& site);
  void hand_over(MapWork work);
  void offer_waiting();
  void offer_transients();
  void show_scans();
  void tell_of_gate();
  void note(const Decision& decision) { (void)wiring_.recorder.try_send(note_of(decision)); }

  Wiring wiring_;
  mapping::StoreScan store_scan_;
  BayStep bays_;
  Timestamp bays_shown_;
  ThingLooks thing_looks_;
  GateWatch gate_watch_;
  std::uint32_t transients_sent_ = 0;   // number of the newest snapshot that the localizer has been sent
  std::uint32_t transients_shown_ = 0;  // and that the page has
  std::deque<MapWork> waiting_;         // the map thread was busy: offered again at the next scan; one set, and orders
  Pulse pulse_;
};

}  // namespace deltamap::daemon
