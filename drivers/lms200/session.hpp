// SPDX-License-Identifier: Apache-2.0
// The conversation with an LMS200: finds its baud whatever state it is in, brings variant, units and mode to what is
// wanted (writing its EEPROM only where they differ), lets it stream, turns its telegrams into Scans, and finds it
// again after a silence (protocols.md B3 to B8). Knows no port and no clock.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/messages.hpp"
#include "core/time.hpp"
#include "drivers/decoder_counts.hpp"
#include "drivers/line_diagnosis.hpp"
#include "drivers/lms200/command.hpp"
#include "drivers/lms200/configuration.hpp"
#include "drivers/lms200/measurement.hpp"
#include "drivers/lms200/status.hpp"
#include "drivers/lms200/telegram.hpp"
#include "drivers/monotonic_times.hpp"
#include "drivers/session.hpp"

namespace deltamap::drivers::lms200 {

struct Lms200Params {
  ScanVariant variant{180, 50};                  ///< wanted; variant_named("180/0.5")
  Units units = Units::kMillimetre;              ///< wanted
  std::optional<std::uint8_t> measuring_mode{};  ///< wanted, B4 byte 5; empty: keep, but 06h where it is too short
  unsigned baud = 38400;                         ///< wanted: 9600, 19200, 38400 or 500000
  double max_range_m = 0.0;                      ///< longer ranges become kBeyondMaximum; 0: as far as the mode goes
  Pose2 robot_from_laser{};                      ///< the mount
  double power_on_wait_s = 65.0;                 ///< how long a silent laser may still be starting up (B8)
  double scan_timeout_s = 2.0;                   ///< silence while streaming that is told, and sought at other bauds
  double assume_after_s = 5.0;  ///< a recording without the laser's replies: the wanted mode counts after this
};

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
  void on_baud(unsigned baud);
  /// Stops the stream; nothing is sent after it.
  [[nodiscard]] Lms200Output close(Timestamp now);

  [[nodiscard]] bool is_streaming() const { return state_ == State::kStreaming; }
  [[nodiscard]] unsigned baud() const { return decoder_.baud(); }
  [[nodiscard]] DecoderCounts counts() const;
  /// Time from one scan to the next at this variant and baud (B7), for judging staleness.
  [[nodiscard]] double nominal_period_s() const;

 private:
  enum class State {
    kIdle,         // not started, closed, failed, or listening only
    kStopping,     // the stream was told to stop at this baud; waiting for silence
    kProbing,      // status requested
    kWatching,     // silent: status requested at one baud after the other, until it speaks
    kSettingBaud,  // awaiting the answer at the old speed
    kSettling,     // a moment until the laser is usable at the new one
    kSettingVariant,
    kReadingConfiguration,
    kEnteringInstallation,  // password sent
    kWritingConfiguration,
    kVerifyingConfiguration,
    kStarting,  // stream requested
    kStreaming
  };
  /// What a step sends, how long it waits for its answer and how often it asks.
  struct Step {
    std::vector<std::uint8_t> request;
    double timeout_s = 0.0;
    int tries = 1;
  };
  /// What a stream depends on and a power cut may change.
  struct Agreement {
    std::uint8_t measuring_mode = 0;
    ScanVariant variant;
    Units units = Units::kCentimetre;
    friend bool operator==(const Agreement&, const Agreement&) = default;
  };

  // What comes in (both modes).
  void take_telegram(const Telegram& telegram, Lms200Output& out);
  void take_status(const Telegram& telegram, Lms200Output& out);
  void take_scan(const Telegram& telegram, Lms200Output& out);
  void forget();
  [[nodiscard]] std::optional<std::uint8_t> measuring_mode(Timestamp now);

