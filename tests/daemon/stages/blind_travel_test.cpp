// SPDX-License-Identifier: Apache-2.0
// A robot whose client falls silent at the worst moment: it travels no further than its speed was allowed for, and
// touches nothing that the laser could see. Its watchdog and brakes are those of the simulated controller.
#include <gtest/gtest.h>

#include <cstdio>
#include <numbers>

#include "experiments/closed_loop/virtual_daemon.hpp"

namespace deltamap {
namespace {

using Daemon = experiments::VirtualDaemon;

constexpr Timestamp kStart = timestamp_from_ns(1'700'000'000'000'000'000);

constexpr double kHullM = 0.255;       // the simulated body of 0.25 m is held where it touches, up to a step before
constexpr double kWallM = 9.0;         // side of a hall
constexpr double kStandsAfterS = 6.0;  // watchdog, braking from 0.7 m/s, and then some

/// A hall with boxes and pillars strewn about; its middle, where the robot begins, is clear.
simulation::Scenario random_hall(Random& random, double watchdog_s) {
  char line[160];
  std::string yaml;
  const auto add = [&](const char* format, auto... values) {
    std::snprintf(line, sizeof line, format, values...);
    yaml += line;
  };
  add("walls:\n  - [[0, 0], [%g, 0], [%g, %g], [0, %g], [0, 0]]\nposts:\n", kWallM, kWallM, kWallM, kWallM);
  for (int i = 0; i < 9; ++i) {
    const double x = random.uniform(0.3, kWallM - 0.3);
    const double y = random.uniform(0.3, kWallM - 0.3);
    if (std::hypot(x - 0.5 * kWallM, y - 0.5 * kWallM) < 1.2) continue;
    if (i % 2 == 0) add("  - circle: [%.2f, %.2f, %.2f]\n", x, y, random.uniform(0.05, 0.3));
    if (i % 2 == 1) {
      add("  - box: [%.2f, %.2f, %.2f, %.2f, %.0f]\n", x, y, random.uniform(0.1, 0.8), random.uniform(0.1, 0.8),
          random.uniform(0.0, 90.0));
    }
  }
  add("robot:\n  start: [%g, %g, %.0f]\n  watchdog_s: %g\n", 0.5 * kWallM, 0.5 * kWallM, random.uniform(-180.0, 180.0),
      watchdog_s);
  yaml += "laser:\n  units: mm\n  max_range_m: 32\n";
  return simulation::parse_scenario(yaml, "hall");
}

/// Anything between standing and racing, another thing every second or so: no pilot is worse.
std::function<DriveCommand(const Scan&)> reckless(std::uint64_t seed) {
  return [random = Random{seed}, held = DriveCommand{}, until = Timestamp{}](const Scan& scan) mutable {
    if (scan.time > until) {
      held.speed_m_per_s = random.uniform(-0.1, 0.8);
      held.turn_rate_rad_per_s = random.uniform(-1.0, 1.0) * (random.uniform() < 0.5 ? 1.2 : 0.2);
      until = scan.time + duration_from_seconds(random.uniform(0.3, 3.0));
    }
    return held;
  };
}

/// A robot in its hall, and what befalls it.
class Drive {
 public:
  Drive(const simulation::Scenario& scenario, std::uint64_t seed, bool is_reckless)
      : simulation_{scenario, {.seed = seed, .start = kStart, .change_every_s = {}}},
        surfaces_{scenario.world},
        daemon_{simulation_, params(seed, is_reckless)} {
    daemon_.start();
    run_for(0.1);
    EXPECT_TRUE(daemon_.operator_says(true));
  }

  void run_for(double s) {
    daemon_.run(s, [this] {
      const Point2 place = simulation_.map_from_robot().position();
      const Timestamp now = simulation_.now();
      if (now == last_) return;
      const double moved_m = (place - last_place_).norm();
      wheels_m_per_s_ = moved_m / seconds(now - last_);
      travelled_m_ += last_ == Timestamp{} ? 0.0 : moved_m;
      last_place_ = place;
      last_ = now;
      const auto nearest = surfaces_.nearest_surface(place, nearest_m_);
      if (nearest) nearest_m_ = nearest->distance_m;
    });
  }
  void kill() { daemon_.kill(); }

