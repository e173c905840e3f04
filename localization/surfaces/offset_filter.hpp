// SPDX-License-Identifier: Apache-2.0
// A Kalman filter over the pose and the offsets of surfaces: where is the robot, and which surfaces of the map still
// hold? At each keyframe the surfaces in view correct the pose. One that was moved is a landmark with an unknown
// offset: it still observes the robot's motion, but no longer its pose.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "localization/motion/motion_model.hpp"
#include "localization/sensor/likelihood_field.hpp"
#include "localization/surfaces/offset_state.hpp"
#include "localization/surfaces/slip_search.hpp"
#include "localization/surfaces/surface_map.hpp"
#include "localization/surfaces/surface_sighting.hpp"
#include "localization/surfaces/surface_switch.hpp"
#include "localization/surfaces/unknown_of_cells.hpp"

namespace deltamap::localization::surfaces {

class OffsetFilter {
 public:
  explicit OffsetFilter(std::shared_ptr<const OccupancyGrid> map) : map_{std::move(map)} {}

  /// Follows no surface yet. What was learned of the wheels is kept.
  void start(const sensor::RefinedPose& at);
  void restore(const motion::DriveCalibration& learned) { state_.restore(learned); }
  /// What the last keyframe has told is taken back, of pose, wheels and mount. Follows no surface.
  void begin_anew();
  /// Another map, the same but for a box of cells: a surface that lies there as before is still followed.
  void apply(std::shared_ptr<const OccupancyGrid> map, const CellBox& changed);

  /// A pose that was found otherwise: it tells how the wheels have erred. Follows no surface.
  void take(const sensor::RefinedPose& found);

  [[nodiscard]] Pose2 corrected(const motion::WheelStep& step) const { return state_.corrected(step); }
  void predict(const motion::WheelStep& step, const PoseCovariance& added);

  /// What a keyframe showed.
  struct Seen {
    double straight = 0.0;   ///< share of its ends on a surface, where that one is believed to be
    double holding = 0.0;    ///< on surfaces that stand where the map has them, and no more than of the last metres' do
    double followed = 0.0;   ///< on surfaces that were followed before, and are where they were expected
    bool slipped = false;    ///< the wheels had slipped: the pose has gone to where the scan is explained
    bool displaced = false;  ///< by both: along the way it may stand elsewhere
  };
  /// `rest_share`: what an end that is on no surface counts, in (0, 1]. `motion`: how far slips may go.
  Seen observe(const sensor::LikelihoodField& field, const FacedScan& scan, double rest_share,
               const motion::MotionModelParams& motion);
  /// What a scan shows of the map's surfaces, each taken to stand where the map has it.
  struct SeenByMap {
    double straight = 0.0;   ///< share of its ends on them
    UnknownOfCells unknown;  ///< what the cells of those leave open that the pose rests on
  };
  [[nodiscard]] SeenByMap seen_by_map(const sensor::LikelihoodField& field, const FacedScan& scan, const Pose2& pose);

  [[nodiscard]] sensor::RefinedPose believed() const { return state_.pose(); }
  /// What the cells of the last metres' surfaces leave open of the position. The filter itself does not count it.
  [[nodiscard]] UnknownOfCells unknown_of_cells() const;
  [[nodiscard]] motion::DriveCalibration calibration() const { return state_.calibration(); }
  [[nodiscard]] bool is_sound() const { return state_.is_sound(); }

 private:
  struct Visit {
    SurfaceMap::Id id;
    int misfits = 0;  ///< keyframes in a row in which it was not where it was expected
  };
  [[nodiscard]] std::span<const Sighting> find(const sensor::LikelihoodField& field, const FacedScan& scan,
                                               const Pose2& at);
  /// As if all stood where the map has it.
  [[nodiscard]] std::span<const Sighting> find_by_map(const sensor::LikelihoodField& field, const FacedScan& scan,
                                                      const Pose2& at);
  [[nodiscard]] std::vector<Sighting> seen_from(const sensor::LikelihoodField& field, const FacedScan& scan,
                                                const Pose2& at);
  [[nodiscard]] std::optional<Slip> slip_of(const sensor::LikelihoodField& field, const FacedScan& scan,
                                            std::span<const Sighting> sightings,
                                            const motion::MotionModelParams& motion);
  [[nodiscard]] bool is_followed(const Sighting& sighting) const;
  void follow(std::span<const Sighting> sightings);
  void cease(std::size_t surface);
  void drop(std::size_t surface);
  void cease_where_long_unseen();
  void renumber();
  /// Is each where it is expected? One that is not followed yet is expected anywhere.
  [[nodiscard]] std::vector<bool> fit_of(std::span<const Sighting> sightings, const Pose2& at) const;
  [[nodiscard]] Eigen::Vector<double, OffsetState::kFixed> fixed_at(const Pose2& at) const;
  void correct_by(std::span<const Sighting> sightings, const std::vector<bool>& fits, const Pose2& at);
  void correct_by_rest(const sensor::LikelihoodField& field, double share, const Eigen::Vector3d& mount);
  [[nodiscard]] std::size_t surface_of(const Sighting& sighting) const;
  template <typename Counts>
  [[nodiscard]] double share_of_ends(std::span<const Sighting> sightings, const std::vector<bool>& fits,
                                     Counts&& counts) const;
  [[nodiscard]] double share_of_surfaces_held() const;
  void note_visits(std::span<const Sighting> sightings, const std::vector<bool>& fits);

  SurfaceMap map_;
  SightingFinder finder_;
  OffsetState state_;
  OffsetState last_;                     ///< before the newest keyframe
  std::vector<SurfaceSwitch> switches_;  ///< of the surfaces of the state, in its order
  std::vector<Visit> visits_;            ///< of the same surfaces, in the same order
  double since_doubt_m_ = 0.0;           ///< driven since another reading was last looked for
};

}  // namespace deltamap::localization::surfaces
