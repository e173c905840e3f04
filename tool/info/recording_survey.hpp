// SPDX-License-Identifier: Apache-2.0
// What a recording holds: the devices by what they say of themselves, what came and how regularly, what is missing, and
// the run that it was made by.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/replay/replay_start.hpp"
#include "drivers/decoder_counts.hpp"
#include "drivers/lms200/status.hpp"
#include "drivers/pioneer/config_packet.hpp"
#include "drivers/pioneer/extra_packets.hpp"
#include "drivers/port/byte_log.hpp"
#include "tool/info/rhythm.hpp"

namespace deltamap::tool {

/// What was told again and again, with the time of each change in seconds after the first record.
struct ToldValues {
  std::vector<std::pair<double, std::string>> changes;
  void tell(double after_s, const std::string& value) {
    if (changes.empty() || changes.back().second != value) changes.emplace_back(after_s, value);
  }
};

/// One direction of a port.
struct TrafficSurvey {
  std::uint64_t chunks = 0;
  std::uint64_t bytes = 0;
  std::map<std::string, std::uint64_t> frames;  ///< by name, acknowledgements too
  drivers::DecoderCounts counts;                ///< and what is no frame
};

struct PortSurvey {
  TrafficSurvey said;   ///< by the device
  TrafficSurvey heard;  ///< by the device
  ToldValues bauds;
  std::vector<double> sessions_s;  ///< begins of the daemon's sessions
  Rhythm rhythm;                   ///< of SIPs, of scans
};

struct LaserSurvey {
  std::string type;
  std::optional<drivers::lms200::DeviceStatus> status;
  ToldValues variants, units, measuring_modes;
};

struct RecordingSurvey {
  std::filesystem::path file;
  std::uint64_t size_bytes = 0;
  std::uint64_t records = 0;
  std::uint64_t notes = 0;
  std::optional<Timestamp> first, last;
  double length_s = 0.0;            ///< that has passed, by whatever clock
  std::array<PortSurvey, 2> ports;  ///< by PortId
  std::optional<drivers::pioneer::RobotIdentity> identity;
  std::optional<drivers::pioneer::ConfigPacket> config;
  LaserSurvey laser;
  std::vector<Silence> set_back;                              ///< of the clock: when, by how much
  std::vector<double> lost_s;                                 ///< where the daemon has noted that records are missing
  std::map<std::string, std::uint64_t> dropped;               ///< by the daemon, for want of time: what, how many
  std::vector<std::pair<std::string, std::string>> settings;  ///< not as delivered; of the newest run
  daemon::RecordedRun run;

  [[nodiscard]] const PortSurvey& robot_port() const { return ports[0]; }
  [[nodiscard]] const PortSurvey& laser_port() const { return ports[1]; }
  /// Silences of both devices at the same time: the recording stood still, or its clock was set forward.
  [[nodiscard]] std::vector<Silence> common_silences() const;
};

/// `progress` is told the bytes that are read. Throws std::runtime_error as ByteLogReader does.
[[nodiscard]] RecordingSurvey survey_of_recording(const std::filesystem::path& file,
                                                  const std::function<void(std::uint64_t)>& progress);

}  // namespace deltamap::tool
