// SPDX-License-Identifier: Apache-2.0
// Two ports that play a recording to the live pipeline, in its order, at any pace: what the pseudo-terminals of the
// simulator do, without the simulator.
#pragma once

#include <utility>  // Boost 1.74's awaitable.hpp needs it and does not say so

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "drivers/port/byte_port.hpp"
#include "drivers/port/port_clock.hpp"
#include "drivers/port/replay_port.hpp"
#include "drivers/port/serial_port.hpp"

namespace deltamap::test {

class ScriptedPorts {
 public:
  using PortId = drivers::port::PortId;

  /// Waits `pause` after each record.
  ScriptedPorts(const std::filesystem::path& recording, std::chrono::microseconds pause)
      : script_{recording, {}}, pause_{pause} {}

  [[nodiscard]] drivers::port::SerialPortAnswer open(boost::asio::io_context& loop, PortId id) {
    if (!timer_) timer_.emplace(loop);
    opened_ = drivers::port::port_clock_now();
    return {std::make_unique<Port>(*this, id), ""};
  }

  /// Ready when the last record has been played.
  [[nodiscard]] std::future<void> played() { return played_.get_future(); }

 private:
  class Port final : public drivers::port::BytePort {
   public:
    Port(ScriptedPorts& ports, PortId id) : ports_{ports}, id_{id}, name_{name_of(id)} {}
    void start(drivers::port::PortHandlers handlers) override { ports_.start(id_, std::move(handlers)); }
    void write(std::span<const std::uint8_t>) override {}
    void set_baud(unsigned) override {}
    void discard_input() override {}
    [[nodiscard]] const std::string& name() const override { return name_; }
    [[nodiscard]] unsigned baud() const override { return 500'000; }

   private:
    ScriptedPorts& ports_;
    PortId id_;
    std::string name_;
  };

  void start(PortId id, drivers::port::PortHandlers handlers) {
    handlers_[id == PortId::kRobot ? 0 : 1] = std::move(handlers);
    if (handlers_[0].on_bytes && handlers_[1].on_bytes) play();
  }

  void play() {
    timer_->expires_after(pause_);
    timer_->async_wait([this](const boost::system::error_code& error) {
      if (error) return;
      const auto next = script_.next();
      if (!next) {
        timer_.reset();  // it must not outlive the loop
        return played_.set_value();
      }
      const auto& record = next->record;
      const auto& handlers = handlers_[record.port == PortId::kRobot ? 0 : 1];
      if (!began_) began_ = record.stamp;
      if (!record.bytes.empty()) handlers.on_bytes(record.bytes, opened_ + (record.stamp - *began_));
      play();
    });
  }

  drivers::port::ReplayPort script_;
  std::chrono::microseconds pause_;
  std::optional<boost::asio::steady_timer> timer_;
  drivers::port::PortHandlers handlers_[2];
  Timestamp opened_;                // the script begins there
  std::optional<Timestamp> began_;  // in the script's own time
  std::promise<void> played_;
};

}  // namespace deltamap::test
