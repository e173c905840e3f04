// SPDX-License-Identifier: Apache-2.0
#include "drivers/pioneer/packet.hpp"

#include <algorithm>
#include <cassert>

#include "drivers/checksums.hpp"

namespace deltamap::drivers::pioneer {
namespace {

constexpr std::uint8_t kHeader[] = {0xFA, 0xFB};
constexpr std::size_t kMinByteCount = 3;  // one data byte and the checksum
constexpr std::size_t kHeaderSize = 3;    // FA FB and the byte count

std::size_t frame_size_of(std::span<const std::uint8_t> bytes) { return bytes[2] + kHeaderSize; }

/// Index of the next FA FB, or of a last FA that may become one, or the size.
std::size_t next_header(std::span<const std::uint8_t> bytes) {
  const auto found = std::search(bytes.begin(), bytes.end(), std::begin(kHeader), std::end(kHeader));
  if (found != bytes.end()) return static_cast<std::size_t>(found - bytes.begin());
  const bool ends_with_half = !bytes.empty() && bytes.back() == kHeader[0];
  return bytes.size() - (ends_with_half ? 1 : 0);
}

}  // namespace

std::uint16_t checksum(std::span<const std::uint8_t> data) { return pioneer_checksum(data); }

std::vector<std::uint8_t> encoded_packet(std::span<const std::uint8_t> data) {
  assert(!data.empty() && data.size() <= kMaxData && "a packet holds 1 to 202 data bytes");
  const std::uint16_t sum = checksum(data);
  std::vector<std::uint8_t> frame;
  frame.reserve(data.size() + kFrameOverhead);
  frame.assign(std::begin(kHeader), std::end(kHeader));
  frame.push_back(static_cast<std::uint8_t>(data.size() + 2));
  frame.insert(frame.end(), data.begin(), data.end());
  frame.push_back(static_cast<std::uint8_t>(sum >> 8));
  frame.push_back(static_cast<std::uint8_t>(sum & 0xFF));
  return frame;
}

void PacketDecoder::set_baud(unsigned baud) {
  if (baud == baud_) return;
  if (!received_.bytes().empty()) ++counts_.truncated;
  received_.clear();
  baud_ = baud;
}

std::vector<Packet> PacketDecoder::decode(std::span<const std::uint8_t> bytes, Timestamp stamp) {
  std::vector<Packet> packets;
  if (bytes.empty()) return packets;
  if (!received_.bytes().empty() && stamp - received_.newest_stamp() > kLongestPauseInFrame) packets = finish();
  received_.append(bytes, stamp);
  take_frames(true, packets);
  return packets;
}

std::vector<Packet> PacketDecoder::finish() {
  std::vector<Packet> packets;
  take_frames(false, packets);
  return packets;
}

std::size_t PacketDecoder::awaited_bytes() const {
  const std::span<const std::uint8_t> bytes = received_.bytes();
  if (bytes.size() < kHeaderSize) return 0;
  const std::size_t frame_size = frame_size_of(bytes);
  return frame_size > bytes.size() ? frame_size - bytes.size() : 0;
}

void PacketDecoder::take_frames(bool more_may_come, std::vector<Packet>& packets) {
  const auto skip = [this](std::size_t count) {
    counts_.garbage_bytes += count;
    received_.drop_front(count);
  };
  while (true) {
    skip(next_header(received_.bytes()));
    const std::span<const std::uint8_t> bytes = received_.bytes();
    if (bytes.empty()) return;
    const bool has_length = bytes.size() >= kHeaderSize;
    if (has_length && (bytes[2] < kMinByteCount || bytes[2] > kMaxByteCount)) {
      ++counts_.bad_length;
      skip(1);
      continue;
    }
    const std::size_t frame_size = has_length ? frame_size_of(bytes) : 0;
    if (!has_length || bytes.size() < frame_size) {
      if (more_may_come) return;
      ++counts_.truncated;
      skip(1);
      continue;
    }
    const std::span<const std::uint8_t> data = bytes.subspan(kHeaderSize, frame_size - kFrameOverhead);
    const unsigned sent = static_cast<unsigned>(bytes[frame_size - 2]) << 8 | bytes[frame_size - 1];
    if (checksum(data) != sent) {
      ++counts_.bad_checksum;
      skip(1);
      continue;
    }
    ++counts_.frames;
    packets.push_back(
        {received_.arrival_of_first(0, baud_), received_.stamp_of(frame_size - 1), {data.begin(), data.end()}});
    received_.drop_front(frame_size);
  }
}

}  // namespace deltamap::drivers::pioneer
