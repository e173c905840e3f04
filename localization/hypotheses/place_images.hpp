// SPDX-License-Identifier: Apache-2.0
// Where the map looks elsewhere as it does here. A hall of bays, or one that is its own image under a quarter turn,
// offers the same few images of the believed pose wherever the robot drives: once met they are remembered and looked at
// again and again, for it is one of them where a robot that has been carried is not missed.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/pose2.hpp"

namespace deltamap::localization::hypotheses {

class PlaceImages {
 public:
  /// Remembers `most`; beyond, those that have been followed for the shortest way go. One that has not been met again
  /// while the robot drove `forgotten_after_m` is of somewhere else, or of a map that has changed.
  explicit PlaceImages(std::size_t most, double forgotten_after_m = 1000.0)
      : most_{most}, forgotten_after_m_{forgotten_after_m} {
    images_.reserve(most);
  }

  [[nodiscard]] std::size_t size() const { return images_.size(); }

  /// A place that has explained the scans beside the believed pose, for so long.
  void note(const Pose2& map_from_believed, const Pose2& map_from_place, double followed_m);

  /// The robot has driven on.
  void age(double driven_m);

  /// Where the robot is if it is at one of the images: one after the other; nothing while none is known.
  [[nodiscard]] std::optional<Pose2> next(const Pose2& map_from_believed);

 private:
  struct Image {
    Pose2 map_from_map;  // applied to a pose it is the pose's image
    double followed_m = 0.0;
    double driven_since_m = 0.0;  // it was met last
  };

  std::size_t most_;
  double forgotten_after_m_;
  std::vector<Image> images_;
  std::size_t next_ = 0;
};

}  // namespace deltamap::localization::hypotheses
