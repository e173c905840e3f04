// SPDX-License-Identifier: Apache-2.0
// Two ports that play a recording to the live pipeline, in its order, at any pace: what the pseudo-terminals of the
// simulator do, without the simulator.
#pragma once

#include <chrono>
#include <filesystem>
#include <future>

#include "drivers/port/played_ports.hpp"
#include "drivers/port/replay_port.hpp"

namespace deltamap::test {

class ScriptedPorts final : public drivers::port::PlayedPorts {
 public:
  /// Waits `pause` after each record.
  ScriptedPorts(const std::filesystem::path& recording, std::chrono::microseconds pause)
      : PlayedPorts{500'000}, script_{recording, {}}, pause_{pause} {}

  /// Ready when the last record has been played.
  [[nodiscard]] std::future<void> played() { return played_.get_future(); }

 private:
  void play() override {
    timer_->expires_after(pause_);
    timer_->async_wait([this](const boost::system::error_code& error) {
      if (error || !timer_) return;
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
  std::promise<void> played_;
};

}  // namespace deltamap::test
