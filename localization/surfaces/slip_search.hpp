// SPDX-License-Identifier: Apache-2.0
// Have the wheels slipped? Looks where a slip may have led to for a pose from which the surfaces are explained clearly
// better than from the one that the wheels tell.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "localization/motion/motion_model.hpp"
#include "localization/surfaces/offset_state.hpp"
#include "localization/surfaces/slip_reading.hpp"
#include "localization/surfaces/surface_map.hpp"
#include "localization/surfaces/surface_sighting.hpp"
#include "localization/surfaces/surface_switch.hpp"

namespace deltamap::localization::surfaces {

/// What a search looks at: the state as the wheels tell it, and the scan.
struct SlipScene {
  const OffsetState& state;
  std::span<const SurfaceSwitch> switches;  ///< of the surfaces of the state, in its order
  std::span<const Sighting> sightings;      ///< from the state's pose
  const motion::MotionModelParams& motion;  ///< how far slips go
  using SeenFrom = std::function<std::span<const Sighting>(const Pose2&)>;
  SeenFrom seen_as_followed;  ///< from a pose, each surface where it is believed to stand,
  SeenFrom seen_as_mapped;    ///< or where it stood at the last visit
  std::function<const SurfaceRecord&(SurfaceMap::Id)> record_of;
};

struct Slip {
  Pose2 led_to;
  PoseCovariance spread;                ///< of a slip of that kind
  bool displaced;                       ///< the robot, by both wheels: not turned alone, by one
  std::vector<std::size_t> read_wrong;  ///< followed surfaces, with a pose that was wrong already, ascending
  double gained = 0.0;                  ///< nats beyond those that a slip costs
};

/// A slip since the last keyframe.
[[nodiscard]] std::optional<Slip> slip_just_now(const SlipScene& scene);
/// A slip metres ago: what seems to have moved since would hold.
[[nodiscard]] std::optional<Slip> slip_behind(const SlipScene& scene);

}  // namespace deltamap::localization::surfaces
