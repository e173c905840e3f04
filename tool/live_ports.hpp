// SPDX-License-Identifier: Apache-2.0
// What plays devices on two ports in real time has in common: links in a folder, a clock, and sleep that a program's
// bytes or a signal ends.
#pragma once

#include <csignal>
#include <ctime>
#include <filesystem>
#include <vector>

#include "core/time.hpp"
#include "simulation/devices/pseudo_terminal.hpp"

namespace deltamap::tool {

/// SIGINT and SIGTERM end the run, and arrive only while it sleeps: none is missed between looking and sleeping.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  [[nodiscard]] bool was_asked() const;
  [[nodiscard]] const sigset_t& while_asleep() const { return before_; }

 private:
  sigset_t before_{};
};

/// Monotonic, with its offset to Unix time fixed at the start, as of drivers/port/port_clock.hpp.
class SteadyClock {
 public:
  SteadyClock();
  [[nodiscard]] Timestamp now() const;

 private:
  Duration offset_;
};

/// One player a folder; a lock, because links stay behind when one is killed.
class LinksFolder {
 public:
  /// Makes the folder. Throws std::runtime_error naming it.
  explicit LinksFolder(const std::filesystem::path& folder);
  ~LinksFolder();
  LinksFolder(const LinksFolder&) = delete;
  LinksFolder& operator=(const LinksFolder&) = delete;

 private:
  int descriptor_ = -1;
};

/// Sleeps until a moment, until there is something to read, or until a signal.
void sleep_until(Timestamp wake, std::vector<pollfd> watched, const SteadyClock& clock, const StopSignals& signals);

/// The links `robot` and `laser` of a folder.
struct LivePorts {
  LinksFolder folder;
  simulation::devices::PseudoTerminal robot;
  simulation::devices::PseudoTerminal laser;
  explicit LivePorts(const std::filesystem::path& links)
      : folder{links}, robot{links / "robot"}, laser{links / "laser"} {}

  /// Sleeps until a moment, until a program has written to one of the ports, or until a signal.
  void sleep_until(Timestamp wake, const SteadyClock& clock, const StopSignals& signals) const {
    std::vector<pollfd> watched;
    robot.watch(watched);
    laser.watch(watched);
    tool::sleep_until(wake, std::move(watched), clock, signals);
  }
};

}  // namespace deltamap::tool
