// SPDX-License-Identifier: Apache-2.0
// Framing of the LMS200 protocol, both directions (protocols.md B1, B2): STX 02, address, length, command and data,
// from the device a status byte, CRC. Between telegrams the device sends single ACK and NAK bytes.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/time.hpp"
#include "drivers/decoder_counts.hpp"
#include "drivers/received_bytes.hpp"

namespace deltamap::drivers::lms200 {

inline constexpr std::uint8_t kAckByte = 0x06;
inline constexpr std::uint8_t kNakByte = 0x15;
inline constexpr std::size_t kMaxLength = 808;       ///< largest length field: 401 values with indices
inline constexpr std::size_t kFrameOverhead = 6;     ///< STX, address, length, CRC
inline constexpr std::uint8_t kNormalStatus = 0x10;  ///< no fault, device type 6

// The status byte (B6).
inline constexpr std::uint8_t kSeverityBits = 0x07;  ///< 0 ok, 1 info, 2 warning, 3 error, 4 fatal
inline constexpr std::uint8_t kImplausibleBit = 0x40;
inline constexpr std::uint8_t kDirtyWindowBit = 0x80;

enum class Sender { kHost, kDevice };

struct Telegram {
  enum class Kind { kTelegram, kAck, kNak } kind = Kind::kTelegram;
  Timestamp first_byte;            ///< arrival of STX
  Timestamp received;              ///< stamp of the chunk with the last byte
  std::uint8_t address = 0;        ///< from the device with 80h added
  std::uint8_t command = 0;        ///< from the device the response: command + 80h
  std::vector<std::uint8_t> data;  ///< after the command, without status
  std::uint8_t status = 0;         ///< from the device only
};

/// Over everything from STX to the byte before the CRC (B2); it is sent low byte first.
[[nodiscard]] std::uint16_t crc16(std::span<const std::uint8_t> bytes);

/// The whole telegram of a host.
[[nodiscard]] std::vector<std::uint8_t> encoded_request(std::uint8_t command, std::span<const std::uint8_t> data,
                                                        std::uint8_t address = 0x00);
/// The whole telegram of a device, without the ACK before it.
[[nodiscard]] std::vector<std::uint8_t> encoded_reply(std::uint8_t response, std::span<const std::uint8_t> data,
                                                      std::uint8_t status = kNormalStatus, std::uint8_t address = 0x80);

/// Finds telegrams in a stream that may start anywhere and hold anything. After a telegram that turned out wrong the
/// search goes on at its second byte. ACK and NAK are read only where a telegram could start, not inside garbage.
class TelegramDecoder {
 public:
  TelegramDecoder(Sender sender, unsigned baud) : sender_{sender}, baud_{baud} {}

  /// A new line speed; what was half received at the old one is given up.
  void set_baud(unsigned baud);
  [[nodiscard]] unsigned baud() const { return baud_; }

  [[nodiscard]] std::vector<Telegram> decode(std::span<const std::uint8_t> bytes, Timestamp stamp);

  /// Nothing more comes: what is left is searched once more and counted.
  [[nodiscard]] std::vector<Telegram> finish();

  /// Bytes that are to come before the telegram at the front is whole; 0 where its length is not known.
  [[nodiscard]] std::size_t awaited_bytes() const;

  [[nodiscard]] const DecoderCounts& counts() const { return counts_; }

 private:
  enum class Header { kNo, kYes, kTooShortToTell };
  [[nodiscard]] Header header_at_front() const;
  [[nodiscard]] std::size_t length_at_front() const;
  [[nodiscard]] bool is_acknowledgement_at_front() const;
  void take_telegrams(bool more_may_come, std::vector<Telegram>& telegrams);
  void take_acknowledgement(std::vector<Telegram>& telegrams);
  void take_whole_telegram(std::size_t frame_size, std::vector<Telegram>& telegrams);
  void skip_byte();

  Sender sender_;
  unsigned baud_;
  ReceivedBytes received_;
  DecoderCounts counts_;
  bool in_garbage_ = false;  // the byte before was garbage: a 06 or 15 proves nothing
};

}  // namespace deltamap::drivers::lms200
