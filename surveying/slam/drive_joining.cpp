// SPDX-License-Identifier: Apache-2.0
#include "surveying/slam/drive_joining.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>

#include "surveying/slam/relative_covariance.hpp"
#include "surveying/slam/seen_space.hpp"
#include "surveying/slam/submap_matcher.hpp"

namespace deltamap::surveying::slam {
namespace {

constexpr double kFirstLookM = 12.0;           // driven
constexpr double kNextLookM = 4.0;             // driven between two
constexpr double kSearchedM[] = {12.0, 40.0};  // of the way so far: the one overlaps more, the other tells more apart
constexpr double kEndEachM = 0.3;              // squares that hold one end of what is searched for
constexpr double kEverywhereM = 100.0;
constexpr double kMostContradicted = 0.15;  // share of the beams
constexpr double kAgreeM = 1.0;             // between what two looks say of where the drive lies
constexpr double kAgreeRad = 0.1;
constexpr std::size_t kFewestVotes = 3;  // places looked from
constexpr double kVotesShare = 0.75;     // of those from which it was found somewhere
constexpr SubmapMatchParams kJoining{.least_score = 0.6,
                                     .least_paired = 0.5,
                                     .ambiguous_share = 0.9,
                                     .inner_deviation_m = 0.03,
                                     .inner_deviation_rad = 0.006};

}  // namespace

struct DriveJoining::Joined {
  std::vector<std::uint32_t> nodes;
  SubmapMatcher matcher;
  SeenSpace space;

  explicit Joined(const Survey& survey)
      : nodes{survey.joined_nodes()},
        matcher{submap(survey, nodes, nodes.front(), 0.0), kEverywhereM},
        space{survey, nodes, nodes.front()} {}
};

DriveJoining::DriveJoining(const Survey& survey) : survey_{survey} {}
DriveJoining::~DriveJoining() = default;

void DriveJoining::search_from(std::uint32_t node) {
  const double driven_m = survey_.keyframes[node].driven_m;
  if (!joined_) {
    joined_ = std::make_unique<Joined>(survey_);
    next_m_ = kFirstLookM;
  }
  if (driven_m < next_m_) return;
  next_m_ = driven_m + kNextLookM;
  for (const double length_m : kSearchedM) search(node, length_m);
}

void DriveJoining::search(std::uint32_t node, double length_m) {
  const std::uint32_t first = back_by(survey_, node, length_m);
  std::vector<std::uint32_t> nodes(node - first + 1);
  std::iota(nodes.begin(), nodes.end(), first);
  const std::uint32_t middle = nodes[nodes.size() / 2];
  const auto match = joined_->matcher.match(submap(survey_, nodes, middle, kEndEachM).ends,
                                            survey_.keyframes[node].scan.range_deviation_m(),
                                            joined_->matcher.everywhere(), {}, kJoining);
  if (!match || joined_->space.contradicted(survey_, nodes, middle, match->submap_from_scan) > kMostContradicted) {
    return;
  }
  const Pose2& map_from_submap = survey_.poses[joined_->nodes.front()];
  found_.push_back({node, middle, map_from_submap * match->submap_from_scan,
                    turned_covariance(match->covariance, map_from_submap.theta), match->score});
}

bool DriveJoining::agree(const Found& a, const Found& b) const {
  const Pose2 expected = a.map_from_node * motion_between(survey_.poses[a.node], survey_.poses[b.node]);
  return distance_between(expected, b.map_from_node) <= kAgreeM &&
         std::abs(turn_between(expected.theta, b.map_from_node.theta)) <= kAgreeRad;
}

std::optional<mapping::alignment::PoseLink> DriveJoining::link() {
  const std::vector<Found> found = std::exchange(found_, {});
  const std::unique_ptr<Joined> joined = std::move(joined_);
  if (found.empty()) return std::nullopt;
  // One vote for each place from which it was looked for, however long the way was that was held against the others.
  const auto places = [&](auto&& counts) {
    std::set<std::uint32_t> distinct;
    for (const Found& one : found) {
      if (counts(one)) distinct.insert(one.from);
    }
    return distinct.size();
  };
  const auto votes = [&](const Found& one) { return places([&](const Found& other) { return agree(one, other); }); };
  const Found& best = *std::max_element(found.begin(), found.end(), [&](const Found& a, const Found& b) {
    return std::pair{votes(a), a.score} < std::pair{votes(b), b.score};
  });
  const std::size_t most = votes(best);
  const std::size_t all = places([](const Found&) { return true; });
  if (most < kFewestVotes || static_cast<double>(most) < kVotesShare * static_cast<double>(all)) {
    return std::nullopt;
  }
  const auto away_m = [&](std::uint32_t node) { return distance_between(survey_.poses[node], best.map_from_node); };
  const std::uint32_t nearest = *std::min_element(joined->nodes.begin(), joined->nodes.end(),
                                                  [&](auto a, auto b) { return away_m(a) < away_m(b); });
  return mapping::alignment::PoseLink{nearest, best.node, motion_between(survey_.poses[nearest], best.map_from_node),
                                      turned_covariance(best.covariance, -survey_.poses[nearest].theta), false};
}

}  // namespace deltamap::surveying::slam
