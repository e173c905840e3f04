// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <ctime>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "drivers/port/byte_log.hpp"
#include "drivers/port/pcapng_block.hpp"

namespace deltamap::drivers::port {
namespace {

constexpr std::uint32_t kMaxBlockBytes = 16u << 20;  // a longer one is damage: ports hand over some kilobytes at once
constexpr std::size_t kPacketHeaderBytes = 20;
constexpr std::size_t kInterfaceHeaderBytes = 8;
constexpr std::int64_t kNsPerSecond = 1'000'000'000;

std::string_view text_of(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// if_tsresol: 10^-n, or 2^-n where the top bit is set. 0 where a Timestamp cannot hold it.
std::int64_t ticks_per_second(std::uint8_t resolution) {
  const int exponent = resolution & 0x7F;
  if ((resolution & 0x80) != 0) return exponent <= 30 ? std::int64_t{1} << exponent : 0;
  if (exponent > 9) return 0;
  std::int64_t ticks = 1;
  for (int i = 0; i < exponent; ++i) ticks *= 10;
  return ticks;
}

/// "2026-11-23T00:40:10.123Z"
std::string utc_text(Timestamp time) {
  const std::int64_t ms = unix_ns(time) / 1'000'000;
  const auto whole_s = static_cast<std::time_t>(ms / 1000);
  std::tm calendar{};
  (void)gmtime_r(&whole_s, &calendar);
  char day[32];
  char text[48];
  (void)std::strftime(day, sizeof day, "%Y-%m-%dT%H:%M:%S", &calendar);
  (void)std::snprintf(text, sizeof text, "%s.%03dZ", day, static_cast<int>(ms % 1000));
  return text;
}

}  // namespace

ByteLogReader::ByteLogReader(std::filesystem::path file) : file_{std::move(file)} {
  if (std::filesystem::is_directory(file_)) throw std::runtime_error(file_.string() + ": is a directory");
  in_.open(file_, std::ios::binary);
  if (!in_) throw std::runtime_error(file_.string() + ": " + std::generic_category().message(errno));
  in_.seekg(0, std::ios::end);
  size_bytes_ = static_cast<std::uint64_t>(in_.tellg());
  in_.seekg(0);
  if (size_bytes_ == 0) refuse("the file is empty");
  try {
    (void)next_block();
  } catch (const Damage& damage) {
    refuse("not a whole recording: " + damage.why);
  }
}

void ByteLogReader::refuse(const std::string& why) const {
  throw std::runtime_error(file_.string() + ": byte " + std::to_string(block_at_) + ": " + why);
}

void ByteLogReader::end_at_cut(const std::string& why) {
  LogCut cut{block_at_, size_bytes_ - block_at_, last_record_, {}};
  cut.text = file_.string() + ": byte " + std::to_string(cut.byte) + ": cut short, " + why + "; " +
             std::to_string(cut.unread_bytes) + " bytes are left out, ";
  if (last_record_) {
    char after[32];
    (void)std::snprintf(after, sizeof after, "%.3f", seconds(*last_record_ - *first_record_));
    cut.text += "the last whole record is of " + utc_text(*last_record_) + ", " + after + " s after the first";
  } else {
    cut.text += "no record is whole";
  }
  cut_ = std::move(cut);
}

std::uint32_t ByteLogReader::read_block_head() {
  const std::uint64_t left = size_bytes_ - at_;
  std::array<std::uint8_t, 12> head{};
  const auto head_size = static_cast<std::size_t>(std::min<std::uint64_t>(left, at_ == 0 ? 12 : 8));
  in_.read(reinterpret_cast<char*>(head.data()), static_cast<std::streamsize>(head_size));
  if (!in_) throw Damage{"the block cannot be read"};
  if (at_ == 0) {
    constexpr std::array<std::uint8_t, 4> kMagic{0x0A, 0x0D, 0x0D, 0x0A};
    const std::size_t seen = std::min<std::size_t>(head_size, kMagic.size());
    if (!std::equal(kMagic.begin(), kMagic.begin() + seen, head.begin())) refuse("not a recording (pcapng)");
    if (pcapng::number_at<std::uint32_t>(head, 8) == pcapng::kSwappedByteOrderMagic) {
      refuse("a big-endian recording is not supported");
    }
    in_.seekg(8);
  }
  if (left < 12) throw Damage{"a block needs at least 12 bytes, " + std::to_string(left) + " are left"};
  const auto length = pcapng::number_at<std::uint32_t>(head, 4);
  if (length < 12 || length % 4 != 0 || length > kMaxBlockBytes) {
    throw Damage{"a block cannot be " + std::to_string(length) + " bytes long"};
  }
  if (left < length) {
    throw Damage{"the block needs " + std::to_string(length) + " bytes, " + std::to_string(left) + " are left"};
  }
  body_.resize(length - 12);
  return pcapng::number_at<std::uint32_t>(head, 0);
}

std::optional<std::uint32_t> ByteLogReader::next_block() {
  if (at_ == size_bytes_) return std::nullopt;
  block_at_ = at_;
  const std::uint32_t type = read_block_head();
  std::array<std::uint8_t, 4> tail{};
  in_.read(reinterpret_cast<char*>(body_.data()), static_cast<std::streamsize>(body_.size()));
  in_.read(reinterpret_cast<char*>(tail.data()), 4);
  if (!in_) throw Damage{"the block cannot be read"};
  const std::size_t length = body_.size() + 12;
  if (pcapng::number_at<std::uint32_t>(tail, 0) != length) throw Damage{"the two lengths of a block differ"};
  at_ += length;
  if (type == pcapng::kSectionHeader) begin_section();
  return type;
}

void ByteLogReader::begin_section() {
  if (pcapng::number_at<std::uint32_t>(body_, 0) != pcapng::kByteOrderMagic)
    refuse("not a little-endian pcapng section");
  interfaces_.clear();  // numbers of interfaces count from 0 in each section
}

ByteLogReader::Interface ByteLogReader::read_interface() const {
  if (body_.size() < kInterfaceHeaderBytes) throw Damage{"an interface description is too short"};
  Interface interface;
  std::span<const std::uint8_t> options = std::span(body_).subspan(kInterfaceHeaderBytes);
  while (const auto option = pcapng::take_option(options)) {
    const auto value = option->value;
    if (option->code == pcapng::kInterfaceName) {
      for (const PortId port : {PortId::kRobot, PortId::kLaser}) {
        if (text_of(value) == name_of(port)) interface.port = port;
      }
    } else if (option->code == pcapng::kInterfaceSpeed) {
      interface.baud = static_cast<unsigned>(pcapng::number_at<std::uint64_t>(value, 0));
    } else if (option->code == pcapng::kInterfaceTimeResolution && !value.empty()) {
      interface.ticks_per_s = ticks_per_second(value[0]);
      if (interface.ticks_per_s == 0) refuse("stamps finer than a nanosecond are not supported");
    } else if (option->code == pcapng::kInterfaceTimeOffset) {
      interface.offset_s = pcapng::number_at<std::int64_t>(value, 0);
    }
  }
  return interface;
}

ByteRecord ByteLogReader::read_packet() {
  if (body_.size() < kPacketHeaderBytes) throw Damage{"a packet is too short"};
  const auto number = pcapng::number_at<std::uint32_t>(body_, 0);
  if (number >= interfaces_.size()) throw Damage{"a packet of an interface that was not described"};
  Interface& interface = interfaces_[number];
  if (!interface.port) refuse("not a recording: a packet of an interface that is neither robot nor laser");
  const auto size = pcapng::number_at<std::uint32_t>(body_, 12);
  if (size > body_.size() || kPacketHeaderBytes + pcapng::padded_size(size) > body_.size()) {
    throw Damage{"a packet is longer than its block"};
  }

  const std::uint64_t ticks =
      (std::uint64_t{pcapng::number_at<std::uint32_t>(body_, 4)} << 32) | pcapng::number_at<std::uint32_t>(body_, 8);
  const auto per_s = static_cast<std::uint64_t>(interface.ticks_per_s);
  const std::int64_t whole_s = static_cast<std::int64_t>(ticks / per_s) + interface.offset_s;
  if (whole_s < 0 || whole_s > 9'000'000'000) throw Damage{"a time stamp lies outside all time"};
  ByteRecord record;
  record.port = *interface.port;
  record.stamp = timestamp_from_ns(whole_s * kNsPerSecond +
                                   static_cast<std::int64_t>(ticks % per_s * std::uint64_t{kNsPerSecond} / per_s));
  const auto bytes = std::span(body_).subspan(kPacketHeaderBytes, size);
  record.bytes.assign(bytes.begin(), bytes.end());

  std::span<const std::uint8_t> options = std::span(body_).subspan(kPacketHeaderBytes + pcapng::padded_size(size));
  while (const auto option = pcapng::take_option(options)) {
    if (option->code == pcapng::kPacketFlags) {
      const auto flags = pcapng::number_at<std::uint32_t>(option->value, 0) & pcapng::kFlagDirectionMask;
      record.direction = flags == pcapng::kFlagOutbound ? Direction::kOut : Direction::kIn;
    } else if (option->code == pcapng::kOptionComment) {
      if (!record.note.empty()) record.note += '\n';
      record.note += text_of(option->value);
    }
  }
  if (const auto baud = baud_of_note(record.note)) interface.baud = *baud;
  record.baud = interface.baud;
  return record;
}

std::optional<ByteRecord> ByteLogReader::next_record() {
  while (const auto type = next_block()) {
    if (*type == pcapng::kInterfaceDescription) {
      interfaces_.push_back(read_interface());
      if (const auto port = interfaces_.back().port) met_[static_cast<std::size_t>(*port)] = true;
    } else if (*type == pcapng::kEnhancedPacket) {
      return read_packet();
    }
  }
  return std::nullopt;
}

std::optional<ByteRecord> ByteLogReader::next() {
  if (cut_) return std::nullopt;
  try {
    if (auto record = next_record()) {
      if (!first_record_) first_record_ = record->stamp;
      last_record_ = record->stamp;
      return record;
    }
  } catch (const Damage& damage) {
    if (!header_is_whole()) refuse("not a whole recording: " + damage.why);
    end_at_cut(damage.why);
    return std::nullopt;
  }
  for (const PortId port : {PortId::kRobot, PortId::kLaser}) {
    if (met_[static_cast<std::size_t>(port)]) continue;
    block_at_ = at_;
    refuse("not a recording: no interface is named " + std::string(name_of(port)));
  }
  return std::nullopt;
}

}  // namespace deltamap::drivers::port
