// SPDX-License-Identifier: Apache-2.0
// The scans of the last metres, joined by odometry: what a place that has only now come to mind must explain too.
// Single scans look alike in many places.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "localization/deskew.hpp"
#include "localization/likelihood_field.hpp"

namespace deltamap::localization {

class ScanStack {
 public:
  static constexpr std::size_t kScans = 4;

  void clear() { count_ = 0; }

  /// Keeps the scan when the robot has moved half a metre or turned 30° since the last kept one.
  void add(const BeamEnds& ends, const Pose2& joined_from_robot);

  /// Sum over the kept scans of the mean ln p(z) had the robot now been at the pose; <= 0.
  [[nodiscard]] double log_likelihood(const LikelihoodField& field, const Pose2& map_from_robot,
                                      const Pose2& joined_from_robot) const;

 private:
  struct Kept {
    BeamEnds ends;
    Pose2 joined_from_robot;
  };
  std::array<Kept, kScans> kept_;
  std::size_t count_ = 0;
  std::size_t newest_ = 0;
};

}  // namespace deltamap::localization
