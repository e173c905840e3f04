// SPDX-License-Identifier: Apache-2.0
// Who takes boxes out of an obstacle of the paper's room (§5) one after another, and then puts them back to where they
// were.
#pragma once

#include <optional>
#include <vector>

#include "core/random.hpp"
#include "simulation/changes/change.hpp"
#include "simulation/scenario/scenario.hpp"
#include "simulation/virtual_drive.hpp"

namespace deltamap::experiments {

struct RoomChangesParams {
  int boxes = 4;         ///< of one obstacle, > 0; the paper's (§5)
  int boxes_a_pile = 6;  ///< that make an obstacle, >= boxes; the paper's
  double settle_s = 120.0;
  double every_s = 60.0;  ///< between two boxes
  double look_s = 180.0;  ///< after the last box has gone, and after the last has come back
  double margin_m = 0.5;  ///< between a box that is put down and the robot's body, >= 0
};

class RoomChanges {
 public:
  /// Obstacle and order of its boxes are drawn by chance.
  RoomChanges(const RoomChangesParams& params, const simulation::Scenario& scenario, Random random);

  /// What is to be done now, to be called before every scan; it is taken for done.
  [[nodiscard]] std::optional<simulation::Change> due(double passed_s, const simulation::VirtualDrive& drive);

  /// All have gone, and the time to look has passed.
  [[nodiscard]] bool is_emptied(double passed_s) const;
  /// All are back, and the time to look has passed.
  [[nodiscard]] bool is_over(double passed_s) const;
  [[nodiscard]] const std::vector<simulation::Object>& boxes() const { return boxes_; }

 private:
  RoomChangesParams params_;
  std::vector<simulation::Object> boxes_;
  int next_id_ = 1;
  std::size_t done_ = 0;  // acts: first the boxes go, then they come
  double next_s_ = 0.0;
};

}  // namespace deltamap::experiments
