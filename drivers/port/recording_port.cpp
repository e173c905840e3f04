// SPDX-License-Identifier: Apache-2.0
#include "drivers/port/recording_port.hpp"

#include <utility>

namespace deltamap::drivers::port {

RecordingPort::RecordingPort(std::unique_ptr<BytePort> inner, PortId id, RecordSink sink, Clock clock)
    : id_{id}, sink_{std::move(sink)}, clock_{std::move(clock)}, inner_{std::move(inner)} {
  tell_baud(inner_->baud());
}

void RecordingPort::tell_baud(unsigned baud) {
  ByteRecord record;
  record.port = id_;
  record.stamp = clock_();
  record.note = baud_note(baud);
  record.baud = baud;
  sink_(std::move(record));
}

void RecordingPort::start(PortHandlers handlers) {
  PortHandlers wrapped;
  wrapped.on_closed = std::move(handlers.on_closed);
  wrapped.on_bytes = [this, hand_on = std::move(handlers.on_bytes)](std::span<const std::uint8_t> bytes,
                                                                    Timestamp stamp) {
    sink_({id_, Direction::kIn, stamp, {bytes.begin(), bytes.end()}, "", inner_->baud()});
    if (hand_on) hand_on(bytes, stamp);  // last: it may destroy this port
  };
  inner_->start(std::move(wrapped));
}

void RecordingPort::write(std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return;
  sink_({id_, Direction::kOut, clock_(), {bytes.begin(), bytes.end()}, "", inner_->baud()});
  inner_->write(bytes);
}

void RecordingPort::set_baud(unsigned baud) {
  tell_baud(baud);
  inner_->set_baud(baud);
}

}  // namespace deltamap::drivers::port
