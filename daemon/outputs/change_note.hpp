// SPDX-License-Identifier: Apache-2.0
// What became of each Δ-phase: a line of changes.jsonl, and what report.json says of them all in bounded memory.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/messages.hpp"

namespace deltamap::daemon {

/// A Δ that was accepted or refused.
struct ChangeNote {
  Timestamp time;  ///< end of the Δ-phase
  std::uint32_t phase = 0;
  std::uint32_t scans = 0;
  std::optional<std::uint32_t> revision;  ///< nothing: refused
  std::uint32_t added = 0;                ///< cells that became occupied
  std::uint32_t freed = 0;                ///< cells that became free
  std::uint32_t forgotten = 0;            ///< cells that became unknown
  Point2 box_low{0.0, 0.0};               ///< bounding box of the changed cells in the map, m
  Point2 box_high{0.0, 0.0};
  double acceptance = 0.0;   ///< Eq. 11
  std::string reason;        ///< of a refusal; of a revision "withdrawn", or what an operator has done; else empty
  bool by_operator = false;  ///< an operator did it, and no localizer had a part in it
  std::vector<std::uint32_t> withdraws;                ///< the revisions that this one takes back
  PoseCovariance covariance = PoseCovariance::Zero();  ///< of the localizer's pose when the phase ended
};

/// One line of changes.jsonl with its line end.
[[nodiscard]] std::string json_line(const ChangeNote& change);

/// What a run has changed and refused. A service runs for months: refusals are counted by cause, of the revisions the
/// newest are kept.
class ChangeTally {
 public:
  struct Revision {
    std::uint32_t number = 0;
    Timestamp time;
    std::uint32_t phase = 0;
    std::uint32_t added = 0;
    std::uint32_t freed = 0;
    std::uint32_t forgotten = 0;
  };
  static constexpr std::size_t kKept = 1000;

  void add(const ChangeNote& change);

  [[nodiscard]] bool empty() const { return accepted_ == 0 && refused_ == 0; }
  [[nodiscard]] std::uint64_t accepted() const { return accepted_; }
  [[nodiscard]] std::uint64_t refused() const { return refused_; }
  /// Revisions that took others back; they count as accepted too.
  [[nodiscard]] std::uint64_t withdrawals() const { return withdrawals_; }
  /// The newest kKept, oldest first.
  [[nodiscard]] const std::deque<Revision>& revisions() const { return revisions_; }
  [[nodiscard]] const std::map<std::string, std::uint64_t>& refusals() const { return refusals_; }

 private:
  std::uint64_t accepted_ = 0;
  std::uint64_t refused_ = 0;
  std::uint64_t withdrawals_ = 0;
  std::deque<Revision> revisions_;
  std::map<std::string, std::uint64_t> refusals_;  // by cause
};

}  // namespace deltamap::daemon
