// SPDX-License-Identifier: Apache-2.0
// Two ports that play a recording to the live pipeline, in its order, at any pace: what the pseudo-terminals of the
// simulator do, without the simulator. Where somebody keeps them back, no machine is too slow for what they play.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <future>
#include <utility>

#include "drivers/port/played_ports.hpp"
#include "drivers/port/replay_port.hpp"

namespace deltamap::test {

class ScriptedPorts final : public drivers::port::PlayedPorts {
 public:
  /// Asked before each record, in the io thread; each may be empty.
  struct Brakes {
    std::function<bool()> is_behind{};  ///< what was played is not worked off yet: waits
    std::function<bool()>
        wants_scans{};  ///< somebody still needs scans: the last third of the recording dawdles, the last sixth more
  };
  /// Waits `pause` after each record.
  ScriptedPorts(const std::filesystem::path& recording, std::chrono::microseconds pause, Brakes brakes)
      : PlayedPorts{500'000}, script_{recording, {}}, pause_{pause}, brakes_{std::move(brakes)} {}

  /// Ready when the last record has been played.
  [[nodiscard]] std::future<void> played() { return played_.get_future(); }

 private:
  [[nodiscard]] std::chrono::microseconds pause() const {
    constexpr std::chrono::microseconds kDawdling{50'000};
    const bool is_last_third = 3 * script_.read_bytes() > 2 * script_.size_bytes();
    const bool is_last_sixth = 6 * script_.read_bytes() > 5 * script_.size_bytes();
    if (!is_last_third || !brakes_.wants_scans || !brakes_.wants_scans()) return pause_;
    return std::max(pause_, is_last_sixth ? 4 * kDawdling : kDawdling);
  }

  void play() override {
    timer_->expires_after(pause());
    timer_->async_wait([this](const boost::system::error_code& error) {
      if (error || !timer_) return;
      if (brakes_.is_behind && brakes_.is_behind()) return play();
      const auto next = script_.next();
      if (!next) {
        timer_.reset();
        return played_.set_value();
      }
      give(next->record);
      play();
    });
  }

  drivers::port::ReplayPort script_;
  std::chrono::microseconds pause_;
  Brakes brakes_;
  std::promise<void> played_;
};

}  // namespace deltamap::test
