// SPDX-License-Identifier: Apache-2.0
// The aliases of the believed pose: poses at which the map looks as it does here. A hall of equal bays, or one that a
// quarter turn maps onto itself, has the same few aliases wherever the robot drives, each given by one rigid motion of
// the map. Each that was met is remembered and examined again and again: a kidnapped robot that stands at an alias is
// noticed nowhere else.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/pose2.hpp"

namespace deltamap::localization::hypotheses {

class PoseAliases {
 public:
  /// Remembers `most`; beyond, those that have been followed for the shortest way go. One that has not been met again
  /// while the robot drove a kilometre is of somewhere else, or of a map that has changed.
  explicit PoseAliases(std::size_t most) : most_{most} { aliases_.reserve(most); }

  /// A hypothesis that has explained the scans beside the believed pose, for so long.
  void note(const Pose2& map_from_believed, const Pose2& map_from_hypothesis, double followed_m);

  /// The robot has driven on.
  void age(double driven_m);

  /// The next alias of the believed pose, one after the other; nothing while none is known.
  [[nodiscard]] std::optional<Pose2> next(const Pose2& map_from_believed);

 private:
  struct Alias {
    Pose2 map_from_map;  // applied to a pose it gives the pose's alias
    double followed_m = 0.0;
    double driven_since_m = 0.0;  // it was met last
  };

  std::size_t most_;
  std::vector<Alias> aliases_;
  std::size_t next_ = 0;
};

}  // namespace deltamap::localization::hypotheses
