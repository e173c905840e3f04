// SPDX-License-Identifier: Apache-2.0
// What passes the write gate: finished sets wait a moment for a sign that their last scans were wrong, and longer where
// the robot may be elsewhere; those that rest on a pose that has proven wrong are marked, and what such a pose has
// written lately is ordered back, in the run before as well.
#pragma once

#include <deque>
#include <optional>

#include "core/messages.hpp"
#include "mapping/gate/write_gate.hpp"

namespace deltamap::mapping::gate {

class GatedSets {
 public:
  /// `inherits`: the run before has left revisions that are still provisional.
  explicit GatedSets(const WriteGateParams& params, bool inherits = false) : params_{params}, gate_{params, inherits} {
    if (inherits) last_handed_on_ = Timestamp::min();
  }

  /// Every tracked scan, before its phase sees it.
  void observe(const TrackedScan& tracked);
  /// May the phase see this scan?
  [[nodiscard]] bool lets_vote() const { return !params_.enabled || gate_.is_open(); }
  /// Shut, though nothing has proven the pose wrong: may the scan vote once the gate is open again?
  [[nodiscard]] bool waits_to_vote(const Estimate& estimate) const;
  /// The set that ended with this scan, if one did.
  void take(std::optional<ScanSet> set, const TrackedScan& tracked);
  /// What is to be handed on now: an order to take back what the newest scan has proven wrong, else a set or a marked
  /// set, else word that all that was written is settled.
  [[nodiscard]] std::optional<MapRequest> next();

  [[nodiscard]] const WriteGate& gate() const { return gate_; }
  /// Finished sets that are not handed on yet, in order of their end.
  [[nodiscard]] const std::deque<ScanSet>& waiting() const { return waiting_; }

 private:
  void withdraw(const TrackedScan& tracked);
  [[nodiscard]] bool is_due(const ScanSet& set) const;

  WriteGateParams params_;
  WriteGate gate_;
  std::deque<ScanSet> waiting_;              // sets in order of their end
  std::deque<ScanSet> due_;                  // marked sets
  std::optional<WithdrawOrder> withdrawal_;  // not handed on yet
  std::optional<Timestamp> last_handed_on_;  // end of the newest set that may have been written, and is provisional
  Timestamp now_;
  double other_share_ = 0.0;
};

}  // namespace deltamap::mapping::gate
