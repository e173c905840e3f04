// SPDX-License-Identifier: Apache-2.0
#include "localization/surfaces/offset_filter.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/geometry/principal_axes.hpp"
#include "localization/sensor/normal_equations.hpp"
#include "localization/surfaces/surface_measurement.hpp"

namespace deltamap::localization::surfaces {
namespace {

constexpr double kDoubtsAgainM = 1.0;  // driven between two looks for a slip that lies behind
constexpr int kMisfitsOfAChange = 3;   // in a row: it was moved while in view
constexpr std::size_t kMostFollowed = 32;
constexpr std::size_t kMostSightings = 24;
constexpr double kReassignM = 0.02;  // a keyframe that moves the pose further is read once more
constexpr double kReassignRad = 0.005;
constexpr double kFarthestRad = 0.18;        // that ends on no surface may turn the pose
constexpr double kFewestOfADirection = 2.0;  // surfaces that tell of it

using Fixed = Eigen::Vector<double, OffsetState::kFixed>;

/// What the row gives at the state, where its measurement was taken with pose and mount at `at`.
double expected(const SparseRow& row, const Eigen::VectorXd& mean, const Fixed& at) {
  double sum = 0.0;
  for (const SparseRow::Entry& entry : row.used()) {
    sum += entry.value * (mean[entry.index] - (entry.index < OffsetState::kFixed ? at[entry.index] : 0.0));
  }
  return sum;
}

double covariance_of(const SparseRow& a, const SparseRow& b, const OffsetState& state) {
  double sum = 0.0;
  for (const SparseRow::Entry& p : a.used()) {
    for (const SparseRow::Entry& q : b.used()) sum += p.value * q.value * state.covariance(p.index, q.index);
  }
  return sum;
}

}  // namespace

void OffsetFilter::start(const sensor::RefinedPose& at) {
  for (const Visit& visit : visits_) map_.record(visit.id).followed_as = SurfaceRecord::kNotFollowed;
  visits_.clear();
  switches_.clear();
  state_.start(at);
}

void OffsetFilter::begin_anew() {
  state_ = last_;
  start(state_.pose());
}

void OffsetFilter::take(const sensor::RefinedPose& found) {
  if (!visits_.empty() || !state_.update(found)) start(found);
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

void OffsetFilter::predict(const motion::WheelStep& step, const PoseCovariance& added) {
  state_.predict(step, added);
  const double driven_m = step.motion.position().norm();
  since_doubt_m_ += driven_m;
  for (SurfaceSwitch& followed : switches_) followed.unseen_m += driven_m;
}

std::size_t OffsetFilter::surface_of(const Sighting& sighting) const {
  return static_cast<std::size_t>(map_.record(sighting.id).followed_as);
}

bool OffsetFilter::is_followed(const Sighting& sighting) const {
  return map_.record(sighting.id).followed_as != SurfaceRecord::kNotFollowed;
}

void OffsetFilter::follow(std::span<const Sighting> sightings) {
  for (const Sighting& sighting : sightings) {
    if (is_followed(sighting)) continue;
    SurfaceRecord& record = map_.record(sighting.id);
    record.followed_as = static_cast<std::int32_t>(visits_.size());
    visits_.push_back({.id = sighting.id});
    switches_.push_back({.surface = sighting.surface, .usual_m = record.offset_m, .prior = record.usually_holds()});
    state_.append(record.offset_m, sensor::kMovedM, kMovedRad);
  }
}

/// To be followed by renumber().
void OffsetFilter::cease(std::size_t surface) {
  if (visits_[surface].id.is_valid()) {
    SurfaceRecord& record = map_.record(visits_[surface].id);
    const double holds = switches_[surface].holds;
    record.visits += 1.0;
    record.visits_in_place += holds;
    if (holds <= 0.5) record.offset_m = state_.mean()[OffsetState::offset_of(surface)];
  }
  drop(surface);
}

/// Without a memory of the visit. To be followed by renumber().
void OffsetFilter::drop(std::size_t surface) {
  if (visits_[surface].id.is_valid()) map_.record(visits_[surface].id).followed_as = SurfaceRecord::kNotFollowed;
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
    if (switches_[i].unseen_m > kForgottenAfterM || visits_[i].misfits >= kMisfitsOfAChange) cease(i);
  }
  while (visits_.size() > kMostFollowed) {
    const auto longest =
        std::max_element(switches_.begin(), switches_.end(),
                         [](const SurfaceSwitch& a, const SurfaceSwitch& b) { return a.unseen_m < b.unseen_m; });
    cease(static_cast<std::size_t>(longest - switches_.begin()));
  }
  renumber();
}

std::span<const Sighting> OffsetFilter::find(const sensor::LikelihoodField& field, const FacedScan& scan,
                                             const Pose2& at) {
  return finder_.find(map_, field, scan, at, [&](const SurfaceRecord& record) -> SurfacePlace {
    if (record.followed_as == SurfaceRecord::kNotFollowed) return {record.offset_m, 0.0, sighting::kMostDeviationM};
    const Eigen::Index offset = OffsetState::offset_of(static_cast<std::size_t>(record.followed_as));
    return {state_.mean()[offset], state_.mean()[offset + 1],
            std::sqrt(std::max(0.0, state_.covariance(offset, offset)))};
  });
}

std::span<const Sighting> OffsetFilter::find_by_map(const sensor::LikelihoodField& field, const FacedScan& scan,
                                                    const Pose2& at) {
  return finder_.find(map_, field, scan, at, [](const SurfaceRecord& record) {
    return SurfacePlace{record.offset_m, 0.0, sighting::kMostDeviationM};
  });
}

/// Pose and mount where measurements are taken.
Eigen::Vector<double, OffsetState::kFixed> OffsetFilter::fixed_at(const Pose2& at) const {
  const double heading = state_.mean()[2];
  Fixed fixed = state_.mean().head<OffsetState::kFixed>();
  fixed.head<OffsetState::kPose>() << at.x, at.y, heading + turn_between(heading, at.theta);
  return fixed;
}

std::vector<bool> OffsetFilter::fit_of(std::span<const Sighting> sightings, const Pose2& at) const {
  const Fixed here = fixed_at(at);
  std::vector<bool> fits;
  for (const Sighting& sighting : sightings) {
    if (!is_followed(sighting)) {
      fits.push_back(true);
      continue;
    }
    const SurfaceMeasurement seen = measurement_of(sighting, at, OffsetState::offset_of(surface_of(sighting)));
    const double cross = covariance_of(seen.distance, seen.turn, state_);
    Eigen::Matrix2d spread;
    spread << covariance_of(seen.distance, seen.distance, state_) + seen.distance_variance, cross, cross,
        covariance_of(seen.turn, seen.turn, state_) + (seen.has_turn ? seen.turn_variance : 1.0);
    const Eigen::Vector2d off{seen.distance_m + expected(seen.distance, state_.mean(), here),
                              seen.turn_rad + expected(seen.turn, state_.mean(), here)};
    fits.push_back(off.dot(spread.inverse() * off) <= kInnovationGate);
  }
  return fits;
}

void OffsetFilter::correct_by(std::span<const Sighting> sightings, const std::vector<bool>& fits, const Pose2& at) {
  const Fixed here = fixed_at(at);
  std::vector<RowMeasurement> rows;
  rows.reserve(2 * sightings.size());
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    if (!fits[i]) continue;
    const SurfaceMeasurement seen = measurement_of(sightings[i], at, OffsetState::offset_of(surface_of(sightings[i])));
    rows.push_back(
        {seen.distance, -seen.distance_m - expected(seen.distance, state_.mean(), here), seen.distance_variance});
    if (!seen.has_turn) continue;
    rows.push_back({seen.turn, -seen.turn_rad - expected(seen.turn, state_.mean(), here), seen.turn_variance});
  }
  state_.update(rows);
}

