// SPDX-License-Identifier: Apache-2.0
// The pose of a map, other than the true one, that explains a path best: boxes of poses, of which those are halved that
// may hold a better one than is known. No pose is overlooked.
#pragma once

#include <cstddef>

#include "experiments/verdict/ambiguity.hpp"

namespace deltamap::experiments {

class PathSearch {
 public:
  PathSearch(const MapDistances& map, const SeenPath& path, const AmbiguityParams& params)
      : map_{map}, path_{path}, params_{params} {}

  /// Pieces of surface that the map does not explain if the path's middle lies here: beams that end beside every
  /// obstacle, go through one, or come from where there is no floor.
  [[nodiscard]] double unexplained(const Pose2& map_from_middle) const;
  /// Whether the map explains a beam of the path if its middle lies here.
  [[nodiscard]] bool explains(const SeenPath::Beam& beam, const Pose2& map_from_middle) const;

  struct Rival {
    Pose2 map_from_middle;
    double unexplained = 0.0;
  };
  /// The best that leaves less than `most` pieces unexplained; {truth, most} where there is none. Content with one that
  /// leaves no more than `enough`.
  [[nodiscard]] Rival best_rival(double most, double enough);
  [[nodiscard]] std::size_t judged_poses() const { return judged_; }

 private:
  struct Turn;
  struct Box {
    Pose2 middle;
    double half_m;
    double half_rad;
    double least;  // pieces that no pose of it explains
  };
  [[nodiscard]] bool explains(const SeenPath::Beam& beam, const Turn& turn) const;
  [[nodiscard]] double least_unexplained(const Box& box, double limit) const;
  [[nodiscard]] std::vector<Box> first_boxes(double most) const;
  [[nodiscard]] bool is_wrong(const Pose2& pose) const;
  [[nodiscard]] bool is_all_right(const Box& box) const;
  [[nodiscard]] Rival climbed(const Pose2& from) const;
  void split(const Box& box, double most, std::vector<Box>& open) const;

  const MapDistances& map_;
  const SeenPath& path_;
  AmbiguityParams params_;
  mutable std::size_t judged_ = 0;
};

}  // namespace deltamap::experiments
