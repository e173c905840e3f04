// SPDX-License-Identifier: Apache-2.0
// What a recording that begins in mid-run must say first: the line speeds in force, what the devices have said about
// themselves at their start, that mapping is paused, and the bays and zones in force. Listens to every record of the
// run.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "daemon/records/site_note.hpp"
#include "drivers/lms200/telegram.hpp"
#include "drivers/pioneer/packet.hpp"
#include "drivers/port/byte_log.hpp"
#include "drivers/port/byte_record.hpp"

namespace deltamap::daemon {

class RunSoFar {
 public:
  explicit RunSoFar(const drivers::port::FirstBauds& bauds);

  void read(const drivers::port::ByteRecord& record);

  /// In force now.
  [[nodiscard]] drivers::port::FirstBauds bauds() const { return {bauds_[0], bauds_[1]}; }
  /// The newest of the operator's "mapping paused", "mapping resumed"; empty: none.
  [[nodiscard]] const std::string& pause_note() const { return pause_note_; }
  /// Of the newest bays and zones that the run has taken; empty: none.
  [[nodiscard]] const std::vector<std::string>& site_notes() const { return site_notes_; }
  /// What stands before the first record of the part: `notes` (part_notes()), then what was said before.
  [[nodiscard]] std::vector<drivers::port::ByteRecord> beginning(const std::vector<std::string>& notes,
                                                                 Timestamp stamp) const;

 private:
  void hear_robot(const drivers::port::ByteRecord& record);
  void hear_laser(const drivers::port::ByteRecord& record);
  void read_note(const drivers::port::ByteRecord& record);

  std::array<unsigned, 2> bauds_;  // by PortId
  drivers::pioneer::PacketDecoder packets_;
  drivers::lms200::TelegramDecoder telegrams_;
  using Frames = std::vector<std::pair<std::uint8_t, std::vector<std::uint8_t>>>;  // by type, the newest of each
  std::array<Frames, 2> said_;                                                     // by PortId
  std::string pause_note_;
  SetSiteReader site_;
  std::vector<std::string> site_notes_;
};

}  // namespace deltamap::daemon
