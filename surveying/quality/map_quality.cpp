// SPDX-License-Identifier: Apache-2.0
#include "surveying/quality/map_quality.hpp"

#include <algorithm>
#include <cmath>

#include "surveying/quality/driven_walls.hpp"
#include "surveying/quality/pass_pairs.hpp"
#include "surveying/quality/pieces.hpp"

namespace deltamap::surveying::quality {
namespace {

constexpr std::uint32_t kFewestCompared = 100;  // beams: fewer may all have met one thing that was moved
constexpr double kDoubledM = 1.5;               // farther apart, walls are no longer told as one and the same
constexpr double kRevisitM = 10.0;              // driven between: the robot has come back, and not stood still
constexpr double kSamePlaceM = 3.0;             // from such places the same walls are seen
constexpr std::size_t kFewestDisagreeing = 3;   // pairs
constexpr double kToldApartM = 2.0;             // between places that are told of
constexpr double kFewestLookedAt = 1000;        // ends that tell of the scale
constexpr double kLeastLeverM = 0.5;

bool disagree(const PassPair& pair) {
  return pair.compared() >= kFewestCompared && pair.through_share() > kMostThrough;
}

Flaw flaw_of(const PassPair& pair, std::span<const Pass> passes) {
  const Pass& one = passes[pair.one];
  const Pass& other = passes[pair.other];
  if (way_between(one, other) < kRevisitM) return Flaw::kTornWay;
  if ((one.middle - other.middle).norm() <= kSamePlaceM) return Flaw::kOpenLoops;
  return pair.depth_m <= kDoubledM ? Flaw::kDoubledWalls : Flaw::kWallsSeenThrough;
}

void add_place(FoundFlaw& flaw, const Point2& place) {
  const bool is_told = std::any_of(flaw.places.begin(), flaw.places.end(),
                                   [&](const Point2& other) { return (place - other).norm() < kToldApartM; });
  if (!is_told) flaw.places.push_back(place);
}

std::size_t out_of_place(std::span<const Pass> passes, std::span<const PassPair> pairs) {
  struct Counts {
    std::size_t pairs = 0;
    std::size_t disagreeing = 0;
  };
  std::vector<Counts> of(passes.size());
  for (const PassPair& pair : pairs) {
    if (pair.compared() < kFewestCompared) continue;
    for (const std::uint32_t pass : {pair.one, pair.other}) {
      ++of[pass].pairs;
      of[pass].disagreeing += disagree(pair) ? 1 : 0;
    }
  }
  return static_cast<std::size_t>(std::count_if(of.begin(), of.end(), [](const Counts& counts) {
    return counts.disagreeing >= kFewestDisagreeing &&
           static_cast<double>(counts.disagreeing) >= kMostOfPass * static_cast<double>(counts.pairs);
  }));
}

/// What passes say of each other.
void judge_pairs(MapQuality& quality, std::span<const Pass> passes, std::span<const PassPair> pairs) {
  std::vector<const PassPair*> bad;
  for (const PassPair& pair : pairs) {
    quality.pairs += pair.compared() >= kFewestCompared ? 1 : 0;
    if (disagree(pair)) bad.push_back(&pair);
  }
  quality.disagreeing = bad.size();
  quality.out_of_place = out_of_place(passes, pairs);
  const bool is_beyond = quality.out_of_place > 0 ||
                         (bad.size() >= kFewestDisagreeing &&
                          static_cast<double>(bad.size()) > kMostDisagreeing * static_cast<double>(quality.pairs));
  std::stable_sort(bad.begin(), bad.end(),
                   [](const PassPair* a, const PassPair* b) { return a->through > b->through; });
  for (const PassPair* const pair : bad) {
    FoundFlaw& flaw = quality.flaws[static_cast<std::size_t>(flaw_of(*pair, passes))];
    if (flaw.places.empty()) flaw.size_m = pair->depth_m;
    flaw.is_beyond_limit = is_beyond;
    add_place(flaw, pair->place);
  }
}

void judge_scale(MapQuality& quality, std::span<const PlacedScan> scans, std::span<const Pass> passes,
                 const SeenWalls& walls) {
  quality.scale = map_scale(scans, passes, walls);
  FoundFlaw& flaw = quality.flaws[static_cast<std::size_t>(Flaw::kWrongScale)];
  flaw.size_m = 10.0 * std::abs(quality.scale.error);
  flaw.is_beyond_limit = std::abs(quality.scale.error) > kMostScaleError &&
                         static_cast<double>(quality.scale.looks) >= kFewestLookedAt &&
                         quality.scale.lever_m >= kLeastLeverM;
}

void judge_pieces(MapQuality& quality, std::span<const Pass> passes, std::span<const PassPair> pairs) {
  FoundFlaw& flaw = quality.flaws[static_cast<std::size_t>(Flaw::kLooseWay)];
  const std::vector<Piece> pieces = pieces_of(passes, pairs);
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    quality.loose_m += pieces[i].way_m;
    add_place(flaw, passes[pieces[i].passes.front()].middle);
  }
  flaw.size_m = quality.loose_m;
  flaw.is_beyond_limit = quality.loose_m > kMostLooseM;
}

}  // namespace

bool MapQuality::is_false() const {
  return std::any_of(flaws.begin(), flaws.end(), [](const FoundFlaw& flaw) { return flaw.is_beyond_limit; });
}

MapQuality map_quality(const OccupancyGrid& map, std::span<const PlacedScan> all_scans) {
  const std::vector<PlacedScan> scans = thinned(all_scans);
  const std::vector<Pass> passes = passes_of(scans);
  const SeenWalls walls{scans, passes};
  const std::vector<PassPair> pairs = pass_pairs(scans, passes, walls);
  MapQuality quality;
  quality.scans = scans.size();
  quality.passes = passes.size();
  judge_pairs(quality, passes, pairs);
  judge_scale(quality, scans, passes, walls);
  judge_pieces(quality, passes, pairs);
  FoundFlaw& driven = quality.flaws[static_cast<std::size_t>(Flaw::kWallsDrivenThrough)];
  driven.places = driven_walls(scans, passes, walls);
  driven.is_beyond_limit = driven.places.size() > kMostDrivenThrough;
  quality.fit = map_fit(map, scans);
  FoundFlaw& unfit = quality.flaws[static_cast<std::size_t>(Flaw::kUnfitScans)];
  if (quality.fit.worst) unfit.places.push_back(*quality.fit.worst);
  unfit.is_beyond_limit =
      static_cast<double>(quality.fit.unfit) > std::max(1.0, kMostUnfit * static_cast<double>(quality.fit.scans));
  return quality;
}

}  // namespace deltamap::surveying::quality
