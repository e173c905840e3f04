// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/virtual_pioneer.hpp"

#include <gtest/gtest.h>

#include "drivers/pioneer/config_packet.hpp"
#include "drivers/pioneer/extra_packets.hpp"

namespace deltamap::simulation::devices {
namespace {

namespace pioneer = drivers::pioneer;
using pioneer::Command;
using pioneer::CommandNumber;

constexpr Timestamp kFirstMoment = timestamp_from_ns(1'000'000'000'000);

/// A host at one speed, and time that passes in steps of 5 ms.
class PioneerRig {
 public:
  explicit PioneerRig(PioneerSetup setup = {}) : robot{setup, Random{1}}, host_baud{setup.baud}, decoder_{setup.baud} {}

  void send(const Command& command) { robot.receive(pioneer::encoded_command(command), host_baud, now); }
  std::vector<pioneer::Packet> pass(double seconds) {
    std::vector<pioneer::Packet> packets;
    for (const Timestamp end = now + duration_from_seconds(seconds); now < end;) {
      now += std::chrono::milliseconds{5};
      robot.advance(now, motion, [](int) { return 2.0; });
      const auto bytes = robot.transmitted(now, host_baud);
      for (auto& packet : decoder_.decode(bytes, now)) packets.push_back(std::move(packet));
    }
    return packets;
  }
  void connect() {
    for (const auto number : {CommandNumber::kPulse, CommandNumber::kOpen, CommandNumber::kClose}) {
      send({number, {}});
      ASSERT_FALSE(pass(0.1).empty());
    }
    send({CommandNumber::kOpen, 1});
    (void)pass(0.15);
    ASSERT_TRUE(robot.is_connected());
  }
  std::optional<pioneer::Sip> next_sip() {
    for (const auto& packet : pass(0.2)) {
      if (pioneer::is_sip(packet.type())) return pioneer::decoded_sip(packet.data);
    }
    return std::nullopt;
  }

  VirtualPioneer robot;
  unsigned host_baud;
  Timestamp now = kFirstMoment;
  WheelMotion motion;

