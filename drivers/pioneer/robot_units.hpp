// SPDX-License-Identifier: Apache-2.0
// Which units this robot counts in, and whether it may be driven by them: by the subtype that its controller tells
// (protocols.md A4, A7), or, where nobody knows that subtype, by what an operator has set by hand.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "drivers/pioneer/odometry.hpp"

namespace deltamap::drivers::pioneer {

/// What an operator has set for his robot; nothing: left as delivered.
struct RobotByHand {
  std::optional<double> metres_per_unit{};  ///< > 0
  std::optional<double> hull_m{};           ///< radius
};

class RobotUnits {
 public:
  /// `configured`: the model until the robot names itself. Throws std::invalid_argument for one that nobody knows.
  RobotUnits(std::string configured, const RobotByHand& by_hand);

  /// Another connection: nothing is known of the robot any more. The units stay until it names itself.
  void forget() { told_.reset(), why_never_driven_.clear(); }

  struct Line {
    std::string text;  ///< empty: nothing new
    bool is_warning = false;
  };
  /// The controller names its subtype: answers what an operator should know of it.
  [[nodiscard]] Line hear(const std::string& subtype);

  [[nodiscard]] const RobotModel& model() const { return model_; }
  /// Empty: nothing speaks against it.
  [[nodiscard]] const std::string& why_never_driven() const { return why_never_driven_; }

 private:
  [[nodiscard]] Line hear_known(const std::string& subtype, const RobotModel& model);
  [[nodiscard]] Line hear_unknown(const std::string& subtype);
  [[nodiscard]] Line never_driven(std::string why);

  std::string configured_;
  RobotByHand by_hand_;
  RobotModel model_;
  std::optional<std::string> told_;  // the newest subtype of this connection
  std::string why_never_driven_;
};

}  // namespace deltamap::drivers::pioneer
