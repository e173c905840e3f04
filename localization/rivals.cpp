// SPDX-License-Identifier: Apache-2.0
#include "localization/rivals.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "localization/weighing.hpp"

namespace deltamap::localization {
namespace {

constexpr std::size_t kProbesKept = 8;
constexpr double kFitsNearlyAsWell = 0.15;  // mean ln p(z) that a newcomer may fit worse by
constexpr double kOverlooked = -2.0;        // log odds of a place that earlier looks did not find
constexpr double kAroundM = 0.6;            // places that the next scans may join
constexpr double kFarthestBehind = 6.0;     // log evidence: the stack may hold scans from before a slip

bool is_within(const Pose2& pose, const Pose2& other, double distance_m, double turn_rad) {
  return distance_between(pose, other) < distance_m && std::abs(turn_between(pose.theta, other.theta)) < turn_rad;
}

/// By how much log evidence the newest scans speak for a place against another, since when they speak for it most.
/// Older ones lie too far back for a robot that has just been carried, and among hundreds of places chance favours one.
double ahead_lately(const ScanStack::Sums& its, const ScanStack::Sums& others, std::size_t scans) {
  constexpr std::size_t kLately = 6;
  double ahead = 0.0;
  for (std::size_t k = 0; k < std::min(scans, kLately); ++k) ahead = std::max(ahead, its[k] - others[k]);
  return ahead;
}

}  // namespace

Rivals::Rivals(const RivalsParams& params, const PlaceBankParams& bank, const GlobalSearchParams& search,
               const OccupancyGrid& map, const LikelihoodField& field, std::uint64_t seed)
    : params_{params},
      coarse_{map, field, params.block_m},
      probes_{params.headings, kProbesKept},
      search_{search, params.headings},
      bank_{bank},
      random_{seed},
      elsewhere_prior_{params.elsewhere_prior} {}

void Rivals::start_believing() {
  believing_ = true;
  elsewhere_prior_ = params_.elsewhere_prior;
  forget_places();
  report_ = {};
}

/// And all that was seen.
void Rivals::forget_places() {
  bank_.clear();
  stack_.clear();
  novelty_.clear();
}

void Rivals::start_believing_in(const Pose2& found) {
  believing_ = true;
  bank_.set_believed_prior(0.0);
  if (!is_near_believed(found)) {
    elsewhere_prior_ = params_.prior_after_search;
    stack_.clear();  // its scans are from before the robot was carried off
    bank_.set_priors([](const Pose2&) { return 0.0; });
  }
  bank_.believe_among(found);
  write_report();
}

void Rivals::stop_believing() {
  believing_ = false;
  bank_.stop_believing();
  bank_.set_priors([&](const Pose2& pose) { return log_prior_unbelieved(pose); });
  search_.start();
  if (report_.beaten) stack_.keep_last(beaten_for_m_);
  write_report();
}

void Rivals::suspect(bool suspicious) {
  if (suspicious && !suspicious_ && !search_.under_way()) search_.start();
  suspicious_ = suspicious;
  bank_.make_room(suspicious);
}

void Rivals::start_anywhere() {
  forget_places();
  last_believed_.reset();
  stop_believing();
}

double Rivals::share_around(const Pose2& pose) const {
  double share = 0.0;
  for (const Place& place : bank_.places().subspan(bank_.believing() ? 1 : 0)) {
    if (is_within(place.map_from_robot, pose, kAroundM, params_.nearby_rad)) share += place.share;
  }
  return share;
}

bool Rivals::is_near_believed(const Pose2& pose) const {
  return last_believed_ && is_within(pose, *last_believed_, params_.nearby_m, params_.nearby_rad);
}

double Rivals::log_prior_unbelieved(const Pose2& pose) const {
  if (believing_) return std::log(elsewhere_prior_);
  return !last_believed_ || is_near_believed(pose) ? 0.0 : std::log(params_.kidnapped_prior);
}

std::optional<Place> Rivals::best_place() const {
  const Place* const best = bank_.reference();
  if (best == nullptr) return std::nullopt;
  Place found = *best;
  found.share = share_around(best->map_from_robot);
  return found;
}

void Rivals::apply(const OccupancyGrid& map, const LikelihoodField& field, const CellBox& changed) {
  const bool whole = changed.width() == map.width() && changed.height() == map.height();
  if (whole) {
    coarse_ = CoarseField{map, field, params_.block_m};  // it may have grown
  } else {
    coarse_.update(map, field, changed);
  }
}

void Rivals::thin(const Seen& seen) {
  const auto most = static_cast<std::size_t>(std::max(1, bank_.params().beams));
  const std::size_t count = std::min(most, seen.ends.size());
  ends_.x_m.resize(count);
  ends_.y_m.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t from = i * seen.ends.size() / count;
    ends_.x_m[i] = seen.ends.x_m[from];
    ends_.y_m[i] = seen.ends.y_m[from];
  }
  keep_near_ends();
}

