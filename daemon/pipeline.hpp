// SPDX-License-Identifier: Apache-2.0
// The daemon's flow: every channel and every thread, in the order in which a scan passes them. Read pipeline.cpp first.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>

#include "daemon/maps/revision_keeper.hpp"
#include "daemon/outputs/outputs.hpp"
#include "daemon/settings/live_settings.hpp"
#include "daemon/settings/settings.hpp"
#include "daemon/stages/io_stage.hpp"
#include "daemon/steps/localization_step.hpp"
#include "daemon/telemetry/log_level.hpp"
#include "daemon/telemetry/telemetry.hpp"

namespace deltamap::daemon {

class Pipeline {
 public:
  struct Options {
    StartMap start;
    std::uint64_t first_map = 0;  ///< grid_hash() of M_0
    std::uint64_t memory = 0;     ///< fingerprint of what else the run begins from (start.remembered); 0: nothing
    std::shared_ptr<LiveSettings> live{};      ///< for reload(); null: the settings came from no file
    StoreToKeep store{};                       ///< of the settings: takes every revision and refusal in the map thread
    std::optional<std::filesystem::path> out;  ///< an existing folder: the files of a replay, while it runs
    PortOpener open;                           ///< empty: the serial devices of the settings
    drivers::SessionMode mode = drivers::SessionMode::kLive;
    double control_patience_s = 1.0;  ///< with an order of `ctl`; more than it takes to notice that no scan comes
    std::function<void(const std::string&)> log;     ///< any thread: a short line
    std::function<void(const std::string&)> warn{};  ///< any thread: a line on what is degraded; empty: log
    std::function<void(LogLevel)> set_log_level{};   ///< control thread; empty: the log has no levels
    std::function<void(const std::string&)> failed;  ///< any thread: a stage has ended by an exception
  };
  /// Begins at once. Throws FileInUse where another program writes its files, sockets::AlreadyServed where another
  /// daemon listens at the control socket, std::runtime_error where settings or map are no good. A full disk is no
  /// reason: saving then pauses.
  Pipeline(const Settings& settings, Options options);
  ~Pipeline();
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;

  /// Ports first, map store last: the robot is stopped, what has arrived is worked off, Δ-phases that are in work
  /// become revisions, the map is written. Answers what report.json says; throws std::runtime_error where that cannot
  /// be written.
  [[nodiscard]] RunReport stop();

  /// Any thread. Reads the settings again; what was taken or refused is in the log, too.
  LiveSettings::Outcome reload();

  [[nodiscard]] const Telemetry& telemetry() const;
  struct Silence {
    std::string_view stage;
    double silence_s = 0.0;  ///< of map and recorder a tenth: a large map update, or a slow disk, may take its time
  };
  /// One thread that watches: the stage that has not looked for work for longest, what the watchdog judges by. Not the
  /// page: without it the robot does its work.
  [[nodiscard]] Silence longest_silence() const;
  [[nodiscard]] std::shared_ptr<const OccupancyGrid> newest_map() const;  ///< after stop()

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace deltamap::daemon
