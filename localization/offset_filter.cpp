// SPDX-License-Identifier: Apache-2.0
#include "localization/offset_filter.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "localization/normal_equations.hpp"

namespace deltamap::localization {
namespace {

constexpr double kRangeDeviationM = 0.015;  // of one beam, laser and surface together
constexpr double kDistanceFloorM = 0.01;    // what all beams on one surface err together
constexpr double kSlopeFloorRad = 0.004;
constexpr double kLeastSpreadM2 = 0.02;    // of the ends along a surface, for its direction to be told
constexpr double kStrange = 16.0;          // squared deviations: not where it was expected
constexpr int kMisfitsOfAChange = 3;       // in a row: it was moved while in view
constexpr double kForgottenAfterM = 15.0;  // driven without a view of it
constexpr std::size_t kMostFollowed = 32;
constexpr std::size_t kMostSightings = 24;
constexpr double kVisitsBefore = 3.0;  // that a surface is taken to have had
constexpr double kUsuallyHolds = 0.9;  // of these
constexpr double kUnknownM = 0.3;      // deviation of a place that no visit has told of
constexpr double kReassignM = 0.02;    // a keyframe that moves the pose further is read once more
constexpr double kReassignRad = 0.005;
constexpr double kFarthestM = 0.3;  // that ends on no surface may move the pose
constexpr double kFarthestRad = 0.18;
constexpr int kRestSteps = 6;

/// What a sighting measures: the distance from where the surface is believed, and the turn against it, 0 expected.
struct Measurement {
  SparseRow distance;
  SparseRow turn;
  double distance_m;
  double turn_rad;
  double distance_variance;
  double turn_variance;
  bool has_turn;
};

/// With the robot at `at`; the rows are over the whole state.
Measurement measurement_of(const Sighting& sighting, const Pose2& at, Eigen::Index offset) {
  const Sighting::Measured seen = sighting.measured(at);
  const Point2& n = sighting.surface.normal;
  const double by_turn_m = n.y() * seen.lever.x() - n.x() * seen.lever.y();
  const double beam2 =
      std::max(kRangeDeviationM * kRangeDeviationM, seen.across_m2 / std::max(1.0, sighting.beams - 2.0));
  return {.distance = {{{{0, n.x()}, {1, n.y()}, {2, by_turn_m}, {offset, -1.0}, {offset + 1, -seen.along_m}}}, 5},
          .turn = {{{{2, -1.0}, {offset + 1, -1.0}}}, 2},
          .distance_m = seen.distance_m,
          .turn_rad = seen.slope,
          .distance_variance = beam2 / sighting.beams + kDistanceFloorM * kDistanceFloorM,
          .turn_variance = beam2 / std::max(1e-6, seen.spread_m2) + kSlopeFloorRad * kSlopeFloorRad,
          .has_turn = seen.spread_m2 > kLeastSpreadM2};
}

/// What the row gives at the state, where its measurement was taken with the pose at `at`.
double expected(const SparseRow& row, const Eigen::VectorXd& mean, const Eigen::Vector3d& at) {
  double sum = 0.0;
  for (const SparseRow::Entry& entry : row.used()) {
    sum += entry.value * (mean[entry.index] - (entry.index < OffsetState::kPose ? at[entry.index] : 0.0));
  }
  return sum;
}

double covariance_of(const SparseRow& a, const SparseRow& b, const Eigen::MatrixXd& covariance) {
  double sum = 0.0;
  for (const SparseRow::Entry& p : a.used()) {
    for (const SparseRow::Entry& q : b.used()) sum += p.value * q.value * covariance(p.index, q.index);
  }
  return sum;
}

/// Do two pieces touch, as the faces of one thing do?
bool touch(const Surface& a, const Surface& b) {
  constexpr double kGapM = 0.4;
  for (const double p : {-1.0, 1.0}) {
    for (const double q : {-1.0, 1.0}) {
      const Point2 end = a.centre + p * a.half_length_m * a.tangent();
      if ((b.centre + q * b.half_length_m * b.tangent() - end).norm() < kGapM) return true;
    }
  }
  return false;
}

/// Are there two among them that no chain of touching ones joins?
bool are_unconnected(std::span<const Sighting* const> sightings) {
  std::vector<bool> joined(sightings.size());
  std::vector<std::size_t> open;
  if (!sightings.empty()) open.push_back(0);
  std::size_t reached = 0;
  while (!open.empty()) {
    const std::size_t at = open.back();
    open.pop_back();
    if (joined[at]) continue;
    joined[at] = true;
    ++reached;
    for (std::size_t k = 0; k < sightings.size(); ++k) {
      if (!joined[k] && touch(sightings[at]->surface, sightings[k]->surface)) open.push_back(k);
    }
  }
  return reached < sightings.size();
}

}  // namespace

void OffsetFilter::start(const RefinedPose& at) {
  for (const Visit& visit : visits_) map_.record(visit.id).followed_as = SurfaceRecord::kNotFollowed;
  visits_.clear();
  switches_.clear();
  state_.start(at);
}

void OffsetFilter::apply(std::shared_ptr<const OccupancyGrid> map, const CellBox& changed) {
  if (!map_.apply(std::move(map), changed)) {
    visits_.clear();
    switches_.clear();
    if (state_.mean().size() > 0) state_.start(state_.pose());
    return;
  }
  for (std::size_t i = visits_.size(); i-- > 0;) {
    visits_[i].id = map_.like(switches_[i].surface);
    if (!visits_[i].id.is_valid()) cease(i);
  }
  renumber();
}

void OffsetFilter::carry(const WheelStep& step, const PoseCovariance& added) {
  state_.carry(step, added);
  const double driven_m = step.motion.position().norm();
  for (Visit& visit : visits_) visit.unseen_m += driven_m;
}

std::size_t OffsetFilter::surface_of(const Sighting& sighting) const {
  return static_cast<std::size_t>(map_.record(sighting.id).followed_as);
}

void OffsetFilter::follow(const Sighting& sighting) {
  SurfaceRecord& record = map_.record(sighting.id);
  if (record.followed_as != SurfaceRecord::kNotFollowed) return;
  record.followed_as = static_cast<std::int32_t>(visits_.size());
  visits_.push_back({.id = sighting.id});
  switches_.push_back({.surface = sighting.surface,
                       .usual_m = record.offset_m,
                       .prior = (kVisitsBefore * kUsuallyHolds + record.held) / (kVisitsBefore + record.visits)});
  state_.append(record.offset_m, kMovedM, kMovedRad);
}

/// To be followed by renumber().
void OffsetFilter::cease(std::size_t surface) {
  if (visits_[surface].id.is_valid()) {
    SurfaceRecord& record = map_.record(visits_[surface].id);
    const double holds = switches_[surface].holds;
    record.followed_as = SurfaceRecord::kNotFollowed;
    record.visits += 1.0;
    record.held += holds;
    if (holds <= 0.5) record.offset_m = state_.mean()[OffsetState::offset_of(surface)];
  }
  state_.remove(surface);
  visits_.erase(visits_.begin() + static_cast<std::ptrdiff_t>(surface));
  switches_.erase(switches_.begin() + static_cast<std::ptrdiff_t>(surface));
}

void OffsetFilter::renumber() {
  for (std::size_t i = 0; i < visits_.size(); ++i)
    map_.record(visits_[i].id).followed_as = static_cast<std::int32_t>(i);
}

void OffsetFilter::cease_where_long_unseen() {
  for (std::size_t i = visits_.size(); i-- > 0;) {
    if (visits_[i].unseen_m > kForgottenAfterM || visits_[i].misfits >= kMisfitsOfAChange) cease(i);
  }
  while (visits_.size() > kMostFollowed) {
    const auto longest = std::max_element(visits_.begin(), visits_.end(),
                                          [](const Visit& a, const Visit& b) { return a.unseen_m < b.unseen_m; });
    cease(static_cast<std::size_t>(longest - visits_.begin()));
  }
  renumber();
}

std::span<const Sighting> OffsetFilter::find(const LikelihoodField& field, std::span<const FacedEnd> ends,
                                             const Pose2& at) {
  return finder_.find(map_, field, ends, at, [&](const SurfaceRecord& record) -> SurfacePlace {
    if (record.followed_as == SurfaceRecord::kNotFollowed) return {record.offset_m, 0.0, kUnknownM};
    const Eigen::Index offset = OffsetState::offset_of(static_cast<std::size_t>(record.followed_as));
    return {state_.mean()[offset], state_.mean()[offset + 1],
            std::sqrt(std::max(0.0, state_.covariance()(offset, offset)))};
  });
}

OffsetFilter::Fit OffsetFilter::fit_of(std::span<const Sighting> sightings) const {
  const Pose2 at = state_.pose().map_from_robot;
  const Eigen::Vector3d here = state_.mean().head<OffsetState::kPose>();
  Fit fit;
  std::vector<const Sighting*> strange;
  for (const Sighting& sighting : sightings) {
    const Measurement seen = measurement_of(sighting, at, OffsetState::offset_of(surface_of(sighting)));
    const double cross = covariance_of(seen.distance, seen.turn, state_.covariance());
    Eigen::Matrix2d spread;
    spread << covariance_of(seen.distance, seen.distance, state_.covariance()) + seen.distance_variance, cross, cross,
        covariance_of(seen.turn, seen.turn, state_.covariance()) + (seen.has_turn ? seen.turn_variance : 1.0);
    const Eigen::Vector2d off{seen.distance_m + expected(seen.distance, state_.mean(), here),
                              seen.turn_rad + expected(seen.turn, state_.mean(), here)};
    fit.fits.push_back(off.dot(spread.inverse() * off) <= kStrange);
    if (!fit.fits.back()) strange.push_back(&sighting);
  }
  fit.slipped = are_unconnected(strange);
  return fit;
}

void OffsetFilter::correct_by(std::span<const Sighting> sightings, const std::vector<bool>& fits, const Pose2& at) {
  const double heading = state_.mean()[2];
  const Eigen::Vector3d here{at.x, at.y, heading + turn_between(heading, at.theta)};
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    if (!fits[i]) continue;
    const Measurement seen = measurement_of(sightings[i], at, OffsetState::offset_of(surface_of(sightings[i])));
    state_.update(seen.distance, -seen.distance_m - expected(seen.distance, state_.mean(), here),
                  seen.distance_variance);
    if (!seen.has_turn) continue;
    state_.update(seen.turn, -seen.turn_rad - expected(seen.turn, state_.mean(), here), seen.turn_variance);
  }
}