/// All where only few are near.
void Rivals::keep_near_ends() {
  constexpr float kNear_m = 10.0F;  // half a step of the lattice's headings turns an end by a block there
  constexpr std::size_t kEnough = 12;
  near_ends_.x_m.clear();
  near_ends_.y_m.clear();
  for (std::size_t i = 0; i < ends_.size(); ++i) {
    if (std::hypot(ends_.x_m[i], ends_.y_m[i]) > kNear_m) continue;
    near_ends_.x_m.push_back(ends_.x_m[i]);
    near_ends_.y_m.push_back(ends_.y_m[i]);
  }
  if (near_ends_.size() < kEnough) near_ends_ = ends_;
}

const RivalReport& Rivals::observe(const LikelihoodField& field, const Seen& seen) {
  const Pose2 motion = last_joined_ ? motion_between(*last_joined_, seen.joined_from_robot) : Pose2{};
  last_joined_ = seen.joined_from_robot;
  bank_.carry(motion);
  if (last_believed_) last_believed_ = *last_believed_ * motion;
  if (believing_ && seen.map_from_believed) bank_.believe(*seen.map_from_believed);
  if (believing_) last_believed_ = seen.map_from_believed;
  held_by_ = believing_ ? params_.held_by * seen.held : 0.0;
  bank_.set_believed_prior(held_by_);
  thin(seen);
  if (ends_.size() == 0) return report_;

  const auto slid = static_cast<std::size_t>(believing_ ? params_.refined_a_scan : bank_.params().most);
  bank_.slide(field, ends_, slid, seen.unknown_s);
  since_step_m_ += motion.position().norm();
  since_step_rad_ += std::abs(motion.theta);
  if (since_step_m_ >= bank_.params().step_m || since_step_rad_ >= bank_.params().step_rad) {
    bank_.weigh(field, ends_, novelty_.weights(ends_, seen.joined_from_robot));
    since_step_m_ = 0.0;
    since_step_rad_ = 0.0;
  }
  if (believing_) probe(field, seen.joined_from_robot);
  if (!believing_ || suspicious_) {
    const std::span<const Pose2> found = search_.look(coarse_, field, {ends_, near_ends_}, seen.joined_from_robot,
                                                      believing_ ? params_.suspicious_pace : 1.0);
    if (!found.empty()) admit_all(field, found, seen.joined_from_robot);
  }
  bank_.settle();
  stack_.add(ends_, seen.joined_from_robot);
  write_report();
  return report_;
}

double Rivals::ahead_of(const ScanStack::Sums& others, const LikelihoodField& field, const Pose2& pose,
                        const Pose2& joined) const {
  const ScanStack::Sums its = stack_.log_likelihoods(field, pose, joined);
  double ahead = 0.0;
  for (std::size_t k = 0; k < stack_.size(); ++k) {
    const double since_then = its[k] - others[k];
    ahead = believing_ ? std::max(ahead, since_then) : since_then;
  }
  return bank_.params().evidence_beams * ahead;
}

void Rivals::admit_all(const LikelihoodField& field, std::span<const Pose2> poses, const Pose2& joined) {
  constexpr double kJustFoundM = 0.5;
  const Place* const best = bank_.reference();
  const bool proven = best != nullptr && best->followed_m > kJustFoundM;  // then no newcomer starts ahead of it
  const Pose2 held_against = best != nullptr ? best->map_from_robot : poses.front();
  const ScanStack::Sums its = stack_.log_likelihoods(field, held_against, joined);
  const double base = best != nullptr ? best->log_evidence : 0.0;
  for (const Pose2& pose : poses) {
    if (bank_.knows(pose)) continue;
    double ahead = ahead_of(its, field, pose, joined);
    double since_carried = 0.0;
    if (believing_ && ahead > 0.0) {
      since_carried =
          bank_.params().evidence_beams * ahead_lately(stack_.log_likelihoods(field, pose, joined), its, stack_.size());
    }
    if (believing_) ahead = std::clamp(ahead, -kFarthestBehind, params_.most_ahead);
    bank_.admit({.map_from_robot = pose,
                 .log_evidence = base + (proven && !believing_ ? std::min(0.0, ahead) : ahead),
                 .log_prior = log_prior_unbelieved(pose) + (proven ? kOverlooked : 0.0),
                 .since_carried = since_carried});
  }
}

void Rivals::probe(const LikelihoodField& field, const Pose2& joined) {
  if (bank_.places().empty()) return;
  (void)probes_.look(coarse_, near_ends_, static_cast<std::size_t>(params_.probes));
  probe_nearby_next_ = !probe_nearby_next_;
  if (probe_nearby_next_) {
    const std::optional<Pose2> nearby = best_nearby(field);
    if (nearby) admit_rival(field, *nearby, joined);
    return;
  }
  for (const Candidate& candidate : probes_.best_apart(1)) admit_rival(field, candidate.map_from_robot, joined);
}

