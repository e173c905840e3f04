// SPDX-License-Identifier: Apache-2.0
// In a replay: revisions that are made and not yet taken. The journal says before which scan each was taken; without a
// journal that is some seconds of recorded time after its Δ-phase ended.
#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <vector>

#include "core/messages.hpp"
#include "daemon/records/journal.hpp"

namespace deltamap::daemon {

class RevisionQueue {
 public:
  /// `journal` may be null: then `delay_s` counts. It counts revisions from `numbers_before` on, the one that the run
  /// starts on.
  RevisionQueue(const Journal* journal, double delay_s, std::uint32_t numbers_before = 0)
      : journal_{journal}, delay_s_{delay_s}, numbers_before_{numbers_before} {}

  void push(MapRevision revision) { waiting_.push_back(std::move(revision)); }

  /// The oldest revision that is to be taken before this scan, until there is none.
  [[nodiscard]] std::optional<MapRevision> next_before(const Scan& scan) {
    if (waiting_.empty() || !is_due(waiting_.front(), scan)) return std::nullopt;
    MapRevision revision = std::move(waiting_.front());
    waiting_.pop_front();
    return revision;
  }

 private:
  [[nodiscard]] bool is_due(const MapRevision& revision, const Scan& scan) const {
    if (journal_ == nullptr) return seconds(scan.time - revision.time) >= delay_s_;
    const auto newest = journal_->revision_before(scan.number);
    return newest && revision.number - numbers_before_ <= *newest;
  }

  const Journal* journal_;
  double delay_s_;
  std::uint32_t numbers_before_;
  std::deque<MapRevision> waiting_;
};

}  // namespace deltamap::daemon
