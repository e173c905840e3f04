// SPDX-License-Identifier: Apache-2.0
// Random sequences of buttons, silences, pulled adapters, resets and restarts, and kills at random moments, on the
// virtual robot in virtual time: what a person has switched off never moves, a robot whose daemon dies stands before
// it touches anything, and is back soon.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/random.hpp"
#include "experiments/closed_loop/virtual_daemon.hpp"
#include "simulation/simulation.hpp"
#include "tests/support/files/figure.hpp"
#include "tests/support/files/temporary_folder.hpp"
#include "tests/support/worlds/quiet_room.hpp"

namespace deltamap {
namespace {

using drivers::pioneer::DriveSwitch;
using simulation::Simulation;
using Daemon = experiments::VirtualDaemon;

constexpr Timestamp kTrialStart = timestamp_from_ns(1'700'000'000'000'000'000);
constexpr std::uint64_t kShards = 8;

Daemon::Params params(const std::filesystem::path& folder, std::uint64_t seed) {
  Daemon::Params params;
  params.settings.robot.session.fast_baud = 38400;
  params.settings.laser.session.baud = 38400;
  params.settings.laser.session.variant = *drivers::lms200::variant_named("180/1");
  params.settings.laser.session.robot_from_laser.x = 0.021;
  params.settings.seed = seed;
  params.kept_file = folder / "store.drive.json";
  return params;
}

/// A drive whose daemon has been told to drive.
struct TrialDrive {
  explicit TrialDrive(std::uint64_t seed)
      : random{seed},
        simulation{test::quiet_room(), {seed, kTrialStart, std::nullopt}},
        daemon{simulation, params(folder.path(), seed)} {
    daemon.start();
    daemon.run(6.0 + random.uniform());
    EXPECT_TRUE(daemon.operator_says(true));
    daemon.run(random.uniform(2.0, 20.0));
  }
  [[nodiscard]] double between(double least, double most) { return random.uniform(least, most); }

  test::TemporaryFolder folder;
  Random random;
  Simulation simulation;
  Daemon daemon;
};

/// What people have said, by what they saw: the measure of the daemon's own notion.
class Persons {
 public:
  explicit Persons(TrialDrive& drive) : drive_{drive} {}

  void press_motors() {
    auto& robot = drive_.simulation.robot();
    const bool was_on = robot.motors_enabled();
    robot.press_motors_button();
    if (was_on) switch_off();
    if (!was_on && robot.motors_enabled()) button_off_ = false;
  }
  void press_stop(bool as_estall) {
    auto& robot = drive_.simulation.robot();
    as_estall ? robot.begin_estall() : robot.press_stop_button();
    holds_stop_ = true;
    switch_off();
  }
  void release_stop() {
    drive_.simulation.robot().release_stop_button();
    drive_.simulation.robot().end_estall();
    holds_stop_ = false;
    // Let go before any SIP: only motors that went off tell it, and those of a robot that waits are off anyway.
    if (is_open_ && waited_ && drive_.daemon.last_odometry() < pressed_) give_up();
  }
  void say(bool on) {
    if (!drive_.daemon.operator_says(on)) return;
    operator_off_ = !on;
    if (on) button_off_ = false;
    if (!on) begin_standing();
  }

  /// At every step.
  void watch() {
    const Timestamp now = drive_.simulation.now();
    if (now - looked_ < std::chrono::milliseconds{20}) return;
    looked_ = now;
    const Pose2 pose = drive_.simulation.map_from_robot();
    const bool moves = distance_between(pose, last_) > 1e-5 || std::abs(turn_between(pose.theta, last_.theta)) > 1e-5;
    last_ = pose;
    const bool was_heard = seconds(drive_.daemon.last_odometry() - pressed_) > 0.25;
    if (was_heard) is_open_ = false;
    if (is_open_ && !holds_stop_ && !drive_.simulation.robot().is_connected()) {
      give_up();
    }
    if (!is_off()) return;
    if (!moves) stands_ = true;
    if (moves && stands_) violations += 1;
    if (moves && seconds(now - off_since_) > 4.5)
      violations += 1;  // watchdog 2 s, then braked from 0.4 m/s at 0.3 m/s^2
  }

  [[nodiscard]] bool is_off() const { return button_off_ || operator_off_; }
  int violations = 0;
  int unknowable = 0;
  int offs = 0;

 private:
  void switch_off() {
    pressed_ = drive_.simulation.now();
    waited_ = !drive_.simulation.robot().is_connected();
    is_open_ = true;
    if (!is_off()) begin_standing();
    button_off_ = true;
  }
  /// Reset or closed before any SIP could tell: nothing on the wire says it any more.
  void give_up() {
    is_open_ = button_off_ = false;
    ++unknowable;
  }
  void begin_standing() {
    off_since_ = drive_.simulation.now();
    stands_ = false;
    ++offs;
  }

