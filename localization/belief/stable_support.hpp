// SPDX-License-Identifier: Apache-2.0
// How far proven tiles support the believed pose: the share of the last scans in which most beams that are expected to
// end on proven tiles do so. A pose hypothesis elsewhere that fits better has to outweigh that.
#pragma once

#include "core/messages.hpp"

namespace deltamap::localization::belief {

class StableSupport {
 public:
  /// Beams on proven tiles at the believed pose, at every scan: what the last check has told holds until the next one.
  /// Too few say nothing.
  void observe(const BeamCounts& stable) {
    if (stable.expected < kLeastExpected) return;
    const bool holds = stable.fit >= kSupported * stable.expected;
    share_ += kShareOfAScan * ((holds ? 1.0 : 0.0) - share_);
  }
  void forget() { share_ = 0.0; }
  /// [0, 1]
  [[nodiscard]] double share() const { return share_; }

 private:
  static constexpr std::uint32_t kLeastExpected = 20;
  static constexpr double kSupported =
      0.75;  // of the beams: a thing that has gone, or stands in front, has proven tiles too
  static constexpr double kShareOfAScan = 0.1;
  double share_ = 0.0;
};

}  // namespace deltamap::localization::belief
