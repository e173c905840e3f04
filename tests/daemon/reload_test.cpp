// SPDX-License-Identifier: Apache-2.0
// `ctl reload` in the running daemon: what it takes shows in what the robot is told.
#include "tests/support/daemon/control_fixture.hpp"

namespace deltamap::daemon {
namespace {

using control::Request;
using test::comes_true;
using test::DriveTest;
using Json = nlohmann::json;

/// Of the forward speeds that were sent from `first` on, mm/s.
int fastest_sent(const test::SimulatedPorts& ports, std::size_t first) {
  int fastest = 0;
  const auto sent = ports.commands();
  for (std::size_t i = first; i < sent.size(); ++i) {
    if (sent[i].number != static_cast<std::uint8_t>(drivers::pioneer::CommandNumber::kVel)) continue;
    fastest = std::max(fastest, sent[i].argument.at(1) + 256 * sent[i].argument.at(2));
  }
  return fastest;
}

class ReloadTest : public DriveTest {
 protected:
  void SetUp() override {
    DriveTest::SetUp();
    settings_.navigation.mode = navigation::DriveMode::kWander;
    wanted_ = settings_;
    live_ = std::make_shared<LiveSettings>(SettingsReading{.settings = settings_}, [this] {
      if (!mistake_.empty()) throw SettingsError(mistake_);
      return SettingsReading{.settings = wanted_, .given = given_};
    });
  }
  Settings wanted_;
  std::set<std::string> given_{"navigation.safety.max_speed_m_per_s", "navigation.wander.speed_m_per_s"};
  std::string mistake_;
};

TEST_F(ReloadTest, SlowsARobotThatDrives) {
  constexpr int kLimit_mm_per_s = 40;
  run([&](test::SimulatedPorts& ports) {
    EXPECT_EQ(asked({Request::Kind::kDriveWander, {}})["ok"], true);
    ASSERT_TRUE(comes_true([&] { return fastest_sent(ports, 0) > 2 * kLimit_mm_per_s; }));
    wanted_.navigation.safety.max_speed_m_per_s = 0.001 * kLimit_mm_per_s;
    const Json reply = asked({Request::Kind::kReload, {}});
    EXPECT_EQ(reply["ok"], true) << reply;
    EXPECT_NE(reply["message"].get<std::string>().find("taken: navigation.safety.max_speed_m_per_s: 0.04"),
              std::string::npos)
        << reply;
    ASSERT_TRUE(reached_scan(static_cast<int>(status()["localized"]) + 3));  // what was decided before is sent by then
    const std::size_t from = ports.commands().size();
    ASSERT_TRUE(comes_true([&] { return fastest_sent(ports, from) > 0; })) << "it drives on";
    ASSERT_TRUE(reached_scan(static_cast<int>(status()["localized"]) + 20));
    EXPECT_LE(fastest_sent(ports, from), kLimit_mm_per_s);
  });
}

TEST_F(ReloadTest, OfAFileWithAMistakeIsRefusedAndTheRobotDrivesOnAsBefore) {
  run([&](test::SimulatedPorts& ports) {
    EXPECT_EQ(asked({Request::Kind::kDriveWander, {}})["ok"], true);
    ASSERT_TRUE(comes_true([&] { return test::DriveTest::moves(ports); }));
    wanted_.navigation.safety.max_speed_m_per_s = 0.01;
    mistake_ = "robot.yaml:1:1: sede: unknown key";
    const Json reply = asked({Request::Kind::kReload, {}});
    EXPECT_EQ(reply["ok"], false);
    EXPECT_EQ(reply["error"], "the settings stay as they are: the file cannot be taken\n" + mistake_);
    EXPECT_EQ(exit_code({"reload"}), 1);
    const std::size_t from = ports.commands().size();
    EXPECT_TRUE(comes_true([&] { return fastest_sent(ports, from) > 10; }));
  });
}

TEST_F(ReloadTest, OfAnEmptiedFileIsRefusedAndTheRobotDrivesNoFaster) {
  constexpr int kLimit_mm_per_s = 60;  // slower than it creeps at first
  settings_.navigation.safety.max_speed_m_per_s = 0.001 * kLimit_mm_per_s;
  live_ = std::make_shared<LiveSettings>(SettingsReading{.settings = settings_}, [this] {
    return SettingsReading{.settings = wanted_, .file = "robot.yaml"};  // as delivered
  });
  run([&](test::SimulatedPorts& ports) {
    EXPECT_EQ(asked({Request::Kind::kDriveWander, {}})["ok"], true);
    ASSERT_TRUE(comes_true([&] { return fastest_sent(ports, 0) > kLimit_mm_per_s / 2; }));
    const Json reply = asked({Request::Kind::kReload, {}});
    EXPECT_EQ(reply["ok"], false) << reply;
    EXPECT_NE(reply["error"].get<std::string>().find("'navigation.safety.max_speed_m_per_s' is gone: 0.06 is in force"),
              std::string::npos)
        << reply;
    ASSERT_TRUE(reached_scan(static_cast<int>(status()["localized"]) + 20));
    EXPECT_LE(fastest_sent(ports, 0), kLimit_mm_per_s);
  });
}

TEST_F(ReloadTest, IsTakenWhileNoScanComes) {
  Pipeline::Options options = this->options();
  options.open = [](boost::asio::io_context&, drivers::port::PortId, unsigned) {
    return drivers::port::SerialPortAnswer{nullptr, "not plugged in"};
  };
  Pipeline pipeline{settings_, std::move(options)};
  for (int i = 1; i <= 10; ++i) {  // more than the way to the pilot holds
    wanted_.navigation.wander.speed_m_per_s = 0.1 + 0.01 * i;
    EXPECT_TRUE(comes_true([&] { return asked({Request::Kind::kReload, {}})["ok"] == true; })) << i;
  }
  (void)pipeline.stop();
}

}  // namespace
}  // namespace deltamap::daemon