OffsetFilter::Seen OffsetFilter::observe(const LikelihoodField& field, std::span<const FacedEnd> ends,
                                         double rest_share, bool may_slip) {
  Seen seen;
  if (ends.empty()) return seen;
  const auto most_beams = [](const Sighting& a, const Sighting& b) { return a.beams > b.beams; };
  std::vector<Sighting> sightings;
  Fit fit;
  OffsetState before;
  for (const bool again : {false, true}) {
    const Pose2 at = state_.pose().map_from_robot;
    const std::span<const Sighting> found = find(field, ends, at);
    if (again) state_ = before;
    sightings.assign(found.begin(), found.end());
    std::stable_sort(sightings.begin(), sightings.end(), most_beams);
    if (sightings.size() > kMostSightings) sightings.resize(kMostSightings);
    for (const Sighting& sighting : sightings) follow(sighting);
    before = state_;
    fit = fit_of(sightings);
    seen.slipped = may_slip && !again && fit.slipped;
    if (seen.slipped) return seen;
    correct_by(sightings, fit.fits, at);
    const Pose2 now = state_.pose().map_from_robot;
    if (distance_between(now, at) <= kReassignM && std::abs(turn_between(now.theta, at.theta)) <= kReassignRad) break;
  }
  note_visits(sightings, fit.fits);
  correct_by_rest(field, rest_share);
  settle(switches_, state_);
  const auto count = static_cast<double>(ends.size());
  seen.straight = 1.0 - static_cast<double>(finder_.rest().size()) / count;
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    if (fit.fits[i] && switches_[surface_of(sightings[i])].holds > 0.5) seen.holding += sightings[i].beams / count;
  }
  cease_where_long_unseen();
  return seen;
}

