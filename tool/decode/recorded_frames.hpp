// SPDX-License-Identifier: Apache-2.0
// A recording frame by frame, by name and field: what passed the ports in both directions, the notes, and the garbage
// between.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "core/time.hpp"
#include "drivers/port/passed_time.hpp"
#include "tool/decode/decoded_frame.hpp"
#include "tool/decode/frame_reader.hpp"

namespace deltamap::tool {

inline constexpr const char* kNoteName = "note";
inline constexpr const char* kGarbageName = "garbage";

struct RecordedFrame {
  /// From a device: arrival of the first byte; to it: when its last bytes were handed to the port; else the record's.
  Timestamp time;
  double after_s = 0.0;      ///< the first record: of `time`
  double completed_s = 0.0;  ///< the same of the record that completed it, by which replays count
  LineEnd line;              ///< of a note the port alone
  DecodedFrame frame;
};

class RecordedFrames {
 public:
  using Sink = std::function<void(const RecordedFrame&)>;

  /// `measuring_mode`: of the laser, where it is not to be read from its own telegrams.
  RecordedFrames(std::optional<std::uint8_t> measuring_mode, Sink sink);
  RecordedFrames(const RecordedFrames&) = delete;
  RecordedFrames& operator=(const RecordedFrames&) = delete;

  /// Hands over what the record holds and completes: its note, garbage, frames.
  void feed(const drivers::port::ByteRecord& record);

 private:
  void take(const drivers::pioneer::Packet& packet, const LineEnd& line);
  void take(const drivers::lms200::Telegram& telegram, const LineEnd& line);
  void take(const drivers::DecoderCounts& garbage, const LineEnd& line);
  void learn_mode(const drivers::lms200::Telegram& telegram);
  void hand_over(Timestamp time, const LineEnd& line, DecodedFrame frame) const;

  Sink sink_;
  FrameReader reader_;
  FrameReader::Sinks sinks_;
  drivers::port::PassedTime passed_;
  bool is_mode_given_;
  std::optional<std::uint8_t> mode_;
  Timestamp stamp_;       // of the newest record
  double after_s_ = 0.0;  // of the newest record
};

}  // namespace deltamap::tool
