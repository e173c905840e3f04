// SPDX-License-Identifier: Apache-2.0
// The drive desk between a simulated robot and people: requests that have waited too long, hands, and a robot that
// cannot be told. What it shares with whole drives is tested in stages/drive_trials_test.
#include "daemon/driving/drive_desk.hpp"

#include <gtest/gtest.h>

#include "experiments/closed_loop/virtual_link.hpp"
#include "simulation/simulation.hpp"
#include "tests/support/files/source_tree.hpp"
#include "tests/support/files/temporary_folder.hpp"

namespace deltamap::daemon {
namespace {

using drivers::pioneer::PioneerOutput;
using drivers::pioneer::PioneerSession;

constexpr Timestamp kDeskOpens = timestamp_from_ns(1'700'000'000'000'000'000);

drivers::pioneer::PioneerParams driving_robot() {
  drivers::pioneer::PioneerParams params;
  params.enable_motors = true;
  return params;
}

/// A robot on its line, a desk, and no laser: scans are made up, of a free hall.
class Desk {
 public:
  explicit Desk(bool may_ever_drive = true)
      : world_{simulation::read_scenario(test::source_path("config/scenarios/room.yaml")),
               {.seed = 1, .start = kDeskOpens, .change_every_s = {}}},
        kept_{{folder_.path() / "drive.json", "/dev/robot"}},
        link_{drivers::port::PortId::kRobot,
              PioneerSession{driving_robot(), drivers::SessionMode::kLive},
              {[this](std::span<const std::uint8_t> bytes, unsigned baud) {
                 if (!is_cut) world_.send_to_robot(bytes, baud);
               },
               [this](PioneerOutput& out) {
                 for (const Odometry& odometry : out.odometry) desk.observe(heard_ = odometry, world_.now());
                 desk.set_port_open(link_.is_open());
                 desk.obey_permission(world_.now());
               }}},
        desk{may_ever_drive,
             {},
             {.session = link_.session(),
              .kept = kept_,
              .telemetry = telemetry,
              .obey = [this](PioneerOutput out) { link_.handle(std::move(out), world_.now()); },
              .log = [this](const std::string& line) { told.push_back(line); },
              .warn = [this](const std::string& line) { told.push_back(line); }}} {
    link_.start(world_.now());
    pass(6.0);
  }

  void pass(double for_s, double speed_m_per_s = 0.2) {
    for (const Timestamp end = now() + duration_from_seconds(for_s); now() < end;) {
      world_.advance_to(std::min(end, world_.next_event()));
      const auto bytes = world_.bytes_from_robot(link_.baud());
      link_.turn(is_cut ? std::span<const std::uint8_t>{} : bytes, true, now());
      if (now() < next_) continue;
      next_ = now() + duration_from_seconds(kSafetyPeriodS);
      desk.observe(hall());
      if (hand == 0) desk.take({.command = {now(), speed_m_per_s, 0.0}}, now());
      if (hand != 0) desk.drive_by_hand(hand, {now(), speed_m_per_s, 0.0});
      desk.tick(now());
    }
  }
  [[nodiscard]] Timestamp now() const { return world_.now(); }
  /// A stall of one packet.
  void stall() {
    Odometry odometry = heard_;
    odometry.stalled = true;
    odometry.time = now();
    desk.observe(odometry, now());
  }
  [[nodiscard]] bool is_driven() const { return desk.allowed().speed_m_per_s > 0.0; }
  [[nodiscard]] drivers::pioneer::DriveSwitch on_disk() const {
    return read_kept_drive({folder_.path() / "drive.json", "/dev/robot"}).value;
  }

 private:
  Scan free_hall() {
    Scan scan;
    scan.time = scan.received = now();
    scan.first_bearing_rad = radians(-90.0);
    scan.bearing_step_rad = radians(1.0);
    scan.max_range_m = 32.0;
    for (int i = 0; i < 181; ++i)
      scan.beams.push_back({static_cast<float>(20.0 + random_.normal(0.01)), 0.0F, BeamKind::kRange});
    return scan;
  }

  Scan hall() {
    Scan scan = free_hall();
    const int first = (181 - lost_beams) / 2;
    for (int i = first; i < first + lost_beams; ++i)
      scan.beams[static_cast<std::size_t>(i)].kind = BeamKind::kBeyondMaximum;
    return scan;
  }

  test::TemporaryFolder folder_;
  simulation::Simulation world_;
  Random random_{5};
  KeptDrive kept_;
  experiments::VirtualLink<PioneerSession, PioneerOutput> link_;
  Timestamp next_{};
  Odometry heard_;

