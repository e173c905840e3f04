// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <unistd.h>

#include <cassert>
#include <cerrno>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "drivers/port/byte_log.hpp"
#include "drivers/port/pcapng_block.hpp"

namespace deltamap::drivers::port {
namespace {

static_assert(sizeof(off_t) == sizeof(std::int64_t), "a recording may grow beyond 2 GB");

constexpr std::size_t kFlushBytes = std::size_t{64} * 1024;
constexpr std::uint8_t kNanoseconds = 9;

void append_section(std::vector<std::uint8_t>& out) {
  pcapng::BlockWriter block{out, pcapng::kSectionHeader};
  block.number(pcapng::kByteOrderMagic);
  block.number(std::uint16_t{1});  // version 1.0
  block.number(std::uint16_t{0});
  block.number(~std::uint64_t{0});  // length of the section: not known, it grows
  block.option(pcapng::kSectionUserApplication, pcapng::kOwnName);
  block.option(pcapng::kOptionEnd, "");
  block.finish();
}

void append_interface(std::vector<std::uint8_t>& out, PortId port, unsigned baud) {
  pcapng::BlockWriter block{out, pcapng::kInterfaceDescription};
  block.number(link_type_of(port));
  block.number(std::uint16_t{0});
  block.number(std::uint32_t{0});  // no limit of a packet's length
  block.option(pcapng::kInterfaceName, name_of(port));
  block.number_option(pcapng::kInterfaceSpeed, static_cast<std::uint64_t>(baud));
  block.number_option(pcapng::kInterfaceTimeResolution, kNanoseconds);
  block.option(pcapng::kOptionEnd, "");
  block.finish();
}

void append_packet(std::vector<std::uint8_t>& out, const ByteRecord& record, std::uint32_t number) {
  assert(unix_ns(record.stamp) >= 0 && "a recording cannot tell times before 1970");
  assert(record.note.size() <= 0xFFFF && "a note must fit a pcapng option");
  const auto stamp_ns = static_cast<std::uint64_t>(unix_ns(record.stamp));
  const auto size = static_cast<std::uint32_t>(record.bytes.size());
  pcapng::BlockWriter block{out, pcapng::kEnhancedPacket};
  block.number(static_cast<std::uint32_t>(record.port));
  block.number(static_cast<std::uint32_t>(stamp_ns >> 32));
  block.number(static_cast<std::uint32_t>(stamp_ns));
  block.number(size);
  block.number(size);
  block.padded(record.bytes);
  if (!record.note.empty()) block.option(pcapng::kOptionComment, record.note);
  if (!record.bytes.empty()) {
    block.number_option(pcapng::kPacketFlags,
                        record.direction == Direction::kIn ? pcapng::kFlagInbound : pcapng::kFlagOutbound);
  }
  block.number_option(pcapng::kPacketId, packet_id({number, sealed_checksum(number, record, record.note)}));
  block.option(pcapng::kOptionEnd, "");
  block.finish();
}

}  // namespace

ByteLogWriter::ByteLogWriter(std::filesystem::path file, const FirstBauds& bauds) : file_{std::move(file)} {
  descriptor_ = ::open(file_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0644);
  if (descriptor_ < 0) fail("cannot be written", errno);
  waiting_.reserve(kFlushBytes + 4096);
  append_section(waiting_);
  append_interface(waiting_, PortId::kRobot, bauds.robot);
  append_interface(waiting_, PortId::kLaser, bauds.laser);
  try {
    flush();
  } catch (const std::runtime_error&) {
    ::close(descriptor_);
    throw;
  }
}

ByteLogWriter::~ByteLogWriter() {
  try {
    flush();
  } catch (const std::runtime_error&) {  // documented: nobody is left to be told
  }
  if (descriptor_ >= 0) ::close(descriptor_);
}

void ByteLogWriter::fail(const char* what, int reason) {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
  waiting_.clear();
  throw std::runtime_error(file_.string() + ": " + what + ": " + std::generic_category().message(reason));
}

void ByteLogWriter::write(const ByteRecord& record) {
  if (descriptor_ < 0) fail("cannot be written", EBADF);
  append_packet(waiting_, record, next_number_++);
  last_stamp_ = record.stamp;
  if (waiting_.size() >= kFlushBytes) flush();
}

void ByteLogWriter::flush() {
  if (descriptor_ < 0) return;
  std::size_t written = 0;
  while (written < waiting_.size()) {
    const ssize_t n = ::write(descriptor_, waiting_.data() + written, waiting_.size() - written);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) {
      const int reason = n < 0 ? errno : ENOSPC;
      std::size_t whole = 0;  // keep the blocks that fit, so that the file stays clean
      for (std::size_t next = 0; next <= written; next += pcapng::number_at<std::uint32_t>(waiting_, next + 4))
        whole = next;
      flushed_bytes_ += whole;
      waiting_.clear();
      (void)!::ftruncate(descriptor_, static_cast<off_t>(flushed_bytes_));
      throw std::runtime_error(file_.string() + ": cannot be written: " + std::generic_category().message(reason));
    }
    written += static_cast<std::size_t>(n);
  }
  flushed_bytes_ += written;
  waiting_.clear();
}

void ByteLogWriter::close() {
  if (descriptor_ < 0) fail("cannot be written", EBADF);
  if (next_number_ > 0) {
    ByteRecord end;
    end.stamp = last_stamp_;
    end.note = end_note(last_stamp_);
    write(end);
  }
  flush();
  if (::fsync(descriptor_) != 0 && errno != EINVAL) fail("cannot be synced", errno);  // EINVAL: a pipe or device
  const int closed = ::close(std::exchange(descriptor_, -1));
  if (closed != 0) fail("cannot be closed", errno);
}

}  // namespace deltamap::drivers::port
