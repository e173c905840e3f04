// SPDX-License-Identifier: Apache-2.0
// What an LMS200 measures in the simulated world: each beam at its own time from the moving robot, with noise, dropouts
// the mixed readings of a beam that is split by an edge, and what glass and stretch wrap do. Ranges in metres; the
// virtual device turns them into words.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "core/messages.hpp"
#include "core/random.hpp"
#include "simulation/robot/surface_optics.hpp"
#include "simulation/world/ray_caster.hpp"

namespace deltamap::simulation {

struct RangeFinderParams {
  Pose2 robot_from_laser{0.021, 0.0, 0.0};  ///< the mount (protocols.md A7: p3dx-sh 21 mm ahead)
  double range_noise_m = 0.008;             ///< deviation of a reading, >= 0
  double range_bias_m = 0.0;                ///< added to every reading
  double dropout_share = 0.002;             ///< beams that return nothing at all, [0, 1]
  double dazzle_share = 0.0;                ///< beams that are dazzled, [0, 1]
  double footprint_rad = 0.0044;            ///< full angle of the beam's cone, >= 0 (0.25°)
  double mixed_share = 0.5;                 ///< beams split by an edge that read something in between, [0, 1]
  double mixed_step_m = 0.15;               ///< least step in depth that counts as an edge, > 0
  SurfaceOptics surfaces{};
};

/// What one beam brought back.
struct Reading {
  BeamKind kind = BeamKind::kNotValid;
  double range_m = 0.0;  ///< 0 where the kind is not kRange
};

/// The beams of one sweep: where and when each is measured.
struct Sweep {
  std::vector<double> bearings_rad;  ///< in the laser frame, counter-clockwise
  std::vector<double> offsets_s;     ///< of each beam after the sweep's first
};

class RangeFinder {
 public:
  RangeFinder(const RangeFinderParams& params, Random random) : params_{params}, random_{random} {}

  /// Where the robot and all that moves are so many seconds after the sweep's first beam.
  using RobotAt = std::function<Pose2(double offset_s)>;
  using MovingAt = std::function<MovingSurfaces(double offset_s)>;

  [[nodiscard]] std::vector<Reading> measure(const Sweep& sweep, double max_range_m, const RayCaster& world,
                                             const RobotAt& map_from_robot_at, const MovingAt& moving_at);

 private:
  [[nodiscard]] Reading measure_beam(const Pose2& map_from_laser, double bearing_rad, double max_range_m,
                                     const RayCaster& world, const MovingSurfaces& moving);
  template <typename HitTowards>
  [[nodiscard]] std::optional<RayHit> nearest_thin(double bearing_in_map, std::optional<RayHit> middle,
                                                   const HitTowards& hit_towards) const;

  RangeFinderParams params_;
  Random random_;
};

}  // namespace deltamap::simulation
