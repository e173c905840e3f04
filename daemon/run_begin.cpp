// SPDX-License-Identifier: Apache-2.0
#include "daemon/run_begin.hpp"

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <span>

#include "daemon/fingerprint.hpp"
#include "mapping/map_codec.hpp"

namespace deltamap::daemon {
namespace {

using Json = nlohmann::ordered_json;
using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kPartChars = 60'000;  // a pcapng option holds 65535
constexpr std::size_t kTileBytes = 4;       // of a StabilityRecord
constexpr std::string_view kAlphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

std::string_view as_text(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// RFC 4648, section 4.
std::string base64_of(std::string_view bytes) {
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t held = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t j = 0; j < 3; ++j) {
      group = group << 8 | (j < held ? static_cast<unsigned char>(bytes[i + j]) : 0u);
    }
    for (std::size_t j = 0; j < 4; ++j) text += j <= held ? kAlphabet[group >> (18 - 6 * j) & 63] : '=';
  }
  return text;
}

/// Nothing where the text is no base64.
std::optional<std::string> bytes_of_base64(std::string_view text) {
  std::string bytes;
  std::uint32_t group = 0;
  int bits = 0;
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  for (const char c : text) {
    const std::size_t value = kAlphabet.find(c);
    if (value == std::string_view::npos) return std::nullopt;
    group = (group << 6 | static_cast<std::uint32_t>(value)) & 0xFFFFFFu;
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes += static_cast<char>(group >> bits & 0xFF);
  }
  return bytes;
}

/// Runs of equal tiles, as most of them have nothing to tell: length (1 to 255), tile.
Bytes packed_tiles(const Bytes& tiles) {
  Bytes packed;
  for (std::size_t at = 0; at + kTileBytes <= tiles.size();) {
    const auto tile = std::span(tiles).subspan(at, kTileBytes);
    std::size_t run = 1;
    while (run < 255 && at + (run + 1) * kTileBytes <= tiles.size() &&
           std::equal(tile.begin(), tile.end(), tiles.begin() + static_cast<std::ptrdiff_t>(at + run * kTileBytes))) {
      ++run;
    }
    packed.push_back(static_cast<std::uint8_t>(run));
    packed.insert(packed.end(), tile.begin(), tile.end());
    at += run * kTileBytes;
  }
  return packed;
}

Bytes unpacked_tiles(std::string_view packed) {
  Bytes tiles;
  for (; packed.size() > kTileBytes; packed.remove_prefix(1 + kTileBytes)) {
    for (unsigned run = static_cast<unsigned char>(packed[0]); run > 0; --run) {
      for (const char byte : packed.substr(1, kTileBytes)) tiles.push_back(static_cast<std::uint8_t>(byte));
    }
  }
  return tiles;
}

Json as_json(const GridGeometry& geometry) {
  return {{"width", geometry.width},
          {"height", geometry.height},
          {"resolution_m", geometry.resolution_m},
          {"origin_m", {geometry.origin.x(), geometry.origin.y()}}};
}

GridGeometry geometry_in(const Json& json) {
  return {json.at("width").get<int>(), json.at("height").get<int>(), json.at("resolution_m").get<double>(),
          Point2{json.at("origin_m").at(0).get<double>(), json.at("origin_m").at(1).get<double>()}};
}

/// Throws Json::exception where the head is not what begin_notes() writes; nothing where the bytes are not.
std::optional<RunBegin> begin_in(const Json& head, std::string_view bytes) {
  RunBegin begin;
  begin.first_map = head.at("first_map").get<std::uint64_t>();
  begin.memory = head.at("memory").get<std::uint64_t>();
  begin.start.revision = head.at("revision").get<std::uint32_t>();
  if (const auto pose = head.find("pose"); pose != head.end()) {
    begin.start.remembered = Pose2{pose->at(0).get<double>(), pose->at(1).get<double>(), pose->at(2).get<double>()};
  }
  const auto map_size = head.at("map_bytes").get<std::size_t>();
  if (map_size > bytes.size()) return std::nullopt;
  if (const auto map = head.find("map"); map != head.end()) {
    auto grid = mapping::decoded_grid(std::span(reinterpret_cast<const std::uint8_t*>(bytes.data()), map_size),
                                      geometry_in(*map));
    if (!grid) return std::nullopt;
    begin.start.map = std::make_shared<const OccupancyGrid>(std::move(*grid));
  }
  if (const auto stability = head.find("stability"); stability != head.end()) {
    begin.start.stability = {geometry_in(*stability), stability->at("cells_a_tile").get<int>(),
                             unpacked_tiles(bytes.substr(map_size))};
  }
  return begin;
}

/// 16 hexadecimal digits: the checksum of all that follows.
std::string sealed(const std::string& content) {
  char checksum[24];
  (void)std::snprintf(checksum, sizeof checksum, "%016" PRIx64, fingerprint_of(content));
  return checksum + content;
}

std::optional<RunBegin> begin_of(const std::string& bytes) {
  const auto end = bytes.find('\n');
  if (end == std::string::npos || end < 16 || sealed(bytes.substr(16)) != bytes) return std::nullopt;
  try {
    return begin_in(Json::parse(bytes.begin() + 16, bytes.begin() + static_cast<std::ptrdiff_t>(end)),
                    std::string_view(bytes).substr(end + 1));
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

}  // namespace

std::vector<std::string> begin_notes(const RunBegin& begin) {
  const StartMap& start = begin.start;
  if (start.revision == 0 && !start.remembered && !start.stability) return {};
  Json head{{"first_map", begin.first_map}, {"memory", begin.memory}, {"revision", start.revision}};
  Bytes bytes;
  if (start.revision > 0) {
    head["map"] = as_json(start.map->geometry());
    bytes = mapping::encoded_grid(*start.map);
  }
  head["map_bytes"] = bytes.size();
  if (start.remembered) head["pose"] = {start.remembered->x, start.remembered->y, start.remembered->theta};
  if (start.stability) {
    head["stability"] = as_json(start.stability->geometry);
    head["stability"]["cells_a_tile"] = start.stability->cells_a_tile;
    const Bytes tiles = packed_tiles(start.stability->bytes);
    bytes.insert(bytes.end(), tiles.begin(), tiles.end());
  }
  const std::string text = base64_of(sealed(head.dump().append("\n").append(as_text(bytes))));
  const std::size_t parts = (text.size() + kPartChars - 1) / kPartChars;
  std::vector<std::string> notes;
  for (std::size_t part = 0; part < parts; ++part) {
    notes.push_back("began from " + std::to_string(part + 1) + "/" + std::to_string(parts) + " " +
                    text.substr(part * kPartChars, kPartChars));
  }
  return notes;
}

void BeginReader::read(std::string_view note) {
  unsigned part = 0;
  unsigned parts = 0;
  int head = 0;
  const std::string start{note.substr(0, 40)};
  if (std::sscanf(start.c_str(), "began from %u/%u %n", &part, &parts, &head) != 2 || head == 0 || parts == 0) return;
  if (part == 1) forget();
  parts_ = parts;
  if (part != read_ + 1) return;  // one is missing: never complete
  ++read_;
  text_ += note.substr(static_cast<std::size_t>(head));
  if (read_ != parts_) return;
  if (const auto bytes = bytes_of_base64(text_)) begin_ = begin_of(*bytes);
  text_ = {};
}

}  // namespace deltamap::daemon
