// SPDX-License-Identifier: Apache-2.0
// A recording as other programs leave it, byte for byte as they write: remarks on packets, packets cut by a snap
// length, taken out, doubled, shifted in time, interfaces renumbered. Each function answers the edited file.
#pragma once

#include <cstdint>
#include <cstring>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace deltamap::test {

template <typename Number>
std::string little_endian(Number value) {
  std::string bytes;
  for (std::size_t i = 0; i < sizeof value; ++i) {
    bytes += static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i) & 0xFF);
  }
  return bytes;
}

template <typename Number>
Number number_in(const std::string& bytes, std::size_t at) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < sizeof(Number); ++i) {
    value |= std::uint64_t{static_cast<unsigned char>(bytes.at(at + i))} << (8 * i);
  }
  return static_cast<Number>(value);
}

inline std::string padded_to_4(std::string bytes) {
  bytes.resize((bytes.size() + 3) / 4 * 4, '\0');
  return bytes;
}

/// A block of a pcapng file.
struct CaptureBlock {
  std::uint32_t type = 0;
  std::string body;

  [[nodiscard]] std::string bytes() const {
    const auto length = little_endian(static_cast<std::uint32_t>(body.size() + 12));
    return little_endian(type) + length + body + length;
  }
};

using CaptureOption = std::pair<std::uint16_t, std::string>;

inline std::vector<CaptureOption> options_in(const std::string& bytes) {
  std::vector<CaptureOption> options;
  for (std::size_t at = 0; at + 4 <= bytes.size();) {
    const auto code = number_in<std::uint16_t>(bytes, at);
    const auto size = number_in<std::uint16_t>(bytes, at + 2);
    if (code == 0) break;
    options.emplace_back(code, bytes.substr(at + 4, size));
    at += 4 + (size + 3u) / 4 * 4;
  }
  return options;
}

inline std::string bytes_of_options(const std::vector<CaptureOption>& options) {
  std::string bytes;
  for (const auto& [code, value] : options) {
    bytes += little_endian(code) + little_endian(static_cast<std::uint16_t>(value.size())) + padded_to_4(value);
  }
  return options.empty() ? bytes : bytes + std::string(4, '\0');
}

/// An enhanced packet block.
struct CapturePacket {
  static constexpr std::uint32_t kType = 6;
  static constexpr std::uint16_t kComment = 1;
  static constexpr std::uint16_t kId = 5;

  std::uint32_t interface = 0;
  std::uint64_t ticks = 0;
  std::string bytes;
  std::uint32_t original_size = 0;
  std::vector<CaptureOption> options;

  [[nodiscard]] std::string comment() const {
    for (const auto& [code, value] : options) {
      if (code == kComment) return value;
    }
    return {};
  }
};

inline CapturePacket packet_of(const CaptureBlock& block) {
  CapturePacket packet;
  packet.interface = number_in<std::uint32_t>(block.body, 0);
  packet.ticks = std::uint64_t{number_in<std::uint32_t>(block.body, 4)} << 32 | number_in<std::uint32_t>(block.body, 8);
  const auto size = number_in<std::uint32_t>(block.body, 12);
  packet.original_size = number_in<std::uint32_t>(block.body, 16);
  packet.bytes = block.body.substr(20, size);
  packet.options = options_in(block.body.substr(20 + (size + 3) / 4 * 4));
  return packet;
}

inline CaptureBlock block_of(const CapturePacket& packet) {
  return {CapturePacket::kType,
          little_endian(packet.interface) + little_endian(static_cast<std::uint32_t>(packet.ticks >> 32)) +
              little_endian(static_cast<std::uint32_t>(packet.ticks)) +
              little_endian(static_cast<std::uint32_t>(packet.bytes.size())) + little_endian(packet.original_size) +
              padded_to_4(packet.bytes) + bytes_of_options(packet.options)};
}

inline std::vector<CaptureBlock> blocks_of(const std::string& file) {
  std::vector<CaptureBlock> blocks;
  for (std::size_t at = 0; at + 12 <= file.size();) {
    const auto length = number_in<std::uint32_t>(file, at + 4);
    blocks.push_back({number_in<std::uint32_t>(file, at), file.substr(at + 8, length - 12)});
    at += length;
  }
  return blocks;
}

inline std::string file_of(const std::vector<CaptureBlock>& blocks) {
  std::string file;
  for (const CaptureBlock& block : blocks) file += block.bytes();
  return file;
}

/// Each packet by its number from 1, as editcap counts; `edit` answers whether it stays.
inline std::string with_packets_edited(const std::string& file,
                                       const std::function<bool(std::size_t number, CapturePacket&)>& edit) {
  std::vector<CaptureBlock> edited;
  std::size_t number = 0;
  for (const CaptureBlock& block : blocks_of(file)) {
    if (block.type != CapturePacket::kType) {
      edited.push_back(block);
      continue;
    }
    CapturePacket packet = packet_of(block);
    if (edit(++number, packet)) edited.push_back(block_of(packet));
  }
  return file_of(edited);
}

