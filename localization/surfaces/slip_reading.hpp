// SPDX-License-Identifier: Apache-2.0
// The likelihood of a pose that a slip of the wheels may have led to, by the surfaces in view: each of them holds,
// stands where it was last seen, or was moved only now. Pieces of one face count as one observation.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "localization/surfaces/offset_state.hpp"
#include "localization/surfaces/surface_measurement.hpp"
#include "localization/surfaces/surface_switch.hpp"

namespace deltamap::localization::surfaces {

class SlipReading {
 public:
  /// `slip`: how far the pose may lie from the state's, beyond what the state itself says. `in_view`: the followed
  /// surfaces that the scan shows where the wheels have not slipped.
  SlipReading(const OffsetState& state, std::span<const SurfaceSwitch> switches, const PoseCovariance& slip,
              std::vector<bool> in_view);

  struct Answer {
    Pose2 pose;
    double evidence = 0.0;                ///< ln p(scan | slipped there), up to a constant
    Eigen::Matrix3d information;          ///< for a Gauss-Newton step,
    Eigen::Vector3d pull;                 ///< which goes against it
    std::vector<std::size_t> hold_again;  ///< followed surfaces that seemed to have moved, and hold from there
  };
  /// The best pose near one, by Gauss-Newton. `seen_from(const Pose2&)`: sightings; `number_of(SurfaceMap::Id)`: of a
  /// followed surface, negative of any other.
  template <typename SeenFrom, typename NumberOf>
  [[nodiscard]] Answer best_near(Pose2 pose, SeenFrom&& seen_from, NumberOf&& number_of) const {
    Answer best;
    best.evidence = -std::numeric_limits<double>::infinity();
    for (int step = 0; step < kSteps; ++step) {
      const std::span<const Sighting> sightings = seen_from(pose);
      Answer here = at_pose(pose);
      std::vector<bool> in_view(switches_.size());
      for (const Sighting& sighting : sightings) {
        const int number = number_of(sighting.id);
        if (number >= 0) in_view[static_cast<std::size_t>(number)] = true;
        add(here, sighting, number, weight_of(sighting, sightings));
      }
      for (std::size_t i = 0; i < switches_.size(); ++i) {
        if (!in_view[i] && switches_[i].holds < 0.5) add_unseen(here, i);
      }
      here.evidence += log_share_of_spread(here);
      const std::optional<Pose2> next = stepped(here);
      if (here.evidence > best.evidence) best = std::move(here);
      if (!next) break;
      pose = *next;
    }
    return best;
  }

 private:
  static constexpr int kSteps = 5;
  /// One step of Gauss-Newton; nothing where it has arrived.
  [[nodiscard]] static std::optional<Pose2> stepped(const Answer& answer);
  [[nodiscard]] Answer at_pose(const Pose2& pose) const;
  [[nodiscard]] static double weight_of(const Sighting& sighting, std::span<const Sighting> all);
  /// Of all poses within the spread, those that fit (Laplace's approximation of the evidence).
  [[nodiscard]] double log_share_of_spread(const Answer& answer) const;
  void add(Answer& answer, const Sighting& sighting, int followed_as, double weight) const;
  /// One that seemed to have moved, and is no longer in view: the slip may lie before it was seen.
  void add_unseen(Answer& answer, std::size_t number) const;
  [[nodiscard]] double cost_of_moved(std::size_t number) const;
  [[nodiscard]] double cost_of_moved_now(std::size_t number) const;
  /// Beside a pose that is known.
  [[nodiscard]] SurfaceStand last_seen(std::size_t number) const;
  [[nodiscard]] double variance_beside_pose(Eigen::Index i) const;

  const OffsetState& state_;
  std::span<const SurfaceSwitch> switches_;
  std::vector<bool> in_view_;
  std::vector<double> share_of_face_;  // of each followed surface, among those that seem to have moved
  Eigen::Matrix3d known_;              // inverse of the spread
  Eigen::Matrix3d pose_inverse_;       // of the state's covariance
};

}  // namespace deltamap::localization::surfaces
