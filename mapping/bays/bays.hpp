// SPDX-License-Identifier: Apache-2.0
// Judges from the scans of a held pose what stands in each bay. A state is told only by evidence that lasts; where the
// view is covered, or too little of the floor was seen, the last state stays and says how old it is. A function of the
// scans in their order; costs what is in view, memory is bounded by the number of bays.
#pragma once

#include <cstdint>
#include <vector>

#include "core/messages.hpp"
#include "mapping/bays/bay_floor.hpp"

namespace deltamap::mapping::bays {

/// A bay's state is another one.
struct BayEvent {
  Bay bay;
  BayState before = BayState::kUnknown;
  BayStatus status;
  Timestamp time;  ///< of the scan that told it
};

class Bays {
 public:
  explicit Bays(std::vector<Bay> bays);

  /// Other bays from now on; of those that are as they were all that is known is kept.
  void set(std::vector<Bay> bays);

  /// Every scan in order. `pose_holds`: sure enough to judge by.
  std::vector<BayEvent> observe(const TrackedScan& tracked, bool pose_holds);
  /// The pose has been wrong since then: what was seen with it is unknown.
  std::vector<BayEvent> forget_since(Timestamp from, Timestamp now);

  [[nodiscard]] const std::vector<Bay>& bays() const { return bays_; }
  /// In the order of the bays.
  [[nodiscard]] const std::vector<BayStatus>& statuses() const { return statuses_; }

 private:
  struct Watch {
    BayFloor floor;
    BayState candidate = BayState::kUnknown;  // that the newest looks show, where it is not the state
    Timestamp candidate_since{};
    int candidate_looks = 0;
    Timestamp looked{};
  };

  void judge(std::size_t bay, Timestamp now, std::vector<BayEvent>& events);
  void follow(Watch& watch, BayState shown, Timestamp now);
  [[nodiscard]] std::uint32_t tenths(Timestamp time) const;

  std::vector<Bay> bays_;
  std::vector<BayStatus> statuses_;
  std::vector<Watch> watches_;
  std::optional<Timestamp> began_;
  std::optional<Timestamp> looked_;
};

}  // namespace deltamap::mapping::bays