inline std::size_t packets_in(const std::string& file) {
  std::size_t count = 0;
  for (const CaptureBlock& block : blocks_of(file)) count += block.type == CapturePacket::kType ? 1 : 0;
  return count;
}

/// editcap -a: one comment more, behind all options.
inline std::string with_remark(const std::string& file, const std::function<bool(const CapturePacket&)>& where,
                               const std::string& text) {
  return with_packets_edited(file, [&](std::size_t, CapturePacket& packet) {
    if (where(packet)) packet.options.emplace_back(CapturePacket::kComment, text);
    return true;
  });
}

/// Programs that know one comment a packet: a person writes into the one that is there.
inline std::string with_comments_rewritten(const std::string& file,
                                           const std::function<std::string(const std::string&)>& text) {
  return with_packets_edited(file, [&](std::size_t, CapturePacket& packet) {
    for (auto& [code, value] : packet.options) {
      if (code == CapturePacket::kComment) value = text(value);
    }
    return true;
  });
}

/// editcap -s: the beginning of each packet; its length stays told.
inline std::string with_snap_length(const std::string& file, std::size_t kept) {
  return with_packets_edited(file, [&](std::size_t, CapturePacket& packet) {
    packet.bytes.resize(std::min(packet.bytes.size(), kept));
    return true;
  });
}

/// editcap -C N -L: the ends of packets, as if they had never been there.
inline std::string with_ends_chopped(const std::string& file, std::size_t chopped) {
  return with_packets_edited(file, [&](std::size_t, CapturePacket& packet) {
    packet.bytes.resize(packet.bytes.size() - std::min(packet.bytes.size(), chopped));
    packet.original_size = static_cast<std::uint32_t>(packet.bytes.size());
    return true;
  });
}

/// editcap FIRST-LAST.
inline std::string without_packets(const std::string& file, std::size_t first, std::size_t last) {
  return with_packets_edited(file, [&](std::size_t number, CapturePacket&) { return number < first || number > last; });
}

/// Programs that do not know the option, such as Wireshark before 3.6, and what was recorded before packets were
/// sealed.
inline std::string without_option(const std::string& file, std::uint16_t code) {
  return with_packets_edited(file, [&](std::size_t, CapturePacket& packet) {
    std::erase_if(packet.options, [&](const CaptureOption& option) { return option.first == code; });
    return true;
  });
}

/// Programs that write their own name into the section header.
inline std::string with_writer(const std::string& file, const std::string& name) {
  constexpr std::size_t kFixedBytes = 16;
  constexpr std::uint16_t kWriter = 4;
  std::vector<CaptureBlock> blocks = blocks_of(file);
  blocks.at(0).body = blocks[0].body.substr(0, kFixedBytes) + bytes_of_options({{kWriter, name}});
  return file_of(blocks);
}

/// editcap -t.
inline std::string shifted_in_time(const std::string& file, std::int64_t ns) {
  return with_packets_edited(file, [&](std::size_t, CapturePacket& packet) {
    packet.ticks += static_cast<std::uint64_t>(ns);
    return true;
  });
}

inline CaptureBlock interface_block(const std::string& name, std::uint16_t link_type) {
  return {1, little_endian(link_type) + little_endian(std::uint16_t{0}) + little_endian(std::uint32_t{0}) +
                 bytes_of_options({{2, name}})};
}

/// mergecap with a capture of another interface named first: ours move up by one, and its packets stand among ours.
inline std::string merged_behind_foreign(const std::string& file, std::size_t every) {
  std::vector<CaptureBlock> merged;
  std::size_t number = 0;
  bool has_foreign = false;
  for (const CaptureBlock& block : blocks_of(file)) {
    if (block.type == 1 && !std::exchange(has_foreign, true)) merged.push_back(interface_block("eth0", 1));
    if (block.type != CapturePacket::kType) {
      merged.push_back(block);
      continue;
    }
    CapturePacket packet = packet_of(block);
    if (++number % every == 0) {
      merged.push_back(block_of({0, 1'700'000'000'000'000u, std::string(60, 'e'), 60, {{1, "a remark"}}}));
    }
    ++packet.interface;
    merged.push_back(block_of(packet));
  }
  return file_of(merged);
}

/// What programs add that carries no packet: names of computers, statistics, secrets, blocks of their own.
inline std::string with_other_blocks(const std::string& file) {
  constexpr std::uint32_t kNames = 4, kStatistics = 5, kSecrets = 10, kOwn = 0xBAD, kOwnNotCopied = 0x40000BAD;
  std::vector<CaptureBlock> blocks = blocks_of(file);
  const auto behind_interfaces = blocks.begin() + 3;
  blocks.insert(behind_interfaces, {{kNames, std::string(4, '\0')},
                                    {kSecrets, little_endian(std::uint32_t{0x544C534B}) + std::string(4, '\0')},
                                    {kOwn, little_endian(std::uint32_t{32473}) + "data"},
                                    {kOwnNotCopied, little_endian(std::uint32_t{32473})}});
  for (std::uint32_t interface : {0u, 1u}) {
    blocks.push_back({kStatistics, little_endian(interface) + std::string(8, '\0')});
  }
  return file_of(blocks);
}

}  // namespace deltamap::test
