// SPDX-License-Identifier: Apache-2.0
#include "localization/surfaces/slip_search.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "localization/surfaces/surface_measurement.hpp"

namespace deltamap::localization::surfaces {
namespace {

// Nats against a slip, keyframes of 0.2 m: of one wheel, one in 200 m; of both, that move the robot, in 4 km.
constexpr double kOneWheelOdds = 7.0;
constexpr double kBothWheelsOdds = 10.0;
constexpr double kHalfAxleM = 0.17;  // between a wheel and the robot's centre
constexpr double kSameTurnRad = 0.02;

/// One wheel slips: the robot turns about the other one.
PoseCovariance one_wheel_covariance(const motion::MotionModelParams& motion) {
  const double aside_m = kHalfAxleM * motion.slip_rad;
  return Eigen::Vector3d{aside_m * aside_m, aside_m * aside_m, motion.slip_rad * motion.slip_rad}
      .asDiagonal()
      .toDenseMatrix();
}

std::vector<bool> in_view(const SlipScene& scene) {
  std::vector<bool> seen(scene.switches.size());
  for (const Sighting& sighting : scene.sightings) {
    const std::int32_t number = scene.record_of(sighting.id).followed_as;
    if (number != SurfaceRecord::kNotFollowed) seen[static_cast<std::size_t>(number)] = true;
  }
  return seen;
}

/// The poses turned as the surfaces in view seem to be: the robot has turned instead. The first: not at all.
std::vector<Pose2> turned_back(const SlipScene& scene) {
  const Pose2 at = scene.state.pose().map_from_robot;
  std::vector<double> turns_rad{0.0};
  for (const Sighting& sighting : scene.sightings) {
    const std::int32_t number = scene.record_of(sighting.id).followed_as;
    if (number == SurfaceRecord::kNotFollowed) continue;
    const Eigen::Index offset = OffsetState::offset_of(static_cast<std::size_t>(number));
    const SurfaceMeasurement seen = measurement_of(sighting, at, offset);
    const double turn_rad = seen.turn_rad - scene.state.mean()[offset + 1];
    const bool is_new = seen.has_turn && std::none_of(turns_rad.begin(), turns_rad.end(), [&](double known_rad) {
                          return std::abs(turn_rad - known_rad) < kSameTurnRad;
                        });
    if (is_new) turns_rad.push_back(turn_rad);
  }
  std::vector<Pose2> poses;
  poses.reserve(turns_rad.size());
  for (const double turn_rad : turns_rad) poses.push_back(at * Pose2{0.0, 0.0, turn_rad});
  return poses;
}

std::vector<Pose2> moved_along(std::span<const Pose2> poses, double slip_m) {
  std::vector<Pose2> moved;
  for (const Pose2& pose : poses) {
    for (const double ahead : motion::kSlipsAhead) moved.push_back(pose * Pose2{ahead * slip_m, 0.0, 0.0});
  }
  return moved;
}

/// Where any one surface that seems to have moved would stand as usual.
std::vector<Pose2> undone_moves(const SlipScene& scene) {
  const Pose2 at = scene.state.pose().map_from_robot;
  std::vector<Pose2> poses;
  for (std::size_t i = 0; i < scene.switches.size(); ++i) {
    if (scene.switches[i].holds > 0.5) continue;
    const Eigen::Index offset = OffsetState::offset_of(i);
    const Surface& surface = scene.switches[i].surface;
    const Pose2 unturned{0.0, 0.0, -scene.state.mean()[offset + 1]};
    const double moved_m = scene.state.mean()[offset] - scene.switches[i].usual_m;
    const Point2 from_centre = at.position() - moved_m * surface.normal - surface.centre;
    const Point2 there = surface.centre + unturned * from_centre;
    poses.push_back({there.x(), there.y(), wrapped_angle(at.theta + unturned.theta)});
  }
  return poses;
}

/// For slips at one time: the best pose so far that is better than none.
class Search {
 public:
  Search(const SlipScene& scene, SlipTime when)
      : scene_{scene},
        when_{when},
        seen_from_{when == SlipTime::kNow ? scene.seen_as_followed : scene.seen_as_mapped},
        in_view_{in_view(scene)},
        usual_{reading(PoseCovariance::Zero())
                   .best_near(scene.state.pose().map_from_robot, seen_from_, scene.record_of)
                   .evidence} {}

  void look_near(std::span<const Pose2> poses, const PoseCovariance& spread, bool displaces) {
    const SlipReading slipped = reading(spread);
    for (const Pose2& pose : poses) {
      SlipReading::Answer there = slipped.best_near(pose, seen_from_, scene_.record_of);
      const double gained = there.evidence - usual_ - (displaces ? kBothWheelsOdds : kOneWheelOdds);
      if (gained <= (best_ ? best_->gained : 0.0)) continue;
      std::sort(there.read_wrong.begin(), there.read_wrong.end());
      best_ = Slip{there.pose, spread, displaces, std::move(there.read_wrong), gained};
    }
  }
  [[nodiscard]] const std::optional<Slip>& best() const { return best_; }

 private:
  [[nodiscard]] SlipReading reading(const PoseCovariance& spread) const {
    return {scene_.state, scene_.switches, when_, spread, in_view_};
  }

  const SlipScene& scene_;
  SlipTime when_;
  const SlipScene::SeenFrom& seen_from_;
  std::vector<bool> in_view_;
  double usual_;  ///< evidence without a slip
  std::optional<Slip> best_;
};

}  // namespace

std::optional<Slip> slip_just_now(const SlipScene& scene) {
  const std::vector<Pose2> turned = turned_back(scene);
  const PoseCovariance of_both = motion::slip_covariance(scene.motion, turned.front().theta);
  Search search{scene, SlipTime::kNow};
  search.look_near(turned, one_wheel_covariance(scene.motion), false);
  search.look_near(moved_along(turned, scene.motion.slip_m), of_both, true);
  return search.best();
}

std::optional<Slip> slip_behind(const SlipScene& scene) {
  const std::vector<Pose2> undone = undone_moves(scene);
  if (undone.empty()) return std::nullopt;
  const double aside_m = 0.5 * kForgottenAfterM * scene.motion.slip_rad;  // by a turn that far behind
  const PoseCovariance spread = motion::slip_covariance(scene.motion, scene.state.pose().map_from_robot.theta) +
                                Eigen::Vector3d{aside_m * aside_m, aside_m * aside_m, 0.0}.asDiagonal().toDenseMatrix();
  Search search{scene, SlipTime::kBehind};
  search.look_near(undone, spread, true);
  return search.best();
}

}  // namespace deltamap::localization::surfaces