 public:
  std::vector<std::string> told;
  int lost_beams = 0;  ///< of 181, in the middle
  Telemetry telemetry;
  DriveDesk desk;
  bool is_cut = false;
  std::uint64_t hand = 0;
};

TEST(DriveDesk, LetsNobodyDriveUntilAPersonSaysSo) {
  Desk desk;
  desk.pass(1.0);
  EXPECT_FALSE(desk.is_driven());
  EXPECT_TRUE(desk.desk.let_drive({true, 1, desk.now()}, desk.now()).done);
  desk.pass(1.0);
  EXPECT_TRUE(desk.is_driven());
  EXPECT_EQ(desk.on_disk(), drivers::pioneer::DriveSwitch::kOn);
  EXPECT_TRUE(desk.desk.let_drive({false, 2, desk.now()}, desk.now()).done);
  EXPECT_FALSE(desk.is_driven()) << "at once, not at the next tick";
  EXPECT_EQ(desk.on_disk(), drivers::pioneer::DriveSwitch::kOffByOperator);
}

TEST(DriveDesk, RefusesARequestThatHasWaitedTooLong) {
  Desk desk;
  const auto outcome = desk.desk.let_drive({true, 1, desk.now() - std::chrono::seconds{2}}, desk.now());
  EXPECT_FALSE(outcome.done);
  desk.pass(1.0);
  EXPECT_FALSE(desk.is_driven());
}

TEST(DriveDesk, ListensToAHandAloneAndLeavesTheRobotStandingAfterIt) {
  Desk desk;
  ASSERT_TRUE(desk.desk.let_drive({true, 1, desk.now()}, desk.now()).done);
  EXPECT_TRUE(desk.desk.take_by_hand(7, desk.now(), desk.now()).done);
  EXPECT_EQ(desk.on_disk(), drivers::pioneer::DriveSwitch::kOffByOperator) << "a restart is no hand";
  desk.pass(1.0);
  EXPECT_FALSE(desk.is_driven()) << "the pilot is not listened to";
  desk.hand = 7;
  desk.pass(1.0);
  EXPECT_TRUE(desk.is_driven());
  EXPECT_FALSE(desk.desk.take_by_hand(8, desk.now(), desk.now()).done);
  EXPECT_FALSE(desk.desk.let_drive({true, 2, desk.now()}, desk.now()).done) << "the hand must end first";
  desk.desk.let_go(7, desk.now());
  desk.hand = 0;
  desk.pass(1.0);
  EXPECT_FALSE(desk.is_driven());
}

TEST(DriveDesk, SaysWhereTheRobotCannotBeTold) {
  Desk desk;
  ASSERT_TRUE(desk.desk.let_drive({true, 1, desk.now()}, desk.now()).done);
  desk.pass(1.0);
  desk.is_cut = true;
  desk.pass(0.7);
  const auto outcome = desk.desk.let_drive({false, 2, desk.now()}, desk.now());
  EXPECT_FALSE(outcome.done);
  EXPECT_NE(outcome.message.find("press STOP"), std::string::npos) << outcome.message;
  EXPECT_EQ(desk.on_disk(), drivers::pioneer::DriveSwitch::kOffByOperator) << "kept all the same";
}

TEST(DriveDesk, StopsWhereThePilotSaysThatTheLaserMissesWalls) {
  Desk desk;
  ASSERT_TRUE(desk.desk.let_drive({true, 1, desk.now()}, desk.now()).done);
  desk.pass(1.0);
  desk.desk.take({.command = {desk.now(), 0.2, 0.0}, .misses_walls = true}, desk.now());
  desk.desk.tick(desk.now());
  EXPECT_EQ(desk.desk.allowed().stop, navigation::StopReason::kLaserBlind);
  EXPECT_FALSE(may_drive_by_pose(desk.telemetry));
}

/// Of the free hall a third ahead, lost at once: an open door, or a cloth.
TEST(DriveDesk, ForgetsWhatTheLaserHasCeasedToSeeByAPersonsWordAndSaysSoOnce) {
  Desk desk;
  const auto says = [&](bool may_drive) { return desk.desk.let_drive({may_drive, 1, desk.now()}, desk.now()); };
  ASSERT_TRUE(says(true).done);
  desk.pass(1.0);
  desk.lost_beams = 60;
  desk.pass(30.0);
  ASSERT_EQ(desk.desk.allowed().stop, navigation::StopReason::kLaserBlind);
  EXPECT_EQ(desk.on_disk(), drivers::pioneer::DriveSwitch::kOffAtRobot) << "a restart is no person";
  const std::uint32_t words = desk.telemetry.times_let_drive.value();
  desk.told.clear();
  EXPECT_TRUE(says(true).done);
  desk.pass(1.0);
  EXPECT_TRUE(desk.is_driven());
  EXPECT_EQ(desk.on_disk(), drivers::pioneer::DriveSwitch::kOn);
  EXPECT_EQ(desk.telemetry.times_let_drive.value(), words + 1) << "what else remembers has to be told";
  EXPECT_EQ(desk.told, (std::vector<std::string>{
                           "a person said drive: what the laser has ceased to see is held against it no more",
                           "driving goes on"}));
  desk.told.clear();
  EXPECT_TRUE(says(true).done);
  desk.pass(0.5);
  EXPECT_TRUE(desk.told.empty()) << desk.told.front();
}

TEST(DriveDesk, ForgetsWhatTheLaserHasCeasedToSeeWhereAHandTakesIt) {
  Desk desk;
  ASSERT_TRUE(desk.desk.let_drive({true, 1, desk.now()}, desk.now()).done);
  desk.pass(1.0);
  desk.lost_beams = 60;
  desk.pass(3.0);
  ASSERT_EQ(desk.desk.allowed().stop, navigation::StopReason::kLaserBlind);
  EXPECT_TRUE(desk.desk.take_by_hand(7, desk.now(), desk.now()).done);
  desk.hand = 7;
  desk.pass(2.0);
  EXPECT_TRUE(desk.is_driven());
}

TEST(DriveDesk, ForgetsForPlannersAsWellWhatTheLaserHasCeasedToSee) {
  Desk desk{false};
  desk.telemetry.localized.set(1);
  const auto says_drive = [&] { return desk.desk.let_drive({true, 1, desk.now()}, desk.now()); };
  desk.lost_beams = 181;
  desk.pass(3.0);
  EXPECT_FALSE(says_drive().done) << "there is no range at all";
  desk.lost_beams = 0;
  desk.pass(1.0);
  desk.lost_beams = 60;
  desk.pass(3.0);
  ASSERT_EQ(forbidden_by(desk.telemetry), navigation::StopReason::kLaserBlind);
  const control::CommandOutcome outcome = says_drive();
  EXPECT_TRUE(outcome.done);
  EXPECT_EQ(outcome.message,
            "it waits no more: laser sees nothing; 'navigation.mode' is off: this daemon never drives (set it to "
            "wander, and restart)");
  desk.pass(1.0);
  EXPECT_TRUE(may_drive_by_pose(desk.telemetry));
}

TEST(DriveDesk, TellsPlannersWhatForbidsToDriveWhereItNeverDrives) {
  Desk desk{false};
  desk.telemetry.localized.set(1);
  EXPECT_TRUE(may_drive_by_pose(desk.telemetry));
  desk.told.clear();
  desk.lost_beams = 181;
  desk.pass(5.0);
  EXPECT_EQ(forbidden_by(desk.telemetry), navigation::StopReason::kLaserBlind);
  desk.lost_beams = 0;
  desk.pass(5.0);
  EXPECT_TRUE(may_drive_by_pose(desk.telemetry));
  EXPECT_EQ(desk.told,
            (std::vector<std::string>{"planners must not drive by the pose: laser sees nothing; until it is over",
                                      "planners may drive by the pose again"}));
}

TEST(DriveDesk, SaysOnceWhyItStandsWhereItDrives) {
  Desk desk;
  ASSERT_TRUE(desk.desk.let_drive({true, 1, desk.now()}, desk.now()).done);
  desk.pass(1.0, 0.0);
  desk.told.clear();
  desk.lost_beams = 181;
  desk.pass(5.0, 0.0);
  desk.lost_beams = 0;
  desk.pass(5.0, 0.0);
  EXPECT_EQ(desk.told,
            (std::vector<std::string>{"driving stops: laser sees nothing; until it is over", "driving goes on"}));
}

TEST(DriveDesk, EndsWhatWaitsForAPersonByTheWordDriveAloneWhereItNeverDrives) {
  Desk desk{false};
  desk.telemetry.localized.set(1);
  const auto says = [&](bool may_drive) { return desk.desk.let_drive({may_drive, 1, desk.now()}, desk.now()); };
  EXPECT_FALSE(says(true).done) << "nothing waits";
  desk.stall();
  EXPECT_FALSE(says(true).done) << "its cause is still there";
  desk.pass(1.0);
  EXPECT_EQ(forbidden_by(desk.telemetry), navigation::StopReason::kStalled);
  EXPECT_TRUE(says(false).done);
  desk.pass(1.0);
  EXPECT_EQ(forbidden_by(desk.telemetry), navigation::StopReason::kStalled) << "who says stop does not say drive";
  EXPECT_FALSE(desk.desk.let_drive({true, 1, desk.now() - std::chrono::seconds{2}}, desk.now()).done);
  const control::CommandOutcome outcome = says(true);
  EXPECT_TRUE(outcome.done);
  EXPECT_EQ(
      outcome.message,
      "it waits no more: stalled; 'navigation.mode' is off: this daemon never drives (set it to wander, and restart)");
  desk.pass(1.0);
  EXPECT_TRUE(may_drive_by_pose(desk.telemetry));
  EXPECT_FALSE(desk.is_driven());
  EXPECT_NE(desk.on_disk(), drivers::pioneer::DriveSwitch::kOn) << "nor after a restart with another mode";
}

}  // namespace
}  // namespace deltamap::daemon
