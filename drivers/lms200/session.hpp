// SPDX-License-Identifier: Apache-2.0
// The conversation with an LMS200 (protocols.md B3 to B8), seen from outside. It asks its parts in turn: the Receiver
// for what came, in both modes; live, StreamSetup on the way to a stream, and StreamWatch for the stream and a laser
// that has fallen silent. Knows no port and no clock.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/messages.hpp"
#include "core/time.hpp"
#include "drivers/decoder_counts.hpp"
#include "drivers/line_diagnosis.hpp"
#include "drivers/line_quality.hpp"
#include "drivers/lms200/params.hpp"
#include "drivers/lms200/receiver.hpp"
#include "drivers/lms200/stream_setup.hpp"
#include "drivers/lms200/stream_watch.hpp"
#include "drivers/session.hpp"

namespace deltamap::drivers::lms200 {

struct Lms200Output {
  SessionOutput output;
  std::vector<Scan> scans;
};

class Lms200Session {
 public:
  /// Throws std::invalid_argument for a variant, mode or baud that the laser does not have.
  Lms200Session(const Lms200Params& params, SessionMode mode);

  /// The port is open and at any speed: begins with the search, or where the laser streamed last. Also the way back
  /// after `failed`.
  [[nodiscard]] Lms200Output start(Timestamp now);
  [[nodiscard]] Lms200Output on_bytes(std::span<const std::uint8_t> bytes, Timestamp stamp);
  [[nodiscard]] Lms200Output on_time(Timestamp now);
  /// Replays only: the recording says that the line changed its speed.
  void on_baud(unsigned baud) { receiver_.set_baud(baud, true); }
  /// Stops the stream; nothing is sent after it.
  [[nodiscard]] Lms200Output close(Timestamp now);

  [[nodiscard]] bool is_streaming() const;
  [[nodiscard]] unsigned baud() const { return receiver_.baud(); }
  /// Bytes that are to come before there is anything new to read; 0 where that is not known.
  [[nodiscard]] std::size_t awaited_bytes() const { return receiver_.awaited_bytes(); }
  [[nodiscard]] DecoderCounts counts() const { return receiver_.counts(); }
  /// Time from one scan to the next at this variant and baud (B7), for judging staleness.
  [[nodiscard]] double nominal_period_s() const { return receiver_.nominal_period_s(); }

 private:
  enum class State {
    kIdle,       // not started, closed, failed, or listening only
    kSettingUp,  // StreamSetup
    kWatching    // StreamWatch
  };

  void take(const Telegram& telegram, Lms200Output& out);
  void answer(const Telegram& telegram, Transmitter& line, SessionOutput& out);
  void go_on(Transmitter& line, SessionOutput& out);
  void go_on_from_setup(Transmitter& line, SessionOutput& out);
  void go_on_from_watch(Transmitter& line, SessionOutput& out);
  void begin_visits(Transmitter& line);
  void diagnose(std::span<const std::uint8_t> bytes, SessionOutput& out);
  void watch_line(Timestamp now, SessionOutput& out);
  void fail(std::string reason, SessionOutput& out);
  [[nodiscard]] Timestamp deadline() const;
  [[nodiscard]] Lms200Output finished(Lms200Output out) const;

  Lms200Params params_;
  SessionMode mode_;
  State state_ = State::kIdle;
  Receiver receiver_;
  StreamSetup setup_;
  StreamWatch watch_;
  LineDiagnosis diagnosis_{Device::kLaser};  // of the line since the laser was last heard
  LineQuality quality_{Device::kLaser};      // of the line while it streams
};

}  // namespace deltamap::drivers::lms200
