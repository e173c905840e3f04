// SPDX-License-Identifier: Apache-2.0
// The io thread: both devices on one event loop, so that messages keep the order in which their bytes came; and the
// drive desk, which has the last word over every velocity before any pulse goes out.
#pragma once

#include <functional>
#include <memory>

#include "core/channel.hpp"
#include "core/messages.hpp"
#include "daemon/control/command.hpp"
#include "daemon/records/recorder.hpp"
#include "daemon/settings/settings.hpp"
#include "daemon/stages/device_link.hpp"
#include "daemon/steps/pilot_step.hpp"
#include "daemon/telemetry/telemetry.hpp"

namespace deltamap::daemon {

class IoStage {
 public:
  struct Wiring {
    PortOpener open;  ///< empty: the serial devices of the settings
    drivers::SessionMode mode = drivers::SessionMode::kLive;
    Channel<SensorMessage>& sensors;
    RecorderInput& recorder;
    Telemetry& telemetry;
    // A short line each; warn: something is degraded, or needs a person.
    std::function<void(const std::string&)> log;
    std::function<void(const std::string&)> warn;
    std::function<void(const control::CommandOutcome&)> answer{};  ///< to an operator who said who drives; may be empty
  };
  IoStage(const Settings& settings, Wiring wiring);
  ~IoStage();
  IoStage(const IoStage&) = delete;
  IoStage& operator=(const IoStage&) = delete;

  /// The io thread's work, until stop().
  void run();
  /// Any thread: the robot is stopped and both devices let go; run() returns soon after.
  void stop();
  /// Any thread, after each localized scan. Its command is not listened to while nobody may drive.
  void post(const PilotWord& word);
  /// Any thread. A person lets the pilot drive (again), or not: the robot is then told to stand at once. Kept on disk
  /// before it is answered. Where the settings say that nobody drives, no velocity is ever sent.
  void let_drive(bool may_drive, std::uint64_t ticket);
  /// Any thread, each of the three. A person takes the robot in hand: the pilot is not listened to, on disk driving is
  /// off, and after let_go() it stands until a person says otherwise. `answer` is called in the io thread. `who` is not
  /// 0.
  void take_by_hand(std::uint64_t who, std::function<void(const control::CommandOutcome&)> answer);
  /// Counts for a moment from the command's time on, however late it comes. Only of the one who has taken it.
  void drive_by_hand(std::uint64_t who, const DriveCommand& command);
  void let_go(std::uint64_t who);
  /// Any thread. From the next decision on.
  void set_safety(const navigation::SafetyParams& params);

  /// Any one thread, now and then: for how long the loop owes an answer to an earlier call. It takes many small turns:
  /// one that hangs shows in that no other comes.
  [[nodiscard]] double silence_s() const;

  /// After run(): decoder counts by device and cause.
  [[nodiscard]] std::map<std::string, std::uint64_t> counts() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace deltamap::daemon
