// SPDX-License-Identifier: Apache-2.0
// What targets of libFuzzer make of their bytes: a file without a disk, chunks with the time that passes between them.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "core/time.hpp"

namespace deltamap::fuzz {

/// The bytes as a file that is read by its name.
class MemoryFile {
 public:
  explicit MemoryFile(std::span<const std::uint8_t> bytes) : descriptor_{::memfd_create("fuzz", 0)} {
    if (descriptor_ < 0 || ::write(descriptor_, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size()))
      throw std::runtime_error("no memory file");
  }
  ~MemoryFile() { ::close(descriptor_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  [[nodiscard]] std::filesystem::path path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }

 private:
  int descriptor_;
};

inline std::string_view text_of(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Calls chunk(bytes, now) again and again. A byte before each chunk says how long it is, and the next how much later
/// it comes.
template <typename Chunk>
void in_chunks(std::span<const std::uint8_t> bytes, const Chunk& chunk) {
  constexpr std::int64_t kTick_ns = 7'000'000;
  Timestamp now = timestamp_from_ns(1'700'000'000'000'000'000);
  while (bytes.size() > 2) {
    const std::size_t size = std::min<std::size_t>(bytes[0] + 1u, bytes.size() - 2);
    now += Duration{kTick_ns * (bytes[1] + 1)};
    chunk(bytes.subspan(2, size), now);
    bytes = bytes.subspan(2 + size);
  }
}

}  // namespace deltamap::fuzz