/// Only now, where something is not where it was expected; metres ago, where something seems to have moved. Answers
/// where the slip has led to, and is less sure of the pose then.
std::optional<Slip> OffsetFilter::slip_of(const sensor::LikelihoodField& field, const FacedScan& scan,
                                          std::span<const Sighting> sightings,
                                          const motion::MotionModelParams& motion) {
  const std::vector<bool> fits = fit_of(sightings, state_.pose().map_from_robot);
  const bool is_unexplained = std::find(fits.begin(), fits.end(), false) != fits.end();
  const bool doubts_again = since_doubt_m_ >= kDoubtsAgainM;
  if (!is_unexplained && !doubts_again) return std::nullopt;
  const SlipScene scene{.state = state_,
                        .switches = switches_,
                        .sightings = sightings,
                        .motion = motion,
                        .seen_as_followed = [&](const Pose2& at) { return find(field, scan, at); },
                        .seen_as_mapped = [&](const Pose2& at) { return find_by_map(field, scan, at); },
                        .record_of = [&](SurfaceMap::Id id) -> const SurfaceRecord& { return map_.record(id); }};
  std::optional<Slip> slip = is_unexplained ? slip_just_now(scene) : std::nullopt;
  std::optional<Slip> behind = doubts_again ? slip_behind(scene) : std::nullopt;
  since_doubt_m_ = 0.0;
  if (behind && (!slip || behind->gained > slip->gained)) slip = std::move(behind);
  if (!slip) return std::nullopt;
  for (std::size_t i = slip->read_wrong.size(); i-- > 0;) drop(slip->read_wrong[i]);
  renumber();
  state_.widen(slip->spread);
  return slip;
}

