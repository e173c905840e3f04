// SPDX-License-Identifier: Apache-2.0
#include "daemon/records/recording_decoder.hpp"

#include "daemon/records/journal.hpp"

namespace deltamap::daemon {

using drivers::SessionMode;
using drivers::port::PortId;

std::string session_note(PortId port) { return "session " + std::string(name_of(port)) + " begins"; }

RecordingDecoder::RecordingDecoder(const Settings& settings)
    : robot_{settings.robot.session, SessionMode::kListenOnly},
      laser_{settings.laser.session, SessionMode::kListenOnly} {}

void RecordingDecoder::feed(const drivers::port::ByteRecord& record, const Sinks& sinks) {
  const bool is_robot = record.port == PortId::kRobot;
  if (unsigned& baud = is_robot ? robot_baud_ : laser_baud_; record.baud != 0 && record.baud != baud) {
    baud = record.baud;
    is_robot ? robot_.on_baud(baud) : laser_.on_baud(baud);
  }
  if (record.note == session_note(record.port)) {
    is_robot ? (void)robot_.start(record.stamp) : (void)laser_.start(record.stamp);
  }
  if (record.note == kEarlierNote) is_earlier_ = true;
  if (record.note == kPartNote) is_earlier_ = false;
  if (record.bytes.empty() || record.direction == drivers::port::Direction::kOut) return;
  if (is_robot) {
    for (Odometry& odometry : robot_.on_bytes(record.bytes, record.stamp).odometry) {
      if (!is_earlier_) sinks.odometry(std::move(odometry), next_odometry_++);
    }
    return;
  }
  for (Scan& scan : laser_.on_bytes(record.bytes, record.stamp).scans) {
    if (is_earlier_) continue;
    scan.number = next_scan_++;
    sinks.scan(std::move(scan));
  }
}

std::map<std::string, std::uint64_t> RecordingDecoder::counts() const {
  std::map<std::string, std::uint64_t> all;
  add_counts(all, "robot", robot_.counts());
  add_counts(all, "laser", laser_.counts());
  return all;
}

void add_counts(std::map<std::string, std::uint64_t>& all, const std::string& device,
                const drivers::DecoderCounts& counts) {
  all[device + ".frames"] = counts.frames;
  all[device + ".garbage_bytes"] = counts.garbage_bytes;
  all[device + ".bad_length"] = counts.bad_length;
  all[device + ".bad_checksum"] = counts.bad_checksum;
  all[device + ".truncated"] = counts.truncated;
  all[device + ".malformed"] = counts.malformed;
  all[device + ".unknown"] = counts.unknown;
}

}  // namespace deltamap::daemon
