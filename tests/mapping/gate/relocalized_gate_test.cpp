// SPDX-License-Identifier: Apache-2.0
// A person says a wrong pose, then the right one: how long the map stays unwritten.
#include <gtest/gtest.h>

#include "mapping/store_scan.hpp"
#include "tests/support/scans/hall_drive.hpp"
#include "tests/support/worlds/drawn_hall.hpp"

namespace deltamap::mapping::gate {
namespace {

/// Rounds of the hall, each scan shown to the localizer and to the write gate.
class Rounds {
 public:
  explicit Rounds(std::uint64_t seed) : drive_{hall_, {1.5, 1.0, 0.0}, seed}, store_scan_{StoreScanParams{}, seed} {}

  void relocalize(const Pose2& place) { drive_.localizer().relocalize({place}); }
  [[nodiscard]] const Pose2& truth() const { return drive_.truth(); }
  [[nodiscard]] GateReason reason() const { return store_scan_.awareness().gate; }
  [[nodiscard]] const GateTimes& times() const { return store_scan_.awareness().gate_times; }

  /// Seconds until the gate is open, within so many legs of the round.
  double seconds_until_open(int legs) {
    double open_s = -1.0;
    const double began_s = observed_s(times());
    drive(legs, [&] {
      if (open_s < 0.0 && reason() == GateReason::kOpen) open_s = observed_s(times()) - began_s;
    });
    return open_s;
  }
  void turn(int scans) {
    drive_.turn(scans, hall_, [&](const TrackedScan& tracked) { (void)store_scan_.observe(tracked); });
  }
  template <typename See>
  void drive(int legs, See&& see) {
    for (int i = 0; i < legs; ++i, ++leg_) {
      drive_.drive_to(test::way_round()[leg_ % 4], hall_, [&](const TrackedScan& tracked) {
        (void)store_scan_.observe(tracked);
        see();
      });
    }
  }

 private:
  OccupancyGrid hall_ = test::drawn_hall();
  test::HallDrive drive_;
  StoreScan store_scan_;
  std::size_t leg_ = 0;
};

/// The robot is moved to a wrong pose for so many scans, then to the right one; seconds until the gate is open.
double shut_after(std::uint64_t seed, const Pose2& wrong, int scans) {
  Rounds rounds{seed};
  rounds.drive(5, [] {});
  EXPECT_EQ(rounds.reason(), GateReason::kOpen) << seed;
  rounds.relocalize(wrong);
  rounds.turn(scans);
  EXPECT_NE(rounds.reason(), GateReason::kOpen) << seed;
  rounds.relocalize(rounds.truth());
  return rounds.seconds_until_open(4);
}

/// 20 s and 10 m (WriteGateParams::confirm_s, confirm_m), and the views that P(pose right) needs.
TEST(RelocalizedGate, IsOpenAgainWithinTheConfirmingTimeOfTheRightPose) {
  constexpr double kConfirmed_s = 45.0;
  for (const int scans : {5, 25, 100}) {
    for (const Pose2& wrong : {Pose2{12.0, 7.0, 1.0}, Pose2{17.0, 4.0, -1.5}}) {
      const double shut_s = shut_after(1, wrong, scans);
      EXPECT_GE(shut_s, 10.0) << scans << " scans at " << wrong.x;
      EXPECT_LE(shut_s, kConfirmed_s) << scans << " scans at " << wrong.x;
    }
  }
}

}  // namespace
}  // namespace deltamap::mapping::gate
