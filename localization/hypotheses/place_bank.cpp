// SPDX-License-Identifier: Apache-2.0
#include "localization/hypotheses/place_bank.hpp"

#include <algorithm>
#include <cmath>

#include "core/points_in_map.hpp"
#include "localization/sensor/weighing.hpp"

namespace deltamap::localization::hypotheses {
namespace {

double odds_of(const Place& place) { return place.log_evidence + place.log_prior; }

std::uint8_t steps_at_end(const sensor::LikelihoodField& field, const PointsInMap& in_map, const motion::BeamEnds& ends,
                          std::size_t i) {
  return field.steps_at(field.geometry().cell_at(in_map(Eigen::Vector2f{ends.x_m[i], ends.y_m[i]})));
}

}  // namespace

double mean_log_likelihood(const sensor::LikelihoodField& field, const motion::BeamEnds& ends, const Pose2& pose) {
  if (ends.size() == 0) return 0.0;
  return -sensor::LikelihoodField::kStep * sensor::misfit_steps(field, ends, pose) / static_cast<double>(ends.size());
}

double weighted_log_likelihood(const sensor::LikelihoodField& field, const motion::BeamEnds& ends,
                               std::span<const float> weights, const Pose2& pose) {
  const PointsInMap in_map{pose};
  double sum = 0.0;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    sum += static_cast<double>(weights[i]) * steps_at_end(field, in_map, ends, i);
  }
  return -sensor::LikelihoodField::kStep * sum;
}

Comparison compared(const sensor::LikelihoodField& field, const motion::BeamEnds& ends, std::span<const float> weights,
                    const Pose2& place, const Pose2& other, double of_a_beam) {
  const PointsInMap from_place{place};
  const PointsInMap from_other{other};
  Comparison result;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const int more = steps_at_end(field, from_other, ends, i) - steps_at_end(field, from_place, ends, i);
    (more > 0 ? result.gained : result.lost) += static_cast<double>(weights[i]) * std::abs(more);
  }
  const double of_a_step = of_a_beam * sensor::LikelihoodField::kStep;
  return {of_a_step * result.gained, of_a_step * result.lost};
}

bool is_within(const Pose2& pose, const Pose2& other, double distance_m, double turn_rad) {
  return distance_between(pose, other) < distance_m && std::abs(turn_between(pose.theta, other.theta)) < turn_rad;
}

PlaceBank::PlaceBank(const PlaceBankParams& params) : params_{params} {
  places_.reserve(static_cast<std::size_t>(std::max(params.most, params.most_while_believing)) + 1);
}

void PlaceBank::clear() {
  places_.clear();
  believing_ = false;
}

void PlaceBank::believe(const Pose2& map_from_robot) {
  if (!believing_) {
    places_.clear();
    places_.push_back({});
    believing_ = true;
  }
  places_.front().map_from_robot = map_from_robot;
}

void PlaceBank::believe_among(const Pose2& map_from_robot) {
  auto chosen = std::find_if(places_.begin(), places_.end(),
                             [&](const Place& place) { return same(place.map_from_robot, map_from_robot); });
  if (chosen == places_.end()) return believe(map_from_robot);
  std::swap(places_.front(), *chosen);
  places_.front().map_from_robot = map_from_robot;
  places_.front().log_prior = 0.0;
  believing_ = true;
}

void PlaceBank::forget_carrying() {
  for (Place& place : places_) place.since_carried = place.lost_since = 0.0;
}

void PlaceBank::carry(const Pose2& motion) {
  const double driven_m = motion.position().norm();
  for (Place& place : places_) {
    place.map_from_robot = place.map_from_robot * motion;
    place.followed_m += driven_m;
  }
}

void PlaceBank::slide(Place& place, const sensor::LikelihoodField& field, const motion::BeamEnds& ends,
                      double unknown_s) const {
  const sensor::RefinementParams sliding{.steps = 2, .prior_share = 1.0};
  const double loose_m = 0.06 + 0.3 * unknown_s;
  const double loose_rad = radians(3.0) + 0.3 * unknown_s;
  const PoseCovariance loose =
      Eigen::Vector3d{loose_m * loose_m, loose_m * loose_m, loose_rad * loose_rad}.asDiagonal();
  const double beam_share = std::min(1.0, 20.0 / static_cast<double>(ends.size()));
  const sensor::RefinedPose slid = sensor::refined(field, ends, {place.map_from_robot, loose}, beam_share, sliding);
  place.map_from_robot = slid.map_from_robot;
  place.covariance = slid.covariance;
}

void PlaceBank::slide(const sensor::LikelihoodField& field, const motion::BeamEnds& ends, std::size_t count,
                      double unknown_s) {
  // The believed one too: places slid to their best fit would beat it by a hair at each scan.
  if (believing_ && !places_.empty() && ends.size() > 0) slide(places_.front(), field, ends, unknown_s);
  slide_others(field, ends, count, unknown_s);
}

