// SPDX-License-Identifier: Apache-2.0
// What becomes of a beam at glass and at stretch wrap. A pane sends back only what meets it nearly at a right angle,
// all else goes through; wrap returns most beams, loses some, lets some through to what lies behind, dazzles, or reads
// short.
#pragma once

#include <cmath>
#include <optional>

#include "core/geometry/angle.hpp"
#include "simulation/world/ray_caster.hpp"

namespace deltamap::simulation {

/// Assumed, not measured: chosen so that none of the kinds is rare in a scan of a wrapped pallet.
struct SurfaceOptics {
  double glass_within_rad = radians(4.0);  ///< of the perpendicular: there a pane returns the beam, [0, π/2]
  double wrap_no_return_share = 0.08;      ///< of beams on wrap that come back as "not valid", [0, 1]
  double wrap_through_share = 0.10;        ///< that see what lies behind the pallet, [0, 1]
  double wrap_dazzle_share = 0.02;         ///< that come back as "dazzled", [0, 1]
  double wrap_short_share = 0.05;          ///< that read short, [0, 1]; the four shares together at most 1
  double wrap_short_m = 0.3;               ///< by how much at most, >= 0
};

enum class WrapEcho : std::uint8_t { kReturned, kNone, kThrough, kDazzled, kShort };

/// By chance: `fate` is uniform in [0, 1).
[[nodiscard]] WrapEcho wrap_echo(const SurfaceOptics& optics, double fate);

/// Whether a beam goes through the pane that it has hit.
[[nodiscard]] inline bool passes_glass(const RayHit& hit, const SurfaceOptics& optics) {
  return hit.incidence_cosine < std::cos(optics.glass_within_rad);
}

/// The first hit of a ray that goes on behind every surface of glass or wrap of which passes(hit) holds.
template <typename Passes>
[[nodiscard]] std::optional<RayHit> cast_through(const RayCaster& world, const Point2& from, double bearing_rad,
                                                 double max_range_m, const MovingSurfaces& moving,
                                                 const Passes& passes) {
  constexpr double kBehind_m = 1e-6;
  std::optional<RayHit> hit = world.cast(from, bearing_rad, max_range_m, moving);
  if (!hit || hit->material == Material::kSolid) return hit;
  const Point2 direction{std::cos(bearing_rad), std::sin(bearing_rad)};
  double passed_m = 0.0;
  while (hit && hit->material != Material::kSolid && passes(*hit)) {
    passed_m += hit->range_m + kBehind_m;
    if (passed_m >= max_range_m) return std::nullopt;
    hit = world.cast(from + passed_m * direction, bearing_rad, max_range_m - passed_m, moving);
  }
  if (hit) hit->range_m += passed_m;
  return hit;
}

}  // namespace deltamap::simulation
