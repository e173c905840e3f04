// SPDX-License-Identifier: Apache-2.0
// A daemon that listens to its operator over a real socket: on a recorded drive, or on a simulated robot that may
// drive.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "daemon/control/request.hpp"
#include "simulation/scenario/start_map.hpp"
#include "tests/support/bytes/simulated_ports.hpp"
#include "tests/support/daemon/pipeline_fixture.hpp"
#include "tests/support/daemon/socket_client.hpp"
#include "tests/support/files/source_tree.hpp"
#include "tool/run_tool.hpp"

namespace deltamap::test {

inline constexpr auto kGiveUp = std::chrono::seconds{120};

/// Asks until the answer is as wanted.
template <typename Wanted>
bool comes_true(const Wanted& wanted) {
  const auto give_up_at = std::chrono::steady_clock::now() + kGiveUp;
  while (!wanted()) {
    if (std::chrono::steady_clock::now() > give_up_at) return false;
    std::this_thread::yield();
  }
  return true;
}

class ControlDeskTest : public PipelineFixture {
 protected:
  ControlDeskTest() { settings_.control.socket = folder_.path() / "ctl.sock"; }

  [[nodiscard]] nlohmann::json asked_once(const daemon::control::Request& request) const {
    SocketClient client{settings_.control.socket};
    return nlohmann::json::parse(client.asked(daemon::control::line_of(request)));
  }
  /// Asked again where the daemon has not done it because this machine was busy: the order, or a scan, came too late.
  [[nodiscard]] nlohmann::json asked(const daemon::control::Request& request) const {
    nlohmann::json reply;
    (void)comes_true([&] {
      reply = asked_once(request);
      const std::string error = reply.value("error", "");
      return !error.starts_with("it was asked for too long ago") && !error.starts_with("not done: no scan has come");
    });
    return reply;
  }
  [[nodiscard]] nlohmann::json status() const { return asked({daemon::control::Request::Kind::kStatus, {}}); }
  [[nodiscard]] bool reached_scan(int scan) const {
    return comes_true([&] { return status()["localized"] > scan; });
  }
  [[nodiscard]] int exit_code(std::vector<const char*> arguments) const {
    arguments.insert(arguments.begin(), {"deltamap", "ctl", "--socket", settings_.control.socket.c_str()});
    return tool::run_tool(static_cast<int>(arguments.size()), arguments.data());
  }
};

class DriveTest : public ControlDeskTest {
 protected:
  void SetUp() override {
    settings_.laser.session.baud = 38400;
    settings_.initial_pose = Pose2{1.0, 2.0, 0.0};
    settings_.recording.file.clear();
    write_grid(simulation::start_map(scenario_, 0.05), folder_.path() / "room.yaml");  // where the robot truly drives
  }

  void run(
      const std::function<void(SimulatedPorts&)>& operate,
      const std::function<void(SimulatedPorts&)>& prepare = [](SimulatedPorts&) {}, int after_scan = 5) {
    SimulatedPorts ports{scenario_, 1};
    prepare(ports);
    daemon::Pipeline::Options live = options();
    live.open = [&ports](boost::asio::io_context& loop, drivers::port::PortId id, unsigned baud) {
      return ports.open(loop, id, baud);
    };
    std::optional<daemon::Pipeline> pipeline{std::in_place, settings_, std::move(live)};
    ASSERT_TRUE(reached_scan(after_scan));
    operate(ports);
    (void)pipeline->stop();
    ports.end();
  }

  /// Whether anything that makes wheels turn or motors hold was among the commands from `first` on.
  static bool moves(const SimulatedPorts& ports, std::size_t first = 0) {
    using Number = drivers::pioneer::CommandNumber;
    const auto sent = ports.commands();
    return std::any_of(sent.begin() + static_cast<std::ptrdiff_t>(std::min(first, sent.size())), sent.end(),
                       [](const SimulatedPorts::SentCommand& command) {
                         const bool is_motion = command.number == static_cast<std::uint8_t>(Number::kVel) ||
                                                command.number == static_cast<std::uint8_t>(Number::kRvel) ||
                                                command.number == static_cast<std::uint8_t>(Number::kEnable);
                         const bool is_zero =
                             command.argument.size() == 3 && command.argument[1] == 0 && command.argument[2] == 0;
                         return is_motion && !is_zero;
                       });
  }

  simulation::Scenario scenario_ = simulation::read_scenario(test::source_path("config/scenarios/room.yaml"));
};

}  // namespace deltamap::test