void PlaceBank::slide_others(const sensor::LikelihoodField& field, const motion::BeamEnds& ends, std::size_t count,
                             double unknown_s) {
  constexpr double kClose = 5.0;
  const std::size_t first = believing_ ? 1 : 0;
  if (places_.empty() || ends.size() == 0) return;
  const double close = odds_of(*reference()) - kClose;
  const std::size_t others = places_.size() - first;
  if (others == 0) return;
  for (std::size_t i = 0; i < others; ++i) {
    const std::size_t after = (i + others - next_to_slide_ % others) % others;  // how soon its turn comes
    Place& place = places_[first + i];
    if (after < count || odds_of(place) > close) slide(place, field, ends, unknown_s);
  }
  next_to_slide_ = (next_to_slide_ + count) % others;
}

void PlaceBank::weigh(const sensor::LikelihoodField& field, const motion::BeamEnds& ends,
                      std::span<const float> weights, double telling) {
  const double kept = 1.0 - 1.0 / params_.memory_steps;
  const double of_a_beam = params_.evidence_of_a_beam();
  double of_believed = 0.0;
  for (Place& place : places_) {
    const double says = of_a_beam * weighted_log_likelihood(field, ends, weights, place.map_from_robot);
    place.log_evidence = kept * place.log_evidence + says;
    if (&place == &places_.front()) of_believed = says;
    const double since_carried = kept * place.since_carried + telling * (says - of_believed);
    place.since_carried = believing_ ? std::max(0.0, since_carried) : 0.0;
    if (place.since_carried == 0.0) {
      place.lost_since = 0.0;
    } else {
      const Comparison beside =
          compared(field, ends, weights, place.map_from_robot, places_.front().map_from_robot, of_a_beam);
      place.lost_since = kept * place.lost_since + telling * beside.lost;
    }
  }
}

bool PlaceBank::same(const Pose2& a, const Pose2& b) const {
  const double x_m = a.x - b.x;
  const double y_m = a.y - b.y;
  return x_m * x_m + y_m * y_m < params_.same_m * params_.same_m &&
         std::abs(turn_between(a.theta, b.theta)) < params_.same_rad;
}

bool PlaceBank::knows(const Pose2& pose) const {
  return std::any_of(places_.begin(), places_.end(),
                     [&](const Place& place) { return same(place.map_from_robot, pose); });
}

const Place* PlaceBank::reference() const {
  if (places_.empty()) return nullptr;
  if (believing_) return &places_.front();
  return &*std::max_element(places_.begin(), places_.end(),
                            [](const Place& a, const Place& b) { return odds_of(a) < odds_of(b); });
}

void PlaceBank::admit(const Place& place) {
  if (knows(place.map_from_robot)) return;
  const auto room = static_cast<std::size_t>(believing_ && !roomy_ ? params_.most_while_believing : params_.most);
  const std::size_t first = believing_ ? 1 : 0;
  if (places_.size() < room + first) {
    places_.push_back(place);
    return;
  }
  const auto worst = std::min_element(places_.begin() + static_cast<std::ptrdiff_t>(first), places_.end(),
                                      [](const Place& a, const Place& b) { return odds_of(a) < odds_of(b); });
  if (worst != places_.end() && odds_of(*worst) < odds_of(place)) *worst = place;
}

void PlaceBank::settle() {
  const Place* const held_against = reference();
  if (held_against == nullptr) return;
  const double hopeless = held_against->log_evidence - params_.hopeless;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    const bool believed = believing_ && i == 0;
    if (!believed && places_[i].log_evidence < hopeless) continue;
    std::size_t twin = 0;
    while (twin < kept && !same(places_[twin].map_from_robot, places_[i].map_from_robot)) ++twin;
    if (twin == kept) {
      places_[kept++] = places_[i];
    } else if (!(believing_ && twin == 0) && odds_of(places_[twin]) < odds_of(places_[i])) {
      const double followed_m = std::max(places_[twin].followed_m, places_[i].followed_m);
      const Place& longer = places_[twin].since_carried > places_[i].since_carried ? places_[twin] : places_[i];
      const double since_carried = longer.since_carried;
      const double lost_since = longer.lost_since;
      places_[twin] = places_[i];
      places_[twin].followed_m = followed_m;
      places_[twin].since_carried = since_carried;
      places_[twin].lost_since = lost_since;
    }
  }
  places_.resize(kept);

  double best = odds_of(places_.front());
  for (const Place& place : places_) best = std::max(best, odds_of(place));
  double sum = 0.0;
  for (Place& place : places_) {
    place.share = std::exp(odds_of(place) - best);
    sum += place.share;
  }
  for (Place& place : places_) place.share /= sum;
}

}  // namespace deltamap::localization::hypotheses
