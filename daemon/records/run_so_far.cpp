// SPDX-License-Identifier: Apache-2.0
#include "daemon/records/run_so_far.hpp"

#include <algorithm>

#include "daemon/records/journal.hpp"
#include "daemon/records/recording_decoder.hpp"
#include "drivers/lms200/command.hpp"
#include "drivers/pioneer/config_packet.hpp"
#include "drivers/pioneer/extra_packets.hpp"

namespace deltamap::daemon {
namespace {

namespace response = drivers::lms200::response;
using drivers::port::ByteRecord;
using drivers::port::PortId;

/// A daemon asks a device anew in each session; what a device says of itself without being asked comes seldom.
constexpr std::size_t kMostFrames = 16;

template <typename Frames>
void keep_newest(Frames& frames, std::uint8_t type, std::vector<std::uint8_t> bytes) {
  std::erase_if(frames, [&](const auto& frame) { return frame.first == type; });
  if (frames.size() < kMostFrames) frames.emplace_back(type, std::move(bytes));
}

ByteRecord note_of(std::string_view note, Timestamp stamp) {
  ByteRecord record;
  record.stamp = stamp;
  record.note = note;
  return record;
}

}  // namespace

RunSoFar::RunSoFar(const drivers::port::FirstBauds& bauds)
    : bauds_{bauds.robot, bauds.laser},
      packets_{std::max(1u, bauds.robot)},
      telegrams_{drivers::lms200::Sender::kDevice, std::max(1u, bauds.laser)} {}

void RunSoFar::read(const ByteRecord& record) {
  if (!record.note.empty()) read_note(record);
  if (record.bytes.empty() || record.direction == drivers::port::Direction::kOut) return;
  record.port == PortId::kRobot ? hear_robot(record) : hear_laser(record);
}

void RunSoFar::read_note(const ByteRecord& record) {
  const auto port = static_cast<std::size_t>(record.port);
  if (const auto baud = drivers::port::baud_of_note(record.note)) {
    bauds_[port] = *baud;
    record.port == PortId::kRobot ? packets_.set_baud(*baud) : telegrams_.set_baud(*baud);
  }
  if (record.note == session_note(record.port)) said_[port].clear();
  if (const auto set = site_.read(record.note)) site_notes_ = notes_of(*set);
  const auto decision = decision_of_note(record.note);
  const bool is_pause =
      decision && (decision->kind == Decision::Kind::kPaused || decision->kind == Decision::Kind::kResumed);
  if (is_pause) pause_note_ = record.note;
}

/// Who the robot is comes first, and ends what was said in an earlier connection.
void RunSoFar::hear_robot(const ByteRecord& record) {
  Frames& said = said_[static_cast<std::size_t>(PortId::kRobot)];
  for (const drivers::pioneer::Packet& packet : packets_.decode(record.bytes, record.stamp)) {
    const std::uint8_t type = packet.type();
    if (type == drivers::pioneer::kSync2) said.clear();
    if (type == drivers::pioneer::kSync2 || type == drivers::pioneer::kConfigPacket)
      keep_newest(said, type, drivers::pioneer::encoded_packet(packet.data));
  }
}

void RunSoFar::hear_laser(const ByteRecord& record) {
  Frames& said = said_[static_cast<std::size_t>(PortId::kLaser)];
  for (const drivers::lms200::Telegram& telegram : telegrams_.decode(record.bytes, record.stamp)) {
    if (telegram.kind != drivers::lms200::Telegram::Kind::kTelegram || telegram.command == response::kScan) continue;
    if (telegram.command == response::kPowerOn) said.clear();
    keep_newest(said, telegram.command,
                drivers::lms200::encoded_reply(telegram.command, telegram.data, telegram.status, telegram.address));
  }
}

std::vector<ByteRecord> RunSoFar::beginning(const std::vector<std::string>& notes, Timestamp stamp) const {
  std::vector<ByteRecord> records;
  for (const std::string& note : notes) records.push_back(note_of(note, stamp));
  records.push_back(note_of(kEarlierNote, stamp));
  for (const PortId port : {PortId::kRobot, PortId::kLaser}) {
    for (const auto& [type, bytes] : said_[static_cast<std::size_t>(port)]) {
      ByteRecord record;
      record.port = port;
      record.stamp = stamp;
      record.bytes = bytes;
      records.push_back(std::move(record));
    }
  }
  records.push_back(note_of(kPartNote, stamp));
  for (const std::string& note : site_notes_) records.push_back(note_of(note, stamp));
  if (!pause_note_.empty()) records.push_back(note_of(pause_note_, stamp));
  return records;
}

}  // namespace deltamap::daemon
