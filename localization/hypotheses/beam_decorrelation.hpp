// SPDX-License-Identifier: Apache-2.0
// Weights the beams of a scan by how independent they are of earlier scans. A container that was moved misleads every
// scan of the next metres in the same way: its surface is one observation, not one a scan. So a beam on a patch of
// surface counts the less, the more beams have met that patch before. Patches lie in the continuous odometry frame, so
// that they are the same for all pose hypotheses.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "localization/motion/deskew.hpp"

namespace deltamap::localization::hypotheses {

class BeamDecorrelation {
 public:
  BeamDecorrelation();

  /// Counts the beams and answers what each is worth, (0, 1]; valid until the next call.
  [[nodiscard]] std::span<const float> weights(const motion::BeamEnds& ends, const Pose2& continuous_odom_from_robot);

  void clear();

 private:
  struct Patch {
    std::int8_t column_turn = 0;  ///< how often the torus has been gone round, modulo 256: 32 km
    std::int8_t row_turn = 0;
    std::uint16_t beams = 0;
    std::uint32_t met_at = 0;  ///< scan that met it last
  };
  [[nodiscard]] Patch& patch_at(double x_m, double y_m);

  std::vector<Patch> patches_;  // a torus: patches far apart share an entry, the later one takes it
  std::uint32_t scan_ = 0;
  std::vector<float> weights_;
};

}  // namespace deltamap::localization::hypotheses