std::optional<Pose2> Rivals::best_nearby(const LikelihoodField& field) {
  const Pose2 believed = bank_.places().front().map_from_robot;
  std::optional<Pose2> best;
  std::int32_t least = std::numeric_limits<std::int32_t>::max();
  for (int i = 0; i < params_.probes_nearby; ++i) {
    const double x_m = random_.uniform(-params_.nearby_m, params_.nearby_m);
    const double y_m = random_.uniform(-params_.nearby_m, params_.nearby_m);
    const double turn_rad = random_.uniform(-params_.nearby_rad, params_.nearby_rad);
    const Pose2 tried{believed.x + x_m, believed.y + y_m, wrapped_angle(believed.theta + turn_rad)};
    if (bank_.knows(tried)) continue;
    const std::int32_t misfit = misfit_steps(field, ends_, tried);
    if (misfit >= least) continue;
    least = misfit;
    best = tried;
  }
  return best;
}

/// Beside a believed pose only what fits the scan nearly as well is worth following.
void Rivals::admit_rival(const LikelihoodField& field, const Pose2& rough, const Pose2& joined) {
  const Place& own = bank_.places().front();
  const Pose2 pose = settled(field, ends_, rough);
  if (bank_.knows(pose)) return;
  const double gain =
      mean_log_likelihood(field, ends_, {}, pose) - mean_log_likelihood(field, ends_, {}, own.map_from_robot);
  if (gain < -kFitsNearlyAsWell) return;
  const bool nearby = is_within(pose, own.map_from_robot, params_.nearby_m, params_.nearby_rad);
  double ahead = bank_.params().evidence_beams * gain;
  // A slip lies behind a nearby place: before it, the scans say nothing of it.
  double since_carried = 0.0;
  if (!nearby) {
    const ScanStack::Sums owns = stack_.log_likelihoods(field, own.map_from_robot, joined);
    ahead = ahead_of(owns, field, pose, joined);
    since_carried =
        bank_.params().evidence_beams * ahead_lately(stack_.log_likelihoods(field, pose, joined), owns, stack_.size());
  }
  bank_.admit(
      {.map_from_robot = pose,
       .log_evidence = own.log_evidence + std::clamp(ahead, -kFarthestBehind, nearby ? 0.0 : params_.most_ahead),
       .log_prior = std::log(nearby ? params_.nearby_prior : elsewhere_prior_),
       .since_carried = since_carried});
}

void Rivals::write_report() {
  const std::span<const Place> places = bank_.places();
  report_ = {};
  report_.own_known = bank_.believing();
  report_.unique = report_.own_known;
  report_.places = places.size();
  double squared_shares = 0.0;
  double most_since_carried = 0.0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Place& place = places[i];
    squared_shares += place.share * place.share;
    if (report_.own_known && i == 0) {
      report_.own_log_evidence = place.log_evidence;
      report_.own_share = place.share;
      continue;
    }
    list(place);
    if (report_.own_known &&
        !is_within(place.map_from_robot, places.front().map_from_robot, params_.nearby_m, params_.nearby_rad)) {
      most_since_carried = std::max(most_since_carried, place.since_carried);
    }
    const double ahead = place.log_evidence - report_.own_log_evidence;
    if (report_.own_known && ahead > params_.beats_by + held_by_ && place.followed_m >= params_.wins_after_m) {
      beaten_for_m_ = report_.beaten ? std::max(beaten_for_m_, place.followed_m) : place.followed_m;
      report_.beaten = true;
    }
    report_.unique &= ahead <= -params_.equal_within;
  }
  for (std::size_t i = 0; i < report_.listed; ++i) {
    report_.rivals[i].share_around = share_around(report_.rivals[i].map_from_robot);
  }
  const double carried_odds = params_.carried_prior * std::exp(most_since_carried);
  if (report_.own_known && places.size() > 1) report_.carried_share = carried_odds / (1.0 + carried_odds);
  report_.effective_places = squared_shares > 0.0 ? 1.0 / squared_shares : 1.0;
}

/// Among the best others, where it belongs there.
void Rivals::list(const Place& place) {
  RivalPlace entry{place.map_from_robot, place.log_evidence, place.share, 0.0, place.followed_m};
  for (std::size_t rank = 0; rank < report_.listed; ++rank) {
    if (entry.share > report_.rivals[rank].share) std::swap(entry, report_.rivals[rank]);
  }
  if (report_.listed < RivalReport::kListed) report_.rivals[report_.listed++] = entry;
}

}  // namespace deltamap::localization
