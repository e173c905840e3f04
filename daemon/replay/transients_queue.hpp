// SPDX-License-Identifier: Apache-2.0
// In a replay: snapshots of the transient layer that are made and not yet taken. The journal says before which scan
// each was taken; without a journal that is the next one.
#pragma once

#include <deque>
#include <memory>
#include <utility>

#include "core/transient_obstacles.hpp"
#include "daemon/records/journal.hpp"

namespace deltamap::daemon {

class TransientsQueue {
 public:
  using Transients = std::shared_ptr<const TransientObstacles>;

  /// `journal` may be null.
  explicit TransientsQueue(const Journal* journal) : journal_{journal} {}

  /// The newest snapshot after each scan; one that is known already is passed over.
  void push(const Transients& transients) {
    if (transients == nullptr || transients->number == newest_) return;
    newest_ = transients->number;
    waiting_.push_back(transients);
  }

  /// The newest snapshot that is to be taken before this scan; null where none is.
  [[nodiscard]] Transients next_before(std::uint32_t scan) {
    const auto newest = journal_ == nullptr ? newest_ : journal_->transients_before(scan).value_or(0);
    Transients taken;
    while (!waiting_.empty() && waiting_.front()->number <= newest) {
      taken = std::move(waiting_.front());
      waiting_.pop_front();
    }
    return taken;
  }

 private:
  const Journal* journal_;
  std::uint32_t newest_ = 0;
  std::deque<Transients> waiting_;
};

}  // namespace deltamap::daemon