  // The conversation (live).
  void answer(const Telegram& telegram, Timestamp now, Lms200Output& out);
  void answer_step(const Telegram& telegram, Timestamp now, Lms200Output& out);
  void answer_nak(Timestamp now);
  void answer_probe(const Telegram& telegram, Timestamp now, Lms200Output& out);
  void answer_baud_change(const Telegram& telegram, Timestamp now, Lms200Output& out);
  void finish_variant(Timestamp now, Lms200Output& out);
  void time_out(Timestamp now, Lms200Output& out);
  void give_up_step(Timestamp now, Lms200Output& out);
  void begin_step(State state, Timestamp now, Lms200Output& out);
  void send_step(Timestamp now, Lms200Output& out);
  [[nodiscard]] Step step_of(State state) const;
  void search_from(unsigned first_baud);
  void try_baud(Timestamp now, Lms200Output& out);
  void next_baud(Timestamp now, Lms200Output& out);
  void set_up(Timestamp now, Lms200Output& out);
  void compare_configuration(Timestamp now, Lms200Output& out);
  void fail(std::string reason, Lms200Output& out);
  void begin_stream(Timestamp now, Lms200Output& out);
  [[nodiscard]] Configuration wanted_configuration() const;

  // A silent laser (live).
  void begin_watch(Timestamp now, Lms200Output& out);
  void visit(Timestamp now, Lms200Output& out);
  void end_visit(Timestamp now, Lms200Output& out);
  void answer_watch(const Telegram& telegram, Timestamp now, Lms200Output& out);
  void answer_stream(const Telegram& telegram, Timestamp now, Lms200Output& out);
  void take_no_telegram(bool was_garbage, Timestamp now);
  void diagnose(std::span<const std::uint8_t> bytes, Lms200Output& out);
  void ask_whether_as_agreed(Timestamp now, Lms200Output& out);
  void resume(bool is_checked, Timestamp now, Lms200Output& out);
  [[nodiscard]] unsigned visited_baud() const;
  [[nodiscard]] bool streams_as_agreed(const DeviceStatus& status) const;
  [[nodiscard]] double scan_timeout_s() const;
  [[nodiscard]] Duration patience_with_stream() const;

  void write(std::vector<std::uint8_t> bytes, Lms200Output& out);
  void set_baud(unsigned baud, Lms200Output& out);
  [[nodiscard]] Lms200Output finished(Lms200Output out) const;

  Lms200Params params_;
  SessionMode mode_;
  TelegramDecoder decoder_;
  LineDiagnosis diagnosis_{Device::kLaser};  // of the line since the laser was last heard
  DecoderCounts content_counts_;             // malformed and unknown, on top of the decoder's own
  std::uint32_t next_scan_number_ = 0;
  MonotonicTimes scan_times_;
  bool was_told_baud_ = false;  // a recording says it itself

  // What the laser said about itself.
  std::optional<std::uint8_t> known_mode_;
  std::optional<ScanVariant> known_variant_;
  std::optional<Configuration> known_configuration_;
  std::optional<Timestamp> first_scan_without_mode_;
  std::uint8_t scan_health_ = 0;  // of the newest scan

  State state_ = State::kIdle;
  std::vector<unsigned> bauds_;  // in the order of trying
  std::size_t attempt_ = 0;
  int tries_ = 0;          // of the present step
  int interruptions_ = 0;  // times that a scan came where silence was wanted, at this baud
  int writes_ = 0;         // of the configuration
  bool may_change_baud_ = true;
  bool may_change_variant_ = true;
  int naks_ = 0;  // of the present step
  bool repeats_after_nak_ = false;
  Timestamp deadline_;  // of the present step
  Timestamp search_began_;

  std::optional<Agreement> agreement_;  // of the last stream
  unsigned home_baud_;                  // where the laser should be found
  std::optional<Timestamp> check_at_;   // streaming again: when to ask again whether as agreed
  Timestamp last_scan_;
  Timestamp visit_end_;
  unsigned visits_ = 0;        // decides which baud is next
  bool is_detour_ = false;     // this visit is to 9600 and does not count
  int unanswered_ = 0;         // visits to a laser that speaks but does not tell its status
  bool it_speaks_ = false;     // a telegram came during this visit
  bool was_garbage_ = false;   // since the last scan or visit: bytes that make no telegram
  bool silence_told_ = false;  // in the log
};

}  // namespace deltamap::drivers::lms200
