// SPDX-License-Identifier: Apache-2.0
// Two ports of the live pipeline to which records are played, in the io thread, from the moment at which they were
// opened on. What is written to them goes nowhere.
#pragma once

#include <utility>  // Boost 1.74's awaitable.hpp needs it and does not say so

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <memory>
#include <optional>
#include <string>

#include "drivers/port/byte_port.hpp"
#include "drivers/port/byte_record.hpp"
#include "drivers/port/port_clock.hpp"
#include "drivers/port/serial_port.hpp"

namespace deltamap::drivers::port {

class PlayedPorts {
 public:
  explicit PlayedPorts(unsigned baud) : baud_{baud} {}
  virtual ~PlayedPorts() = default;
  PlayedPorts(const PlayedPorts&) = delete;
  PlayedPorts& operator=(const PlayedPorts&) = delete;

  [[nodiscard]] SerialPortAnswer open(boost::asio::io_context& loop, PortId id) {
    if (!timer_) timer_.emplace(loop);
    opened_ = port_clock_now();
    return {std::make_unique<Port>(*this, id), ""};
  }

 protected:
  /// Both ports listen: the first turn of the play, which keeps itself going by the timer.
  virtual void play() = 0;

  void give(const ByteRecord& record) {
    if (!first_stamp_) first_stamp_ = record.stamp;
    if (record.bytes.empty()) return;
    handlers_[record.port == PortId::kRobot ? 0 : 1].on_bytes(record.bytes, opened_ + (record.stamp - *first_stamp_));
  }

  std::optional<boost::asio::steady_timer> timer_;  // nothing: the play is over; it must not outlive the loop

 private:
  class Port final : public BytePort {
   public:
    Port(PlayedPorts& ports, PortId id) : ports_{ports}, id_{id}, name_{name_of(id)} {}
    ~Port() override { ports_.timer_.reset(); }
    void start(PortHandlers handlers) override { ports_.start(id_, std::move(handlers)); }
    void write(std::span<const std::uint8_t>) override {}
    void set_baud(unsigned) override {}
    void discard_input() override {}
    void await(std::size_t) override {}
    [[nodiscard]] const std::string& name() const override { return name_; }
    [[nodiscard]] unsigned baud() const override { return ports_.baud_; }

   private:
    PlayedPorts& ports_;
    PortId id_;
    std::string name_;
  };

  void start(PortId id, PortHandlers handlers) {
    handlers_[id == PortId::kRobot ? 0 : 1] = std::move(handlers);
    if (handlers_[0].on_bytes && handlers_[1].on_bytes) play();
  }

  unsigned baud_;
  PortHandlers handlers_[2];
  Timestamp opened_;                      // the play begins there
  std::optional<Timestamp> first_stamp_;  // in the records' own time
};

}  // namespace deltamap::drivers::port
