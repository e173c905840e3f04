// SPDX-License-Identifier: Apache-2.0
#include "experiments/verdict/ambiguity.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "experiments/verdict/path_search.hpp"

namespace deltamap::experiments {
namespace {

constexpr double kTellUpTo = 1.5;      // times the log odds that are asked for
constexpr double kAnyRival = 0.99;     // times them: another path that makes this one ambiguous, rounding aside
constexpr std::size_t kStride = 61;    // a prime: neighbours of the path lie far apart in the order of judging
constexpr double kMostChanged = 0.45;  // of the pieces: beyond this a misfit would hardly speak against a pose

using Piece = std::pair<int, int>;  // column and row

struct Hit {
  Point2 from;
  Point2 end;
  Piece piece;
};

std::vector<Hit> hits_of(const std::vector<Pose2>& map_from_laser, const simulation::RayCaster& world,
                         double max_range_m, const AmbiguityParams& params) {
  std::vector<Hit> hits;
  const int beams = static_cast<int>(std::numbers::pi / params.beam_step_rad) + 1;
  for (const Pose2& view : map_from_laser) {
    for (int beam = 0; beam < beams; ++beam) {
      const double bearing_rad = view.theta + (beam - 0.5 * (beams - 1)) * params.beam_step_rad;
      const auto hit = world.cast(view.position(), bearing_rad, max_range_m);
      if (!hit) continue;
      const Point2 end = view.position() + hit->range_m * Point2{std::cos(bearing_rad), std::sin(bearing_rad)};
      hits.push_back({view.position(),
                      end,
                      {static_cast<int>(std::floor(end.x() / params.piece_m)),
                       static_cast<int>(std::floor(end.y() / params.piece_m))}});
    }
  }
  return hits;
}

/// Pieces in a patch of neighbours that mostly do not fit at the true pose, on average over all patches and one more of
/// a single piece.
double pieces_at_once(const SeenPath& path, const PathSearch& search) {
  std::map<Piece, float> misfits;  // share of a piece's beams
  for (const SeenPath::Beam& beam : path.beams) {
    if (!search.explains(beam, path.map_from_middle)) misfits[{beam.piece_column, beam.piece_row}] += beam.weight;
  }
  std::map<Piece, bool> open;
  for (const auto& [piece, share] : misfits) {
    if (share > 0.5F) open[piece] = true;
  }
  double patches = 0.0;
  std::vector<Piece> front;
  for (auto& [seed, is_open] : open) {
    if (!is_open) continue;
    patches += 1.0;
    is_open = false;
    front.push_back(seed);
    while (!front.empty()) {
      const Piece at = front.back();
      front.pop_back();
      for (int i = 0; i < 9; ++i) {
        const auto next = open.find({at.first + i % 3 - 1, at.second + i / 3 - 1});
        if (next == open.end() || !next->second) continue;
        next->second = false;
        front.push_back(next->first);
      }
    }
  }
  return (static_cast<double>(open.size()) + 1.0) / (patches + 1.0);
}

/// What one piece of surface that does not fit says against a pose, if each has changed with the share of those that do
/// not fit at the true one (after Laplace).
double log_odds_a_piece(double unexplained, double pieces) {
  const double changed = std::min(kMostChanged, (unexplained + 1.0) / (pieces + 2.0));
  return std::log((1.0 - changed) / changed);
}

}  // namespace

SeenPath seen_path(const std::vector<Pose2>& map_from_laser, const simulation::RayCaster& world, double max_range_m,
                   const AmbiguityParams& params) {
  SeenPath path;
  if (map_from_laser.empty()) return path;
  path.map_from_middle = map_from_laser[map_from_laser.size() / 2];
  const std::vector<Hit> hits = hits_of(map_from_laser, world, max_range_m, params);
  std::map<Piece, double> beams_on;
  for (const Hit& hit : hits) beams_on[hit.piece] += 1.0;
  path.pieces = static_cast<double>(beams_on.size());
  const Pose2 middle_from_map = inverse(path.map_from_middle);
  for (std::size_t first = 0; first < kStride; ++first) {
    for (std::size_t i = first; i < hits.size(); i += kStride) {
      const Point2 from = middle_from_map * hits[i].from;
      const Point2 end = middle_from_map * hits[i].end;
      const auto& [column, row] = hits[i].piece;
      path.beams.push_back({static_cast<float>(from.x()), static_cast<float>(from.y()), static_cast<float>(end.x()),
                            static_cast<float>(end.y()), static_cast<float>(from.norm()),
                            static_cast<float>(end.norm()), static_cast<float>(1.0 / beams_on[hits[i].piece]), column,
                            row});
    }
  }
  return path;
}

Ambiguity AmbiguityOracle::ambiguity(const std::vector<Pose2>& map_from_laser, const simulation::RayCaster& world,
                                     double max_range_m) const {
  return ambiguity(map_from_laser, world, max_range_m, Wanted::kBestRival);
}

Ambiguity AmbiguityOracle::ambiguity(const std::vector<Pose2>& map_from_laser, const simulation::RayCaster& world,
                                     double max_range_m, Wanted wanted) const {
  const SeenPath path = seen_path(map_from_laser, world, max_range_m, params_);
  Ambiguity answer;
  answer.map_from_rival = path.map_from_middle;
  if (path.beams.empty()) return answer;
  PathSearch search{map_, path, params_};
  answer.pieces = path.pieces;
  answer.unexplained = search.unexplained(path.map_from_middle);
  answer.changed_at_once = pieces_at_once(path, search);
  const double a_piece = log_odds_a_piece(answer.unexplained, answer.pieces) / answer.changed_at_once;
  const double surely = std::log(params_.odds);
  const double most = answer.unexplained + kTellUpTo * surely / a_piece;
  const double any = answer.unexplained + kAnyRival * surely / a_piece;
  const PathSearch::Rival rival = search.best_rival(most, wanted == Wanted::kAnyRival ? any : answer.unexplained);
  answer.map_from_rival = rival.map_from_middle;
  answer.log_odds = std::max(0.0, (rival.unexplained - answer.unexplained) * a_piece);
  answer.ambiguous = answer.log_odds < surely;
  answer.judged_poses = search.judged_poses();
  return answer;
}

std::size_t AmbiguityOracle::views_needed(const std::vector<Pose2>& map_from_laser, const simulation::RayCaster& world,
                                          double max_range_m, const Ambiguity& whole) const {
  if (whole.ambiguous) return 0;
  std::size_t too_few = 0;
  std::size_t enough = map_from_laser.size();
  while (enough - too_few > 1) {
    const std::size_t views = (too_few + enough) / 2;
    const std::vector<Pose2> part(map_from_laser.begin(), map_from_laser.begin() + static_cast<std::ptrdiff_t>(views));
    (ambiguity(part, world, max_range_m, Wanted::kAnyRival).ambiguous ? too_few : enough) = views;
  }
  return enough;
}

}  // namespace deltamap::experiments
