// SPDX-License-Identifier: Apache-2.0
#include "tool/export/posed_scans.hpp"

#include <stdexcept>

#include "daemon/records/recording_decoder.hpp"
#include "drivers/port/replay_port.hpp"
#include "localization/motion/odometry_buffer.hpp"
#include "tool/progress.hpp"

namespace deltamap::tool {
drivers::port::LogFaults read_posed_scans(const std::string& recording, const daemon::Settings& settings,
                                          const PosedScanSinks& sinks) {
  localization::motion::OdometryBuffer buffer{{}};
  std::uint64_t messages = 0;
  const auto pose_at = [&](Timestamp time) {
    const auto at = buffer.at(time);
    return at ? at->continuous_odom_from_robot : Pose2{};
  };
  const daemon::RecordingDecoder::Sinks decoded{[&](Odometry&& odometry, std::uint32_t) {
                                                  ++messages;
                                                  buffer.add(odometry);
                                                  sinks.odometry(odometry, pose_at(odometry.time));
                                                },
                                                [&](Scan&& scan) {
                                                  ++messages;
                                                  sinks.scan(scan, pose_at(scan.time));
                                                }};
  drivers::port::ReplayPort port{recording, {}};
  daemon::RecordingDecoder decoder{settings};
  Progress progress{"exporting", port.size_bytes()};
  while (const auto replayed = port.next()) {
    decoder.feed(replayed->record, decoded);
    progress.show(port.read_bytes());
  }
  if (messages == 0) throw std::runtime_error(recording + ": holds neither scan nor odometry");
  return port.faults();
}

}  // namespace deltamap::tool
