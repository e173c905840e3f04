// SPDX-License-Identifier: Apache-2.0
// A pcapng file block by block (draft-ietf-opsawg-pcapng 3.1): finds where each block begins and ends, whatever is in
// it. What is no pcapng file is named by what it is.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "drivers/port/pcapng_block.hpp"

namespace deltamap::drivers::port::pcapng {

class PcapngFile {
 public:
  /// Throws std::runtime_error with file and reason where it is missing, empty or foreign.
  explicit PcapngFile(std::filesystem::path file);

  /// Reads the next whole block and answers its type; nothing at the end. Throws Damage, and as refuse() does at a
  /// section that is not ours to read.
  [[nodiscard]] std::optional<std::uint32_t> next();
  /// Of the block that next() has read, without type and lengths.
  [[nodiscard]] std::span<const std::uint8_t> body() const { return body_; }
  /// Its first byte in the file; at the end of the file its size.
  [[nodiscard]] std::uint64_t block_at() const { return block_at_; }

  /// Throws std::runtime_error "FILE: byte N: why", N where the block begins.
  [[noreturn]] void refuse(const std::string& why) const;

  [[nodiscard]] const std::filesystem::path& path() const { return file_; }
  [[nodiscard]] std::uint64_t size_bytes() const { return size_bytes_; }
  [[nodiscard]] std::uint64_t read_bytes() const { return at_; }

 private:
  void require_pcapng();
  void require_little_endian(std::uint32_t order) const;
  /// Throws Damage where the file does not give so much.
  void read(std::span<std::uint8_t> into);

  std::filesystem::path file_;
  std::ifstream in_;
  std::uint64_t size_bytes_ = 0;
  std::uint64_t at_ = 0;        // of the block after the one in body_
  std::uint64_t block_at_ = 0;  // of the block in body_
  std::vector<std::uint8_t> body_;
};

}  // namespace deltamap::drivers::port::pcapng