  [[nodiscard]] double travelled_m() const { return travelled_m_; }
  /// Of the robot's centre from what stands in the world, the least so far; 1 at most.
  [[nodiscard]] double nearest_m() const { return nearest_m_; }
  [[nodiscard]] double wheels_m_per_s() const { return wheels_m_per_s_; }
  /// The greater of what was allowed last and what the robot does.
  [[nodiscard]] double speed_m_per_s() const { return std::max(daemon_.last_allowed().speed_m_per_s, wheels_m_per_s_); }

 private:
  static Daemon::Params params(std::uint64_t seed, bool is_reckless) {
    Daemon::Params params;
    daemon::Settings& settings = params.settings;
    settings.robot.session.fast_baud = 38400;
    settings.robot.session.limits.max_speed_m_per_s = 0.7;
    settings.robot.session.limits.max_turn_rate_rad_per_s = radians(80.0);
    settings.laser.session.baud = 38400;
    settings.laser.session.variant = *drivers::lms200::variant_named("180/1");
    settings.laser.session.robot_from_laser.x = 0.021;
    settings.seed = seed;
    if (is_reckless) params.pilot = reckless(seed);
    return params;
  }

  simulation::Simulation simulation_;
  simulation::RayCaster surfaces_;
  Daemon daemon_;
  Timestamp last_{};
  Point2 last_place_{0.0, 0.0};
  double wheels_m_per_s_ = 0.0;
  double travelled_m_ = 0.0;
  double nearest_m_ = 1.0;
};

double allowed_travel_m(double v, double watchdog_s) {
  constexpr double kReactionS = 0.1;
  constexpr double kCycleS = 0.1;
  constexpr double kWheelErrorM = 0.03;  // wheels roll a little farther than they say
  return v * (kReactionS + watchdog_s + kCycleS) + v * v / (2.0 * 0.3) + kWheelErrorM;
}

struct Silence {
  double speed_m_per_s = 0.0;
  double travelled_m = 0.0;
};

/// Drives for a while, falls silent while it moves, and waits until it stands.
Silence silenced(Drive& drive, double after_s) {
  drive.run_for(after_s);
  for (int i = 0; i < 1000 && drive.wheels_m_per_s() < 0.05; ++i) drive.run_for(0.02);
  const double before_m = drive.travelled_m();
  const Silence silence{drive.speed_m_per_s(), 0.0};
  drive.kill();
  drive.run_for(kStandsAfterS);
  EXPECT_EQ(drive.wheels_m_per_s(), 0.0);
  return {silence.speed_m_per_s, drive.travelled_m() - before_m};
}

TEST(BlindTravel, IsWithinWhatIsDocumentedAndTouchesNothing) {
  Random random{11};
  double longest_m = 0.0;
  double fastest_m_per_s = 0.0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    const double watchdog_s = seed % 3 == 0 ? 0.7 : 2.0;
    Drive drive{random_hall(random, watchdog_s), seed, seed % 2 == 0};
    const Silence silence = silenced(drive, random.uniform(5.0, 25.0));
    EXPECT_LE(silence.travelled_m, allowed_travel_m(silence.speed_m_per_s, watchdog_s)) << seed;
    EXPECT_GT(drive.nearest_m(), kHullM) << seed << ": touched at " << silence.speed_m_per_s << " m/s";
    longest_m = std::max(longest_m, silence.travelled_m);
    fastest_m_per_s = std::max(fastest_m_per_s, silence.speed_m_per_s);
  }
  EXPECT_GT(longest_m, 0.5) << "it must have been driving";
  EXPECT_GT(fastest_m_per_s, 0.3);
  RecordProperty("longest_m", std::to_string(longest_m));
}

TEST(BlindTravel, LeavesAWanderingRobotItsWayAbout) {
  Random random{5};
  double driven_m = 0.0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    Drive drive{random_hall(random, 2.0), seed, false};
    drive.run_for(120.0);
    driven_m += drive.travelled_m();
    EXPECT_GT(drive.nearest_m(), kHullM) << seed;
  }
  EXPECT_GT(driven_m, 4 * 120.0 * 0.1);
  RecordProperty("driven_m", std::to_string(driven_m));
}

}  // namespace
}  // namespace deltamap
