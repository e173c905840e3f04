// SPDX-License-Identifier: Apache-2.0
// How much of what a scan sees has not been seen before. A container that has come or gone misleads every scan of the
// next metres alike: its surface is one fact, not one a scan. Beams on a patch of surface count the less, the more
// beams have met it already. Patches lie in the joined odometry frame, so that they are the same for every place where
// the robot might be.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "localization/motion/deskew.hpp"

namespace deltamap::localization::hypotheses {

class SurfaceNovelty {
 public:
  SurfaceNovelty();

  /// Counts the beams and answers what each is worth, (0, 1]; valid until the next call.
  [[nodiscard]] std::span<const float> weights(const motion::BeamEnds& ends, const Pose2& joined_from_robot);

  void clear();

 private:
  struct Patch {
    std::int8_t column_turn = 0;  ///< how often the torus has been gone round, modulo 256: 32 km
    std::int8_t row_turn = 0;
    std::uint16_t beams = 0;
    std::uint32_t met_at = 0;  ///< scan that met it last
  };
  [[nodiscard]] Patch& patch_at(double x_m, double y_m);

  std::vector<Patch> patches_;  // a torus: far places share an entry, the later one takes it
  std::uint32_t scan_ = 0;
  std::vector<float> weights_;
};

}  // namespace deltamap::localization::hypotheses
