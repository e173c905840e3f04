// SPDX-License-Identifier: Apache-2.0
// Why "through": a beam that ends before a wall tells nothing (somebody stands there, or the two faces of a thin wall
// were seen from either side), but one that ends behind it has looked through it.
#include "surveying/quality/pass_pairs.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "core/geometry/points_in_map.hpp"
#include "core/grid/grid_ray.hpp"

namespace deltamap::surveying::quality {
namespace {

constexpr std::size_t kEachBeam = 2;  // of these one is held against the others
constexpr double kShortestM = 0.3;
constexpr float kLeastSine = 0.35F;  // 20° to the wall: flatter beams touch cells beside their way
constexpr double kHalfCellM = 0.5 * kWallCellM;
// Square to the wall: three times what a good map is unsure by (5 cm, and half a degree of heading).
constexpr double kThroughM = 0.25;
constexpr double kThroughPerRange = 0.01;

struct Sums {
  std::uint32_t ended = 0;
  std::uint32_t through = 0;
  Point2 places{0.0, 0.0};
  double depths_m = 0.0;
};

/// The beams of one pass against the walls of all others.
class PassBeams {
 public:
  PassBeams(const SeenWalls& walls, std::uint32_t pass, std::size_t passes)
      : walls_{walls}, pass_{pass}, sums_(passes), marks_(passes) {}

  void add(const PlacedScan& scan, std::size_t first_beam) {
    const PointsInMap in_map{scan.map_from_robot};
    const TrackedScan tracked = scan.scan->tracked();
    for (std::size_t i = first_beam; i < tracked.rays.size(); i += kEachBeam) {
      if (tracked.scan.beams[i].kind != BeamKind::kRange) continue;
      add(in_map(tracked.rays[i].origin), in_map(tracked.rays[i].end));
    }
  }
  [[nodiscard]] const std::vector<Sums>& sums() const { return sums_; }

 private:
  /// What the beam at hand has done to a pass's walls.
  struct Mark {
    std::uint32_t through_of = 0;  // number of the beam
    std::uint32_t ended_of = 0;
  };

  void add(const Point2& origin, const Point2& end) {
    const double length_m = (end - origin).norm();
    if (length_m < kShortestM) return;
    ++beam_;
    const Point2 along = (end - origin) / length_m;
    const Eigen::Vector2f direction = along.cast<float>();
    walk_ray(walls_.geometry(), origin, end, [&](Cell cell, double entered_m) {
      for (const SeenWalls::Wall& wall : walls_.at(cell)) {
        const float sine = std::abs(wall.normal.dot(direction));
        if (wall.pass == pass_ || sine < kLeastSine) continue;
        cross(wall.pass, origin + entered_m * along, entered_m, (length_m - entered_m - kHalfCellM) * sine);
      }
      return entered_m < kLongestSeenM;
    });
    if (length_m <= kLongestSeenM) end_at(walls_.geometry().cell_at(end));
  }

  void cross(std::uint32_t pass, const Point2& place, double entered_m, double depth_m) {
    Mark& mark = marks_[pass];
    Sums& sums = sums_[pass];
    if (depth_m <= kThroughM + kThroughPerRange * entered_m || mark.through_of == beam_) return;
    mark.through_of = beam_;
    ++sums.through;
    sums.places += place;
    sums.depths_m += depth_m;
  }

  void end_at(Cell end) {
    for (int row = end.row - 1; row <= end.row + 1; ++row) {
      for (int column = end.column - 1; column <= end.column + 1; ++column) {
        for (const SeenWalls::Wall& wall : walls_.at({column, row})) {
          Mark& mark = marks_[wall.pass];
          if (wall.pass == pass_ || mark.through_of == beam_ || mark.ended_of == beam_) continue;
          mark.ended_of = beam_;
          ++sums_[wall.pass].ended;
        }
      }
    }
  }

  const SeenWalls& walls_;
  std::uint32_t pass_;
  std::vector<Sums> sums_;
  std::vector<Mark> marks_;
  std::uint32_t beam_ = 0;
};

void add_to(PassPair& pair, const Sums& sums) {
  pair.ended += sums.ended;
  pair.through += sums.through;
  pair.place += sums.places;
  pair.depth_m += sums.depths_m;
}

}  // namespace

std::vector<PassPair> pass_pairs(std::span<const PlacedScan> scans, std::span<const Pass> passes,
                                 const SeenWalls& walls) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, PassPair> pairs;
  for (std::uint32_t i = 0; i < passes.size(); ++i) {
    PassBeams beams{walls, i, passes.size()};
    for (std::uint32_t k = passes[i].first; k <= passes[i].last; ++k) beams.add(scans[k], k % kEachBeam);
    for (std::uint32_t j = 0; j < passes.size(); ++j) {
      const Sums& sums = beams.sums()[j];
      if (sums.ended + sums.through == 0) continue;
      PassPair& pair = pairs[std::minmax(i, j)];
      std::tie(pair.one, pair.other) = std::minmax(i, j);
      add_to(pair, sums);
    }
  }
  std::vector<PassPair> all;
  all.reserve(pairs.size());
  for (auto& [passes_of_it, pair] : pairs) {
    if (pair.through > 0) {
      pair.place /= pair.through;
      pair.depth_m /= pair.through;
    }
    all.push_back(pair);
  }
  return all;
}

}  // namespace deltamap::surveying::quality
