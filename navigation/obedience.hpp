// SPDX-License-Identifier: Apache-2.0
// Does the robot do what it is told? Its measured speeds are held against all that a robot could do that was told the
// same: it may be late, and gather or lose speed as slowly as its controller is set to.
#pragma once

#include <deque>
#include <optional>

#include "core/messages.hpp"
#include "navigation/coasting.hpp"

namespace deltamap::navigation {

/// What one speed of an obedient robot may be now.
class SpeedRange {
 public:
  struct Gathering {
    double acceleration = 0.3;  ///< > 0, per s
    double deceleration = 0.3;  ///< > 0, per s
  };
  void begin(double measured) { low_ = high_ = measured; }
  /// `least`, `most`: of what it may be acting on.
  void advance(double least, double most, const Gathering& gathering, double dt_s);
  [[nodiscard]] double low() const { return low_; }
  [[nodiscard]] double high() const { return high_; }

 private:
  double low_ = 0.0;
  double high_ = 0.0;
};

/// How far it has gone beyond what an obedient robot may have: bounded however slowly it creeps.
class ExcessWay {
 public:
  struct Tolerance {
    double creep;  ///< per s; so slow it stands
    double most;   ///< of the way
  };
  void advance(double measured, const SpeedRange& range, const Tolerance& tolerance, double dt_s);
  [[nodiscard]] bool is_too_far() const { return is_too_far_; }

 private:
  double ahead_ = 0.0;   // >= 0: farther, or ahead where it was to stand or to go back
  double behind_ = 0.0;  // >= 0
  bool is_too_far_ = false;
};

class Obedience {
 public:
  /// What was sent to the robot just now, every safety period.
  void told(const Motion& motion, Timestamp now);
  /// Nothing is asked of a robot that nobody talks to.
  void forget();
  /// `stopping`: how its controller brakes.
  void observe(const Odometry& odometry, const StoppingBehaviour& stopping);

  /// For half a second it has been much faster than anything that it was told, or turned so; or by and by it has gone
  /// 0.1 m, or turned by 30°, farther than that or the other way; or for two seconds it has not gone as it was told.
  [[nodiscard]] bool disobeys() const { return disobeys_; }

 private:
  struct Told {
    Timestamp at;
    Motion motion;
  };
  void begin(const Odometry& odometry);

  std::deque<Told> told_;
  std::optional<Odometry> last_;
  SpeedRange speed_;
  SpeedRange turn_rate_;
  ExcessWay excess_way_;
  ExcessWay excess_turn_;
  std::optional<Timestamp> excess_since_;
  std::optional<Timestamp> idle_since_;
  bool disobeys_ = false;
};

}  // namespace deltamap::navigation
