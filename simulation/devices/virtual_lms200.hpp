// SPDX-License-Identifier: Apache-2.0
// An LMS200 as its serial port shows it (protocols.md B): bytes and time in, bytes out. It knows no port and no world;
// what it measures it asks for, scan by scan. Its mirror turns all the time; a scan is sent where the line is free when
// it is complete, so the rate follows from the baud as in table B7.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/messages.hpp"
#include "drivers/lms200/configuration.hpp"
#include "drivers/lms200/telegram.hpp"
#include "drivers/lms200/value_selection.hpp"
#include "drivers/lms200/variant.hpp"
#include "simulation/devices/controller_faults.hpp"
#include "simulation/devices/serial_line.hpp"

namespace deltamap::simulation::devices {

struct Lms200Setup {
  unsigned baud = 9600;         ///< after power-on
  bool permanent_baud = false;  ///< keeps its baud over a power cycle (66h)
  drivers::lms200::ScanVariant variant{180, 50};
  bool has_fixed_variant = false;  ///< refuses every other, as an LMS Fast does
  drivers::lms200::Units units = drivers::lms200::Units::kCentimetre;
  std::uint8_t measuring_mode = 0x00;  ///< B4 byte 5
  double start_up_s = 3.0;             ///< of silence after power-on or reset, until 90h; the real one up to 60
  bool is_up = true;                   ///< has been switched on long ago
};

/// What a sweep of the mirror has to measure.
struct SweepRequest {
  Timestamp begin;  ///< of the first beam
  drivers::lms200::ScanVariant variant;
  double max_range_m = 0.0;            ///< the farthest that the measuring mode can tell
  double first_angle_shift_deg = 0.0;  ///< of all beams, counter-clockwise: a raster of an interlaced scan
};

class VirtualLms200 {
 public:
  VirtualLms200(const Lms200Setup& setup, Timestamp power_on, Random random);

  void receive(std::span<const std::uint8_t> bytes, unsigned host_baud, Timestamp now);

  /// Measures a sweep that has just ended: a beam for each value of the variant.
  using Measure = std::function<std::vector<Beam>(const SweepRequest&)>;

  /// Lets time pass: answers what is due, and sends the scans that are complete.
  void advance(Timestamp now, const Measure& measure);

  [[nodiscard]] std::vector<std::uint8_t> transmitted(Timestamp now, unsigned host_baud) {
    return line_.arrived(now, host_baud);
  }
  [[nodiscard]] std::optional<Timestamp> next_event() const;

  /// Off and on again: back to 9600 unless permanent, 90h when up; after as long as it was set up for, unless told.
  void cut_power(Timestamp now, std::optional<double> start_up_s = {});
  /// Neither hears nor speaks until then, as behind a loose contact. Its stream goes on afterwards, or has ended.
  void fall_silent(Timestamp now, Timestamp until, bool ends_stream);
  void nack_next_request() { ++naks_owed_; }                       ///< as a disturbed line would make it
  void set_status_byte(std::uint8_t status) { status_ = status; }  ///< of the scans, B6

  /// What changes in them happens now.
  void suffer(const LaserUnitFaults& faults, Timestamp now);
  void suffer(const LineFaults& faults);
  void set_witness(SerialLine::Witness witness) { line_.set_witness(std::move(witness)); }

  [[nodiscard]] bool is_streaming() const { return stream_.has_value(); }
  [[nodiscard]] unsigned baud() const { return line_.baud(); }
  [[nodiscard]] const drivers::lms200::Configuration& configuration() const { return configuration_; }
  [[nodiscard]] const drivers::lms200::ScanVariant& variant() const { return variant_; }
  [[nodiscard]] int configuration_writes() const { return configuration_writes_; }

 private:
  struct Answer {
    Timestamp at;
    std::vector<std::uint8_t> bytes;
    std::optional<unsigned> baud_after{};  // takes effect once the answer has left
    std::optional<drivers::lms200::ValueSelection> starts_stream{};
    bool restarts = false;  // reset: silence, then 90h
  };

  void take(const drivers::lms200::Telegram& telegram, Timestamp now);
  [[nodiscard]] Answer answer_to(const drivers::lms200::Telegram& telegram, Timestamp now);
  [[nodiscard]] Answer mode_answer(const drivers::lms200::Telegram& telegram, Timestamp now);
  [[nodiscard]] Answer stream_answer(const drivers::lms200::Telegram& telegram, Answer answer);
  [[nodiscard]] Answer variant_answer(const drivers::lms200::Telegram& telegram, Timestamp now);
  [[nodiscard]] Answer configuration_answer(const drivers::lms200::Telegram& telegram, Timestamp now);
  [[nodiscard]] std::vector<std::uint8_t> status_frame() const;
  void give(const Answer& answer);
  void begin_start_up(Timestamp now, double start_up_s);
  void set_baud(unsigned baud);
  void sweep(Timestamp end, const Measure& measure);
  void send_sweeps(const drivers::lms200::ValueSelection& selection, Timestamp end);
  [[nodiscard]] const drivers::lms200::ValueSelection& selection() const { return wanted_ ? *wanted_ : *stream_; }
  [[nodiscard]] bool can_send(const drivers::lms200::ValueSelection& selection) const;
  /// What one sweep of the present selection measures.
  [[nodiscard]] drivers::lms200::ScanVariant swept() const;
  [[nodiscard]] std::uint8_t raster(Timestamp end) const;
  /// When the next sweep will be complete: the first of a telegram finds the line free, the others follow it.
  [[nodiscard]] Timestamp next_sweep_end() const;

  Lms200Setup setup_;
  LaserUnitFaults faults_;
  Random random_;
  SerialLine line_;
  drivers::lms200::TelegramDecoder decoder_;
  drivers::lms200::Configuration configuration_;
  drivers::lms200::ScanVariant variant_;
  Timestamp mirror_start_;          // a turn begins here and every 13.32 ms
  std::optional<Timestamp> up_at_;  // still silent until then
  Timestamp silent_until_{};
  std::deque<Answer> answers_;
  std::optional<Timestamp> baud_change_at_;
  unsigned baud_after_ = 0;
  Timestamp last_host_byte_{};
  std::optional<Timestamp> last_sweep_end_;
  std::optional<drivers::lms200::ValueSelection> stream_;
  std::uint8_t stream_mode_ = 0;
  std::optional<drivers::lms200::ValueSelection> wanted_;  // once, by 30h, 36h, 37h or 3Fh
  std::vector<std::vector<Beam>> sweeps_;                  // of the telegram to come: the first of a mean
  bool installing_ = false;
  bool permanent_baud_ = false;
  int naks_owed_ = 0;
  int configuration_writes_ = 0;
  std::uint8_t status_ = drivers::lms200::kNormalStatus;
  std::uint8_t telegram_index_ = 0;
};

}  // namespace deltamap::simulation::devices
