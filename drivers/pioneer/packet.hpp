// SPDX-License-Identifier: Apache-2.0
// Framing of the ARCOS protocol, the same in both directions (protocols.md A1, A2): FA FB, byte count N, N - 2 data
// bytes with the command or type first, checksum high byte first.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/time.hpp"
#include "drivers/decoder_counts.hpp"
#include "drivers/received_bytes.hpp"

namespace deltamap::drivers::pioneer {

inline constexpr std::size_t kMaxByteCount = 204;           ///< N; longer packets are ignored (A1)
inline constexpr std::size_t kMaxData = kMaxByteCount - 2;  ///< data bytes, command or type included
inline constexpr std::size_t kFrameOverhead = 5;            ///< FA FB N and the checksum

/// A packet whose checksum was right.
struct Packet {
  Timestamp first_byte;            ///< arrival of FA
  Timestamp received;              ///< stamp of the chunk with the last byte
  std::vector<std::uint8_t> data;  ///< command or type first, without checksum; never empty

  [[nodiscard]] std::uint8_t type() const { return data.front(); }
  /// What follows the command or type byte.
  [[nodiscard]] std::span<const std::uint8_t> body() const { return std::span{data}.subspan(1); }
};

/// Sum of big-endian words modulo 65536; an odd last byte is XORed into the low byte (A2).
[[nodiscard]] std::uint16_t checksum(std::span<const std::uint8_t> data);

/// The frame for 1 to kMaxData data bytes.
[[nodiscard]] std::vector<std::uint8_t> encoded_packet(std::span<const std::uint8_t> data);

/// Finds packets in a stream that may start anywhere and hold anything. Garbage is counted by cause; after a packet
/// that turned out wrong the search goes on at its second byte.
class PacketDecoder {
 public:
  explicit PacketDecoder(unsigned baud) : baud_{baud} {}

  /// A new line speed; what was half received at the old one is given up.
  void set_baud(unsigned baud);
  [[nodiscard]] unsigned baud() const { return baud_; }

  [[nodiscard]] std::vector<Packet> decode(std::span<const std::uint8_t> bytes, Timestamp stamp);

  /// Nothing more comes: what is left is searched once more and counted.
  [[nodiscard]] std::vector<Packet> finish();

  /// Bytes that are to come before the packet at the front is whole; 0 where its length is not known.
  [[nodiscard]] std::size_t awaited_bytes() const;

  [[nodiscard]] const DecoderCounts& counts() const { return counts_; }

 private:
  void take_frames(bool more_may_come, std::vector<Packet>& packets);

  unsigned baud_;
  ReceivedBytes received_;
  DecoderCounts counts_;
};

}  // namespace deltamap::drivers::pioneer
