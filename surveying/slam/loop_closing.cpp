// SPDX-License-Identifier: Apache-2.0
#include "surveying/slam/loop_closing.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/geometry/pose_spread.hpp"
#include "surveying/slam/relative_covariance.hpp"
#include "surveying/slam/submap_matcher.hpp"

namespace deltamap::surveying::slam {
namespace {

constexpr double kEachM = 1.0;          // driven between two searches
constexpr double kAgainM = 10.0;        // driven since: the robot has come back, and not stood still
constexpr double kLoopSearchedM = 5.0;  // of the way so far that is held against older ones
constexpr double kLoopEndEachM = 0.15;  // squares that hold one end of it
constexpr double kReferenceM = 6.0;     // of the older way, before and after
constexpr double kSeesM = 4.0;          // keyframes so near to each other see the same surfaces
constexpr std::size_t kMostTried = 3;   // older ways at one search
constexpr double kMostWindowRad = 1.0;  // whatever the graph says
constexpr double kLeastWindowM = 0.3;
constexpr double kLeastWindowRad = 0.05;
constexpr double kConfirmedM = 6.0;  // driven between two loops that may confirm each other
constexpr double kSameM = 0.3;       // between what these say
constexpr double kSameRad = 0.05;
constexpr double kWorthSolvingM = 0.05;  // by which a link moves its keyframes; else some are gathered
constexpr double kWorthSolvingRad = 0.01;
constexpr std::size_t kMostUnsolved = 20;
constexpr double kNeighbourEachM = 0.5;
constexpr double kNeighbourM = 2.5;  // away at most, a radian of heading counted as a metre
constexpr double kNeighbourSubmapM = 1.0;
constexpr SubmapMatchParams kLoop{.ambiguous_share = 0.9, .inner_deviation_m = 0.02, .inner_deviation_rad = 0.004};
constexpr SubmapMatchParams kNeighbour{.least_score = 0.45,
                                       .least_paired = 0.5,
                                       .most_deviation_m = 0.06,
                                       .inner_deviation_m = 0.01,
                                       .inner_deviation_rad = 0.003};

}  // namespace

void LoopClosing::search_from(std::uint32_t node) {
  const Keyframe& here = survey_.keyframes[node];
  const Keyframe& last = survey_.keyframes[last_searched_];
  if (last.drive == here.drive && here.driven_m - last.driven_m < kEachM) return;
  last_searched_ = node;
  search(node);
}

bool LoopClosing::is_way_back(std::uint32_t node, std::uint32_t other) const {
  const Keyframe& here = survey_.keyframes[node];
  const Keyframe& there = survey_.keyframes[other];
  return there.drive != here.drive || here.driven_m - there.driven_m >= kAgainM;
}

/// The nearest one of each older way that may be near.
std::vector<LoopClosing::Candidate> LoopClosing::candidates(std::uint32_t node) const {
  const auto away_m = [&](std::uint32_t other) { return distance_between(survey_.poses[node], survey_.poses[other]); };
  std::vector<std::uint32_t> older;
  for (std::uint32_t other = 0; other < node; ++other) {
    if (is_way_back(node, other) && away_m(other) <= kSeesM + kMostWindowM) older.push_back(other);
  }
  const auto known = relative_covariances(survey_, node, older);
  std::vector<Candidate> near;
  for (std::size_t i = 0; i < older.size(); ++i) {
    if (known[i] && away_m(older[i]) <= kSeesM + window_of({}, *known[i]).position_m) {
      near.push_back({older[i], *known[i]});
    }
  }
  std::stable_sort(near.begin(), near.end(),
                   [&](const Candidate& a, const Candidate& b) { return away_m(a.node) < away_m(b.node); });
  std::vector<Candidate> chosen;
  for (const Candidate& other : near) {
    const Keyframe& there = survey_.keyframes[other.node];
    const bool is_of_a_chosen_way = std::any_of(chosen.begin(), chosen.end(), [&](const Candidate& one) {
      const Keyframe& of = survey_.keyframes[one.node];
      return of.drive == there.drive && std::abs(of.driven_m - there.driven_m) < 2.0 * kReferenceM;
    });
    if (!is_of_a_chosen_way) chosen.push_back(other);
    if (chosen.size() == kMostTried) break;
  }
  return chosen;
}

/// One that is believed already, between the same places of both ways: another would tell nothing new.
std::optional<mapping::alignment::PoseLink> LoopClosing::loop_between(std::uint32_t other, std::uint32_t node) const {
  const Keyframe& there = survey_.keyframes[other];
  const std::uint32_t last = on_by(survey_, node, kEachM);
  for (std::uint32_t near = back_by(survey_, node, kEachM); near <= last; ++near) {
    for (const std::uint32_t place : survey_.links_of[near]) {
      const mapping::alignment::PoseLink& link = survey_.links[place];
      if (!link.may_drop || link.to != near) continue;
      const Keyframe& of = survey_.keyframes[link.from];
      if (of.drive == there.drive && std::abs(of.driven_m - there.driven_m) < 2.0 * kEachM) return link;
    }
  }
  return std::nullopt;
}

void LoopClosing::search(std::uint32_t node) {
  const std::vector<Candidate> tried = candidates(node);
  if (tried.empty()) return;
  const Submap seen = submap(survey_, back_by(survey_, node, kLoopSearchedM), node, node, kLoopEndEachM);
  for (const auto& [other, covariance] : tried) {
    if (const auto told = loop_between(other, node)) {
      consider(*told);  // it may confirm others
      continue;
    }
    const Pose2 node_from_other = motion_between(survey_.poses[node], survey_.poses[other]);
    const Pose2 expected = inverse(node_from_other);
    const PoseCovariance unsure = inverted_covariance(node_from_other, covariance);
    SearchWindow window = window_of(expected, unsure);
    window.position_m += kLeastWindowM;
    window.heading_rad = std::min(kMostWindowRad, window.heading_rad + kLeastWindowRad);
    SubmapMatcher matcher{
        submap(survey_, back_by(survey_, other, kReferenceM), on_by(survey_, other, kReferenceM), other, 0.0),
        window.position_m};
    const auto match = matcher.match(seen.ends, survey_.keyframes[node].scan.range_deviation_m(), window, {}, kLoop);
    if (!match) continue;
    const Eigen::Vector3d innovation = difference(expected, match->submap_from_scan);
    if (squared_deviations(innovation, unsure + match->covariance) > kMostChi2) continue;
    consider({other, node, match->submap_from_scan, match->covariance, true});
  }
}

void LoopClosing::search_all(std::optional<std::uint32_t> drive) {
  waiting_.clear();
  for (std::uint32_t node = 0; node < survey_.keyframes.size();
       node = std::max(node + 1, on_by(survey_, node, kEachM))) {
    if (!drive || survey_.keyframes[node].drive == *drive) search(node);
  }
}

/// Do both say the same of how the two ways lie to each other?
bool LoopClosing::agree(const mapping::alignment::PoseLink& a, const mapping::alignment::PoseLink& b) const {
  const auto apart_m = [&](std::uint32_t one, std::uint32_t other) {
    const Keyframe& p = survey_.keyframes[one];
    const Keyframe& q = survey_.keyframes[other];
    return p.drive == q.drive ? std::abs(p.driven_m - q.driven_m)
                              : distance_between(survey_.poses[one], survey_.poses[other]);
  };
  if (a.to == b.to || apart_m(a.to, b.to) > kConfirmedM || apart_m(a.from, b.from) > 2.0 * kConfirmedM) return false;
  const Pose2 expected = motion_between(survey_.poses[b.from], survey_.poses[a.from]) * a.from_from_to *
                         motion_between(survey_.poses[a.to], survey_.poses[b.to]);
  const Eigen::Vector3d off = difference(expected, b.from_from_to);
  return off.head<2>().norm() <= kSameM && std::abs(off.z()) <= kSameRad;
}

void LoopClosing::consider(const mapping::alignment::PoseLink& loop) {
  const Keyframe& here = survey_.keyframes[loop.to];
  std::erase_if(waiting_, [&](const mapping::alignment::PoseLink& one) {
    const Keyframe& there = survey_.keyframes[one.to];
    return there.drive != here.drive || here.driven_m - there.driven_m > kConfirmedM;
  });
  const auto agreeing = std::stable_partition(
      waiting_.begin(), waiting_.end(), [&](const mapping::alignment::PoseLink& one) { return !agree(one, loop); });
  const std::vector<mapping::alignment::PoseLink> confirmed{agreeing, waiting_.end()};
  waiting_.erase(agreeing, waiting_.end());
  waiting_.push_back(loop);  // where it is confirmed, it may confirm the next one
  if (confirmed.empty()) return;
  believe(loop);
  for (const mapping::alignment::PoseLink& one : confirmed) believe(one);
}

void LoopClosing::believe(const mapping::alignment::PoseLink& loop) {
  const auto& known = survey_.links_of[loop.to];
  const bool is_known = std::any_of(known.begin(), known.end(), [&](std::uint32_t place) {
    return survey_.links[place].from == loop.from && survey_.links[place].to == loop.to;
  });
  if (is_known) return;
  const Eigen::Vector3d moves =
      difference(motion_between(survey_.poses[loop.from], survey_.poses[loop.to]), loop.from_from_to);
  survey_.add(loop);
  ++unsolved_;
  if (unsolved_ < kMostUnsolved && moves.head<2>().norm() <= kWorthSolvingM && std::abs(moves.z()) <= kWorthSolvingRad)
    return;
  (void)survey_.solve();
  unsolved_ = 0;
}

void LoopClosing::join(const mapping::alignment::PoseLink& link) {
  const std::uint32_t drive = survey_.keyframes[link.to].drive;
  survey_.join(link);
  (void)survey_.solve();
  search_all(drive);
}

bool LoopClosing::finish() {
  (void)drop_contradicted();
  search_all({});
  (void)drop_contradicted();
  match_neighbours();
  return drop_contradicted();
}

void LoopClosing::match_neighbours() {
  std::vector<mapping::alignment::PoseLink> found;
  for (std::uint32_t node = 0; node < survey_.keyframes.size();
       node = std::max(node + 1, on_by(survey_, node, kNeighbourEachM))) {
    std::optional<std::uint32_t> nearest;
    double nearest_m = kNeighbourM;
    for (std::uint32_t other = 0; other < node; ++other) {
      if (survey_.component_of(other) != survey_.component_of(node) || !is_way_back(node, other)) continue;
      const double away_m = distance_between(survey_.poses[node], survey_.poses[other]) +
                            std::abs(turn_between(survey_.poses[node].theta, survey_.poses[other].theta));
      if (away_m >= nearest_m) continue;
      nearest = other;
      nearest_m = away_m;
    }
    if (!nearest) continue;
    SubmapMatcher matcher{submap(survey_, back_by(survey_, *nearest, kNeighbourSubmapM),
                                 on_by(survey_, *nearest, kNeighbourSubmapM), *nearest, 0.0),
                          kLeastWindowM};
    const auto match = matcher.match(
        survey_.keyframes[node].ends(), survey_.keyframes[node].scan.range_deviation_m(),
        {motion_between(survey_.poses[*nearest], survey_.poses[node]), kLeastWindowM, kLeastWindowRad}, {}, kNeighbour);
    if (match) found.push_back({*nearest, node, match->submap_from_scan, match->covariance, true});
  }
  for (const mapping::alignment::PoseLink& link : found) survey_.add(link);
}

/// The worst quarter first: they bend the others, so much that the graph may not settle before they are gone.
bool LoopClosing::drop_contradicted() {
  unsolved_ = 0;
  for (;;) {
    const bool is_settled = survey_.solve();
    std::vector<std::pair<double, std::uint32_t>> wrong;
    for (std::uint32_t place = 0; place < survey_.links.size(); ++place) {
      const mapping::alignment::PoseLink& link = survey_.links[place];
      if (!link.may_drop) continue;
      const double chi2 = mapping::alignment::link_chi2(link, survey_.poses);
      if (chi2 > kMostChi2) wrong.emplace_back(chi2, place);
    }
    if (wrong.empty()) return is_settled;
    std::sort(wrong.rbegin(), wrong.rend());
    wrong.resize((wrong.size() + 3) / 4);
    std::vector<std::uint32_t> places;
    places.reserve(wrong.size());
    for (const auto& [chi2, place] : wrong) places.push_back(place);
    survey_.remove(places);
    contradicted_ += places.size();
  }
}

}  // namespace deltamap::surveying::slam
