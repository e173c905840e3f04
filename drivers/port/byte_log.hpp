// SPDX-License-Identifier: Apache-2.0
// Recordings: every byte of both ports and every scheduling decision, as pcapng (draft-ietf-opsawg-pcapng), which
// Wireshark, capinfos, editcap and mergecap read. Interface `robot` is LINKTYPE_USER0 (147), `laser` USER1 (148),
// stamps in nanoseconds, if_speed the first baud, direction in epb_flags; a note is the packet's comment, on a packet
// of no bytes where it stands alone. Blocks are only appended, so that whatever cuts the file leaves all blocks before
// the cut.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "drivers/port/byte_record.hpp"
#include "drivers/port/log_cut.hpp"

namespace deltamap::drivers::port {

struct FirstBauds {
  unsigned robot = 0;
  unsigned laser = 0;
};

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
  /// Flushes, syncs to the disk and closes. Throws as write() does.
  void close();

  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  [[nodiscard]] std::uint64_t size_bytes() const { return flushed_bytes_ + waiting_.size(); }

 private:
  [[noreturn]] void fail(const char* what, int reason);

  std::filesystem::path file_;
  int descriptor_ = -1;
  std::vector<std::uint8_t> waiting_;  // whole blocks
  std::uint64_t flushed_bytes_ = 0;
};

/// Reads a recording record by record, in constant memory. Blocks of kinds that are not ours are skipped, so that files
/// that other tools have cut, joined or commented are read as well.
class ByteLogReader {
 public:
  /// Throws std::runtime_error "FILE: byte N: why" where the file is missing, empty, foreign or ends inside its header.
  explicit ByteLogReader(std::filesystem::path file);

  /// The next record; nothing at the end, or at the first block after the header that is not whole (ask cut()). Throws
  /// std::runtime_error "FILE: byte N: why" where the header is not whole, and at a block of a foreign interface.
  [[nodiscard]] std::optional<ByteRecord> next();

  /// Where the file was cut: "FILE: byte N: cut short…", N the first byte of the block that is incomplete or damaged.
  /// Nothing while no cut has been met.
  [[nodiscard]] const std::optional<LogCut>& cut() const { return cut_; }

  [[nodiscard]] std::uint64_t size_bytes() const { return size_bytes_; }
  [[nodiscard]] std::uint64_t read_bytes() const { return at_; }

 private:
  struct Interface {
    std::optional<PortId> port;  // nothing: foreign
    unsigned baud = 0;
    std::int64_t ticks_per_s = 1'000'000;  // pcapng's default
    std::int64_t offset_s = 0;
  };
  /// A block that is incomplete or damaged: nothing after it can be found.
  struct Damage {
    std::string why;
  };
  [[noreturn]] void refuse(const std::string& why) const;
  /// Sections and both interfaces have been described.
  [[nodiscard]] bool header_is_whole() const { return met_[0] && met_[1]; }
  void end_at_cut(const std::string& why);
  /// Throws Damage.
  [[nodiscard]] std::optional<ByteRecord> next_record();
  /// Reads the next whole block into body_ and answers its type; nothing at the end. Throws Damage.
  [[nodiscard]] std::optional<std::uint32_t> next_block();
  [[nodiscard]] std::uint32_t read_block_head();
  void begin_section();
  [[nodiscard]] Interface read_interface() const;
  [[nodiscard]] ByteRecord read_packet();

  std::filesystem::path file_;
  std::ifstream in_;
  std::uint64_t size_bytes_ = 0;
  std::uint64_t at_ = 0;            // of the block after the one in body_
  std::uint64_t block_at_ = 0;      // of the block in body_
  std::vector<std::uint8_t> body_;  // without type and lengths
  std::vector<Interface> interfaces_;
  std::array<bool, 2> met_{};  // which of our interfaces, by PortId
  std::optional<Timestamp> first_record_;
  std::optional<Timestamp> last_record_;
  std::optional<LogCut> cut_;
};

}  // namespace deltamap::drivers::port
