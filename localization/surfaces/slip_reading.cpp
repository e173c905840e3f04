// SPDX-License-Identifier: Apache-2.0
#include "localization/surfaces/slip_reading.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace deltamap::localization::surfaces {
namespace {

// Nats that an explanation costs against "it holds". Moved: anywhere within half a metre, where it would stand to 2 cm;
// since it was last in view: one in so many metres.
constexpr double kAnywhere = 3.2;
constexpr double kSharpM = 0.02;
constexpr double kMovedOnceInM = 1500.0;

double cost_of_moved(double holds) { return std::log(holds / (1.0 - holds)) + kAnywhere; }

/// Of that, what a measurement does not tell that is less sharp: a corner between two beams.
double lost_by_bluntness(const SurfaceMeasurement& seen) {
  return 0.5 * std::log(std::max(1.0, seen.distance_variance / (kSharpM * kSharpM)));
}

SurfaceStand usual_stand(const Surface& surface, double usual_m) {
  return {.offset_m = usual_m,
          .offset_m2 = surface.offset_deviation_m * surface.offset_deviation_m,
          .turn_rad2 = surface.turn_deviation_rad * surface.turn_deviation_rad};
}

}  // namespace

SlipReading::SlipReading(const OffsetState& state, std::span<const SurfaceSwitch> switches, SlipTime when,
                         const PoseCovariance& slip, std::vector<bool> in_view)
    : state_{state},
      switches_{switches},
      when_{when},
      in_view_{std::move(in_view)},
      latest_first_(switches.size()),
      known_{(state.pose().covariance + slip).inverse()},
      pose_inverse_{state.covariance_at<3>(0).inverse()} {
  for (std::size_t i = 0; i < switches.size(); ++i) {
    const SurfaceSwitch& of = switches[i];
    const Eigen::Index at = OffsetState::offset_of(i);
    const auto pieces = std::count_if(switches.begin(), switches.end(), [&](const SurfaceSwitch& other) {
      return (other.holds < 0.5) == (of.holds < 0.5) && move_as_one(of.surface, other.surface);
    });
    followed_.push_back(
        {.usual = usual_stand(of.surface, of.usual_m),
         .last = {state.mean()[at], state.mean()[at + 1], variance_beside_pose(at), variance_beside_pose(at + 1)},
         .cost_of_moved = cost_of_moved(of.prior),
         .share_of_face = 1.0 / static_cast<double>(pieces)});
  }
  std::iota(latest_first_.begin(), latest_first_.end(), std::size_t{0});
  std::stable_sort(latest_first_.begin(), latest_first_.end(),
                   [&](std::size_t a, std::size_t b) { return switches[a].unseen_m < switches[b].unseen_m; });
}

double SlipReading::variance_beside_pose(Eigen::Index i) const {
  const Eigen::Vector3d with_pose{state_.covariance(i, 0), state_.covariance(i, 1), state_.covariance(i, 2)};
  return std::max(1e-8, state_.covariance(i, i) - with_pose.dot(pose_inverse_ * with_pose));
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
          .read_wrong = {}};
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
      all.begin(), all.end(), [&](const Sighting& other) { return move_as_one(sighting.surface, other.surface); });
  return 1.0 / static_cast<double>(pieces);
}

void SlipReading::add_new(Answer& answer, const Sighting& sighting, const SurfaceRecord& record, double weight) const {
  const SurfaceMeasurement seen = measurement_of(sighting, answer.pose, 0);
  const SurfaceStand stand = usual_stand(sighting.surface, record.offset_m);
  add(answer, seen, stand, -0.5 * seen.mahalanobis_squared(stand),
      cost_of_moved(record.usually_holds()) - lost_by_bluntness(seen), weight);
}

void SlipReading::add_followed(Answer& answer, const Sighting& sighting, std::size_t number, double weight) const {
  const SurfaceMeasurement seen = measurement_of(sighting, answer.pose, 0);
  const Followed& followed = followed_[number];
  // One that only this pose has in view may be another thing that stands there by chance.
  const double gain = (in_view_[number] ? cost_of_moved_now(number) : followed.cost_of_moved) - lost_by_bluntness(seen);
  const double as_last = -0.5 * seen.mahalanobis_squared(followed.last);
  if (when_ == SlipTime::kNow) return add(answer, seen, followed.last, as_last, gain, weight);
  const double holds = -0.5 * seen.mahalanobis_squared(followed.usual);
  const double moved = as_last - followed.cost_of_moved * (1.0 - switches_[number].holds);
  if (holds > std::max(moved, -gain) && switches_[number].holds < 0.5) answer.read_wrong.push_back(number);
  add(answer, seen, holds > moved ? followed.usual : followed.last, std::max(holds, moved), gain, weight);
}

void SlipReading::add(Answer& answer, const SurfaceMeasurement& seen, const SurfaceStand& stand, double evidence,
                      double gain, double weight) {
  if (gain <= 0.0) return;  // it may as well have been moved
  answer.evidence += weight * (gain + std::max(-gain, evidence));
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

double SlipReading::evidence_of_unseen(std::size_t number, const Pose2& from_believed) const {
  const Surface& surface = switches_[number].surface;
  const auto& [usual, last, cost_of_moved, share_of_face] = followed_[number];
  const Point2 centre = from_believed * Point2{surface.centre + last.offset_m * surface.normal};
  const double off_m = surface.normal.dot(centre - surface.centre) - usual.offset_m;
  const double off_rad = last.turn_rad + from_believed.theta;
  const double holds = -0.5 * (off_m * off_m / (last.offset_m2 + usual.offset_m2) +
                               off_rad * off_rad / (last.turn_rad2 + usual.turn_rad2));
  return share_of_face * std::max(holds, -cost_of_moved);
}

void SlipReading::add_seen_since(Answer& answer, const std::vector<bool>& in_view) const {
  const Pose2 from_believed = answer.pose * inverse(state_.pose().map_from_robot);
  std::vector<std::size_t> since;
  std::size_t best_count = 0;
  double best = 0.0;
  double sum = 0.0;
  for (const std::size_t number : latest_first_) {
    if (in_view[number]) continue;
    sum += evidence_of_unseen(number, from_believed) - evidence_of_unseen(number, {});
    since.push_back(number);
    if (sum <= best) continue;
    best = sum;
    best_count = since.size();
  }
  answer.evidence += best;
  answer.read_wrong.insert(answer.read_wrong.end(), since.begin(),
                           since.begin() + static_cast<std::ptrdiff_t>(best_count));
}

}  // namespace deltamap::localization::surfaces