/// The surfaces that the scan shows from a pose: those of which it shows the most.
std::vector<Sighting> OffsetFilter::seen_from(const sensor::LikelihoodField& field, const FacedScan& scan,
                                              const Pose2& at) {
  const std::span<const Sighting> found = find(field, scan, at);
  std::vector<Sighting> sightings{found.begin(), found.end()};
  std::stable_sort(sightings.begin(), sightings.end(),
                   [](const Sighting& a, const Sighting& b) { return a.beams > b.beams; });
  if (sightings.size() > kMostSightings) sightings.resize(kMostSightings);
  return sightings;
}

/// Of the ends, those on surfaces that are where they were expected and of which `counts` is true, by their number.
template <typename Counts>
double OffsetFilter::share_of_ends(std::span<const Sighting> sightings, const std::vector<bool>& fits,
                                   Counts&& counts) const {
  double counted = 0.0;
  double all = static_cast<double>(finder_.rest().size());
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    all += sightings[i].beams;
    if (fits[i] && counts(surface_of(sightings[i]))) counted += sightings[i].beams;
  }
  return all > 0.0 ? counted / all : 0.0;
}

OffsetFilter::Seen OffsetFilter::observe(const sensor::LikelihoodField& field, const FacedScan& scan, double rest_share,
                                         const motion::MotionModelParams& motion) {
  Seen seen;
  if (scan.ends.empty()) return seen;
  last_ = state_.without_surfaces();
  const Eigen::Vector3d mount = state_.mean().segment<3>(OffsetState::kMount);
  std::vector<Sighting> sightings = seen_from(field, scan, state_.pose().map_from_robot);
  const std::optional<Slip> slip = slip_of(field, scan, sightings, motion);
  seen.slipped = slip.has_value();
  seen.displaced = slip && slip->displaced;
  const Pose2 at = slip ? slip->led_to : state_.pose().map_from_robot;
  if (slip) sightings = seen_from(field, scan, at);
  const std::size_t known = visits_.size();
  follow(sightings);
  std::vector<bool> fits = fit_of(sightings, at);
  OffsetState before = state_;
  correct_by(sightings, fits, at);
  const Pose2 now = state_.pose().map_from_robot;
  if (distance_between(now, at) > kReassignM || std::abs(turn_between(now.theta, at.theta)) > kReassignRad) {
    std::swap(state_, before);
    sightings = seen_from(field, scan, now);
    follow(sightings);
    fits = fit_of(sightings, at);
    correct_by(sightings, fits, at);
  }
  note_visits(sightings, fits);
  correct_by_rest(field, rest_share, mount);
  settle(switches_, state_);
  const auto count = static_cast<double>(scan.ends.size());
  seen.straight = 1.0 - static_cast<double>(finder_.rest().size()) / count;
  const auto holds = [&](std::size_t surface) { return switches_[surface].holds > 0.5; };
  seen.holding = std::min(share_of_ends(sightings, fits, holds), share_of_surfaces_held());
  seen.followed = share_of_ends(sightings, fits, [&](std::size_t surface) { return surface < known; });
  cease_where_long_unseen();
  return seen;
}