void OffsetFilter::note_visits(std::span<const Sighting> sightings, const std::vector<bool>& fits) {
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    Visit& visit = visits_[surface_of(sightings[i])];
    visit.unseen_m = 0.0;
    visit.misfits = fits[i] ? 0 : visit.misfits + 1;
  }
}

/// Ends on no surface correct the pose alone, as pose_refinement.hpp does: slid to where they fit, held by the rest.
void OffsetFilter::correct_by_rest(const LikelihoodField& field, double share) {
  if (finder_.rest().size() == 0) return;
  const Eigen::Vector3d start = state_.mean().head<OffsetState::kPose>();
  const Eigen::Matrix3d spread = state_.covariance().topLeftCorner<3, 3>();
  Eigen::Vector3d at = start;
  Eigen::Matrix3d information;
  Eigen::Vector3d pull;
  for (int step = 0; step < kRestSteps; ++step) {
    const NormalEquations beams = normal_equations(field, finder_.rest(), {at.x(), at.y(), wrapped_angle(at.z())});
    information = share * beams.information;
    pull = information * (at - start) - share * beams.pull;  // as seen from the start
    const Eigen::Matrix3d inverse = (Eigen::Matrix3d::Identity() + spread * information).inverse();
    const Eigen::Vector3d next = start + inverse * spread * pull;
    const Eigen::Vector3d move = next - at;
    at = next;
    if (move.head<2>().norm() < 5e-4 && std::abs(move.z()) < 2e-4) break;
  }
  const Eigen::Vector3d moved = at - start;
  if (moved.head<2>().norm() > kFarthestM || std::abs(moved.z()) > kFarthestRad) return;
  state_.multiply<3>(0, information, pull + information * start);
}

double OffsetFilter::straight_share(const LikelihoodField& field, std::span<const FacedEnd> ends, const Pose2& pose) {
  if (ends.empty()) return 0.0;
  (void)finder_.find(map_, field, ends, pose, [](const SurfaceRecord& record) {
    return SurfacePlace{record.offset_m, 0.0, kUnknownM};
  });
  return 1.0 - static_cast<double>(finder_.rest().size()) / static_cast<double>(ends.size());
}

}  // namespace deltamap::localization
