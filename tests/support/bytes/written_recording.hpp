// SPDX-License-Identifier: Apache-2.0
// A recording of bytes and notes at given seconds, in a folder of its own.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "drivers/port/byte_log.hpp"
#include "tests/support/files/temporary_folder.hpp"

namespace deltamap::test {

class WrittenRecording {
 public:
  static constexpr unsigned kBaud = 38400;

  [[nodiscard]] static Timestamp at(double after_s) {
    return timestamp_from_ns(1'700'000'000'000'000'000) + duration_from_seconds(after_s);
  }

  void bytes(double at_s, drivers::port::PortId port, drivers::port::Direction direction,
             std::vector<std::uint8_t> chunk) {
    writer_->write({port, direction, at(at_s), std::move(chunk), {}, 0});
  }
  void note(double at_s, const std::string& text, drivers::port::PortId port = drivers::port::PortId::kRobot) {
    writer_->write({port, drivers::port::Direction::kIn, at(at_s), {}, text, 0});
  }
  /// Ends it, once, and answers its name.
  [[nodiscard]] std::string closed() {
    writer_->close();
    return file();
  }
  [[nodiscard]] std::string file() const { return (folder_.path() / "drive.pcapng").string(); }

 private:
  TemporaryFolder folder_;
  std::unique_ptr<drivers::port::ByteLogWriter> writer_ = std::make_unique<drivers::port::ByteLogWriter>(
      folder_.path() / "drive.pcapng", drivers::port::FirstBauds{kBaud, kBaud});
};

}  // namespace deltamap::test
