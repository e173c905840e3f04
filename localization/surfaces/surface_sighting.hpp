// SPDX-License-Identifier: Apache-2.0
// Data association: each beam's end belongs to the surface of the map that it lies nearest to, where that surface is
// believed to stand. The beams on one surface together are one observation.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/messages.hpp"
#include "localization/motion/deskew.hpp"
#include "localization/sensor/likelihood_field.hpp"
#include "localization/surfaces/surface_map.hpp"

namespace deltamap::localization::surfaces {

/// Ends of one scan with the direction of the surface that they lie on, robot frame.
struct FacedEnd {
  Point2 at{0.0, 0.0};
  Point2 normal{0.0, 0.0};  ///< towards the laser; zero where the neighbouring ends do not lie on a line with it
};
[[nodiscard]] std::vector<FacedEnd> faced_ends(const Scan& scan, std::span<const RayInRobot> rays,
                                               std::vector<FacedEnd> reused = {});

/// Where a surface is believed to lie, beside where the map has it.
struct SurfacePlace {
  double offset_m = 0.0;     ///< along the normal
  double turn_rad = 0.0;     ///< about the surface's centre
  double deviation_m = 0.5;  ///< of the offset
};

/// The beams that ended at one surface, by their moments, robot frame.
struct Sighting {
  SurfaceMap::Id id;
  Surface surface;
  double beams = 0.0;
  Point2 mean{0.0, 0.0};                              ///< m
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();  ///< sum of squares about the mean, m²

  /// What the beams say of the surface with the robot at a pose.
  struct Measured {
    double distance_m;  ///< of their mean from the map's line, along its normal
    double along_m;     ///< of their mean from the surface's centre, along its tangent
    double slope;       ///< of their line against the map's, rad
    double spread_m2;   ///< sum of squares along the surface
    double across_m2;   ///< sum of squares from their line
    Point2 lever;       ///< from the robot to their mean, map directions
  };
  [[nodiscard]] Measured measured(const Pose2& map_from_robot) const;
};

class SightingFinder {
 public:
  /// `place_of(const SurfaceRecord&)` answers a SurfacePlace. The answer is valid until the next call.
  template <typename PlaceOf>
  std::span<const Sighting> find(SurfaceMap& map, const sensor::LikelihoodField& field, std::span<const FacedEnd> ends,
                                 const Pose2& map_from_robot, PlaceOf&& place_of);
  /// Ends of the last scan that belong to no surface, robot frame.
  [[nodiscard]] const motion::BeamEnds& rest() const { return rest_; }

 private:
  struct Claim {
    SurfaceMap::Id id;
    Surface surface;
    std::vector<std::uint32_t> ends;
    std::vector<float> residuals_m;
  };
  struct Candidate {
    SurfaceMap::Id id;
    Surface surface;
  };
  void begin();
  void claim(const Candidate& candidate, double residual_m, std::uint32_t end);
  void judge(std::span<const FacedEnd> ends);

  std::vector<Claim> claims_;
  std::size_t claims_used_ = 0;
  std::vector<Sighting> sightings_;
  std::vector<std::uint8_t> is_taken_;
  motion::BeamEnds rest_;
};

namespace sighting {
inline constexpr double kReachM = 1.0;          // how far a thing may have been pushed and still be taken for itself
inline constexpr double kFarthestM = 1.5;       // from where the map has it
inline constexpr double kFacingCosine = 0.86;   // 30°: between an end's normal and its surface's
inline constexpr double kBesideM = 0.4;         // beyond a surface's end: things are pushed along their faces too
inline constexpr double kExplainedCells = 1.6;  // from a contour
inline constexpr double kNone = 1e9;
/// How far from a surface's place an end may lie that the map explains.
[[nodiscard]] inline double known_within_m(double deviation_m) { return 0.15 + 3.0 * std::min(0.05, deviation_m); }
}  // namespace sighting

template <typename PlaceOf>
std::span<const Sighting> SightingFinder::find(SurfaceMap& map, const sensor::LikelihoodField& field,
                                               std::span<const FacedEnd> ends, const Pose2& map_from_robot,
                                               PlaceOf&& place_of) {
  begin();
  is_taken_.assign(ends.size(), 0);
  const double c = std::cos(map_from_robot.theta);
  const double s = std::sin(map_from_robot.theta);
  for (std::size_t i = 0; i < ends.size(); ++i) {
    if (ends[i].normal.isZero()) continue;
    const Point2 at{map_from_robot.x + c * ends[i].at.x() - s * ends[i].at.y(),
                    map_from_robot.y + s * ends[i].at.x() + c * ends[i].at.y()};
    const Point2 normal{c * ends[i].normal.x() - s * ends[i].normal.y(),
                        s * ends[i].normal.x() + c * ends[i].normal.y()};
    // What the map explains is no thing that was pushed far.
    const double off_the_map_m = field.distance_of_steps_m()[field.steps_at(field.geometry().cell_at(at))];
    const bool explained = off_the_map_m <= sighting::kExplainedCells * field.geometry().resolution_m;
    double least = sighting::kNone;
    Candidate best;
    double best_residual_m = 0.0;
    map.near(at, sighting::kReachM, [&](SurfaceMap::Id id, const SurfaceRecord& record) {
      const std::optional<Surface::Place> beside = record.surface.place_of(at, normal, sighting::kFacingCosine);
      if (!beside || beside->beyond_m > sighting::kBesideM || std::abs(beside->across_m) > sighting::kFarthestM) return;
      const SurfacePlace place = place_of(record);
      const double residual_m = beside->across_m - place.offset_m - place.turn_rad * beside->along_m;
      const double within_m = explained ? sighting::known_within_m(place.deviation_m) : sighting::kReachM;
      const double badness = std::abs(residual_m) + beside->beyond_m;
      if (std::abs(residual_m) > within_m || badness >= least) return;
      least = badness;
      best = {id, record.surface};
      best_residual_m = residual_m;
    });
    if (least < sighting::kNone) claim(best, best_residual_m, static_cast<std::uint32_t>(i));
  }
  judge(ends);
  return sightings_;
}

}  // namespace deltamap::localization::surfaces
