// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/virtual_lms200.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "drivers/lms200/command.hpp"
#include "drivers/lms200/measurement.hpp"
#include "drivers/lms200/status.hpp"
#include "simulation/devices/scan_telegram.hpp"

namespace deltamap::simulation::devices {
namespace {

namespace lms200 = drivers::lms200;
namespace command = lms200::command;
namespace mode = lms200::mode;

constexpr const char* kType = "LMS200;301063;V02.30 ";
constexpr unsigned kDefaultBaud = 9600;
constexpr std::uint32_t kHoursOfOperation = 1200;
constexpr std::uint16_t kSwitchOns = 300;
constexpr lms200::ScanVariant kPartialVariant{180, 100};  // one raster, whatever the variant (B6)
// How long the real device takes to answer (B3, measured there).
constexpr double kAcknowledgeDelay_s = 0.001;
constexpr double kAnswerDelay_s = 0.010;
constexpr double kModeDelay_s = 0.080;
constexpr double kVariantDelay_s = 0.060;
constexpr double kWriteDelay_s = 0.250;
/// A pause that long ends an unfinished telegram. The real limit is 6 ms (B1); an operating system that schedules the
/// host is given some more.
constexpr double kHostPause_s = 0.060;

std::uint8_t mode_of(const lms200::Telegram& telegram) { return telegram.data.empty() ? 0xFF : telegram.data.front(); }

}  // namespace

VirtualLms200::VirtualLms200(const Lms200Setup& setup, Timestamp power_on, Random random)
    : setup_{setup},
      random_{random},
      line_{setup.baud, random},
      decoder_{lms200::Sender::kHost, setup.baud},
      variant_{setup.variant},
      mirror_start_{power_on},
      permanent_baud_{setup.permanent_baud} {
  configuration_.set_units(setup.units);
  configuration_.set_measuring_mode(setup.measuring_mode);
  if (!setup.is_up) begin_start_up(power_on, setup.start_up_s);
}

void VirtualLms200::receive(std::span<const std::uint8_t> bytes, unsigned host_baud, Timestamp now) {
  if (up_at_ || now < silent_until_) return;
  if (now - last_host_byte_ > duration_from_seconds(kHostPause_s)) (void)decoder_.finish();
  last_host_byte_ = now;
  const auto damaged_before = decoder_.counts().bad_checksum;
  const auto heard = garbled(bytes, host_baud, line_.baud(), random_);
  const auto telegrams = decoder_.decode(heard, now);
  if (telegrams.empty() && decoder_.counts().bad_checksum > damaged_before) {
    line_.interrupt(now);
    line_.send(std::vector{lms200::kNakByte}, now + duration_from_seconds(kAcknowledgeDelay_s));
  }
  for (const lms200::Telegram& telegram : telegrams) {
    if (telegram.kind == lms200::Telegram::Kind::kTelegram && telegram.address == 0) take(telegram, now);
  }
}

void VirtualLms200::take(const lms200::Telegram& telegram, Timestamp now) {
  line_.interrupt(now);  // a request interrupts a running output (B1)
  const Timestamp acknowledged = now + duration_from_seconds(kAcknowledgeDelay_s);
  if (naks_owed_ > 0 || faults_.sends_naks) {
    naks_owed_ = std::max(0, naks_owed_ - 1);
    line_.send(std::vector{lms200::kNakByte}, acknowledged);
    return;
  }
  if (!faults_.sends_no_acks) line_.send(std::vector{lms200::kAckByte}, acknowledged);
  sweeps_.clear();
  const auto wanted = telegram.command != command::kSetMode ? lms200::requested_selection(telegram) : std::nullopt;
  if (wanted && can_send(*wanted)) {
    wanted_ = *wanted;  // what is measured next is the answer
    return;
  }
  answers_.push_back(answer_to(telegram, now));
}

VirtualLms200::Answer VirtualLms200::answer_to(const lms200::Telegram& telegram, Timestamp now) {
  const Timestamp soon = now + duration_from_seconds(kAnswerDelay_s);
  switch (telegram.command) {
    case command::kSetMode:
      return mode_answer(telegram, now);
    case command::kSetVariant:
      return variant_answer(telegram, now);
    case command::kReadConfiguration:
      return {soon, lms200::configuration_reply(configuration_), {}};
    case command::kWriteConfiguration:
      return configuration_answer(telegram, now);
    case command::kRequestStatus:
      return {soon, status_frame(), {}};
    case command::kRequestType:
      return {soon, lms200::type_reply(kType), {}};
    case command::kRequestErrors:
      return {soon, lms200::encoded_reply(lms200::response::kErrors, {}), {}};
    case command::kSetPermanentBaud:
      if (mode_of(telegram) > 1) break;
      permanent_baud_ = mode_of(telegram) == 1;
      return {soon, lms200::permanent_baud_reply(true, permanent_baud_), {}};
    case command::kRequestCounters:
      return {soon, lms200::counters_reply({kHoursOfOperation, kSwitchOns}), {}};
    case command::kReadConfiguration2:
      return {soon, lms200::configuration_2_reply(), {}};
    case command::kReset: {
      Answer answer{soon, lms200::encoded_reply(lms200::response::kReset, {}), {}};
      answer.restarts = true;
      return answer;
    }
    default:
      break;
  }
  return {soon, lms200::refused_reply(), {}};
}

VirtualLms200::Answer VirtualLms200::mode_answer(const lms200::Telegram& telegram, Timestamp now) {
  Answer answer{now + duration_from_seconds(kModeDelay_s), lms200::mode_reply(true), {}};
  const std::uint8_t wanted = mode_of(telegram);
  if (const auto baud = lms200::baud_of_mode(wanted)) {
    answer.baud_after = *baud;
    return answer;
  }
  switch (wanted) {
    case mode::kInstallation:
      if (!lms200::has_right_password(telegram)) {
        answer.bytes = lms200::mode_reply(false);
        return answer;
      }
      installing_ = true;
      stream_.reset();
      return answer;
    case mode::kTestPassword:
      answer.bytes = lms200::mode_reply(lms200::has_right_password(telegram));
      return answer;
    case mode::kDiagnostic:
    case mode::kOnRequest:
      installing_ = false;
      stream_.reset();
      return answer;
    default:
      return stream_answer(telegram, std::move(answer));
  }
}

VirtualLms200::Answer VirtualLms200::stream_answer(const lms200::Telegram& telegram, Answer answer) {
  const auto wanted = lms200::requested_selection(telegram);
  if (!wanted || !can_send(*wanted)) {
    answer.bytes = lms200::refused_reply();
    return answer;
  }
  installing_ = false;
  stream_mode_ = mode_of(telegram);
  answer.starts_stream = *wanted;
  return answer;
}

bool VirtualLms200::can_send(const lms200::ValueSelection& selection) const {
  return can_be_sent(selection, selection.is_partial() ? kPartialVariant.values() : variant_.values());
}

VirtualLms200::Answer VirtualLms200::variant_answer(const lms200::Telegram& telegram, Timestamp now) {
  const auto wanted = lms200::requested_variant(telegram);
  // Only an LMS Fast measures 90 degrees, and nothing else.
  const bool possible =
      wanted &&
      (wanted == variant_ || (!setup_.has_fixed_variant && wanted->angle_deg != 90 && lms200::is_possible(*wanted)));
  if (possible) variant_ = *wanted;
  return {now + duration_from_seconds(kVariantDelay_s), lms200::variant_reply(possible, variant_), {}};
}

VirtualLms200::Answer VirtualLms200::configuration_answer(const lms200::Telegram& telegram, Timestamp now) {
  if (!installing_) return {now + duration_from_seconds(kAnswerDelay_s), lms200::refused_reply(), {}};
  const auto written = lms200::configuration_with(telegram.data, configuration_);
  const bool accepted = written && lms200::range_coding(written->measuring_mode());
  if (accepted) {
    configuration_ = *written;
    ++configuration_writes_;
  }
  return {
      now + duration_from_seconds(kWriteDelay_s), lms200::configuration_written_reply(accepted, configuration_), {}};
}

std::vector<std::uint8_t> VirtualLms200::status_frame() const {
  lms200::DeviceStatus status;
  status.operating_mode = installing_ ? mode::kInstallation : stream_ ? stream_mode_ : mode::kOnRequest;
  status.measuring_mode = configuration_.measuring_mode();
  status.scan_angle_deg = variant_.angle_deg;
  status.resolution_centideg = variant_.resolution_centideg;
  status.baud_code = lms200::baud_code(line_.baud()).value_or(0);
  status.permanent_baud = permanent_baud_ ? 1 : 0;
  status.units = static_cast<std::uint8_t>(configuration_.units());
  return lms200::status_reply(status);
}

void VirtualLms200::advance(Timestamp now, const Measure& measure) {
  if (up_at_ && *up_at_ <= now) {
    line_.send(lms200::power_on_reply(kType), *up_at_);
    up_at_.reset();
  }
  for (;;) {
    const bool answer_due = !answers_.empty() && answers_.front().at <= now;
    if (baud_change_at_ && *baud_change_at_ <= now && !(answer_due && answers_.front().at < *baud_change_at_)) {
      set_baud(baud_after_);
      baud_change_at_.reset();
    }
    if (!answer_due) break;
    const Answer answer = answers_.front();
    answers_.pop_front();
    give(answer);
  }
  while ((stream_ || wanted_) && !up_at_ && next_sweep_end() <= now) sweep(next_sweep_end(), measure);
}

void VirtualLms200::give(const Answer& answer) {
  line_.send(answer.bytes, answer.at);
  if (answer.baud_after) {
    baud_change_at_ = line_.idle_at();
    baud_after_ = *answer.baud_after;
  }
  if (answer.starts_stream) {
    stream_ = answer.starts_stream;
    sweeps_.clear();
    last_sweep_end_.reset();
  }
  if (answer.restarts) cut_power(line_.idle_at());
}

void VirtualLms200::suffer(const LaserUnitFaults& faults, Timestamp now) {
  const LaserUnitFaults before = std::exchange(faults_, faults);
  if (faults.restarts != before.restarts) cut_power(now, faults.start_up_s);
}

void VirtualLms200::suffer(const LineFaults& faults) {
  const unsigned before = line_.baud();
  line_.suffer(faults);
  if (line_.baud() != before) decoder_.set_baud(line_.baud());
}

void VirtualLms200::cut_power(Timestamp now, std::optional<double> start_up_s) {
  line_.interrupt(now);
  begin_start_up(now, start_up_s.value_or(setup_.start_up_s));
}

void VirtualLms200::fall_silent(Timestamp now, Timestamp until, bool ends_stream) {
  line_.interrupt(now);
  answers_.clear();
  silent_until_ = until;
  sweeps_.clear();
  wanted_.reset();
  if (ends_stream) stream_.reset();
}

void VirtualLms200::begin_start_up(Timestamp now, double start_up_s) {
  up_at_ = now + duration_from_seconds(start_up_s);
  mirror_start_ = now;
  answers_.clear();
  baud_change_at_.reset();
  installing_ = false;
  stream_.reset();
  wanted_.reset();
  sweeps_.clear();
  variant_ = setup_.variant;
  last_sweep_end_.reset();
  if (!permanent_baud_) set_baud(kDefaultBaud);
}

void VirtualLms200::set_baud(unsigned baud) {
  line_.set_baud(baud);
  decoder_.set_baud(line_.baud());
}

lms200::ScanVariant VirtualLms200::swept() const { return selection().is_partial() ? kPartialVariant : variant_; }

/// The four rasters follow one another turn by turn.
std::uint8_t VirtualLms200::raster(Timestamp end) const {
  constexpr int kRasters = 4;
  const auto turns = (end - mirror_start_) / duration_from_seconds(lms200::kMirrorTurnS);
  return static_cast<std::uint8_t>((turns - 1) % kRasters);
}

Timestamp VirtualLms200::next_sweep_end() const {
  const Duration duration = duration_from_seconds(swept().scan_duration_s());
  if (!sweeps_.empty()) return *last_sweep_end_ + duration;
  // It must end when the line is free, must have begun after the last one ended, and sweeps begin where the mirror
  // passes its start.
  Timestamp free = std::max(line_.idle_at(), silent_until_);
  if (last_sweep_end_) free = std::max(free, *last_sweep_end_ + duration);
  if (!answers_.empty()) free = std::max(free, answers_.back().at + Duration{1});
  const auto sweeps = (std::max(free, mirror_start_ + duration) - mirror_start_ + duration - Duration{1}) / duration;
  return mirror_start_ + sweeps * duration;
}

void VirtualLms200::sweep(Timestamp end, const Measure& measure) {
  const lms200::ValueSelection selected = selection();
  const auto coding = lms200::range_coding(configuration_.measuring_mode());
  assert(coding && "a mode without ranges is never accepted");
  const double metres_per_word = configuration_.units() == lms200::Units::kMillimetre ? 0.001 : 0.01;
  constexpr double kRasterStep_deg = 0.25;
  const SweepRequest request{end - duration_from_seconds(swept().scan_duration_s()), swept(),
                             metres_per_word * (coding->beyond_maximum - 1),
                             selected.is_partial() ? kRasterStep_deg * raster(end) : 0.0};
  sweeps_.push_back(measure(request));
  assert(sweeps_.back().size() == swept().values() && "a beam for each value");
  last_sweep_end_ = end;
  if (sweeps_.size() == selected.mean_of) send_sweeps(selected, end);
}

void VirtualLms200::send_sweeps(const lms200::ValueSelection& selected, Timestamp end) {
  lms200::Measurement head;
  head.unit_code = configuration_.units() == lms200::Units::kMillimetre ? 1 : 0;
  head.status = faults_.status != 0 ? faults_.status : status_;
  head.is_partial = selected.is_partial();
  if (head.is_partial) head.partial_number = raster(end);
  if (configuration_.sends_real_time_indices()) {
    const auto turns = (end - mirror_start_) / duration_from_seconds(lms200::kMirrorTurnS);
    head.indices = lms200::Measurement::Indices{static_cast<std::uint8_t>(turns & 0xFF), telegram_index_};
  }
  ++telegram_index_;
  const auto coding = lms200::range_coding(configuration_.measuring_mode());
  line_.send(scan_telegram(selected, sweeps_, *coding, std::move(head)), end);
  sweeps_.clear();
  wanted_.reset();
}

std::optional<Timestamp> VirtualLms200::next_event() const {
  std::optional<Timestamp> next = line_.burst_whole_at();
  const auto consider = [&](Timestamp candidate) { next = next ? std::min(*next, candidate) : candidate; };
  if (up_at_) consider(*up_at_);
  if (!answers_.empty()) consider(answers_.front().at);
  if (baud_change_at_) consider(*baud_change_at_);
  if ((stream_ || wanted_) && !up_at_) consider(next_sweep_end());
  return next;
}

}  // namespace deltamap::simulation::devices
