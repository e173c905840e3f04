// SPDX-License-Identifier: Apache-2.0
#include "tool/info/recording_survey.hpp"

#include <cstdio>

#include "daemon/records/journal.hpp"
#include "daemon/records/recording_decoder.hpp"
#include "daemon/steps/run_begin.hpp"
#include "drivers/lms200/command.hpp"
#include "drivers/lms200/measurement.hpp"
#include "drivers/pioneer/status.hpp"
#include "drivers/port/passed_time.hpp"
#include "tool/decode/decoded_frame.hpp"
#include "tool/decode/frame_reader.hpp"

namespace deltamap::tool {
namespace {

namespace lms = drivers::lms200;
namespace pioneer = drivers::pioneer;
using drivers::port::ByteRecord;
using drivers::port::Direction;
using drivers::port::PortId;

std::string hex_byte(std::uint8_t byte) {
  char text[4];
  (void)std::snprintf(text, sizeof text, "%02X", byte);
  return text;
}

/// What the daemon has not looked at, for want of time.
const char* name_of_drop(daemon::Decision::Kind kind) {
  using Kind = daemon::Decision::Kind;
  switch (kind) {
    case Kind::kScanDropped:
      return "scans overtaken by newer ones";
    case Kind::kScanLost:
      return "scans";
    case Kind::kOdometryLost:
      return "odometry";
    case Kind::kTrackedLost:
      return "localized scans";
    case Kind::kSetLost:
      return "sets of scans";
    default:
      return nullptr;
  }
}

class Surveyor {
 public:
  explicit Surveyor(RecordingSurvey& survey)
      : survey_{survey},
        sinks_{[this](const pioneer::Packet& packet, const LineEnd& line) { take(packet, line); },
               [this](const lms::Telegram& telegram, const LineEnd& line) { take(telegram, line); },
               [](const drivers::DecoderCounts&, const LineEnd&) {}} {}

  void feed(const ByteRecord& record) {
    look_at_time(record.stamp);
    PortSurvey& port = port_of(record.port);
    ++survey_.records;
    if (record.baud > 0) port.bauds.tell(after_s_, std::to_string(record.baud));
    if (!record.note.empty()) read(record.note, record.port);
    if (!record.bytes.empty()) {
      TrafficSurvey& traffic = traffic_of({record.port, record.direction});
      ++traffic.chunks;
      traffic.bytes += record.bytes.size();
    }
    reader_.feed(record, sinks_);
  }

  void finish() {
    for (const PortId port : {PortId::kRobot, PortId::kLaser}) {
      for (const Direction direction : {Direction::kIn, Direction::kOut}) {
        traffic_of({port, direction}).counts = reader_.counts({port, direction});
      }
    }
  }

 private:
  PortSurvey& port_of(PortId port) { return survey_.ports[static_cast<std::size_t>(port)]; }
  TrafficSurvey& traffic_of(const LineEnd& line) {
    PortSurvey& port = port_of(line.port);
    return line.direction == Direction::kIn ? port.said : port.heard;
  }
  [[nodiscard]] double after_s(Timestamp time) const { return after_s_ + seconds(time - stamp_); }

  void look_at_time(Timestamp stamp) {
    stamp_ = stamp;
    after_s_ = passed_.after_s(stamp);
    if (passed_.set_back_s() > 0.0) survey_.set_back.push_back({after_s_, passed_.set_back_s()});
    if (!survey_.first) survey_.first = stamp;
    survey_.last = stamp;
    survey_.length_s = std::max(survey_.length_s, after_s_);
  }

  void read(const std::string& note, PortId port) {
    ++survey_.notes;
    if (daemon::run_of_note(note)) survey_.settings.clear();
    if (auto setting = daemon::setting_of_note(note)) survey_.settings.push_back(std::move(*setting));
    if (note == daemon::session_note(port)) port_of(port).sessions_s.push_back(after_s_);
    if (note == daemon::kGapNote) survey_.lost_s.push_back(after_s_);
    const auto decision = daemon::decision_of_note(note);
    const char* dropped = decision ? name_of_drop(decision->kind) : nullptr;
    if (dropped != nullptr) ++survey_.dropped[dropped];
  }

