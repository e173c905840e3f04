// SPDX-License-Identifier: Apache-2.0
// The likelihood of a pose that a slip of the wheels may have led to, by the surfaces around. After a slip just now
// each stands where it was last seen or was moved meanwhile. A slip that lies metres behind has put all that was seen
// since in the wrong place: each of these holds, or was moved after all. Pieces of one face count as one observation.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "localization/surfaces/offset_state.hpp"
#include "localization/surfaces/surface_map.hpp"
#include "localization/surfaces/surface_measurement.hpp"
#include "localization/surfaces/surface_switch.hpp"

namespace deltamap::localization::surfaces {

/// When the wheels have slipped.
enum class SlipTime { kNow, kBehind };

class SlipReading {
 public:
  /// `slip`: how far the pose may lie from the state's, beyond what the state itself says; zero: they have not slipped.
  /// `in_view`: the followed surfaces that the scan shows where the wheels have not slipped.
  SlipReading(const OffsetState& state, std::span<const SurfaceSwitch> switches, SlipTime when,
              const PoseCovariance& slip, std::vector<bool> in_view);

  struct Answer {
    Pose2 pose;
    double evidence = 0.0;                ///< ln p(scan | slipped there), up to a constant
    Eigen::Matrix3d information;          ///< for a Gauss-Newton step,
    Eigen::Vector3d pull;                 ///< which goes against it
    std::vector<std::size_t> read_wrong;  ///< followed surfaces, seen since a slip that lies behind
  };
  /// The best pose near one, by Gauss-Newton. `seen_from(const Pose2&)`: sightings; `record_of(SurfaceMap::Id)`: what
  /// is known of a surface.
  template <typename SeenFrom, typename RecordOf>
  [[nodiscard]] Answer best_near(Pose2 pose, SeenFrom&& seen_from, RecordOf&& record_of) const {
    Answer best;
    best.evidence = -std::numeric_limits<double>::infinity();
    for (int step = 0; step < kSteps; ++step) {
      const std::span<const Sighting> sightings = seen_from(pose);
      Answer here = at_pose(pose);
      std::vector<bool> in_view(switches_.size());
      for (const Sighting& sighting : sightings) {
        const SurfaceRecord& record = record_of(sighting.id);
        const double weight = weight_of(sighting, sightings);
        if (record.followed_as == SurfaceRecord::kNotFollowed) {
          add_new(here, sighting, record, weight);
        } else {
          const auto number = static_cast<std::size_t>(record.followed_as);
          in_view[number] = true;
          add_followed(here, sighting, number, weight);
        }
      }
      if (when_ == SlipTime::kBehind) add_seen_since(here, in_view);
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
  void add_new(Answer& answer, const Sighting& sighting, const SurfaceRecord& record, double weight) const;
  void add_followed(Answer& answer, const Sighting& sighting, std::size_t number, double weight) const;
  /// `gain`: nats against an explanation by chance. `evidence`: of the best explanation, the surface standing there.
  static void add(Answer& answer, const SurfaceMeasurement& seen, const SurfaceStand& stand, double evidence,
                  double gain, double weight);
  /// Those that are no longer in view: the slip lies where these speak for it most.
  void add_seen_since(Answer& answer, const std::vector<bool>& in_view) const;
  struct Followed {
    SurfaceStand usual;  ///< while it holds
    SurfaceStand last;   ///< where it was last seen, beside a pose that is known
    double cost_of_moved;
    double share_of_face;  ///< among the pieces that hold as it does
  };
  /// ln p of one that is no longer in view, had the robot stood elsewhere when it was seen.
  [[nodiscard]] double evidence_of_unseen(std::size_t number, const Pose2& from_believed) const;
  [[nodiscard]] double cost_of_moved_now(std::size_t number) const;
  [[nodiscard]] double variance_beside_pose(Eigen::Index i) const;

  const OffsetState& state_;
  std::span<const SurfaceSwitch> switches_;
  SlipTime when_;
  std::vector<bool> in_view_;
  std::vector<Followed> followed_;
  std::vector<std::size_t> latest_first_;  // numbers of the followed surfaces, by when they were last in view
  Eigen::Matrix3d known_;                  // inverse of the spread
  Eigen::Matrix3d pose_inverse_;           // of the state's covariance
};

}  // namespace deltamap::localization::surfaces
