// SPDX-License-Identifier: Apache-2.0
// What goes out to a Pioneer during one call of the session: commands, which wait in the queue for their distance, line
// speeds and log lines. The receiver follows each change of speed at once.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "drivers/pioneer/command_queue.hpp"
#include "drivers/pioneer/receiver.hpp"
#include "drivers/session.hpp"

namespace deltamap::drivers::pioneer {

class Transmitter {
 public:
  Transmitter(Receiver& receiver, CommandQueue& commands, Timestamp now, SessionOutput& output)
      : receiver_{receiver}, commands_{commands}, now_{now}, output_{output} {}

  [[nodiscard]] Timestamp now() const { return now_; }
  [[nodiscard]] unsigned baud() const { return receiver_.baud(); }
  /// What the robot has said about itself so far.
  [[nodiscard]] const Receiver& receiver() const { return receiver_; }
  [[nodiscard]] CommandQueue& commands() { return commands_; }

  /// At once, past the queue.
  void write(std::vector<std::uint8_t> bytes) { request({PortRequest::Kind::kWrite, std::move(bytes), 0}); }
  void discard_input() { request({PortRequest::Kind::kDiscardInput, {}, 0}); }
  void set_baud(unsigned baud) {
    receiver_.set_baud(baud);
    request({PortRequest::Kind::kSetBaud, {}, baud});
  }
  void log(std::string line) { output_.log.push_back(std::move(line)); }

 private:
  void request(PortRequest request) { output_.requests.push_back(std::move(request)); }

  Receiver& receiver_;
  CommandQueue& commands_;
  Timestamp now_;
  SessionOutput& output_;
};

}  // namespace deltamap::drivers::pioneer
