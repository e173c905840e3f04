// SPDX-License-Identifier: Apache-2.0
#include "drivers/port/pcapng_packet.hpp"

namespace deltamap::drivers::port::pcapng {
namespace {

constexpr std::size_t kSectionHeaderBytes = 16;
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

}  // namespace

bool is_written_by_us(std::span<const std::uint8_t> body) {
  if (body.size() < kSectionHeaderBytes) return false;
  std::span<const std::uint8_t> options = body.subspan(kSectionHeaderBytes);
  while (const auto option = take_option(options)) {
    if (option->code == kSectionUserApplication && text_of(option->value) == kOwnName) return true;
  }
  return false;
}

Interface interface_in(std::span<const std::uint8_t> body) {
  if (body.size() < kInterfaceHeaderBytes) throw Damage{"an interface description is too short"};
  Interface interface;
  interface.link_type = number_at<std::uint16_t>(body, 0);
  std::span<const std::uint8_t> options = body.subspan(kInterfaceHeaderBytes);
  while (const auto option = take_option(options)) {
    const auto value = option->value;
    if (option->code == kInterfaceName) interface.name = text_of(value);
    if (option->code == kInterfaceSpeed) interface.baud = static_cast<unsigned>(number_at<std::uint64_t>(value, 0));
    if (option->code == kInterfaceTimeResolution && !value.empty()) interface.ticks_per_s = ticks_per_second(value[0]);
    if (option->code == kInterfaceTimeOffset) interface.offset_s = number_at<std::int64_t>(value, 0);
  }
  return interface;
}

Packet packet_in(std::span<const std::uint8_t> body) {
  if (body.size() < kPacketHeaderBytes) throw Damage{"a packet is too short"};
  const auto size = number_at<std::uint32_t>(body, 12);
  const auto whole_size = number_at<std::uint32_t>(body, 16);
  if (size > body.size() || kPacketHeaderBytes + padded_size(size) > body.size()) {
    throw Damage{"a packet is longer than its block"};
  }
  Packet packet;
  packet.interface = number_at<std::uint32_t>(body, 0);
  packet.ticks = (std::uint64_t{number_at<std::uint32_t>(body, 4)} << 32) | number_at<std::uint32_t>(body, 8);
  packet.bytes = body.subspan(kPacketHeaderBytes, size);
  packet.bytes_cut_off = whole_size > size ? whole_size - size : 0;
  std::span<const std::uint8_t> options = body.subspan(kPacketHeaderBytes + padded_size(size));
  while (const auto option = take_option(options)) {
    if (option->code == kOptionComment) packet.comments.push_back(text_of(option->value));
    if (option->code == kPacketId) packet.id = number_at<std::uint64_t>(option->value, 0);
    if (option->code == kPacketFlags) {
      const std::uint32_t direction = number_at<std::uint32_t>(option->value, 0) & kFlagDirectionMask;
      packet.went_out = direction == kFlagOutbound;
      packet.tells_direction = direction != 0;
    }
  }
  if (!options.empty() && number_at<std::uint16_t>(options, 0) != kOptionEnd) {
    throw Damage{"an option of a packet is longer than its block"};
  }
  return packet;
}

Timestamp stamp_of(const Packet& packet, const Interface& interface) {
  const auto per_s = static_cast<std::uint64_t>(interface.ticks_per_s);
  const std::int64_t whole_s = static_cast<std::int64_t>(packet.ticks / per_s) + interface.offset_s;
  if (whole_s < 0 || whole_s > 9'000'000'000) throw Damage{"a time stamp lies outside all time"};
  return timestamp_from_ns(whole_s * kNsPerSecond +
                           static_cast<std::int64_t>(packet.ticks % per_s * std::uint64_t{kNsPerSecond} / per_s));
}

}  // namespace deltamap::drivers::port::pcapng
