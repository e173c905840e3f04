// SPDX-License-Identifier: Apache-2.0
// Little-endian fields out of bytes, one behind the other, never past their end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace deltamap::tool {

/// What is read is not there: the bytes were cut, or are not what they are taken for.
struct OutOfBytes : std::runtime_error {
  OutOfBytes() : std::runtime_error("ends in the middle") {}
};

class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_{bytes} {}

  template <typename Number>
  Number number() {
    Number value{};
    const std::string_view field = raw(sizeof value);
    std::memcpy(&value, field.data(), sizeof value);  // Debian's machines that this runs on are little-endian
    return value;
  }
  std::string_view raw(std::size_t size) {
    if (size > bytes_.size()) throw OutOfBytes{};
    const std::string_view field = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    at_ += size;
    return field;
  }
  /// With its length before it.
  std::string_view text() { return raw(number<std::uint32_t>()); }
  /// To a multiple of `size` from the beginning.
  void align(std::size_t size) { (void)raw((size - at_ % size) % size); }

  [[nodiscard]] std::size_t at() const { return at_; }
  [[nodiscard]] std::size_t left() const { return bytes_.size(); }
  [[nodiscard]] bool is_at_end() const { return bytes_.empty(); }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
};

/// MessageFile::cut of a file of so many bytes.
[[nodiscard]] inline std::string cut_at(std::size_t byte, std::size_t bytes, const std::exception& why) {
  return "cut at byte " + std::to_string(byte) + " of " + std::to_string(bytes) + ": " + why.what();
}

}  // namespace deltamap::tool
