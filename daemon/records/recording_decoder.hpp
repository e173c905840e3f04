// SPDX-License-Identifier: Apache-2.0
// From the records of a recording to odometry and scans: both sessions, listening only. Numbers scans and odometry as
// the live daemon does, so that its journal can be obeyed.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>

#include "core/messages.hpp"
#include "daemon/settings/settings.hpp"
#include "drivers/port/byte_record.hpp"

namespace deltamap::daemon {

/// The note before a session's first byte, so that a replay begins anew where the live session did.
[[nodiscard]] std::string session_note(drivers::port::PortId port);

class RecordingDecoder {
 public:
  explicit RecordingDecoder(const Settings& settings);

  /// Hands over what the record completes, in order of arrival. `odometry_number` counts from 0. Of what was said
  /// before the recorded part (kEarlierNote) nothing is handed over.
  struct Sinks {
    std::function<void(Odometry&& odometry, std::uint32_t odometry_number)> odometry;
    std::function<void(Scan&& scan)> scan;
  };
  void feed(const drivers::port::ByteRecord& record, const Sinks& sinks);

  /// Decoder counts by device and cause.
  [[nodiscard]] std::map<std::string, std::uint64_t> counts() const;

 private:
  drivers::pioneer::PioneerSession robot_;
  drivers::lms200::Lms200Session laser_;
  unsigned robot_baud_ = 0;  // line speed of the newest record: what a byte's time is reckoned by
  unsigned laser_baud_ = 0;
  bool is_earlier_ = false;  // what is fed was said before the recorded part of the run
  std::uint32_t next_odometry_ = 0;
  std::uint32_t next_scan_ = 0;
};

/// "robot.frames", "laser.bad_checksum", … for report.json.
void add_counts(std::map<std::string, std::uint64_t>& all, const std::string& device,
                const drivers::DecoderCounts& counts);

}  // namespace deltamap::daemon