  void take(const pioneer::Packet& packet, const LineEnd& line) {
    ++traffic_of(line).frames[robot_frame(packet, line.direction).name];
    if (line.direction == Direction::kOut) return;
    if (pioneer::is_sip(packet.type())) port_of(PortId::kRobot).rhythm.add(after_s(packet.first_byte));
    if (auto identity = pioneer::decoded_identity(packet.data)) survey_.identity = std::move(identity);
    if (auto config = pioneer::decoded_config(packet.data)) survey_.config = std::move(config);
  }

  void take(const lms::Telegram& telegram, const LineEnd& line) {
    const bool is_acknowledgement = telegram.kind != lms::Telegram::Kind::kTelegram;
    const std::string name = !is_acknowledgement                          ? lms::telegram_name(telegram.command)
                             : telegram.kind == lms::Telegram::Kind::kAck ? "ACK"
                                                                          : "NAK";
    ++traffic_of(line).frames[name];
    if (line.direction == Direction::kIn && !is_acknowledgement) learn(telegram);
  }

  void learn(const lms::Telegram& telegram) {
    LaserSurvey& laser = survey_.laser;
    if (telegram.command == lms::response::kScan) port_of(PortId::kLaser).rhythm.add(after_s(telegram.first_byte));
    if (telegram.command == lms::response::kType || telegram.command == lms::response::kPowerOn) {
      laser.type.assign(telegram.data.begin(), telegram.data.end());
    }
    if (const auto status = lms::decoded_status(telegram)) {
      laser.status = status;
      laser.variants.tell(after_s_, lms::name_of({status->scan_angle_deg, status->resolution_centideg}));
      learn_format(status->measuring_mode, status->units == 0 ? "cm" : "mm");
    }
    if (const auto variant = lms::decoded_variant_reply(telegram)) {
      laser.variants.tell(after_s_, lms::name_of(variant->active));
    }
    if (const auto configuration = lms::decoded_configuration(telegram)) learn_format(*configuration);
    if (const auto written = lms::decoded_write_reply(telegram)) learn_format(written->active);
  }
  void learn_format(const lms::Configuration& configuration) {
    learn_format(configuration.measuring_mode(), configuration.units() == lms::Units::kCentimetre ? "cm" : "mm");
  }
  void learn_format(std::uint8_t measuring_mode, const char* units) {
    survey_.laser.measuring_modes.tell(after_s_, hex_byte(measuring_mode));
    survey_.laser.units.tell(after_s_, units);
  }

  RecordingSurvey& survey_;
  FrameReader reader_;
  FrameReader::Sinks sinks_;
  drivers::port::PassedTime passed_;
  Timestamp stamp_;       // of the newest record
  double after_s_ = 0.0;  // of the newest record
};

}  // namespace

std::vector<Silence> RecordingSurvey::common_silences() const {
  std::vector<Silence> common;
  for (const Silence& of_robot : robot_port().rhythm.silences()) {
    for (const Silence& of_laser : laser_port().rhythm.silences()) {
      const double begin_s = std::max(of_robot.after_s, of_laser.after_s);
      const double end_s = std::min(of_robot.after_s + of_robot.length_s, of_laser.after_s + of_laser.length_s);
      if (end_s - begin_s > 1.0) common.push_back({begin_s, end_s - begin_s});
    }
  }
  return common;
}

RecordingSurvey survey_of_recording(const std::filesystem::path& file,
                                    const std::function<void(std::uint64_t)>& progress) {
  RecordingSurvey survey;
  survey.file = file;
  drivers::port::ByteLogReader reader{file};
  survey.size_bytes = reader.size_bytes();
  Surveyor surveyor{survey};
  while (const auto record = reader.next()) {
    surveyor.feed(*record);
    progress(reader.read_bytes());
  }
  surveyor.finish();
  daemon::ReplayJob job;
  job.recording = file;
  survey.run = daemon::recorded_run(job);
  return survey;
}

}  // namespace deltamap::tool
