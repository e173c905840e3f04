// SPDX-License-Identifier: Apache-2.0
// Recordings: every byte of both ports and every scheduling decision, as pcapng (draft-ietf-opsawg-pcapng), which
// Wireshark, capinfos, editcap and mergecap read. Interface `robot` is LINKTYPE_USER0 (147), `laser` USER1 (148),
// stamps in nanoseconds, if_speed the first baud, direction in epb_flags; a note is the packet's comment, on a packet
// of no bytes where it stands alone. Blocks are only appended, so that whatever cuts the file leaves all blocks before
// the cut; each packet is sealed, so that what another program has done to it is seen.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "drivers/port/byte_record.hpp"
#include "drivers/port/log_audit.hpp"
#include "drivers/port/log_faults.hpp"
#include "drivers/port/packet_seal.hpp"
#include "drivers/port/pcapng_file.hpp"
#include "drivers/port/pcapng_packet.hpp"

namespace deltamap::drivers::port {

struct FirstBauds {
  unsigned robot = 0;
  unsigned laser = 0;
};

/// LINKTYPE_USER0 of the tcpdump.org registry; USER1 follows.
[[nodiscard]] constexpr std::uint16_t link_type_of(PortId port) { return port == PortId::kRobot ? 147 : 148; }

class ByteLogWriter {
 public:
  /// Begins a new file, replacing an old one of that name. Throws std::runtime_error naming the file and the reason.
  ByteLogWriter(std::filesystem::path file, const FirstBauds& bauds);
  /// Writes what is left, without telling whether it could: call close() where that matters.
  ~ByteLogWriter();
  ByteLogWriter(const ByteLogWriter&) = delete;
  ByteLogWriter& operator=(const ByteLogWriter&) = delete;

  /// Takes a record (its `baud` is not looked at; the stamp must not lie before 1970). Goes to the disk with flush(),
  /// or when enough has come together. Throws std::runtime_error naming file and reason where the disk is full or gone;
  /// the file then ends with the last whole block that fit, what did not fit is lost, and more may be written after it.
  void write(const ByteRecord& record);
  /// Hands everything to the kernel: a crash of this process loses nothing from before.
  void flush();
  /// Marks the end, flushes, syncs to the disk and closes. Throws as write() does.
  void close();

  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  [[nodiscard]] std::uint64_t size_bytes() const { return flushed_bytes_ + waiting_.size(); }

 private:
  [[noreturn]] void fail(const char* what, int reason);

  std::filesystem::path file_;
  int descriptor_ = -1;
  std::vector<std::uint8_t> waiting_;  // whole blocks
  std::uint64_t flushed_bytes_ = 0;
  std::uint32_t next_number_ = 0;
  Timestamp last_stamp_;
};

/// Reads a recording record by record, in constant memory. Blocks of kinds that are not ours and packets of other
/// interfaces are skipped, so that files that other programs have cut, joined or commented are read as well; faults()
/// tells what they did.
class ByteLogReader {
 public:
  /// Throws std::runtime_error "FILE: byte N: why" where the file is missing, empty, foreign or ends inside its header.
  explicit ByteLogReader(std::filesystem::path file);

  /// The next record; nothing at the end, or at the first block after the header that is not whole (ask faults()).
  /// Throws std::runtime_error "FILE: byte N: why" where the header is not whole.
  [[nodiscard]] std::optional<ByteRecord> next();

  /// Where the file was cut: "FILE: byte N: cut short…", N the first byte of the block that is incomplete or damaged.
  /// Nothing while no cut has been met.
  [[nodiscard]] const std::optional<LogCut>& cut() const { return cut_; }
  /// What has been found to be missing so far, the cut included.
  [[nodiscard]] LogFaults faults() const;

  [[nodiscard]] std::uint64_t size_bytes() const { return file_.size_bytes(); }
  [[nodiscard]] std::uint64_t read_bytes() const { return file_.read_bytes(); }

 private:
  struct Source {
    pcapng::Interface interface;
    std::optional<PortId> port;  // nothing: foreign
    bool has_begun = false;      // some packet of it was there
  };
  /// Sections and both interfaces have been described.
  [[nodiscard]] bool header_is_whole() const { return met_[0] && met_[1]; }
  void end_at_cut(const std::string& why);
  [[noreturn]] void refuse_without_ports();
  /// Reads blocks until some record waits; false at the end. Throws Damage.
  [[nodiscard]] bool read_on();
  void begin_section();
  void read_interface();
  void read_packet();
  void take_sealed(ByteRecord record, const std::vector<std::string_view>& comments, const PacketSeal& seal);
  void take_unsealed(ByteRecord record, const std::vector<std::string_view>& comments);
  void begin(Source& source, const std::optional<PacketSeal>& seal);
  void hand_over(ByteRecord record);

  pcapng::PcapngFile file_;
  std::vector<Source> sources_;      // of the section, by number
  std::string foreign_;              // the interfaces that are neither robot nor laser, for a refusal
  std::array<bool, 2> met_{};        // which of our interfaces, by PortId
  std::array<unsigned, 2> bauds_{};  // in force, by PortId
  std::deque<ByteRecord> waiting_;   // read and not yet handed over
  LogAudit audit_;
  bool at_end_ = false;
  std::optional<Timestamp> first_record_;
  std::optional<Timestamp> last_record_;
  std::optional<LogCut> cut_;
};

}  // namespace deltamap::drivers::port
