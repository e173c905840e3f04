// SPDX-License-Identifier: Apache-2.0
// Data association: each beam's end belongs to the surface of the map that it lies nearest to, where that surface is
// believed to stand. The beams on one surface together are one observation. A surface that no beam meets is seen by the
// corner at which another one ends.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "localization/motion/deskew.hpp"
#include "localization/sensor/likelihood_field.hpp"
#include "localization/surfaces/faced_scan.hpp"
#include "localization/surfaces/surface_map.hpp"
#include "localization/surfaces/unknown_of_cells.hpp"

namespace deltamap::localization::surfaces {

/// Where a surface is believed to lie, beside where the map has it.
struct SurfacePlace {
  double offset_m;     ///< along the normal
  double turn_rad;     ///< about the surface's centre
  double deviation_m;  ///< of the offset
};

/// The beams that ended at one surface, by their moments, robot frame; or the corner behind which it lies.
struct Sighting {
  SurfaceMap::Id id;
  Surface surface;
  double beams = 0.0;                                 ///< 1 for a corner
  Point2 mean{0.0, 0.0};                              ///< m
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();  ///< sum of squares about the mean, m²
  double range_deviation_m = kRangeDeviationM;        ///< Scan::range_deviation_m
  double corner_deviation_m = 0.0;                    ///< along the normal; 0 where beams ended at the surface

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

/// What a pose rests on: the surfaces that stand within `within_m` of where the map has them, pieces of one face as one
/// observation. Corners are none: they stand where their faces do.
[[nodiscard]] std::vector<SupportingFace> supporting_faces(std::span<const Sighting> sightings,
                                                           const Pose2& map_from_robot, double within_m);

class SightingFinder {
 public:
  /// `place_of(const SurfaceRecord&)` answers a SurfacePlace. The answer is valid until the next call.
  template <typename PlaceOf>
  std::span<const Sighting> find(SurfaceMap& map, const sensor::LikelihoodField& field, const FacedScan& scan,
                                 const Pose2& map_from_robot, PlaceOf&& place_of);
  /// Ends of the last scan that belong to no surface, robot frame.
  [[nodiscard]] const motion::BeamEnds& rest() const { return rest_; }

 private:
  struct Match {
    SurfaceMap::Id id;
    Surface surface;
    double residual_m;
  };
  struct Claim {
    SurfaceMap::Id id;
    Surface surface;
    std::vector<std::uint32_t> ends;
    std::vector<float> residuals_m;
  };
  /// The nearest surface that faces as the point does, map frame. `explained`: the map tells of the point.
  template <typename PlaceOf>
  [[nodiscard]] static std::optional<Match> nearest(SurfaceMap& map, const Point2& at, const Point2& faces,
                                                    bool explained, PlaceOf& place_of);
  void begin(std::size_t ends);
  void claim(const Match& match, std::uint32_t end);
  void judge(const FacedScan& scan);
  void add(const Match& match, const Corner& corner, double range_deviation_m);

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
/// Of an offset: a larger one widens the search no further, as does one that no visit has told of.
inline constexpr double kMostDeviationM = 0.05;
/// How far from a surface's place an end may lie that the map explains.
[[nodiscard]] inline double known_within_m(double deviation_m) {
  return 0.15 + 3.0 * std::min(kMostDeviationM, deviation_m);
}
[[nodiscard]] bool is_on_contour(const sensor::LikelihoodField& field, const Point2& at);
/// Does a face of the map end there too?
[[nodiscard]] bool ends_face(const sensor::LikelihoodField& field, const Point2& at, const Point2& outward);
}  // namespace sighting

template <typename PlaceOf>
std::optional<SightingFinder::Match> SightingFinder::nearest(SurfaceMap& map, const Point2& at, const Point2& faces,
                                                             bool explained, PlaceOf& place_of) {
  std::optional<Match> best;
  double least = 0.0;
  map.near(at, sighting::kReachM, [&](SurfaceMap::Id id, const SurfaceRecord& record) {
    const std::optional<Surface::Place> beside = record.surface.place_of(at, faces, sighting::kFacingCosine);
    if (!beside || beside->beyond_m > sighting::kBesideM || std::abs(beside->across_m) > sighting::kFarthestM) return;
    const SurfacePlace place = place_of(record);
    const double residual_m = beside->across_m - place.offset_m - place.turn_rad * beside->along_m;
    const double within_m = explained ? sighting::known_within_m(place.deviation_m) : sighting::kReachM;
    const double badness = std::abs(residual_m) + beside->beyond_m;
    if (std::abs(residual_m) > within_m || (best && badness >= least)) return;
    least = badness;
    best = Match{id, record.surface, residual_m};
  });
  return best;
}

template <typename PlaceOf>
std::span<const Sighting> SightingFinder::find(SurfaceMap& map, const sensor::LikelihoodField& field,
                                               const FacedScan& scan, const Pose2& map_from_robot, PlaceOf&& place_of) {
  begin(scan.ends.size());
  const Eigen::Matrix2d turn = Eigen::Rotation2Dd{map_from_robot.theta}.toRotationMatrix();
  const Point2 from = map_from_robot.position();
  for (std::size_t i = 0; i < scan.ends.size(); ++i) {
    const FacedEnd& end = scan.ends[i];
    if (end.normal.isZero()) continue;
    const Point2 at = from + turn * end.at;
    // What the map explains is no thing that was pushed far.
    const bool explained = sighting::is_on_contour(field, at);
    if (const auto match = nearest(map, at, turn * end.normal, explained, place_of))
      claim(*match, static_cast<std::uint32_t>(i));
  }
  judge(scan);
  for (const Corner& corner : scan.corners) {
    const Point2 at = from + turn * corner.at;
    const Point2 outward = turn * corner.outward;
    if (const auto match = nearest(map, at, outward, sighting::ends_face(field, at, outward), place_of))
      add(*match, corner, scan.range_deviation_m);
  }
  return sightings_;
}

}  // namespace deltamap::localization::surfaces