 private:
  pioneer::PacketDecoder decoder_;
};

TEST(VirtualPioneer, EchoesEachSyncAndNamesItself) {
  PioneerRig rig;
  rig.send({CommandNumber::kPulse, {}});
  EXPECT_EQ(rig.pass(0.1).at(0).type(), 0);
  rig.send({CommandNumber::kOpen, {}});
  EXPECT_EQ(rig.pass(0.1).at(0).type(), 1);
  rig.send({CommandNumber::kClose, {}});
  const auto identity = pioneer::decoded_identity(rig.pass(0.1).at(0).data);
  ASSERT_TRUE(identity);
  EXPECT_EQ(identity->subtype, "p3dx-sh");
  EXPECT_FALSE(rig.robot.is_connected()) << "until OPEN";
}

TEST(VirtualPioneer, DoesNotOpenWithoutSync) {
  PioneerRig rig;
  rig.send({CommandNumber::kOpen, 1});
  EXPECT_TRUE(rig.pass(0.5).empty());
}

TEST(VirtualPioneer, SendsASipEveryCycleWithMotorsOff) {
  PioneerRig rig{{.baud = 38400}};
  rig.connect();
  int sips = 0;
  for (const auto& packet : rig.pass(1.0)) {
    ASSERT_TRUE(pioneer::is_sip(packet.type()));
    EXPECT_FALSE(pioneer::decoded_sip(packet.data)->has(pioneer::sip_flag::kMotorsEnabled));
    ++sips;
  }
  EXPECT_EQ(sips, 10);
}

TEST(VirtualPioneer, HasItsMotorsOffAfterOpenThoughAButtonHadSwitchedThemOnWhileItWaited) {
  PioneerRig rig;
  rig.robot.press_motors_button();
  rig.connect();
  EXPECT_FALSE(rig.next_sip().value().has(pioneer::sip_flag::kMotorsEnabled));
}

TEST(VirtualPioneer, AnswersSync0WithSipsWhereAnotherClientLeftItConnected) {
  PioneerRig rig;
  rig.connect();
  rig.send({CommandNumber::kPulse, {}});
  for (const auto& packet : rig.pass(0.5)) EXPECT_TRUE(pioneer::is_sip(packet.type()));
  rig.send({CommandNumber::kClose, {}});
  (void)rig.pass(0.1);
  EXPECT_TRUE(rig.pass(0.5).empty());
  rig.connect();
}

TEST(VirtualPioneer, WatchdogStopsItAndAnyPacketResumesTheOldSetPoints) {
  PioneerRig rig;
  rig.connect();
  rig.send({CommandNumber::kEnable, 1});
  rig.send({CommandNumber::kVel, 300});
  rig.send({CommandNumber::kRvel, -20});
  (void)rig.pass(1.9);
  EXPECT_NEAR(rig.robot.demand().speed_m_per_s, 0.3, 1e-9);
  (void)rig.pass(0.2);
  EXPECT_TRUE(rig.robot.watchdog_has_fired());
  EXPECT_EQ(rig.robot.demand().speed_m_per_s, 0.0);
  EXPECT_EQ(rig.robot.demand().turn_rate_rad_per_s, 0.0);
  rig.send({CommandNumber::kPulse, {}});
  (void)rig.pass(0.01);
  EXPECT_NEAR(rig.robot.demand().speed_m_per_s, 0.3, 1e-9) << "by itself, as A9 warns";
  EXPECT_NEAR(rig.robot.demand().turn_rate_rad_per_s, radians(-20), 1e-9);
}

TEST(VirtualPioneer, KeepsToTheLimitsThatItWasGivenReportsThemAndForgetsThemAtClose) {
  PioneerRig rig;
  rig.connect();
  for (const Command& command : std::vector<Command>{{CommandNumber::kSetV, 400},
                                                     {CommandNumber::kSetRv, 50},
                                                     {CommandNumber::kSetA, -1000},
                                                     {CommandNumber::kSetRa, -150},
                                                     {CommandNumber::kEnable, 1},
                                                     {CommandNumber::kVel, 900}})
    rig.send(command);
  EXPECT_NEAR(rig.robot.demand().speed_m_per_s, 0.4, 1e-9);
  const auto told = [&rig] {
    rig.send({CommandNumber::kConfig, 1});
    for (const auto& packet : rig.pass(0.4)) {
      if (packet.type() == pioneer::kConfigPacket) return pioneer::decoded_config(packet.data);
    }
    return std::optional<pioneer::ConfigPacket>{};
  };
  auto config = told();
  ASSERT_TRUE(config);
  EXPECT_EQ(config->trans_vel_max, 400);
  EXPECT_EQ(config->rot_vel_max, 50);
  EXPECT_EQ(config->trans_acc, 300);
  EXPECT_EQ(config->trans_decel, 1000);
  EXPECT_EQ(config->rot_decel, 150);
  (void)rig.pass(2.1);
  ASSERT_TRUE(rig.robot.watchdog_has_fired());
  EXPECT_NEAR(rig.robot.demand().deceleration_m_per_s2, 1.0, 1e-9) << "its own stop too";
  rig.send({CommandNumber::kSetA, -300});
  rig.send({CommandNumber::kEstop, {}});
  EXPECT_GT(rig.robot.demand().deceleration_m_per_s2, 1.9) << "ESTOP brakes as it can";
  rig.send({CommandNumber::kClose, {}});
  (void)rig.pass(0.3);
  rig.connect();
  config = told();
  ASSERT_TRUE(config);
  EXPECT_EQ(config->trans_vel_max, 750);
  EXPECT_EQ(config->trans_decel, 300);
}

TEST(VirtualPioneer, TellsItsFaults) {
  PioneerRig rig;
  rig.connect();
  EXPECT_EQ(rig.next_sip()->fault_flags, 0);
  rig.robot.fail(0x0010);
  EXPECT_EQ(rig.next_sip()->fault_flags, 0x0010);
}

TEST(VirtualPioneer, MovesOnlyWithMotorsEnabledAndTheStopButtonDisablesThem) {
  PioneerRig rig;
  rig.connect();
  rig.send({CommandNumber::kVel, 300});
  EXPECT_EQ(rig.robot.demand().speed_m_per_s, 0.0);
  rig.send({CommandNumber::kEnable, 1});
  EXPECT_GT(rig.robot.demand().speed_m_per_s, 0.0);
  rig.robot.press_stop_button();
  EXPECT_EQ(rig.robot.demand().speed_m_per_s, 0.0);
  EXPECT_TRUE(rig.next_sip()->has(pioneer::sip_flag::kStopButton));
  rig.send({CommandNumber::kEnable, 1});
  EXPECT_FALSE(rig.robot.motors_enabled()) << "while it is pressed";
  rig.robot.release_stop_button();
  EXPECT_EQ(rig.robot.demand().speed_m_per_s, 0.0) << "and not by letting go";
}

TEST(VirtualPioneer, ShowsEstall) {
  PioneerRig rig;
  rig.connect();
  rig.send({CommandNumber::kEnable, 1});
  rig.robot.begin_estall();
  EXPECT_FALSE(rig.robot.motors_enabled());
  EXPECT_TRUE(rig.next_sip()->has(pioneer::sip_flag::kEstall));
  rig.robot.end_estall();
  EXPECT_FALSE(rig.next_sip()->has(pioneer::sip_flag::kEstall));
  EXPECT_FALSE(rig.robot.motors_enabled());
}

TEST(VirtualPioneer, TellsItsPoseInFifteenBitsOfItsUnit) {
  PioneerRig rig{{.model = "p3dx"}};
  rig.motion.odom_from_robot = {20.0, -0.485, radians(-90)};
  rig.connect();
  const auto sip = rig.next_sip();
  ASSERT_TRUE(sip);
  EXPECT_EQ(sip->x_units, 41237 & 0x7FFF) << "20 m / 0.485 mm";
  EXPECT_EQ(sip->y_units, 0x8000 - 1000);
  EXPECT_EQ(sip->heading_units, -1024);
}

TEST(VirtualPioneer, CountsFromItsLastSetO) {
  PioneerRig rig;
  rig.motion.odom_from_robot = {3.0, 4.0, radians(90)};
  rig.connect();
  rig.send({CommandNumber::kSetO, {}});
  rig.motion.odom_from_robot = {3.0, 5.0, radians(90)};
  const auto sip = rig.next_sip();
  EXPECT_EQ(sip->x_units, 1000) << "ahead, as it counts now";
  EXPECT_EQ(sip->y_units, 0);
}

TEST(VirtualPioneer, TellsStallBumpersAndBattery) {
  PioneerRig rig{{.battery_v = 11.5, .has_bumpers = true}};
  rig.connect();
  rig.motion.stalled = true;
  rig.motion.contact_bearing_rad = 0.0;
  auto sip = rig.next_sip();
  EXPECT_TRUE(sip->left_stall && sip->right_stall);
  EXPECT_EQ(sip->front_bumpers, 0b00100);
  EXPECT_EQ(sip->rear_bumpers, 0);
  EXPECT_EQ(sip->battery_decivolts, 115);
  rig.motion.contact_bearing_rad = radians(179);
  sip = rig.next_sip();
  EXPECT_EQ(sip->front_bumpers, 0);
  EXPECT_EQ(sip->rear_bumpers, 0b00100);
}

TEST(VirtualPioneer, TellsAChargerAndAnEmptyOrNoBatteryOnOrder) {
  PioneerRig rig;
  rig.connect();
  EXPECT_FALSE(rig.next_sip()->has(pioneer::sip_flag::kChargerPower));
  rig.robot.suffer({.charger_power = true, .charge_state = 1}, rig.now);
  (void)rig.next_sip();
  auto sip = rig.next_sip();
  EXPECT_TRUE(sip->has(pioneer::sip_flag::kChargerPower));
  EXPECT_EQ(sip->charge_state, 1);
  rig.robot.suffer({.battery_v = 0.0}, rig.now);
  (void)rig.next_sip();
  sip = rig.next_sip();
  EXPECT_EQ(sip->battery_decivolts, 0);
  EXPECT_EQ(sip->battery_x10_decivolts, 0);
  rig.robot.suffer({.tells_no_battery = true}, rig.now);
  (void)rig.next_sip();
  sip = rig.next_sip();
  EXPECT_EQ(sip->battery_decivolts, 0);
  EXPECT_FALSE(sip->battery_x10_decivolts) << "and nothing after it";
  rig.robot.suffer({}, rig.now);
  (void)rig.next_sip();
  EXPECT_EQ(rig.next_sip()->battery_x10_decivolts, 128);
}

TEST(VirtualPioneer, HasTheUnitOfTheRobotWhoseSubtypeItTells) {
  EXPECT_EQ(kind_of("p3dx-sh-lms500").metres_per_unit, 0.001);
  EXPECT_EQ(kind_of("p3dx").metres_per_unit, 0.000485);
  EXPECT_EQ(kind_of("p3at").metres_per_unit, 0.000465);
  EXPECT_EQ(kind_of("p3at").hull_m, 0.5);
  EXPECT_EQ(kind_of("p3at-sh-lms1xx").metres_per_unit, 0.001);
  EXPECT_EQ(kind_of("powerbot-sh").hull_m, 0.55);
  EXPECT_EQ(kind_of("somebody's").metres_per_unit, 0.001);
}

TEST(VirtualPioneer, IsDeafAndUnreadableAtAnotherBaudAndFollowsHostbaud) {
  PioneerRig rig;
  rig.host_baud = 38400;
  rig.send({CommandNumber::kPulse, {}});
  EXPECT_TRUE(rig.pass(0.5).empty());
  rig.host_baud = 9600;
  rig.connect();
  rig.host_baud = 38400;
  EXPECT_TRUE(rig.pass(1.0).empty()) << "SIPs come, but as garbage";
  rig.host_baud = 9600;
  rig.send({CommandNumber::kHostBaud, 2});
  (void)rig.pass(0.1);
  EXPECT_EQ(rig.robot.baud(), 38400u);
  rig.host_baud = 38400;
  EXPECT_FALSE(rig.pass(0.5).empty());
  rig.send({CommandNumber::kClose, {}});
  EXPECT_EQ(rig.robot.baud(), 9600u) << "reverts on disconnect (A4)";
}

TEST(VirtualPioneer, ForgetsEverythingAtAReset) {
  PioneerRig rig;
  rig.motion.odom_from_robot = {3.0, 0.0, 0.0};
  rig.connect();
  rig.send({CommandNumber::kEnable, 1});
  rig.robot.reset(rig.now);
  (void)rig.pass(0.1);
  EXPECT_TRUE(rig.pass(1.0).empty());
  EXPECT_FALSE(rig.robot.motors_enabled());
  rig.connect();
  EXPECT_EQ(rig.next_sip()->x_units, 0);
}

TEST(VirtualPioneer, TurnsToAHeadingAndMovesADistance) {
  SetPoints points;
  WheelMotion motion;
  ASSERT_TRUE(points.take({CommandNumber::kHead, 90}, motion));
  EXPECT_GT(points.demand(motion).turn_rate_rad_per_s, 0.5);
  motion.odom_from_robot.theta = radians(90);
  EXPECT_EQ(points.demand(motion).turn_rate_rad_per_s, 0.0);
  ASSERT_TRUE(points.take({CommandNumber::kMove, -500}, motion));
  EXPECT_LT(points.demand(motion).speed_m_per_s, -0.3);
  motion.travelled_m = -0.5;
  EXPECT_EQ(points.demand(motion).speed_m_per_s, 0.0);
  ASSERT_TRUE(points.take(pioneer::byte_pair_command(CommandNumber::kVel2, {-5, 5}), motion));
  EXPECT_NEAR(points.demand(motion).speed_m_per_s, 0.0, 1e-9);
  EXPECT_NEAR(points.demand(motion).turn_rate_rad_per_s, 0.1 / 0.1786, 1e-6) << "100 mm/s each way";
}

}  // namespace
}  // namespace deltamap::simulation::devices
