// SPDX-License-Identifier: Apache-2.0
// Wheels that contradict the scans all the time are told once; those that slip for seconds are not.
#include "daemon/steps/wheel_watch.hpp"

#include <gtest/gtest.h>

namespace deltamap::daemon {
namespace {

constexpr double kWatchedEach_s = 0.2;
constexpr double kFast_s = 1.0 / 75.0;

/// What is said while a share of the scans contradicts the wheels.
class WatchedWheels {
 public:
  explicit WatchedWheels(bool moves, double each_s = kWatchedEach_s) : moves_{moves}, each_s_{each_s} {}

  std::string after(double duration_s, double share, double stood_m = 0.0) {
    std::string said;
    for (double t = 0.0; t < duration_s - 1e-9; t += each_s_) {
      tracked_.scan.time += duration_from_seconds(each_s_);
      tracked_.stood_m = stood_m;
      odometry_.odom_from_robot.x += moves_ ? 0.05 : 0.0;
      watch_.observe(odometry_);
      due_ += share;
      if (due_ >= 1.0) ++contradicted_;
      if (due_ >= 1.0) due_ -= 1.0;
      const LogLine line = watch_.observe(tracked_, contradicted_);
      if (!line.text.empty()) said += (line.is_warning ? "warning: " : "") + line.text + "\n";
    }
    return said;
  }
  [[nodiscard]] bool contradict() const { return watch_.contradict(); }
  [[nodiscard]] bool contradicted_of_late() const { return watch_.contradicted_of_late(); }

 private:
  bool moves_;
  double each_s_;
  double due_ = 0.0;
  std::uint64_t contradicted_ = 0;
  Odometry odometry_;
  TrackedScan tracked_;
  WheelWatch watch_;
};

TEST(WheelWatch, WheelsThatContradictAThirdOfTheScansAreToldOnceAfterAMinute) {
  WatchedWheels watched{true};
  EXPECT_EQ(watched.after(59.0, 0.35), "");
  EXPECT_FALSE(watched.contradict());
  const std::string said = watched.after(300.0, 0.35);
  EXPECT_EQ(said.find("warning: wheels and scans contradict each other in 105 of the last 301 scans: check the "), 0u)
      << said;
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1);
  EXPECT_TRUE(watched.contradict());
  EXPECT_EQ(watched.after(200.0, 0.0), "wheels and scans agree again\n");
  EXPECT_FALSE(watched.contradict());
}

TEST(WheelWatch, APoseThatNeverChangesIsToldByFewerScans) {
  WatchedWheels watched{false};
  const std::string said = watched.after(30.0, 0.2);
  EXPECT_EQ(said.find("warning: the robot's pose has never changed, and in "), 0u) << said;
  EXPECT_TRUE(watched.contradict());
}

TEST(WheelWatch, SlipsAndSpinsAreNoFaultOfTheSettings) {
  WatchedWheels watched{true};
  EXPECT_EQ(watched.after(600.0, 0.1), "");
  EXPECT_EQ(watched.after(10.0, 1.0), "") << "carried";
  WatchedWheels fast{true, kFast_s};
  EXPECT_EQ(fast.after(200.0, 0.02), "");
  EXPECT_EQ(fast.after(10.0, 1.0), "") << "carried, 75 scans a second";
  WatchedWheels parked{false, kFast_s};
  EXPECT_EQ(parked.after(2.0, 1.0), "") << "pushed for two seconds";
  EXPECT_EQ(watched.after(200.0, 0.02), "");
  EXPECT_EQ(watched.after(100.0, 1.0, 0.5), "") << "it spins";
  EXPECT_EQ(WatchedWheels{false}.after(600.0, 0.05), "") << "it stands, and people pass";
}

TEST(WheelWatch, TellsWhetherTheLastScansContradictedTheWheels) {
  WatchedWheels watched{true};
  (void)watched.after(30.0, 0.01);
  EXPECT_FALSE(watched.contradicted_of_late()) << "one contradiction in a hundred scans: any drive has these";
  (void)watched.after(4.0, 0.2);
  EXPECT_TRUE(watched.contradicted_of_late());
  (void)watched.after(4.0, 0.0);
  EXPECT_FALSE(watched.contradicted_of_late());
}

}  // namespace
}  // namespace deltamap::daemon
