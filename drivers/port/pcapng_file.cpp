// SPDX-License-Identifier: Apache-2.0
#include "drivers/port/pcapng_file.hpp"

#include <algorithm>
#include <cerrno>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

namespace deltamap::drivers::port::pcapng {
namespace {

constexpr std::uint32_t kMaxBlockBytes = 16u << 20;  // a longer one is damage: ports hand over some kilobytes at once
constexpr std::size_t kHeadBytes = 8;                // type and length
constexpr std::size_t kSmallestBlock = 12;

/// What else a file may be that somebody takes for a recording, by its first bytes.
struct ForeignKind {
  std::string_view magic;
  std::string_view advice;
};
constexpr std::string_view kPcapAdvice =
    "a capture in the older pcap format, which holds neither both ports nor notes; give the pcapng file it came from";
constexpr ForeignKind kForeignKinds[] = {
    {{"\x1F\x8B", 2}, "compressed with gzip; unpack it first: gunzip -k FILE"},
    {{"\x28\xB5\x2F\xFD", 4}, "compressed with Zstandard; unpack it first: unzstd FILE"},
    {{"\x04\x22\x4D\x18", 4}, "compressed with LZ4; unpack it first: unlz4 FILE"},
    {{"\xFD\x37\x7A\x58", 4}, "compressed with xz; unpack it first: unxz -k FILE"},
    {{"BZh", 3}, "compressed with bzip2; unpack it first: bunzip2 -k FILE"},
    {{"PK\x03\x04", 4}, "a zip archive; unpack it first: unzip FILE"},
    {{"\xD4\xC3\xB2\xA1", 4}, kPcapAdvice},
    {{"\xA1\xB2\xC3\xD4", 4}, kPcapAdvice},
    {{"\x4D\x3C\xB2\xA1", 4}, kPcapAdvice},
    {{"\xA1\xB2\x3C\x4D", 4}, kPcapAdvice},
};

}  // namespace

PcapngFile::PcapngFile(std::filesystem::path file) : file_{std::move(file)} {
  if (std::filesystem::is_directory(file_)) throw std::runtime_error(file_.string() + ": is a directory");
  in_.open(file_, std::ios::binary);
  if (!in_) throw std::runtime_error(file_.string() + ": " + std::generic_category().message(errno));
  in_.seekg(0, std::ios::end);
  size_bytes_ = static_cast<std::uint64_t>(in_.tellg());
  in_.seekg(0);
  if (size_bytes_ == 0) refuse("the file is empty");
  require_pcapng();
}

void PcapngFile::refuse(const std::string& why) const {
  throw std::runtime_error(file_.string() + ": byte " + std::to_string(block_at_) + ": " + why);
}

void PcapngFile::require_pcapng() {
  std::array<char, 4> start{};
  const auto size = static_cast<std::size_t>(std::min<std::uint64_t>(size_bytes_, start.size()));
  in_.read(start.data(), static_cast<std::streamsize>(size));
  in_.seekg(0);
  const std::string_view seen{start.data(), size};
  for (const ForeignKind& kind : kForeignKinds) {
    if (!seen.starts_with(kind.magic)) continue;
    std::string advice{kind.advice};
    if (const auto at = advice.find("FILE"); at != std::string::npos) advice.replace(at, 4, file_.string());
    refuse("not a recording (pcapng): " + advice);
  }
  constexpr std::string_view kMagic{"\x0A\x0D\x0D\x0A", 4};
  if (!kMagic.starts_with(seen)) refuse("not a recording (pcapng)");
}

void PcapngFile::read(std::span<std::uint8_t> into) {
  in_.read(reinterpret_cast<char*>(into.data()), static_cast<std::streamsize>(into.size()));
  if (!in_) throw Damage{"the block cannot be read"};
}

std::optional<std::uint32_t> PcapngFile::next() {
  block_at_ = at_;
  if (at_ == size_bytes_) return std::nullopt;
  const std::uint64_t left = size_bytes_ - at_;
  if (left < kSmallestBlock) throw Damage{"a block needs at least 12 bytes, " + std::to_string(left) + " are left"};
  std::array<std::uint8_t, kSmallestBlock> head{};
  std::size_t held = kHeadBytes;
  read(std::span(head).first(held));
  const auto type = number_at<std::uint32_t>(head, 0);
  if (type == kSectionHeader) {  // it tells its byte order behind the length
    read(std::span(head).subspan(held));
    held = head.size();
    require_little_endian(number_at<std::uint32_t>(head, kHeadBytes));
  }
  const auto length = number_at<std::uint32_t>(head, 4);
  if (length < held + 4 || length % 4 != 0 || length > kMaxBlockBytes) {
    throw Damage{"a block cannot be " + std::to_string(length) + " bytes long"};
  }
  if (left < length) {
    throw Damage{"the block needs " + std::to_string(length) + " bytes, " + std::to_string(left) + " are left"};
  }
  body_.resize(length - kSmallestBlock);
  std::copy(head.begin() + kHeadBytes, head.begin() + static_cast<std::ptrdiff_t>(held), body_.begin());
  read(std::span(body_).subspan(held - kHeadBytes));
  std::array<std::uint8_t, 4> tail{};
  read(tail);
  if (number_at<std::uint32_t>(tail, 0) != length) throw Damage{"the two lengths of a block differ"};
  at_ += length;
  return type;
}

void PcapngFile::require_little_endian(std::uint32_t order) const {
  if (order == kByteOrderMagic) return;
  refuse(order == kSwappedByteOrderMagic
             ? "a big-endian recording is not supported; write it anew on a little-endian computer: editcap FILE NEW"
             : "not a little-endian pcapng section");
}

}  // namespace deltamap::drivers::port::pcapng
