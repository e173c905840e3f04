// SPDX-License-Identifier: Apache-2.0
#include "tool/export/posed_scans.hpp"

#include <array>
#include <stdexcept>

#include "daemon/records/recording_decoder.hpp"
#include "drivers/port/replay_port.hpp"
#include "localization/motion/odometry_buffer.hpp"
#include "tool/progress.hpp"

namespace deltamap::tool {
namespace {

/// A decoder goes by the notes alone; what an importer writes has its baud in the file's header.
class BaudTeller {
 public:
  explicit BaudTeller(daemon::RecordingDecoder& decoder) : decoder_{decoder} {}

  void tell_before(const drivers::port::ByteRecord& record, const daemon::RecordingDecoder::Sinks& sinks) {
    unsigned& told = told_[static_cast<std::size_t>(record.port)];
    if (record.baud == 0 || told == record.baud) return;
    told = record.baud;
    drivers::port::ByteRecord note;
    note.port = record.port;
    note.stamp = record.stamp;
    note.note = drivers::port::baud_note(record.baud);
    decoder_.feed(note, sinks);
  }

 private:
  daemon::RecordingDecoder& decoder_;
  std::array<unsigned, 2> told_{};  // by PortId
};

}  // namespace

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
  BaudTeller bauds{decoder};
  Progress progress{"exporting", port.size_bytes()};
  while (const auto replayed = port.next()) {
    bauds.tell_before(replayed->record, decoded);
    decoder.feed(replayed->record, decoded);
    progress.show(port.read_bytes());
  }
  if (messages == 0) throw std::runtime_error(recording + ": holds neither scan nor odometry");
  return port.faults();
}

}  // namespace deltamap::tool
