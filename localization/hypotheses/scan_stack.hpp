// SPDX-License-Identifier: Apache-2.0
// Keeps the scans of the last metres, joined by odometry. A new pose hypothesis must explain all of them, for single
// scans fit at many poses.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "localization/hypotheses/beam_decorrelation.hpp"
#include "localization/hypotheses/hypothesis_bank.hpp"
#include "localization/motion/deskew.hpp"
#include "localization/sensor/likelihood_field.hpp"

namespace deltamap::localization::hypotheses {

class ScanStack {
 public:
  static constexpr std::size_t kScans = 24;
  static constexpr double kApartM = 0.5;  ///< between two kept scans, m, where the robot drives straight on

  void clear() {
    count_ = 0;
    decorrelation_.clear();
  }
  /// Forgets all but the scans of the last metres of driving.
  void keep_last(double driven_m);

  /// Keeps the scan when the robot has moved half a metre or turned 30° since the last kept one.
  void add(const motion::BeamEnds& ends, const Pose2& continuous_odom_from_robot);

  [[nodiscard]] std::size_t size() const { return count_; }

  /// Element k: the sum over the beams of the k + 1 newest scans of ln p(z), surfaces counted once, had the robot now
  /// been at the pose, <= 0.
  using Sums = std::array<double, kScans>;
  [[nodiscard]] Sums log_likelihoods(const sensor::LikelihoodField& field, const Pose2& map_from_robot,
                                     const Pose2& continuous_odom_from_robot) const;

  /// What the newest scans say of a hypothesis beside another, since when they speak for it most; nothing where they
  /// never do. Older ones lie too far back for a robot that has just been carried, and among hundreds of hypotheses
  /// chance favours one.
  [[nodiscard]] Comparison compared_lately(const sensor::LikelihoodField& field, const Pose2& hypothesis,
                                           const Pose2& other, const Pose2& continuous_odom_from_robot,
                                           double of_a_beam) const;

 private:
  struct Kept {
    motion::BeamEnds ends;
    std::vector<float> weights;
    Pose2 continuous_odom_from_robot;
    double since_last_m = 0.0;  ///< driven between the scan kept before and this one
  };
  [[nodiscard]] const Kept& newest_but(std::size_t back) const { return kept_[(newest_ + kScans - back) % kScans]; }

  BeamDecorrelation decorrelation_;
  std::array<Kept, kScans> kept_;
  std::size_t count_ = 0;
  std::size_t newest_ = 0;
};

}  // namespace deltamap::localization::hypotheses
