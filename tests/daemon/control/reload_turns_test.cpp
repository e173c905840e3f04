// SPDX-License-Identifier: Apache-2.0
// Reading the settings again takes a while: those who ask for it at the same time share one answer, and no order to
// stop waits for a queue of them.
#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <memory>
#include <thread>
#include <vector>

#include "daemon/control/control_desk.hpp"
#include "tests/support/daemon/socket_client.hpp"
#include "tests/support/files/temporary_folder.hpp"

namespace deltamap::daemon::control {
namespace {

using test::SocketClient;

class ReloadTurns : public testing::Test {
 protected:
  ReloadTurns() {
    settings_.control.socket = (folder_.path() / "ctl.sock").string();
    desk_ = std::make_unique<ControlDesk>(
        settings_, ControlDesk::Wiring{.map = {10, 10, 0.1, {0.0, 0.0}},
                                       .commands = commands_,
                                       .telemetry = telemetry_,
                                       .let_drive = [this](bool, std::uint64_t ticket) { stop(ticket); },
                                       .log = [](const std::string&) {},
                                       .reload = [this] { return reloaded(); },
                                       .record = [](bool, std::uint64_t) { return false; },
                                       .set_log_level = [](LogLevel) { return false; },
                                       .patience_s = 600.0});
    thread_ = std::jthread{[this] { desk_->run(); }};
  }
  ~ReloadTurns() override {
    desk_->stop();
    thread_.join();
  }

  LiveSettings::Outcome reloaded() {
    if (++reloads_ == 1) may_go_on_.get_future().wait();
    return {true, {"reload " + std::to_string(reloads_)}};
  }
  void stop(std::uint64_t ticket) {
    reloads_before_stop_ = reloads_.load();
    desk_->tell({.ticket = ticket, .message = "stands"});
  }

  test::TemporaryFolder folder_;
  Settings settings_;
  Channel<Command> commands_{4};
  Telemetry telemetry_;
  std::atomic<int> reloads_{0};
  std::atomic<int> reloads_before_stop_{-1};
  std::promise<void> may_go_on_;
  std::unique_ptr<ControlDesk> desk_;
  std::jthread thread_;
};

TEST_F(ReloadTurns, ManyWhoAskShareOneAndAnOrderToStopWaitsForNone) {
  constexpr int kClients = 40;
  constexpr int kEach = 20;
  std::vector<std::unique_ptr<SocketClient>> clients;
  for (int i = 0; i <= kClients; ++i) {
    clients.push_back(std::make_unique<SocketClient>(settings_.control.socket));
    EXPECT_NE(clients.back()->asked("hello"), "") << "has come in";
  }
  SocketClient holds{settings_.control.socket};
  ASSERT_TRUE(holds.send(line_of({.kind = Request::Kind::kReload}) + "\n"));
  while (reloads_ == 0) std::this_thread::yield();
  std::string lines;
  for (int i = 0; i < kEach; ++i) lines += line_of({.kind = Request::Kind::kReload}) + "\n";
  for (int i = 0; i < kClients; ++i) ASSERT_TRUE(clients[static_cast<std::size_t>(i)]->send(lines));
  ASSERT_TRUE(clients.back()->send(line_of({.kind = Request::Kind::kDriveOff}) + "\n"));
  may_go_on_.set_value();
  EXPECT_NE(clients.back()->line().find("stands"), std::string::npos);
  EXPECT_LE(reloads_before_stop_, 5);
  for (int i = 0; i < kClients; ++i) {
    for (int j = 0; j < kEach; ++j) {
      ASSERT_NE(clients[static_cast<std::size_t>(i)]->line().find("reload "), std::string::npos) << i << " " << j;
    }
  }
  EXPECT_LT(reloads_, kClients * kEach / 4);
}

}  // namespace
}  // namespace deltamap::daemon::control
