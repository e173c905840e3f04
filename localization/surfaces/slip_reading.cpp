// SPDX-License-Identifier: Apache-2.0
#include "localization/surfaces/slip_reading.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

namespace deltamap::localization::surfaces {
namespace {

// Nats that an explanation costs against "it holds". Moved: anywhere within half a metre, where it would stand to 2 cm,
// and one in ten is where nothing is known of a surface; since it was last in view: one in so many metres.
constexpr double kAnywhere = 3.2;
constexpr double kMoved = 2.2 + kAnywhere;
constexpr double kMovedOnceInM = 1500.0;

/// Where the map has it.
SurfaceStand held(const Surface& surface) {
  return {.offset_m2 = surface.offset_deviation_m * surface.offset_deviation_m,
          .turn_rad2 = surface.turn_deviation_rad * surface.turn_deviation_rad};
}

}  // namespace

SlipReading::SlipReading(const OffsetState& state, std::span<const SurfaceSwitch> switches, const PoseCovariance& slip,
                         std::vector<bool> in_view)
    : state_{state},
      switches_{switches},
      in_view_{std::move(in_view)},
      known_{(state.pose().covariance + slip).inverse()},
      pose_inverse_{state.covariance().topLeftCorner<3, 3>().inverse()} {
  for (const SurfaceSwitch& of : switches) {
    const auto pieces = std::count_if(switches.begin(), switches.end(), [&](const SurfaceSwitch& other) {
      return other.holds < 0.5 && are_one_face(of.surface, other.surface);
    });
    share_of_face_.push_back(1.0 / static_cast<double>(std::max<std::ptrdiff_t>(1, pieces)));
  }
}

double SlipReading::variance_beside_pose(Eigen::Index i) const {
  const Eigen::Vector3d with_pose = state_.covariance().block<3, 1>(0, i);
  return std::max(1e-8, state_.covariance()(i, i) - with_pose.dot(pose_inverse_ * with_pose));
}

SurfaceStand SlipReading::last_seen(std::size_t number) const {
  const Eigen::Index at = OffsetState::offset_of(number);
  return {state_.mean()[at], state_.mean()[at + 1], variance_beside_pose(at), variance_beside_pose(at + 1)};
}

double SlipReading::cost_of_moved(std::size_t number) const {
  const double holds = switches_[number].prior;
  return std::log(holds / (1.0 - holds)) + kAnywhere;
}

double SlipReading::cost_of_moved_now(std::size_t number) const {
  return std::log(kMovedOnceInM / std::max(kKeyframeM, switches_[number].unseen_m)) + kAnywhere;
}

SlipReading::Answer SlipReading::at_pose(const Pose2& pose) const {
  const Pose2 from = state_.pose().map_from_robot;
  const Eigen::Vector3d off{pose.x - from.x, pose.y - from.y, turn_between(from.theta, pose.theta)};
  return {.pose = pose,
          .evidence = -0.5 * off.dot(known_ * off),
          .information = known_,
          .pull = known_ * off,
          .hold_again = {}};
}

std::optional<Pose2> SlipReading::stepped(const Answer& answer) {
  constexpr double kArrivedM = 1e-3;
  constexpr double kArrivedRad = 5e-4;
  const Eigen::Vector3d move = answer.information.ldlt().solve(answer.pull);
  if (move.head<2>().norm() < kArrivedM && std::abs(move.z()) < kArrivedRad) return std::nullopt;
  const Pose2& at = answer.pose;
  return Pose2{at.x - move.x(), at.y - move.y(), wrapped_angle(at.theta - move.z())};
}

double SlipReading::log_share_of_spread(const Answer& answer) const {
  return 0.5 * std::log(known_.determinant() / answer.information.determinant());
}

double SlipReading::weight_of(const Sighting& sighting, std::span<const Sighting> all) {
  const auto pieces = std::count_if(
      all.begin(), all.end(), [&](const Sighting& other) { return are_one_face(sighting.surface, other.surface); });
  return 1.0 / static_cast<double>(std::max<std::ptrdiff_t>(1, pieces));
}

void SlipReading::add(Answer& answer, const Sighting& sighting, int followed_as, double weight) const {
  const SurfaceMeasurement seen = measurement_of(sighting, answer.pose, 0);
  SurfaceStand stand = held(sighting.surface);
  double evidence = -0.5 * seen.strangeness(stand);
  double least = -kMoved;
  double gain = kMoved;
  if (followed_as >= 0) {
    const auto number = static_cast<std::size_t>(followed_as);
    const SurfaceStand last = last_seen(number);
    const double as_last = -0.5 * seen.strangeness(last) - cost_of_moved(number) * (1.0 - switches_[number].holds);
    // One that only this pose has in view may be another thing that stands there by chance.
    if (in_view_[number]) gain = cost_of_moved_now(number);
    least = -gain;
    if (as_last >= evidence) {
      evidence = as_last;
      stand = last;
    } else if (evidence > least && switches_[number].holds < 0.5) {
      answer.hold_again.push_back(number);
    }
  }
  answer.evidence += weight * (gain + std::max(least, evidence));
  // Beams that no explanation fits pull less (Geman and McClure).
  const double trust = weight / std::pow(1.0 + std::max(0.0, -evidence) / gain, 2);
  const SurfaceStand off = seen.off(stand);
  const Eigen::Vector3d row{seen.distance.entries[0].value, seen.distance.entries[1].value,
                            seen.distance.entries[2].value};
  answer.information += trust / off.offset_m2 * row * row.transpose();
  answer.pull += trust / off.offset_m2 * row * off.offset_m;
  if (!seen.has_turn) return;
  answer.information(2, 2) += trust / off.turn_rad2;
  answer.pull[2] -= trust / off.turn_rad2 * off.turn_rad;
}

void SlipReading::add_unseen(Answer& answer, std::size_t number) const {
  const Surface& surface = switches_[number].surface;
  const SurfaceStand last = last_seen(number);
  const Pose2 moved = answer.pose * inverse(state_.pose().map_from_robot);
  const Point2 centre = moved * Point2{surface.centre + last.offset_m * surface.normal};
  const double off_m = surface.normal.dot(centre - surface.centre);
  const double off_rad = last.turn_rad + moved.theta;
  const SurfaceStand mapped = held(surface);
  const double holds = -0.5 * (off_m * off_m / (last.offset_m2 + mapped.offset_m2) +
                               off_rad * off_rad / (last.turn_rad2 + mapped.turn_rad2));
  const double stays = -cost_of_moved(number);
  if (holds > stays) answer.hold_again.push_back(number);
  answer.evidence += share_of_face_[number] * std::max(holds, stays);
}

}  // namespace deltamap::localization::surfaces
