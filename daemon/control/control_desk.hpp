// SPDX-License-Identifier: Apache-2.0
// Answers the operator (`deltamap ctl`) in the control thread: the status from telemetry; what concerns pose and map is
// sent to the localization thread, which takes it before its next scan; who drives is the io thread's.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/channel.hpp"
#include "core/grid/occupancy_grid.hpp"
#include "daemon/control/command.hpp"
#include "daemon/control/request.hpp"
#include "daemon/control/server.hpp"
#include "daemon/settings/live_settings.hpp"
#include "daemon/settings/settings.hpp"
#include "daemon/telemetry/loop_pulse.hpp"
#include "daemon/telemetry/telemetry.hpp"

namespace deltamap::daemon::control {

class ControlDesk {
 public:
  struct Wiring {
    GridGeometry map;  ///< where a robot can be
    Channel<Command>& commands;
    const Telemetry& telemetry;
    std::function<void(bool may_drive, std::uint64_t ticket)> let_drive;
    std::function<void(const std::string&)> log;
    std::function<LiveSettings::Outcome()> reload;
    std::function<bool(bool goes_on, std::uint64_t ticket)> record;       ///< false: too busy
    std::function<bool(std::string words, std::uint64_t ticket)> mark{};  ///< false: too busy
    std::function<bool(SiteEdit edit, std::uint64_t ticket)> draw{};      ///< false: too busy
    std::function<std::string()> incidents{};                             ///< the reply that lists them
    std::function<bool(LogLevel)> set_log_level;                          ///< false: this run's log has no levels
    std::function<std::string()> things{};                                ///< one line of JSON: all things
    std::function<std::string()> bays{};                                  ///< one line of JSON: all bays
    double patience_s = 1.0;  ///< then a sender is told that the daemon is busy
  };
  /// Listens from now on. Throws sockets::AlreadyServed, or std::runtime_error with one line that names the socket.
  ControlDesk(const Settings& settings, Wiring wiring);

  /// The control thread's work, until stop().
  void run() { server_.run(); }
  void stop() { server_.stop(); }
  /// One thread that watches: how long it has not looked for requests, s. 0 at the first time.
  [[nodiscard]] double silence_s();
  /// Any thread: a line that has not come by the socket. The reply is given in the control thread, or never where what
  /// was asked for is lost.
  void ask(std::string line, control::Server::Reply reply);
  /// Any thread: a command has been taken, or could not be.
  void tell(const CommandOutcome& outcome);

 private:
  struct Waiting {
    control::Request request;
    control::Server::Reply reply;
  };
  void answer(const std::string& line, bool sender_is_gone, control::Server::Reply reply);
  void refuse(const control::Request& request, const std::string& why, const control::Server::Reply& reply) const;
  void drive(bool may_drive, const control::Request& request, control::Server::Reply reply);
  /// Of an order that waits for the disk: `send` hands it over with its ticket, or answers false.
  void await(const control::Request& request, control::Server::Reply reply,
             const std::function<bool(std::uint64_t)>& send);
  void reload(control::Server::Reply reply);
  [[nodiscard]] std::string reloaded() const;
  [[nodiscard]] std::string with_log_level(LogLevel level) const;
  void command(const control::Request& request, control::Server::Reply reply);

  Settings settings_;
  Wiring wiring_;
  Timestamp began_;
  std::uint64_t next_ticket_ = 1;
  std::map<std::uint64_t, Waiting> waiting_;     // by ticket
  std::vector<control::Server::Reply> reloads_;  // that wait for the next one
  LoopPulse pulse_;
  control::Server server_;  // last: its handler uses the others
};

/// Null where the settings name no socket, or it cannot be had: a daemon that cannot be commanded still does its work,
/// and warns. But not beside another one: throws sockets::AlreadyServed.
[[nodiscard]] std::unique_ptr<ControlDesk> begun_control_desk(const Settings& settings, ControlDesk::Wiring wiring,
                                                              const std::function<void(const std::string&)>& warn);

}  // namespace deltamap::daemon::control