/// Of the surfaces of the last metres that tell of a direction, those that hold; in the direction of which fewer do.
double OffsetFilter::share_of_surfaces_held() const {
  Eigen::Matrix2d all = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d held = Eigen::Matrix2d::Zero();
  for (const SurfaceSwitch& of : switches_) {
    const Point2& normal = of.surface.normal;
    all += normal * normal.transpose();
    if (of.holds > 0.5) held += normal * normal.transpose();
  }
  const PrincipalAxes directions = principal_axes(all);
  if (directions.values[0] < kFewestOfADirection) return 0.0;
  const Eigen::Matrix2d scale =
      directions.vectors * directions.values.cwiseInverse().cwiseSqrt().asDiagonal() * directions.vectors.transpose();
  return principal_axes(scale * held * scale).values[0];
}

void OffsetFilter::note_visits(std::span<const Sighting> sightings, const std::vector<bool>& fits) {
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    const std::size_t number = surface_of(sightings[i]);
    switches_[number].unseen_m = 0.0;
    visits_[number].misfits = fits[i] ? 0 : visits_[number].misfits + 1;
  }
}

/// Ends on no surface correct the pose alone, as pose_refinement.hpp does: refined to where they fit, held by the rest.
/// `mount`: as the scan was corrected by.
void OffsetFilter::correct_by_rest(const sensor::LikelihoodField& field, double share, const Eigen::Vector3d& mount) {
  if (finder_.rest().size() == 0) return;
  const sensor::RefinementParams as_delivered;
  const Eigen::Vector<double, 6> before = state_.mean().head<6>();
  const Eigen::Matrix<double, 3, 6> by = state_.scan_by_pose_and_mount();
  const Eigen::Vector3d start = before.head<3>() + by.rightCols<3>() * (before.tail<3>() - mount);
  const Eigen::Matrix3d spread = by * state_.covariance_at<6>(0) * by.transpose();
  Eigen::Vector3d at = start;
  Eigen::Matrix3d information;
  Eigen::Vector3d pull;
  for (int step = 0; step < as_delivered.steps; ++step) {
    const sensor::NormalEquations beams =
        sensor::normal_equations(field, finder_.rest(), {at.x(), at.y(), wrapped_angle(at.z())});
    information = share * beams.information;
    pull = information * (at - start) - share * beams.pull;  // as seen from the start
    const Eigen::Matrix3d inverse = (Eigen::Matrix3d::Identity() + spread * information).inverse();
    const Eigen::Vector3d next = start + inverse * spread * pull;
    const Eigen::Vector3d move = next - at;
    at = next;
    if (sensor::is_settled(move)) break;
  }
  const Eigen::Vector3d moved = at - start;
  if (moved.head<2>().norm() > as_delivered.longest_shift_m || std::abs(moved.z()) > kFarthestRad) return;
  state_.multiply<6>(0, by.transpose() * information * by, by.transpose() * (pull + information * by * before));
}

OffsetFilter::SeenByMap OffsetFilter::seen_by_map(const sensor::LikelihoodField& field, const FacedScan& scan,
                                                  const Pose2& pose) {
  if (scan.ends.empty()) return {};
  const std::span<const Sighting> sightings = find_by_map(field, scan, pose);
  return {1.0 - static_cast<double>(finder_.rest().size()) / static_cast<double>(scan.ends.size()),
          surfaces::unknown_of_cells(
              supporting_faces(sightings, pose, sighting::kExplainedCells * field.geometry().resolution_m))};
}

UnknownOfCells OffsetFilter::unknown_of_cells() const {
  std::vector<SupportingFace> faces;
  faces.reserve(switches_.size());
  for (std::size_t i = 0; i < switches_.size(); ++i) {
    const SurfaceSwitch& of = switches_[i];
    faces.push_back({.normal = of.surface.normal,
                     .cells_m = of.surface.offset_deviation_m,
                     .off_m = state_.mean()[OffsetState::offset_of(i)] - of.usual_m,
                     .weight = of.holds * of.share});
  }
  return surfaces::unknown_of_cells(faces);
}

}  // namespace deltamap::localization::surfaces
