// SPDX-License-Identifier: Apache-2.0
// A yard that a seed draws: 24 bays of 2.4 m × 2.4 m in three rows, each empty, with a container in it, or with a
// pallet; what stands where, what a laser sees of it, and which bays are in its view.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/messages.hpp"
#include "core/random.hpp"
#include "mapping/bays/bay.hpp"
#include "simulation/world/bodies.hpp"
#include "simulation/world/ray_caster.hpp"

namespace deltamap::experiments {

class BayYard {
 public:
  explicit BayYard(std::uint64_t seed);

  [[nodiscard]] const std::vector<mapping::bays::Bay>& bays() const { return bays_; }
  [[nodiscard]] mapping::bays::BayState truth(std::size_t bay) const { return truths_[bay]; }
  /// Another load, or none, comes to stand there.
  void change(std::size_t bay);
  [[nodiscard]] const simulation::World& world() const { return world_; }
  [[nodiscard]] const simulation::RayCaster& caster() const { return *caster_; }

  /// Corners of a way round all rows, driven round and round.
  [[nodiscard]] static std::vector<Point2> way();
  /// Somewhere on the floor: in an aisle, or in a bay that is not full.
  [[nodiscard]] Point2 floor(Random& random) const;

  /// 181 beams over half a turn; the laser is the robot's middle. Of the ranges without noise.
  [[nodiscard]] std::vector<double> ranges(const Pose2& map_from_robot, const simulation::MovingSurfaces& moving) const;
  /// Some beam has met it, or its rim.
  [[nodiscard]] bool is_reached(std::size_t bay, const Pose2& map_from_robot, const std::vector<double>& ranges) const;
  /// Of the beams that lead to the bay, within 10 m, the share that nothing covers before it; 0 where there are fewer
  /// than twelve.
  [[nodiscard]] double view_of(std::size_t bay, const Pose2& map_from_robot, const std::vector<double>& ranges) const;

 private:
  struct Beams {
    int aimed = 0;
    int reached = 0;
  };
  [[nodiscard]] Beams beams_to(std::size_t bay, const Pose2& map_from_robot, const std::vector<double>& ranges) const;
  void rebuild();

  Random random_;
  std::vector<mapping::bays::Bay> bays_;
  std::vector<mapping::bays::BayState> truths_;
  std::vector<std::optional<simulation::Box>> loads_;
  simulation::World walls_;
  simulation::World world_;
  std::optional<simulation::RayCaster> caster_;
};

/// A scan of these ranges with the laser's noise.
[[nodiscard]] Scan scan_of(const std::vector<double>& ranges, Timestamp time, Random& random);

}  // namespace deltamap::experiments
