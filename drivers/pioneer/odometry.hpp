// SPDX-License-Identifier: Apache-2.0
// From SIPs to core Odometry (protocols.md A7, A8): unwraps the controller's counters, converts to metres and radians,
// and begins a new epoch where the controller's pose jumped.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "core/geometry/angle.hpp"
#include "core/messages.hpp"
#include "drivers/pioneer/status.hpp"

namespace deltamap::drivers::pioneer {

inline constexpr int kHeadingUnitsPerTurn = 4096;

/// Conversion factors of one kind of robot (A7).
struct RobotModel {
  double metres_per_unit = 0.001;  ///< DistConvFactor
  /// DiffConvFactor: rad/s for each mm/s of (right - left) / 2; 0: its track is not known, and the controller's own
  /// turn rate or its heading tells.
  double turn_rate_per_speed = 0.0056;
  double max_speed_m_per_s = 2.2;  ///< absolute, whatever the flash allows
  friend bool operator==(const RobotModel&, const RobotModel&) = default;
};

/// "p3dx" (old controller), or any that begins with "p3dx-sh": what follows tells of its equipment. Capitals count as
/// small letters.
[[nodiscard]] std::optional<RobotModel> model_named(std::string_view subtype);

class OdometryTracker {
 public:
  explicit OdometryTracker(const RobotModel& model) : model_{model} {}

  /// A new epoch begins where the units change after the first SIP.
  void set_model(const RobotModel& model);
  /// The next SIP is a reference again. Harmless before the first.
  void begin_epoch();

  /// Takes one SIP that was true at a time. An epoch starts at x = y = 0 with the heading that the controller reports.
  [[nodiscard]] Odometry observe(const Sip& sip, Timestamp time);

 private:
  [[nodiscard]] double turn_rate_rad_per_s(const Sip& sip, int turn_units, double elapsed_s) const;
  [[nodiscard]] bool is_jump(int dx_units, int dy_units, int turn_units, double elapsed_s) const;

  struct Reference {
    Sip sip;
    Timestamp time;
  };

  RobotModel model_;
  std::optional<Reference> last_;
  std::uint32_t epoch_ = 0;
  std::int64_t x_units_ = 0;  // since the epoch's start
  std::int64_t y_units_ = 0;
};

}  // namespace deltamap::drivers::pioneer
