// SPDX-License-Identifier: Apache-2.0
// A port that hands every chunk that passes it, in or out, and every change of baud to a sink, in order, and otherwise
// does what the port inside it does.
#pragma once

#include <functional>
#include <memory>

#include "drivers/port/byte_port.hpp"
#include "drivers/port/byte_record.hpp"

namespace deltamap::drivers::port {

using RecordSink = std::function<void(ByteRecord&& record)>;
using Clock = std::function<Timestamp()>;

class RecordingPort final : public BytePort {
 public:
  /// `clock` stamps what goes out; what comes in keeps the stamp of the inner port. The sink is told the present baud
  /// first.
  RecordingPort(std::unique_ptr<BytePort> inner, PortId id, RecordSink sink, Clock clock);

  void start(PortHandlers handlers) override;
  void write(std::span<const std::uint8_t> bytes) override;
  void set_baud(unsigned baud) override;
  void discard_input() override { inner_->discard_input(); }
  void await(std::size_t bytes) override { inner_->await(bytes); }
  [[nodiscard]] const std::string& name() const override { return inner_->name(); }
  [[nodiscard]] unsigned baud() const override { return inner_->baud(); }

 private:
  void tell_baud(unsigned baud);

  PortId id_;
  RecordSink sink_;
  Clock clock_;
  std::unique_ptr<BytePort> inner_;  // last: it goes first, and with it every handler that uses the others
};

}  // namespace deltamap::drivers::port
