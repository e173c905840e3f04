// SPDX-License-Identifier: Apache-2.0
// The grammar of pcapng blocks that recordings use (draft-ietf-opsawg-pcapng, sections 3 and 4): numbers in
// little-endian, everything padded to 4 bytes, options as (code, length, value).
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace deltamap::drivers::port::pcapng {

constexpr std::uint32_t kSectionHeader = 0x0A0D0D0A;   // 4.1
constexpr std::uint32_t kByteOrderMagic = 0x1A2B3C4D;  // 4.1
constexpr std::uint32_t kSwappedByteOrderMagic = 0x4D3C2B1A;
constexpr std::uint32_t kInterfaceDescription = 1;     // 4.2
constexpr std::uint32_t kObsoletePacket = 2;           // appendix A
constexpr std::uint32_t kSimplePacket = 3;             // 4.4: without stamp and options
constexpr std::uint32_t kEnhancedPacket = 6;           // 4.3
constexpr std::uint16_t kOptionEnd = 0;                // 3.5
constexpr std::uint16_t kOptionComment = 1;            // 3.5
constexpr std::uint16_t kSectionUserApplication = 4;   // 4.1, table 3
constexpr std::string_view kOwnName = "deltamap";      // its value here
constexpr std::uint16_t kInterfaceName = 2;            // 4.2, table 4
constexpr std::uint16_t kInterfaceSpeed = 8;           // 4.2, table 4: 64 bits, bit/s
constexpr std::uint16_t kInterfaceTimeResolution = 9;  // 4.2, table 4: 10^-n s, or 2^-n s with the top bit
constexpr std::uint16_t kInterfaceTimeOffset = 14;     // 4.2, table 4: s
constexpr std::uint16_t kPacketFlags = 2;              // 4.3, table 6
constexpr std::uint16_t kPacketId = 5;                 // 4.3, table 6
constexpr std::uint32_t kFlagInbound = 1;              // 4.3.1, bits 0-1
constexpr std::uint32_t kFlagOutbound = 2;
constexpr std::uint32_t kFlagDirectionMask = 3;

/// A block that is incomplete or damaged: nothing after it can be found.
struct Damage {
  std::string why;
};

/// Builds one block at the end of a buffer.
class BlockWriter {
 public:
  BlockWriter(std::vector<std::uint8_t>& out, std::uint32_t type) : out_{out}, start_{out.size()} {
    number(type);
    number(std::uint32_t{0});  // the length, put in by finish()
  }
  template <typename T>
  void number(T value) {
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      out_.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8 * i)));
    }
  }
  void padded(std::span<const std::uint8_t> bytes) {
    out_.insert(out_.end(), bytes.begin(), bytes.end());
    while ((out_.size() - start_) % 4 != 0) out_.push_back(0);
  }
  void padded(std::string_view text) { padded({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}); }
  void option(std::uint16_t code, std::string_view text) {
    number(code);
    number(static_cast<std::uint16_t>(text.size()));
    padded(text);
  }
  template <typename T>
  void number_option(std::uint16_t code, T value) {
    number(code);
    number(static_cast<std::uint16_t>(sizeof(T)));
    number(value);
    padded(std::string_view{});
  }
  void finish() {
    const auto length = static_cast<std::uint32_t>(out_.size() - start_ + 4);
    number(length);
    for (std::size_t i = 0; i < 4; ++i) out_[start_ + 4 + i] = static_cast<std::uint8_t>(length >> (8 * i));
  }

 private:
  std::vector<std::uint8_t>& out_;
  std::size_t start_;
};

/// A number at an offset; 0 where the bytes end before it.
template <typename T>
[[nodiscard]] T number_at(std::span<const std::uint8_t> bytes, std::size_t offset) {
  if (offset + sizeof(T) > bytes.size()) return T{0};
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i) value |= static_cast<std::uint64_t>(bytes[offset + i]) << (8 * i);
  return static_cast<T>(value);
}

[[nodiscard]] constexpr std::size_t padded_size(std::size_t size) { return (size + 3) / 4 * 4; }

struct Option {
  std::uint16_t code;
  std::span<const std::uint8_t> value;
};

/// Takes one option off the front; nothing at opt_endofopt, at the end, or where an option runs over the end.
[[nodiscard]] inline std::optional<Option> take_option(std::span<const std::uint8_t>& options) {
  if (options.size() < 4) return std::nullopt;
  const auto code = number_at<std::uint16_t>(options, 0);
  const std::size_t length = number_at<std::uint16_t>(options, 2);
  if (code == kOptionEnd || 4 + padded_size(length) > options.size()) return std::nullopt;
  const Option option{code, options.subspan(4, length)};
  options = options.subspan(4 + padded_size(length));
  return option;
}

}  // namespace deltamap::drivers::port::pcapng
