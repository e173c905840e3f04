// SPDX-License-Identifier: Apache-2.0
// In a replay: snapshots of the temporary layer that are made and not yet taken. The journal says before which scan
// each was taken; without a journal that is the next one.
#pragma once

#include <deque>
#include <memory>
#include <utility>

#include "core/temporary_things.hpp"
#include "daemon/records/journal.hpp"

namespace deltamap::daemon {

class ThingsQueue {
 public:
  using Things = std::shared_ptr<const TemporaryThings>;

  /// `journal` may be null.
  explicit ThingsQueue(const Journal* journal) : journal_{journal} {}

  /// The newest snapshot after each scan; one that is known already is passed over.
  void push(const Things& things) {
    if (things == nullptr || things->number == newest_) return;
    newest_ = things->number;
    waiting_.push_back(things);
  }

  /// The newest snapshot that is to be taken before this scan; null where none is.
  [[nodiscard]] Things next_before(std::uint32_t scan) {
    const auto newest = journal_ == nullptr ? newest_ : journal_->things_before(scan).value_or(0);
    Things taken;
    while (!waiting_.empty() && waiting_.front()->number <= newest) {
      taken = std::move(waiting_.front());
      waiting_.pop_front();
    }
    return taken;
  }

 private:
  const Journal* journal_;
  std::uint32_t newest_ = 0;
  std::deque<Things> waiting_;
};

}  // namespace deltamap::daemon
