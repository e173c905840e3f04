// SPDX-License-Identifier: Apache-2.0
// Little-endian fields, one after another, as both devices send them (protocols.md A1, B1). A reader that runs past
// the end says so once, at the end, instead of at each field.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace deltamap::drivers {

class FieldReader {
 public:
  explicit FieldReader(std::span<const std::uint8_t> bytes) : bytes_{bytes} {}

  [[nodiscard]] std::size_t left() const { return bytes_.size() - at_; }
  /// Every field so far was there.
  [[nodiscard]] bool is_good() const { return good_; }

  /// 0 past the end.
  std::uint8_t u8() {
    if (!has(1)) return 0;
    return bytes_[at_++];
  }
  std::uint16_t u16() {
    if (!has(2)) return 0;
    const unsigned value = bytes_[at_] | static_cast<unsigned>(bytes_[at_ + 1]) << 8;
    at_ += 2;
    return static_cast<std::uint16_t>(value);
  }
  std::int16_t s16() { return static_cast<std::int16_t>(u16()); }
  std::int32_t s32() {
    const std::uint32_t low = u16();
    const std::uint32_t high = u16();
    return static_cast<std::int32_t>(low | high << 16);
  }
  /// Up to a NUL, which is taken too. Without NUL the reader is no longer good.
  std::string zero_ended_text() {
    std::string text;
    while (has(1)) {
      const std::uint8_t character = bytes_[at_++];
      if (character == 0) return text;
      text.push_back(static_cast<char>(character));
    }
    return text;
  }
  std::string text(std::size_t size) {
    if (!has(size)) return {};
    const std::string answer(bytes_.begin() + static_cast<std::ptrdiff_t>(at_),
                             bytes_.begin() + static_cast<std::ptrdiff_t>(at_ + size));
    at_ += size;
    return answer;
  }
  void skip(std::size_t count) {
    if (has(count)) at_ += count;
  }

 private:
  bool has(std::size_t count) {
    good_ = good_ && left() >= count;
    return good_;
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool good_ = true;
};

class FieldWriter {
 public:
  FieldWriter& u8(unsigned value) {
    bytes_.push_back(static_cast<std::uint8_t>(value));
    return *this;
  }
  FieldWriter& u16(unsigned value) { return u8(value & 0xFF).u8(value >> 8 & 0xFF); }
  FieldWriter& s16(int value) { return u16(static_cast<unsigned>(value) & 0xFFFFu); }
  FieldWriter& s32(std::int32_t value) {
    const auto bits = static_cast<std::uint32_t>(value);
    return u16(bits & 0xFFFF).u16(bits >> 16);
  }
  FieldWriter& zero_ended_text(std::string_view text) { return this->text(text).u8(0); }
  FieldWriter& text(std::string_view text) {
    bytes_.insert(bytes_.end(), text.begin(), text.end());
    return *this;
  }
  FieldWriter& bytes(std::span<const std::uint8_t> more) {
    bytes_.insert(bytes_.end(), more.begin(), more.end());
    return *this;
  }

  [[nodiscard]] const std::vector<std::uint8_t>& written() const { return bytes_; }

 private:
  std::vector<std::uint8_t> bytes_;
};

}  // namespace deltamap::drivers
