// SPDX-License-Identifier: Apache-2.0
// A differential-drive robot with the size and limits of a P3-DX (protocols.md A7): where it truly is, and where its
// wheels say it is. Obstacles stop it; its motors then stall.
#pragma once

#include <optional>
#include <span>

#include "core/geometry/pose2.hpp"
#include "core/random.hpp"
#include "simulation/devices/drive_target.hpp"
#include "simulation/robot/body_faults.hpp"
#include "simulation/world/ray_caster.hpp"

namespace deltamap::simulation {

struct RobotParams {
  double radius_m = 0.25;             ///< of the round body that touches obstacles, > 0
  double half_track_m = 0.1786;       ///< half the distance between the wheels as the controller believes it (A7), > 0
  double track_error = 0.01;          ///< share by which the true track is wider; biases turns
  double left_wheel_error = 0.002;    ///< share by which the left wheel truly rolls farther than its encoder says
  double right_wheel_error = -0.001;  ///< the same of the right wheel
  double wheel_noise_m_per_sqrt_m = 0.002;  ///< deviation of a wheel's travel over one metre, >= 0
  double slips_per_m = 0.02;                ///< how often a wheel begins to slip, >= 0
  double slip_length_m = 0.05;              ///< encoder travel during which it slips, >= 0
  double slip_share = 0.5;                  ///< share of that travel that is lost, [0, 1]
};

/// How the wheels' report differs from the truth, throughout: what a calibration has left over.
struct WheelErrors {
  double scale = 0.0;            ///< share by which they count too far
  double turn = 0.0;             ///< share by which they turn too much
  double drift_rad_per_m = 0.0;  ///< that they turn, counter-clockwise, where the body goes straight
};
/// The same robot with these errors in place of its own.
[[nodiscard]] RobotParams with_wheel_errors(RobotParams body, const WheelErrors& errors);

/// What the body touches.
struct RobotContact {
  double bearing_rad = 0.0;    ///< robot frame
  int object = kMoverId;       ///< id in the world; kMoverId: of nothing that stands in it
  double speed_m_per_s = 0.0;  ///< of the body by its own wheels when it came to touch
};

struct RobotState {
  Pose2 map_from_robot;              ///< the truth
  Pose2 odom_from_robot;             ///< integrated by the wheels' encoders
  double speed_m_per_s = 0.0;        ///< by the encoders
  double turn_rate_rad_per_s = 0.0;  ///< by the encoders
  bool stalled = false;              ///< asked to move and held by an obstacle
  std::optional<RobotContact> contact;
};

class Robot {
 public:
  Robot(const RobotParams& params, const Pose2& map_from_start, Random random);

  /// Moves for dt_s seconds, a few milliseconds at a time.
  void move(const devices::DriveTarget& target, double dt_s, const RayCaster& world, std::span<const Circle> people);

  /// Someone carries it there; its wheels notice nothing.
  void carry_to(const Pose2& map_from_robot) { state_.map_from_robot = map_from_robot; }
  void suffer(const BodyFaults& faults) { faults_ = faults; }
  /// Its wheels roll that far on the spot; it stands.
  void spin_wheels(const Pose2& robot_from_moved) {
    state_.odom_from_robot = state_.odom_from_robot * robot_from_moved;
  }

  /// Whether anything is nearer to its body.
  [[nodiscard]] bool touches(double within_m, const RayCaster& world, std::span<const Circle> people) const {
    return contact_at(state_.map_from_robot.position(), params_.radius_m + within_m, world, people).has_value();
  }

  [[nodiscard]] const RobotState& state() const { return state_; }
  [[nodiscard]] const RobotParams& params() const { return params_; }

 private:
  struct Wheel {
    double error = 0.0;
    double slip_left_m = 0.0;
  };
  struct Contact {
    double distance_m;
    Point2 direction;
    int object;
  };
  [[nodiscard]] double ground_travel_m(Wheel& wheel, double encoder_m);
  [[nodiscard]] std::optional<Contact> contact_at(const Point2& position, double within_m, const RayCaster& world,
                                                  std::span<const Circle> people) const;

  RobotParams params_;
  BodyFaults faults_;
  Random random_;
  RobotState state_;
  Wheel left_;
  Wheel right_;
};

}  // namespace deltamap::simulation
