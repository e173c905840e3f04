// SPDX-License-Identifier: Apache-2.0
// Where a later drive lies in what the drives before it have seen: its last metres are searched for everywhere, again
// and again while it goes on. At its end the looks vote, so that a place that looks alike is not taken for the other.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "surveying/slam/survey.hpp"

namespace deltamap::surveying::slam {

class DriveJoining {
 public:
  explicit DriveJoining(const Survey& survey);
  ~DriveJoining();
  DriveJoining(const DriveJoining&) = delete;
  DriveJoining& operator=(const DriveJoining&) = delete;

  /// After each keyframe of a drive that has a frame of its own.
  void search_from(std::uint32_t node);
  /// After its last one: the link to the drives before it, where most looks agree. Then all is forgotten.
  [[nodiscard]] std::optional<mapping::alignment::PoseLink> link();

 private:
  /// What the first drive, and those that have been joined to it, have seen.
  struct Joined;
  /// One look.
  struct Found {
    std::uint32_t from = 0;  ///< keyframe after which it was looked for
    std::uint32_t node = 0;  ///< whose pose was found
    Pose2 map_from_node;
    PoseCovariance covariance;
    double score = 0.0;
  };
  void search(std::uint32_t node, double length_m);
  [[nodiscard]] bool agree(const Found& a, const Found& b) const;

  const Survey& survey_;
  std::unique_ptr<Joined> joined_;
  std::vector<Found> found_;
  double next_m_ = 0.0;  // driven
};

}  // namespace deltamap::surveying::slam
