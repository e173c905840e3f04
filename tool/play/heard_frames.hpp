// SPDX-License-Identifier: Apache-2.0
// What a client says to the played devices, held against what was said to them when they were recorded.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "core/time.hpp"
#include "drivers/port/byte_record.hpp"
#include "tool/decode/frame_reader.hpp"

namespace deltamap::tool {

class HeardFrames {
 public:
  explicit HeardFrames(drivers::port::PortId port) : port_{port} {}

  /// Of the recording, in order, before anything is heard.
  void expect(const drivers::port::ByteRecord& record);
  /// Answers a line for each way in which the client has left the recording: a frame in place of another, one that is
  /// not recorded, ones that it has left out, bytes that are no frame.
  [[nodiscard]] std::vector<std::string> hear(const std::vector<std::uint8_t>& bytes, Timestamp now, unsigned baud,
                                              double after_s);

  [[nodiscard]] std::uint64_t same() const { return same_; }
  [[nodiscard]] std::uint64_t differences() const { return differences_; }
  /// Recorded frames that were not said.
  [[nodiscard]] std::size_t left() const { return expected_.size(); }

 private:
  struct Frame {
    std::string name;  ///< with what it asks for
    std::vector<std::uint8_t> content;
  };
  [[nodiscard]] FrameReader::Sinks sinks_into(std::vector<Frame>& frames, std::uint64_t& garbage_bytes) const;
  [[nodiscard]] std::string judge(const Frame& frame);

  drivers::port::PortId port_;
  FrameReader recorded_reader_;
  FrameReader reader_;
  std::deque<Frame> expected_;
  std::uint64_t same_ = 0;
  std::uint64_t differences_ = 0;
};

}  // namespace deltamap::tool