  TrialDrive& drive_;
  bool button_off_ = false;
  bool operator_off_ = false;
  bool stands_ = false;
  bool holds_stop_ = false;
  bool waited_ = false;   // for a connection, when it was pressed
  bool is_open_ = false;  // pressed, and no SIP has told it yet
  Timestamp looked_{};
  Timestamp pressed_{};
  Timestamp off_since_{};
  Pose2 last_;
};

void random_event(TrialDrive& drive, Persons& persons) {
  const auto pass = [&](double least, double most) {
    drive.daemon.run(drive.between(least, most), [&] { persons.watch(); });
  };
  switch (drive.random.index_below(8)) {
    case 0:
      return persons.press_motors();
    case 1: {
      const bool as_estall = drive.random.uniform() < 0.5;
      persons.press_stop(as_estall);
      pass(0.15, 2.0);
      if (as_estall && drive.random.uniform() < 0.5) {
        drive.simulation.robot().reset(drive.simulation.now());
        pass(0.15, 4.0);
        persons.say(true);  // refused as soon as a SIP shows it
        pass(0.15, 2.0);
      }
      return persons.release_stop();
    }
    case 2: {
      const bool half = drive.random.uniform() < 0.5;
      half ? drive.daemon.cut_answers(true) : drive.daemon.cut_line(true);
      if (drive.random.uniform() < 0.5) {
        pass(0.1, 1.5);
        persons.press_motors();
      }
      pass(0.1, 4.0);
      drive.daemon.cut_answers(false);
      return drive.daemon.cut_line(false);
    }
    case 3:
      drive.daemon.pull_adapter(true);
      pass(0.1, 3.0);
      return drive.daemon.pull_adapter(false);
    case 4:
      return drive.simulation.robot().reset(drive.simulation.now());
    case 5:
      drive.daemon.kill();
      pass(0.05, 2.5);
      return drive.daemon.start();
    case 6:
      return persons.say(false);
    default:
      return persons.say(true);
  }
}

class RandomSequences : public testing::TestWithParam<std::uint64_t> {};

/// 200 seeds in all, 16 events each.
TEST_P(RandomSequences, NeverMoveARobotThatAPersonHasSwitchedOff) {
  int offs = 0;
  int unknowable = 0;
  int drove = 0;
  for (std::uint64_t seed = 1 + GetParam(); seed <= 200; seed += kShards) {
    TrialDrive drive{seed};
    Persons persons{drive};
    const Pose2 start = drive.simulation.map_from_robot();
    for (int event = 0; event < 16; ++event) {
      random_event(drive, persons);
      drive.daemon.run(drive.between(0.02, 2.0), [&] { persons.watch(); });
    }
    drive.daemon.run(3.0, [&] { persons.watch(); });
    EXPECT_EQ(persons.violations, 0) << "seed " << seed;
    offs += persons.offs;
    unknowable += persons.unknowable;
    if (!persons.is_off() && distance_between(start, drive.simulation.map_from_robot()) > 0.1) ++drove;
  }
  EXPECT_GT(offs, 40);
  EXPECT_GT(drove, 2) << "a person is obeyed the other way as well";
  EXPECT_LT(unknowable, offs / 6);
  test::tell_figure("switched_off_in_shard", offs, "times");
  test::tell_figure("unknowable_in_shard", unknowable, "times");
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomSequences, testing::Range(std::uint64_t{0}, kShards));

TEST(StopsThatWaitForAPerson, WaitForOneAfterARestartAsWell) {
  TrialDrive drive{3001};
  Daemon& daemon = drive.daemon;
  auto& robot = drive.simulation.robot();
  const auto drives = [&] {
    const Pose2 before = drive.simulation.map_from_robot();
    daemon.run(6.0);
    const Pose2 after = drive.simulation.map_from_robot();
    return distance_between(before, after) > 0.02 || std::abs(turn_between(before.theta, after.theta)) > 0.02;
  };
  ASSERT_TRUE(drives());
  robot.fail(1);
  daemon.run(3.0);
  robot.fail(0);
  EXPECT_FALSE(drives()) << "nobody has said so again";
  daemon.kill();
  daemon.run(0.5);
  daemon.start();
  EXPECT_FALSE(drives()) << "a restart is no person";
  EXPECT_FALSE(robot.motors_enabled());
  EXPECT_TRUE(daemon.operator_says(true));
  EXPECT_TRUE(drives());
  daemon.kill();
  daemon.run(4.0);
  daemon.start();
  EXPECT_TRUE(drives()) << "a person has let it go, and that is kept";
}

/// Between the robot's middle and whatever stands there.
double nearest_m(const Simulation& simulation) {
  const simulation::RayCaster surfaces{simulation.world()};
  double nearest = 10.0;
  for (int bearing = 0; bearing < 360; bearing += 3) {
    const auto hit = surfaces.cast(simulation.map_from_robot().position(), radians(bearing), nearest);
    if (hit) nearest = hit->range_m;
  }
  return nearest;
}

class RandomKills : public testing::TestWithParam<std::uint64_t> {};

/// 200 kills in all. The robot goes on at its last set points until its watchdog (2 s) stops it.
TEST_P(RandomKills, LeaveTheRobotStandingBeforeItTouchesAnythingAndItIsSoonBack) {
  double longest_m = 0.0;
  int moving = 0;
  int late = 0;
  int trials = 0;
  int touched = 0;
  for (std::uint64_t seed = 1 + GetParam(); seed <= 200; seed += kShards) {
    TrialDrive drive{1000 + seed};
    const Pose2 killed_at = drive.simulation.map_from_robot();
    drive.daemon.kill();
    double travel_m = 0.0;
    Pose2 last = killed_at;
    const auto follow = [&] {
      const Pose2 pose = drive.simulation.map_from_robot();
      travel_m += distance_between(last, pose);
      last = pose;
    };
    drive.daemon.run(5.0, follow);
    const double body_m = test::quiet_room().robot.body.radius_m;
    touched += nearest_m(drive.simulation) < body_m + 0.005 ? 1 : 0;
    longest_m = std::max(longest_m, travel_m);
    moving += travel_m > 0.05 ? 1 : 0;
    // Worst case at the most that the session allows: watchdog, and braking.
    const drivers::pioneer::MotionLimits limits;
    const double v = limits.max_speed_m_per_s;
    EXPECT_LE(travel_m, v * 2.1 + v * v / (2.0 * limits.deceleration_m_per_s2) + 0.02) << "seed " << seed;
    const Timestamp started = drive.simulation.now();
    drive.daemon.start();
    while (!drive.daemon.is_connected() && seconds(drive.simulation.now() - started) < 30.0) drive.daemon.run(0.02);
    if (seconds(drive.simulation.now() - started) > 3.0) ++late;
    drive.daemon.run(8.0);
    EXPECT_TRUE(drive.simulation.robot().motors_enabled()) << "seed " << seed << ": nobody has switched it off";
    ++trials;
  }
  test::tell_figure("longest_way_after_kill_in_shard", longest_m, "m");
  EXPECT_EQ(touched, 0);
  EXPECT_GT(moving, trials / 3);
  EXPECT_LE(late, trials / 20);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomKills, testing::Range(std::uint64_t{0}, kShards));

/// Adapters pulled out and lines cut for 0.3 to 20 s while it drives; back from the moment they are in again.
TEST(PulledCables, AreForgottenWithinThreeSecondsInNinetyFiveOfAHundred) {
  int late = 0;
  double longest_s = 0.0;
  std::vector<double> times_s;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    TrialDrive drive{2000 + seed};
    for (int pull = 0; pull < 5; ++pull) {
      const bool adapter = drive.random.uniform() < 0.5;
      adapter ? drive.daemon.pull_adapter(true) : drive.daemon.cut_line(true);
      drive.daemon.run(drive.between(0.3, 20.0));
      if (drive.random.uniform() < 0.2) drive.simulation.robot().reset(drive.simulation.now());
      adapter ? drive.daemon.pull_adapter(false) : drive.daemon.cut_line(false);
      const Timestamp plugged = drive.simulation.now();
      drive.daemon.run(0.12);  // a SIP must have come where the link has outlived it
      while ((!drive.daemon.is_connected() || drive.daemon.last_odometry() < plugged) &&
             seconds(drive.simulation.now() - plugged) < 30.0)
        drive.daemon.run(0.02);
      times_s.push_back(seconds(drive.simulation.now() - plugged));
      drive.daemon.run(3.0);
    }
  }
  for (const double time_s : times_s) late += time_s > 3.0 ? 1 : 0;
  longest_s = *std::max_element(times_s.begin(), times_s.end());
  std::nth_element(times_s.begin(), times_s.begin() + 50, times_s.end());
  test::tell_figure("back_median", times_s[50], "s");
  test::tell_figure("back_longest", longest_s, "s");
  EXPECT_EQ(times_s.size(), 100u);
  EXPECT_LE(late, 5);
}

}  // namespace
}  // namespace deltamap
